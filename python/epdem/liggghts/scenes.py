# SPDX-License-Identifier: GPL-2.0-or-later
"""Bulk scenes in LIGGGHTS: run, continue, read."""

from collections.abc import Collection
from pathlib import Path

from ..base import paths
from ..case.parts import Parts
from ..errors import CaseError
from ..impacts.engine import Report
from ..scenes.engine import Resumed, Tables
from ..scenes.plan import ScenePlan
from . import executable, launcher, wall_stress
from . import resume as restarts
from . import scene_tables as tables

# patterns of files that an earlier run may have left in the folder
LEFTOVERS = (
    "particles.*.bin",
    "contacts.*.txt",
    "wall_contacts.*.txt",
    "restart.*.bin",
    "scene_*.vtk",
    "stress_*.vtk",
    "picture.*.ppm",
    "in.resume",
)


def run(plan: ScenePlan, folder: Path, *, ranks: int, report: Report) -> None:
    """Run the deck of a scene, which is in `folder`. Raises CaseError, EngineError."""
    _refuse_vtk(plan)
    launcher.run("in.scene", folder, ranks=ranks, report=_pruning(folder, report))


def resume(plan: ScenePlan, folder: Path, *, ranks: int, report: Report) -> Resumed:
    """Continue a run from its newest restart file. Raises CaseError, EngineError."""
    _refuse_vtk(plan)
    step, lost = restarts.choose(plan, folder)
    deck = restarts.write_resume(plan, folder, step)
    launcher.run(deck.name, folder, ranks=ranks, append=True, report=_pruning(folder, report))
    return Resumed(step, lost)


def read(plan: ScenePlan, folder: Path, *, without: Collection[int] = ()) -> Tables:
    """The tables of a run, without the frames of the steps `without`.

    Raises EngineError for any other frame that is missing or not whole.
    """
    plan = plan.ended(tables.ends(folder)) if plan.ends_early else plan
    found = {"rows": tables.rows(plan, folder / launcher.OUT)}
    if isinstance(plan.case.scene, Parts):
        found["phases"] = plan.phase_table
    if plan.frames:
        found["particles"] = tables.particles(plan, folder, without=without)
    if plan.contacts:
        found["contacts"] = tables.contact_table(plan, folder, found["particles"], without=without)
    if wall_stress.stress_walls(plan):
        found["walls"] = wall_stress.table(plan, folder, without=without)
    return found


def _refuse_vtk(plan: ScenePlan) -> None:
    """Raise CaseError for VTK files of a LIGGGHTS without VTK."""
    path = paths.launcher()
    if plan.vtk and path and not executable.writes_vtk(path):
        raise CaseError(
            f"output.vtk: {path} was built without VTK; leave output.vtk out (output.particles holds the same), or "
            "take a LIGGGHTS with VTK"
        )


def _pruning(folder: Path, report: Report) -> Report:
    def row(step: int) -> None:
        restarts.prune(folder, step)
        report(step)

    return row
