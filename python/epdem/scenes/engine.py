# SPDX-License-Identifier: GPL-2.0-or-later
"""The interface of an engine of bulk scenes: a plan goes in, tables come out."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from ..jobs.engine import Engine, Report
from ..jobs.stage import Tables
from .plan import ScenePlan


@dataclass(frozen=True)
class Resumed:
    """Step from which a run was continued; `lost`: steps of earlier frames that are missing or not whole."""

    step: int
    lost: list[int] = field(default_factory=list)


class SceneEngine(Engine[ScenePlan, Tables], Protocol):
    """An engine of scenes, whose tables are rows, particles, contacts, walls and phases, as far as a plan has them."""

    def resume(self, job: ScenePlan, folder: Path, *, ranks: int, report: Report) -> tuple[Tables, Resumed]:
        """Continue a run from its newest restart file. Raises CaseError if there is none, EngineError."""
