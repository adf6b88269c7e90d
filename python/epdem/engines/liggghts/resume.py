# SPDX-License-Identifier: GPL-2.0-or-later
"""Bulk scenes in LIGGGHTS: a run, and one that continues from a restart file."""

import contextlib
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from ...base import rendering as decks
from ...errors import EngineError
from ...jobs.engine import Report
from ...scenes.plan import ScenePlan
from .. import log
from ..restarts import later, phase_at, pruning
from . import launcher
from .deck import SceneDeck, deck
from .scene_parts import InsertFix


def run(plan: ScenePlan, folder: Path, *, ranks: int, report: Report) -> None:
    """Run the deck of a scene, which is in `folder`. Raises CaseError, EngineError."""
    with _lost_walls_named(folder):
        launcher.run("in.scene", folder, ranks=ranks, report=pruning(folder, report))


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


def run_on(plan: ScenePlan, folder: Path, step: int, *, ranks: int, report: Report) -> None:
    """Continue a run from the restart file of a step. Raises CaseError, EngineError."""
    script = write_resume(plan, folder, step)
    with _lost_walls_named(folder):
        launcher.run(script.name, folder, ranks=ranks, append=True, report=pruning(folder, report))


def _going_on(d: SceneDeck, phase: int, inserted: dict[str, int]) -> Iterator[InsertFix]:
    """The insertions of a run that goes on in a phase, without streams that have ended: LIGGGHTS refuses these. A
    stream of an earlier phase goes on in this one."""
    names = [part.run.name for part in d.phases]
    for f in d.insertions:
        if f.once:
            yield f
        elif inserted.get(f.id, 0) < f.count:
            yield replace(f, phase=names[min(max(names.index(f.phase), phase), len(names) - 1)])


def write_resume(p: ScenePlan, folder: Path, step: int) -> Path:
    """in.resume, which continues from the restart file of `step`."""
    d = deck(p)
    number, begin = phase_at(p, folder / launcher.OUT, step)
    comes = False  # spheres that come with this phase and are not in the restart file
    if number < len(p.phases):
        part = d.phases[number]
        at_once = [f for f in d.insertions if f.once and f.phase == part.run.name]
        comes = step == begin and bool(part.particles or at_once)
        gone = step - begin
        rest = replace(part, steps=part.steps - gone, stop=later(part.stop, gone, p.every))
        d = replace(d, phases=(*d.phases[:number], rest, *d.phases[number + 1 :]))
    path = folder / "in.resume"
    going_on = tuple(_going_on(d, number, log.inserted(folder / launcher.OUT, step)))
    continued = replace(d, insertions=going_on, from_restart=f"restart.{step}.bin", resumed_phase=number, comes=comes)
    path.write_text(decks.render("liggghts/scene_resume.in.j2", deck=continued), encoding="utf-8")
    return path
