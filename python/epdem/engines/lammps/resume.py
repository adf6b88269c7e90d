# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene in LAMMPS that continues from a restart file."""

import re
from dataclasses import replace
from pathlib import Path

from ...base import rendering as decks
from ...scenes.plan.plan import ScenePlan
from ..restarts import later, phase_at
from . import launcher
from .deck import Restart, SceneDeck, deck
from .scene_walls import DeckWall, motions_again, plane, power


def write_resume(p: ScenePlan, folder: Path, step: int) -> Path:
    """in.resume, which continues from the restart file of `step`."""
    path, out = folder / "in.resume", folder / launcher.OUT
    path.write_text(decks.render("lammps/scene.in.j2", deck=_continued(p, out, step)), encoding="utf-8")
    return path


def _continued(p: ScenePlan, out: Path, step: int) -> SceneDeck:
    d = deck(p)
    number, begin = phase_at(p, out, step)
    phases = d.phases[number:]
    inside = bool(phases) and step > begin
    if inside:
        part, gone = phases[0], step - begin
        rest = replace(part, steps=part.steps - gone, stop=later(part.stop, out, step, gone, p.every))
        phases = (
            replace(rest, time_step=None, data=None, temperatures=(), fills=(), gates=(), commands=()),
            *phases[1:],
        )
    last = number if inside else number - 1  # the phase whose motions and planes the restart file meets
    return replace(
        d,
        phases=phases,
        power=power(p, p.phases[last]),
        motions=tuple(motions_again(p, last, _printed(out, step))),
        restart=Restart(f"restart.{step}.bin", tuple(_gates(p, last, ended=not inside))),
    )


def _gates(p: ScenePlan, number: int, *, ended: bool) -> list[DeckWall]:
    """The planes of some phases that are there in a phase, or after it has ended, in the order of their fixes."""
    there: list[str] = []
    for run in p.phase_steps[: number + 1]:
        there += run.added
        if ended or run.name != p.phases[number].name:
            there = [name for name in there if name not in run.removed]
    walls = {w.name: w for w in p.scene.gates}
    return [plane(p, walls[name]) for name in there]


def _printed(out: Path, step: int) -> dict[str, str]:
    """The values of the variables of motions that the run printed at a step."""
    text = out.read_text(encoding="utf-8", errors="replace")
    lines = re.findall(rf"^motions at step {step}: (.*)$", text, re.M)
    return dict(value.split("=") for value in lines[-1].split()) if lines else {}
