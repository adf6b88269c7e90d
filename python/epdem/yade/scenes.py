# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE as an engine of bulk scenes."""

from collections.abc import Collection
from pathlib import Path

import pandas as pd

from ..base.processes import call
from ..errors import CaseError
from ..scenes.engine import Report, Resumed
from ..scenes.plan import ScenePlan
from . import scene_deck
from . import scene_tables as tables
from .impacts import Yade
from .launcher import command, environment

OUT = "out.yade"


class YadeScenes:
    """YADE with our laws; a run begins at its start and has one core."""

    name = Yade.name
    can = Yade.can
    subfolder = "yade"
    leftovers: tuple[str, ...] = ("particles.*.npy", "contacts.*.npy")

    def missing(self) -> str | None:
        return Yade().missing()

    def version(self) -> str:
        return Yade().version()

    def files(self, plan: ScenePlan) -> dict[str, str]:
        return scene_deck.files(plan)

    def notes(self, plan: ScenePlan) -> list[str]:
        return scene_deck.notes(plan)

    def run(self, plan: ScenePlan, folder: Path, *, ranks: int, report: Report) -> None:
        call([command(), "-n", "-x", scene_deck.SCRIPT], folder, log=OUT, env=environment(), report=report)

    def resume(self, plan: ScenePlan, folder: Path, *, ranks: int, report: Report) -> Resumed:
        raise CaseError(f"{folder}: a scene in YADE runs from its start; run it anew")

    def read(self, plan: ScenePlan, folder: Path, *, without: Collection[int] = ()) -> dict[str, pd.DataFrame]:
        return tables.read(plan, folder, folder / OUT)
