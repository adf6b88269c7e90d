# SPDX-License-Identifier: GPL-2.0-or-later
"""Bulk scenes in LIGGGHTS: run, continue, read."""

import contextlib
import re
from collections.abc import Collection, Iterator
from pathlib import Path

from ...base import paths
from ...case.parts import Parts
from ...errors import CaseError, EngineError
from ...impacts.engine import Report
from ...scenes.engine import Resumed, Tables
from ...scenes.plan import ScenePlan
from .. import log
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
    with _lost_walls_named(folder):
        launcher.run("in.scene", folder, ranks=ranks, report=_pruning(folder, report))


@contextlib.contextmanager
def _lost_walls_named(folder: Path) -> Iterator[None]:
    """An error of LIGGGHTS about a mesh that has left the domain names the wall and the step."""
    try:
        yield
    except EngineError as error:
        lost = re.search(r"Mesh \(id (?:wall_)?(\w+)\): Mesh elements have been lost", str(error))
        if lost is None:
            raise
        step = int(log.rows(folder / launcher.OUT)["Step"].iloc[-1])
        raise EngineError(
            f"scene.wall.{lost[1]}: the wall has left scene.room after step {step}; enlarge the room, or stop the wall "
            f"before by the duration or the 'until' of its phase ({folder / launcher.OUT})"
        ) from None


def resume(plan: ScenePlan, folder: Path, *, ranks: int, report: Report) -> Resumed:
    """Continue a run from its newest restart file. Raises CaseError, EngineError."""
    _refuse_vtk(plan)
    step, lost = restarts.choose(plan, folder)
    deck = restarts.write_resume(plan, folder, step)
    with _lost_walls_named(folder):
        launcher.run(deck.name, folder, ranks=ranks, append=True, report=_pruning(folder, report))
    return Resumed(step, lost)


def read(plan: ScenePlan, folder: Path, *, without: Collection[int] = ()) -> Tables:
    """The tables of a run, without the frames of the steps `without`.

    Raises EngineError for any other frame that is missing or not whole.
    """
    out = folder / launcher.OUT
    plan = plan.ended(log.ends(out), log.not_reached(out)) if plan.ends_early else plan
    found = {"rows": log.scene_rows(plan, folder / launcher.OUT)}
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
