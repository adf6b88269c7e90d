# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases beside one impact: 1e9 steps of bounces, 10^4 reloads, and a sphere between two walls that it overlaps.

The sphere between walls has two contacts that yield, part and meet again, with an energy balance. Decks of impacts are
edited for it and for reloads.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.integrate import trapezoid

from ...engines.liggghts.engine import Liggghts
from ...engines.yade.engine import Yade
from ...errors import CaseError, EngineError, EpdemError
from ...impacts.engine import Trajectory
from ...impacts.plan import Plan, starting_phases
from ...laws.library import ImpactNumbers
from ...theory.backbones import Backbone
from ...theory.numerics import gauss
from .. import native
from ..runner import Row
from .cases import build
from .running import BROKEN, COARSE, FINE, POSITION_COARSE, Bench, Setting, order, position_floor, setting

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


BOUNCE_SHARE = 0.01  # of the stability limit: about 200 steps in contact


def bounces(s: Setting, total: int) -> Row:
    """Bounce one contact for `total` steps: its plastic work is done once, then it must neither gain nor lose."""
    dt = BOUNCE_SHARE * s.limit
    law, steps = s.x.native_law(), s.steps(dt)
    one = ImpactNumbers(R_star=s.x.R_star, m_star=s.x.m_star, speed=float(s.x.speed[0]), time_step=dt)
    trial, _ = native.bounces(law, 200, steps=steps, **one)
    count = int(np.ceil(1.01 * 200 * total / trial["steps"]))
    _, speeds = native.bounces(law, count, steps=steps, **one)
    # the first bounce yields for good; what comes after it should be elastic
    change = speeds / speeds[0]
    note = f"{count} bounces, speed off by {change[-1] - 1:+.1e} after the last"
    return {"e_n_error": float(np.abs(change - 1).max()), "created": float(change.max() ** 2 - 1), "notes": note}


def embedded_cycles(s: Setting, cycles: int) -> tuple[np.ndarray, np.ndarray]:
    """Overlap [m] and force [N] of a contact taken from alpha_max to zero and back, shape (cycles, samples)."""
    law, up = s.x.native_law(), np.linspace(0.0, s.overlap_max, 33)
    delta = np.concatenate([up[::-1], up[1:]])
    memory, force = np.array([s.overlap_max]), np.empty((cycles, delta.size))
    for k in range(cycles):
        force[k], _, after = law.step(R_star=s.x.R_star, delta_max=memory, delta=delta)
        memory = after[-1:]
    return np.broadcast_to(delta, force.shape), force


def position_cycles(s: Setting, bench: Bench, cycles: int) -> tuple[np.ndarray, np.ndarray]:
    """The same by an engine that carries the sphere; the cycle in which it is loaded first is left out."""
    got = carried(s, bench, cycles + 1)
    overlap, force = (
        np.lib.stride_tricks.sliding_window_view(a[0, CYCLE:], CYCLE + 1)[::CYCLE] for a in (got.overlap, got.force)
    )
    return overlap, force


def reloads(s: Setting, bench: Bench, cycles: int) -> Row:
    """Unload and reload a contact that reached alpha_max: forces repeat, are the law's, and a cycle does no work.

    drift: from cycle to cycle; off: from the law's force; over the largest force. work: of a cycle over the energy.
    """
    overlap, force = position_cycles(s, bench, cycles) if bench.positions else embedded_cycles(s, cycles)
    law = s.x.native_law().step(R_star=s.x.R_star, delta_max=overlap.max(), delta=overlap[0])[0]
    return {
        "cycles": len(force),
        "drift": float(np.abs(force - force[0]).max() / force.max()),
        "off": float(np.abs(force[0] - law).max() / law.max()),
        "work": float(np.abs(trapezoid(force, overlap, axis=1)).max() / s.energy),
    }


PERIODS = 20.0  # length of a run in stability limits


def stored(theory: Backbone, alpha: np.ndarray, top: np.ndarray) -> np.ndarray:
    """Elastic and plastic work in a contact [J] at overlap alpha that reached `top` > 0; arrays of one shape.

    On the elastic branch: what was put in less what came back from `top` to alpha, by Gauss points in an angle in
    which the branch is smooth at both of its ends.
    """
    (x, w), alpha = gauss(40), np.maximum(alpha, 0.0)
    recovered = np.asarray(theory.recovered_overlap(top))
    # alpha = top - recovered sin^2(angle)
    last = np.arcsin(np.sqrt(np.clip((top - alpha) / recovered, 0.0, 1.0)))
    angle = last[..., None] * x
    points = top[..., None] - recovered[..., None] * np.sin(angle) ** 2
    force = theory.unloading_force(np.maximum(points, 0.0), top[..., None])
    back = (force * np.sin(2 * angle)) @ w * recovered * last
    return np.asarray(np.where(top <= theory.yield_overlap, theory.work(alpha), theory.work(top) - back))


