# SPDX-License-Identifier: GPL-2.0-or-later
"""One contact many times: drift over 1e9 steps and 10^4 reloads."""

import numpy as np
from scipy.integrate import trapezoid

from ...laws.library import ImpactNumbers
from .. import native
from ..runner import Row
from .bench import Bench
from .running import Setting
from .variants import CYCLE, carried

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
