# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS as an engine of bulk scenes."""

from collections.abc import Collection
from pathlib import Path

import pandas as pd

from ..base import paths
from ..case.parts import Parts
from ..errors import CaseError
from ..scenes.engine import Report, Resumed
from ..scenes.plan import ScenePlan
from . import executable, launcher, resume, scene_deck, wall_stress
from . import scene_tables as tables
from .impacts import Liggghts


class LiggghtsScenes:
    """LIGGGHTS with our models."""

    name = Liggghts.name
    can = Liggghts.can
    subfolder = ""
    leftovers: tuple[str, ...] = (
        "particles.*.bin",
        "contacts.*.txt",
        "wall_contacts.*.txt",
        "restart.*.bin",
        "scene_*.vtk",
        "stress_*.vtk",
        "picture.*.ppm",
        "in.resume",
    )

    def missing(self) -> str | None:
        return launcher.missing()

    def version(self) -> str:
        return Liggghts().version()

    def files(self, plan: ScenePlan) -> dict[str, str]:
        return scene_deck.files(plan)

    def notes(self, plan: ScenePlan) -> list[str]:
        return []

    def run(self, plan: ScenePlan, folder: Path, *, ranks: int, report: Report) -> None:
        _refuse_vtk(plan)
        launcher.run("in.scene", folder, ranks=ranks, report=_pruning(folder, report))

    def resume(self, plan: ScenePlan, folder: Path, *, ranks: int, report: Report) -> Resumed:
        _refuse_vtk(plan)
        step, lost = resume.choose(plan, folder)
        deck = resume.write_resume(plan, folder, step)
        launcher.run(deck.name, folder, ranks=ranks, append=True, report=_pruning(folder, report))
        return Resumed(step, lost)

    def read(self, plan: ScenePlan, folder: Path, *, without: Collection[int] = ()) -> dict[str, pd.DataFrame]:
        plan = plan.ended(tables.ends(folder)) if plan.ends_early else plan
        read = {"rows": tables.rows(plan, folder / launcher.OUT)}
        if isinstance(plan.case.scene, Parts):
            read["phases"] = plan.phase_table
        if plan.frames:
            read["particles"] = tables.particles(plan, folder, without=without)
        if plan.contacts:
            read["contacts"] = tables.contact_table(plan, folder, read["particles"], without=without)
        if wall_stress.watched(plan):
            read["walls"] = wall_stress.table(plan, folder, without=without)
        return read


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
        resume.prune(folder, step)
        report(step)

    return row
