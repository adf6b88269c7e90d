# SPDX-License-Identifier: GPL-2.0-or-later
"""What an engine of bulk scenes is: it takes a plan and gives tables. Its own words end here."""

from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import pandas as pd

from .plan import ScenePlan

Tell = Callable[[int], None]  # the step of a row that was written


@dataclass(frozen=True)
class Resumed:
    """From which step a run went on; `lost`: steps of earlier frames that are missing or not whole."""

    step: int
    lost: list[int] = field(default_factory=list)


class SceneEngine(Protocol):
    """One way to run a scene."""

    name: str
    subfolder: str  # of a case's results, where this engine puts its own if nothing else is asked for
    leftovers: tuple[str, ...]  # patterns of files that an earlier run may have left in the folder

    def refuse(self, *, ranks: int, resume: bool) -> None:
        """Raise CaseError for an option that the engine does not have, EngineError if it cannot run here."""

    def version(self) -> str:
        """One line: the engine's version."""

    def files(self, plan: ScenePlan) -> dict[str, str]:
        """Everything written for the engine, by path in the folder; it runs by hand there.

        Raises CaseError for what the engine cannot do.
        """

    def notes(self, plan: ScenePlan) -> list[str]:
        """What of the case the engine leaves out, in words."""

    def run(self, plan: ScenePlan, folder: Path, *, ranks: int, tell: Tell) -> None:
        """Run what `files` holds, written into `folder`. Raises EngineError with the engine's last words."""

    def resume(self, plan: ScenePlan, folder: Path, *, ranks: int, tell: Tell) -> Resumed:
        """Go on from the newest restart file. Raises CaseError if there is none, EngineError."""

    def read(self, plan: ScenePlan, folder: Path, *, without: Collection[int] = ()) -> dict[str, pd.DataFrame]:
        """The tables rows, particles and contacts, as far as the plan has them; SI. No frames of the steps `without`.

        Raises EngineError for any other frame that is missing or not whole.
        """
