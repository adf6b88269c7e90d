# SPDX-License-Identifier: GPL-2.0-or-later
"""One contact many times: drift over 1e9 steps and 10^4 reloads; and the verdict on these and on two walls."""

import numpy as np
from scipy.integrate import trapezoid

from ...laws.library import ImpactNumbers
from .. import native
from .cases import Extreme
from .running import Setting, Verdict, judged
from .sampling import PositionSampler, Sampler
from .two_walls import judge_two_walls
from .variants import CYCLE, carried

BOUNCE_SHARE = 0.01  # of the stability limit: about 200 steps in contact
FORCE = 1e-8  # of the largest force: YADE follows cavity's branch to 3e-9, all else is round-off
DRIFT = 1e-3  # of the speed over 1e9 steps; it goes with dt^3 (6e-11 a bounce at 1 % of the limit)


def bounces(v: Verdict, s: Setting, total: int) -> None:
    """Bounce one contact for `total` steps: its plastic work is done once, then it must neither gain nor lose."""
    dt = BOUNCE_SHARE * s.limit
    law, steps = s.x.native_law(), int(1.5 * s.contact_time / dt) + 20
    one = ImpactNumbers(R_star=s.x.R_star, m_star=s.x.m_star, speed=float(s.x.speed[0]), time_step=dt)
    trial, _ = native.bounces(law, 200, steps=steps, **one)
    count = int(np.ceil(1.01 * 200 * total / trial["steps"]))
    out, speeds = native.bounces(law, count, steps=steps, **one)
    # the first bounce yields for good; what comes after it should be elastic
    v.steps, v.e_n_error = int(out["steps"]), float(np.abs(speeds / speeds[0] - 1).max())
    v.created = float(speeds.max() ** 2 / speeds[0] ** 2 - 1)
    v.notes.append(f"{count} bounces, speed off by {speeds[-1] / speeds[0] - 1:+.1e} after the last")
    if not v.e_n_error <= DRIFT:
        v.fail(f"speed drifts by {v.e_n_error:.2g}")
    if not v.created <= 2 * DRIFT:  # drift has either sign
        v.fail(f"energy created: {v.created:.2g}")


def embedded_cycles(s: Setting, cycles: int) -> tuple[np.ndarray, np.ndarray]:
    """Overlap [m] and force [N] of a contact taken from alpha_max to zero and back, shape (cycles, samples)."""
    law, up = s.x.native_law(), np.linspace(0.0, s.overlap_max, 33)
    delta = np.concatenate([up[::-1], up[1:]])
    memory, force = np.array([s.overlap_max]), np.empty((cycles, delta.size))
    for k in range(cycles):
        force[k], _, after = law.step(R_star=s.x.R_star, delta_max=memory, delta=delta)
        memory = after[-1:]
    return np.broadcast_to(delta, force.shape), force


def position_cycles(s: Setting, sampler: PositionSampler, cycles: int) -> tuple[np.ndarray, np.ndarray]:
    """The same by an engine that carries the sphere; the cycle in which it is loaded first is left out."""
    got = carried(s, sampler, cycles + 1)
    overlap, force = (
        np.lib.stride_tricks.sliding_window_view(a[0, CYCLE:], CYCLE + 1)[::CYCLE] for a in (got.overlap, got.force)
    )
    return overlap, force


def reloads(v: Verdict, s: Setting, sampler: Sampler, cycles: int) -> None:
    """Unload and reload a contact that reached alpha_max: forces repeat, are the law's, and a cycle does no work."""
    if isinstance(sampler, PositionSampler):
        overlap, force = position_cycles(s, sampler, cycles)
    else:
        overlap, force = embedded_cycles(s, cycles)
    drift = float(np.abs(force - force[0]).max() / force.max())
    work = float(np.abs(trapezoid(force, overlap, axis=1)).max() / s.energy)
    law = s.x.native_law().step(R_star=s.x.R_star, delta_max=overlap.max(), delta=overlap[0])[0]
    off = float(np.abs(force[0] - law).max() / law.max())
    v.steps, v.e_n_error, v.created = force.size, max(drift, off), work
    if not drift <= 0.0:
        v.fail(f"force changes from cycle to cycle by {drift:.2g} of the largest")
    if not off <= FORCE:
        v.fail(f"force is off the law's by {off:.2g} of the largest")
    if not work <= 1e-12:
        v.fail(f"work of a cycle: {work:.2g} of the energy")


def judge_repeats(extreme: Extreme, law: str, sampler: Sampler, *, steps: int, cycles: int) -> Verdict:
    """The verdict on bounces, reloads or a sphere between two walls; the first run in the embedded engine alone."""
    if sampler.positions and extreme.kind == "bounces":
        reason = "not run: 1e9 steps take hours in an engine with positions"
        return Verdict(extreme.name, extreme.group, sampler.name, law, "embedded only", reason)

    def judges(v: Verdict, s: Setting) -> None:
        if extreme.kind == "bounces":
            bounces(v, s, steps)
        elif extreme.kind == "reloads":
            reloads(v, s, sampler, cycles)
        else:
            judge_two_walls(v, s, sampler)

    return judged(extreme, law, sampler, judges, reach=2.0)
