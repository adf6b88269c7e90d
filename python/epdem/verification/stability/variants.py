# SPDX-License-Identifier: GPL-2.0-or-later
"""An impact's deck made into another one: a second wall above the sphere, or a sphere carried up and down."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...engines.liggghts.engine import Liggghts
from ...engines.yade.engine import Yade
from ...errors import CaseError, EngineError
from ...impacts.engine import Trajectory
from ...impacts.plan import Plan
from .bench import Bench
from .running import Setting

CYCLE = 64  # samples of a cycle of overlaps: a triangle, up in the first half
LOWEST = 1 / 32  # smallest overlap of a cycle over the largest: contacts that end lose their history


@dataclass(frozen=True)
class Edit:
    """`lines` after, or `instead` of, the one line of a deck that begins with `start`."""

    start: str
    lines: tuple[str, ...]
    instead: bool = False


class LiggghtsEdits:
    """Edits of LIGGGHTS's deck. unknown: samples at the start that the history of a contact does not know.

    LIGGGHTS evaluates the contacts at t = 0 without storing their history.
    """

    deck, wall, unknown = "in.impact", "fix target all wall/gran", 1

    def second_wall(self, line: str, z: float) -> str:
        """The line of a second wall at height z [m] from that of the wall at height 0."""
        return line.replace("fix target", "fix ceiling").replace("zplane 0.0", f"zplane {z!r}")

    def carry(self, place: float, rise: float, steps: int) -> list[Edit]:
        """Carry the sphere from `place` [m] down by `rise` [m] and back, in cycles of `steps` with the same bits."""
        lines = (
            f"variable at equal step-{steps}*floor(step/{steps})",
            f"variable dz atom {-rise!r}*(1-abs(v_at/{steps // 2}-1))",
            "variable vz atom 0",
            "fix motion all move variable NULL NULL v_dz NULL NULL v_vz",
        )
        return [Edit("fix motion", lines, instead=True)]


class YadeEdits:
    """The same of YADE's script."""

    deck, wall, unknown = "impact.py", "O.bodies.append(wall(0,", 0

    def second_wall(self, line: str, z: float) -> str:
        return line.replace("wall(0,", f"wall({z!r},")

    def carry(self, place: float, rise: float, steps: int) -> list[Edit]:
        height = f"{place!r} - {rise!r} * (1 - abs((O.iter + 1) % {steps} / {steps // 2} - 1))"
        return [
            Edit("states =", ("for s in states:", '    s.blockedDOFs = "xyzXYZ"')),
            Edit("    now[2]", ("    for s in states:", f"        s.pos = (s.pos[0], s.pos[1], {height})")),
        ]


def edits(bench: Bench) -> LiggghtsEdits | YadeEdits:
    """The edits of an engine's deck. Raises CaseError for an engine without."""
    if isinstance(bench.tool, Liggghts):
        return LiggghtsEdits()
    if isinstance(bench.tool, Yade):
        return YadeEdits()
    raise CaseError(f"engine {bench.name}: its deck cannot be made into this set-up; take liggghts or yade")


def edit(deck: Path, change: Edit) -> str:
    """Change a deck; returns the line at which it is changed. Raises EngineError if there is not exactly one."""
    lines = deck.read_text(encoding="utf-8").splitlines()
    places = [k for k, line in enumerate(lines) if line.startswith(change.start)]
    if len(places) != 1:
        raise EngineError(f"{deck}: {len(places)} lines start with {change.start!r}, expected 1")
    at = places[0]
    line = lines[at]
    lines[at : at + 1] = change.lines if change.instead else [line, *change.lines]
    deck.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return line


def between_walls(s: Setting, bench: Bench, overlap: float, time_step: float, steps: int) -> Trajectory:
    """A sphere that overlaps two walls by `overlap` [m] at the start and moves towards the first."""
    x, known = s.x, edits(bench)
    p, deck = Plan(x, time_step, steps, 1, x.speed[:1], np.array([-overlap])), bench.folder / known.deck
    bench.tool.write(p, bench.folder)
    first = edit(deck, Edit(known.wall, ()))
    edit(deck, Edit(known.wall, (known.second_wall(first, 2 * (x.body.radius - overlap)),)))
    return bench.tool.run(p, bench.folder)


def carried(s: Setting, bench: Bench, cycles: int) -> Trajectory:
    """A sphere carried from LOWEST to its largest overlap and back, `cycles` times CYCLE steps with the same bits."""
    known, low = edits(bench), LOWEST * s.overlap_max
    p = Plan(s.x, 1e-3 * s.limit, cycles * CYCLE, 1, np.zeros(1), np.array([-low]))
    bench.tool.write(p, bench.folder)
    for change in known.carry(s.x.body.radius - low, s.overlap_max - low, CYCLE):
        edit(bench.folder / known.deck, change)
    return bench.tool.run(p, bench.folder)
