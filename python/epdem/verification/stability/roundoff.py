# SPDX-License-Identifier: GPL-2.0-or-later
"""Round-off of e_n: in the law itself (double against long double) and in overlaps made of positions."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from ...errors import EpdemError
from ...impacts.plan import starting_phases
from ...laws.library import ImpactNumbers
from .. import native
from .cases import build
from .running import Bench, Setting, position_floor, setting

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


def floors(
    law: str, benches: Sequence[Bench], *, times: Sequence[float] = (1e-4, 1e-2, 3.0, 1e2), share: float = 0.01
) -> pd.DataFrame:
    """One row per speed: overlap_max, recovered overlap [m], steps, and the largest deviation of e_n from long
    double over 8 phases.

    Columns: `double` (the C library), `positions` (this module's own), each engine's with positions, and `formula`.
    """
    rows = []
    for t in times:
        s = setting(build("roundoff", ratio=1e4, times=t), law)
        x, dt = s.x, share * s.limit
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
