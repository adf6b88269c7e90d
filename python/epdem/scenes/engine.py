# SPDX-License-Identifier: GPL-2.0-or-later
"""The interface of an engine of bulk scenes: a plan goes in, tables come out."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from ..base.files import claim
from ..errors import CaseError, EngineError
from ..jobs.engine import Engine, Feature, Report, refuse_ranks
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


def files(engine: SceneEngine, p: ScenePlan) -> dict[str, str]:
    """The text of every file of a scene by its path in the folder. Raises CaseError for what the engine cannot do."""
    engine.check(p)
    return engine.files(p)


def write_deck(engine: SceneEngine, p: ScenePlan, folder: Path, *, force: bool = False) -> list[Path]:
    """Write the deck of a scene into `folder`, where `force` allows other files; its files. Raises CaseError."""
    found = files(engine, p)
    with claim(folder, force=force, files=found):
        return engine.put(found, folder)


def check_run(engine: SceneEngine, *, ranks: int = 1, resume: bool = False) -> None:
    """Raise CaseError for a request that the engine does not support, EngineError if the engine is missing."""
    refuse_ranks(engine, ranks)
    if resume and Feature.RESTART not in engine.features:
        raise CaseError(f"--resume: a scene in {engine.name} runs from its start; leave it out")
    if reason := engine.missing():
        raise EngineError(reason)
