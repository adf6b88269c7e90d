# SPDX-License-Identifier: GPL-2.0-or-later
"""Bulk scenes in YADE: run and read."""

from pathlib import Path

from ...base.processes import call
from ...impacts.engine import Report
from ...scenes.engine import Tables
from ...scenes.plan import ScenePlan
from . import scene_deck
from . import scene_tables as tables
from .launcher import command, environment

OUT = "out.yade"
LEFTOVERS = ("particles.*.npy", "contacts.*.npy")  # patterns of files that an earlier run may have left in the folder


def run(folder: Path, *, report: Report) -> None:
    """Run the script of a scene, which is in `folder`. Raises EngineError."""
    call([command(), "-n", "-x", scene_deck.SCRIPT], folder, log=OUT, env=environment(), report=report)


def read(plan: ScenePlan, folder: Path) -> Tables:
    """The tables of a run. Raises EngineError."""
    return tables.read(plan, folder, folder / OUT)
