# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene in LIGGGHTS that continues from a restart file."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from ...base import rendering as decks
from ...scenes.plan.plan import ScenePlan
from .. import log
from ..restarts import later, phase_at
from . import launcher
from .deck import SceneDeck, deck
from .scene_parts import InsertFix


def _going_on(d: SceneDeck, phase: int, inserted: dict[str, int]) -> Iterator[InsertFix]:
    """The insertions of a run that goes on in a phase, without streams that have ended: LIGGGHTS refuses these. A
    stream of an earlier phase goes on in this one."""
    names = [part.run.name for part in d.phases]
    for f in d.insertions:
        if f.fill.rate is None:
            yield f
        elif inserted.get(f"fill{f.number}", 0) < f.fill.count:
            number = min(max(names.index(f.fill.phase), phase), len(names) - 1)
            yield replace(f, fill=replace(f.fill, phase=names[number]))


def write_resume(p: ScenePlan, folder: Path, step: int) -> Path:
    """in.resume, which continues from the restart file of `step`."""
    d = deck(p)
    number, begin = phase_at(p, folder / launcher.OUT, step)
    comes = False  # spheres that come with this phase and are not in the restart file
    if number < len(p.phases):
        part = d.phases[number]
        at_once = [f for f in d.insertions if f.fill.rate is None and f.fill.phase == part.run.name]
        comes = step == begin and bool(part.bodies or at_once)
        gone = step - begin
        stop = later(part.stop, folder / launcher.OUT, step, gone, p.every)
        rest = replace(part, steps=part.steps - gone, stop=stop)
        d = replace(d, phases=(*d.phases[:number], rest, *d.phases[number + 1 :]))
    path = folder / "in.resume"
    going_on = tuple(_going_on(d, number, log.inserted(folder / launcher.OUT, step)))
    continued = replace(d, insertions=going_on, from_restart=f"restart.{step}.bin", resumed_phase=number, comes=comes)
    path.write_text(decks.render("liggghts/scene_resume.in.j2", deck=continued), encoding="utf-8")
    return path
