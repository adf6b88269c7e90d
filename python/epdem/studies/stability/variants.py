# SPDX-License-Identifier: GPL-2.0-or-later
"""An impact's deck made into another one: a second wall above the sphere, or a sphere carried up and down."""

from pathlib import Path

import numpy as np

from ...errors import EngineError
from ...impacts.engine import Trajectory
from ...impacts.plan import Plan
from .running import Setting
from .sampling import PositionSampler

CYCLE = 64  # samples of a cycle of overlaps: a triangle, up in the first half
LOWEST = 1 / 32  # smallest overlap of a cycle over the largest: contacts that end lose their history

DECK = {"liggghts": "in.impact", "yade": "impact.py"}
# the line that makes the wall at height 0, and what makes of it the line of a second wall at `z`
WALL = {
    "liggghts": ("fix target all wall/gran", {"fix target": "fix ceiling", "zplane 0.0": "zplane {z!r}"}),
    "yade": ("O.bodies.append(wall(0,", {"wall(0,": "wall({z!r},"}),
}


def edit(deck: Path, start: str, *after: str, instead: bool = False) -> str:
    """Put lines after (or `instead` of) the one line that starts with `start`; returns that line.

    Raises EngineError if there is not exactly one.
    """
    lines = deck.read_text(encoding="utf-8").splitlines()
    places = [k for k, line in enumerate(lines) if line.startswith(start)]
    if len(places) != 1:
        raise EngineError(f"{deck}: {len(places)} lines start with {start!r}, expected 1")
    at = places[0]
    line = lines[at]
    lines[at : at + 1] = after if instead else [line, *after]
    deck.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return line


def between_walls(s: Setting, sampler: PositionSampler, overlap: float, time_step: float, steps: int) -> Trajectory:
    """A sphere that overlaps two walls by `overlap` [m] at the start and moves towards the first."""
    x, deck = s.x, sampler.folder / DECK[sampler.name]
    p = Plan(x, time_step, steps, 1, x.speed[:1], np.array([-overlap]))
    sampler.engine.write(p, sampler.folder)
    start, changes = WALL[sampler.name]
    second = edit(deck, start)
    for old, new in changes.items():
        second = second.replace(old, new.format(z=2 * (x.body.radius - overlap)))
    edit(deck, start, second)
    return sampler.engine.run(p, sampler.folder)


def carried(s: Setting, sampler: PositionSampler, cycles: int) -> Trajectory:
    """A sphere carried from LOWEST to its largest overlap and back, `cycles` times CYCLE steps with the same bits."""
    deck, low, R = sampler.folder / DECK[sampler.name], LOWEST * s.overlap_max, s.x.body.radius
    p = Plan(s.x, 1e-3 * s.limit, cycles * CYCLE, 1, np.zeros(1), np.array([-low]))
    sampler.engine.write(p, sampler.folder)
    rise, half = s.overlap_max - low, CYCLE // 2
    if sampler.name == "liggghts":
        edit(
            deck,
            "fix motion",
            f"variable at equal step-{CYCLE}*floor(step/{CYCLE})",
            f"variable dz atom {-rise!r}*(1-abs(v_at/{half}-1))",
            "variable vz atom 0",
            "fix motion all move variable NULL NULL v_dz NULL NULL v_vz",
            instead=True,
        )
    else:
        edit(deck, "states =", "for s in states:", '    s.blockedDOFs = "xyzXYZ"')
        height = f"{R - low!r} - {rise!r} * (1 - abs((O.iter + 1) % {CYCLE} / {half} - 1))"
        edit(deck, "    now[2]", "    for s in states:", f"        s.pos = (s.pos[0], s.pos[1], {height})")
    return sampler.engine.run(p, sampler.folder)
