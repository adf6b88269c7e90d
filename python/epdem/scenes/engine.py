# SPDX-License-Identifier: GPL-2.0-or-later
"""The interface of an engine of bulk scenes: a plan goes in, tables come out."""

from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import pandas as pd

from ..errors import CaseError, EngineError
from ..impacts.engine import Abilities, check_law, refuse_ranks
from .plan import ScenePlan

Report = Callable[[int], None]  # the step of a row that was written


@dataclass(frozen=True)
class Resumed:
    """From which step a run went on; `lost`: steps of earlier frames that are missing or not whole."""

    step: int
    lost: list[int] = field(default_factory=list)


class SceneEngine(Protocol):
    """One way to run a scene."""

    name: str
    can: Abilities
    subfolder: str  # of a case's results, where the default results folder of this engine is
    leftovers: tuple[str, ...]  # patterns of files that an earlier run may have left in the folder

    def missing(self) -> str | None:
        """None if the engine can run here, else a sentence with the command that installs it."""

    def version(self) -> str:
        """One line: the engine's version."""

    def files(self, plan: ScenePlan) -> dict[str, str]:
        """Everything written for the engine, by path in the folder; it runs by hand there.

        Raises CaseError for what no ability names; others call `files` below.
        """

    def notes(self, plan: ScenePlan) -> list[str]:
        """The parts of the case that the engine leaves out, in words."""

    def run(self, plan: ScenePlan, folder: Path, *, ranks: int, report: Report) -> None:
        """Run what `files` holds, written into `folder`. Raises EngineError with the end of the engine's log."""

    def resume(self, plan: ScenePlan, folder: Path, *, ranks: int, report: Report) -> Resumed:
        """Go on from the newest restart file. Raises CaseError if there is none, EngineError."""

    def read(self, plan: ScenePlan, folder: Path, *, without: Collection[int] = ()) -> dict[str, pd.DataFrame]:
        """The tables rows, particles and contacts, as far as the plan has them; SI. No frames of the steps `without`.

        Raises EngineError for any other frame that is missing or not whole.
        """


def files(engine: SceneEngine, p: ScenePlan) -> dict[str, str]:
    """Everything written for the engine, by path in the folder. Raises CaseError for what the engine cannot do."""
    kind, law, can = p.case.scene.kind, p.model.law, engine.can
    if kind not in can.scenes:
        known = ", ".join(can.scenes)
        raise CaseError(f"scene.kind = {kind!r}: engine {engine.name} runs {known}; use another --engine")
    check_law(engine.name, can, law)
    return engine.files(p)


def check_run(engine: SceneEngine, *, ranks: int = 1, resume: bool = False) -> None:
    """Raise CaseError for what a run asks of an engine that cannot do it, EngineError if it is not here."""
    refuse_ranks(engine.name, engine.can.ranks, ranks)
    if resume and not engine.can.restarts:
        raise CaseError(f"--resume: a scene in {engine.name} runs from its start; leave it out")
    if reason := engine.missing():
        raise EngineError(reason)