def embedded_path(s: Setting, time_step: float, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Overlap with the first wall [m] and velocity towards it [m/s], shape (steps + 1,), by velocity Verlet.

    Both walls overlap the sphere by alpha_max/2 at the start. A contact that ends loses its history.
    """
    x, law = s.x, s.x.native_law()
    half, d = 0.5 * time_step / x.m_star, s.overlap_max / 2
    z, v, memory = 0.0, float(x.speed[0]), np.zeros(2)
    overlap, speed = np.empty(steps + 1), np.empty(steps + 1)
    for n in range(steps + 1):
        alpha = np.array([d + z, d - z])
        force, _, memory = law.step(R_star=x.R_star, delta_max=np.where(alpha > 0, memory, 0.0), delta=alpha)
        push = half * (force[1] - force[0])
        v = v + push if n else v
        overlap[n], speed[n] = alpha[0], v
        v += push
        z += time_step * v
    return overlap, speed


def balance(s: Setting, overlap: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Kinetic, stored and lost energy over that at the start at every sample, shape of `overlap`."""
    theory, total = s.x.backbone(), 0.5 * s.x.m_star * velocity**2
    for alpha in (overlap, s.overlap_max - overlap):
        top, lost = np.empty_like(alpha), np.zeros_like(alpha)
        reached = gone = 0.0
        for n, a in enumerate(alpha):
            if a <= 0.0 < reached:  # the contact ends: its history is lost, its work is counted
                gone += float(theory.plastic_work(reached))
                reached = 0.0
            reached = max(reached, a)
            top[n], lost[n] = reached, gone
        touching = top > 0
        total = total + lost
        total[touching] += stored(theory, alpha[touching], top[touching])
    return np.asarray(total / total[0])


def path(s: Setting, bench: Bench, share: float) -> tuple[np.ndarray, np.ndarray]:
    """Overlap with the first wall [m] and velocity towards it [m/s] at a share of the limit of two springs."""
    time_step, steps = share * s.limit / np.sqrt(2.0), int(PERIODS / share)
    if not bench.positions:
        return embedded_path(s, time_step, steps)
    got = between_walls(s, bench, s.overlap_max / 2, time_step, steps)
    known = edits(bench).unknown  # the balance begins where the law knows the overlaps of the start
    return got.overlap[0, known:], got.velocity[0, known:]


def two_walls(s: Setting, bench: Bench) -> Row:
    """The energy balance of a sphere between two walls, which holds to second order in dt."""

    def off(share: float) -> np.ndarray:
        return balance(s, *path(s, bench, share)) - 1

    drift = [np.abs(off(share)).max() for share in FINE[:-1]]
    last = off(FINE[-1])
    drift.append(np.abs(last).max())
    coarse = POSITION_COARSE if bench.positions else COARSE
    breaks_at = next((share for share in coarse if not off(share).max() <= BROKEN), np.nan)
    found = {"e_n_error": drift[-1], "created": last.max(), "breaks_at": breaks_at}
    return found | order(FINE, drift, 1e-13)


FORMULA = "0.5 sqrt(N) eps R/delta_e"


def with_positions(s: Setting, time_step: float, gap: np.ndarray, steps: int) -> np.ndarray:
    """e_n of a sphere on a wall by velocity Verlet on the sphere's position, as any DEM engine does; shape of gap."""
    x, law = s.x, s.x.native_law()
    half, R = 0.5 * time_step / x.m_star, x.R_star
    z, v = R + gap, np.full_like(gap, -float(x.speed[0]))
    force, memory = np.zeros_like(gap), np.zeros_like(gap)
    for _ in range(steps):
        v = v + half * force
        z = z + time_step * v
        force, _, memory = law.step(R_star=R, delta_max=memory, delta=R - z)
        v = v + half * force
    return v / float(x.speed[0])


def floors(law: str, benches: Sequence[Bench], *, times: Sequence[float] = (1e-4, 1e-2, 3.0, 1e2)) -> pd.DataFrame:
    """One row per speed: overlap_max, recovered overlap [m], steps, and the largest deviation of e_n from long
    double over 8 phases.

    Columns: `double` (the C library), `positions` (this module's own), each engine's with positions, and `formula`.
    """
    rows = []
    for t in times:
        s = setting(build("roundoff", ratio=1e4, times=t), law)
        x, dt = s.x, 0.01 * s.limit
        steps, gap = s.steps(dt), starting_phases(8) * s.x.speed[0] * dt
        one = ImpactNumbers(R_star=x.R_star, m_star=x.m_star, speed=x.speed[0], time_step=dt, gap=gap)
        exact = native.impacts_long_double(x.native_law(), steps=steps, **one)["rebound_speed"] / x.speed[0]
        double = x.native_law().impacts(steps=steps, **one)["rebound_speed"]
        e_n = {"double": double / x.speed[0], "positions": with_positions(s, dt, gap, steps)}
        e_n |= {bench.name: _tried(bench, s, dt, gap, steps) for bench in benches if bench.positions}
        row = {"law": law, "times_yield": t, "overlap_max": s.overlap_max, "recovered": s.recovered}
        row |= {"steps": s.contact_time / dt}
        row |= {name: float(np.abs(e / exact - 1).max()) for name, e in e_n.items()}
        row["formula"] = position_floor(radius=x.R_star, recovered=s.recovered, steps=s.contact_time / dt)
        rows.append(row)
    return pd.DataFrame(rows)


def _tried(bench: Bench, s: Setting, time_step: float, gap: np.ndarray, steps: int) -> np.ndarray:
    """e_n of an engine, NaN where it cannot: that it failed stands in the verdicts."""
    try:
        return bench.impacts(s.x, time_step, gap, steps)[0]
    except (EpdemError, FloatingPointError):
        return np.full_like(gap, np.nan)
