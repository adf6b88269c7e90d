# SPDX-License-Identifier: GPL-2.0-or-later
"""Round-off of positions in builds of an engine of other precisions: the same script, its own Hertz contact."""

import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from ...impacts.plan import starting_phases
from .cases import build
from .precisions_yade import PROGRAMS, rebounds
from .running import position_floor, setting

SHARE = 0.01  # of the stability limit


def floors(*, times: Sequence[float] = (1e-4, 1e-2, 1e2)) -> pd.DataFrame:
    """One row per speed: largest deviation of e_n from the finest precision over 8 phases, and the formula's."""
    rows = []
    with tempfile.TemporaryDirectory(prefix="epdem-precisions-") as scratch:
        for t in times:
            s = setting(build("roundoff", ratio=1e4, times=t), "hertz")
            dt = SHARE * s.limit
            gaps, steps = starting_phases(8) * float(s.x.speed[0]) * dt, int(2 * s.contact_time / dt)
            e = {program: rebounds(program, Path(scratch), s.x, dt, gaps, steps) for program in PROGRAMS}
            row = {"overlap_max": s.overlap_max, "steps": s.contact_time / dt}
            row |= {p: float(np.abs(e[p] / e[PROGRAMS[-1]] - 1).max()) for p in PROGRAMS[:-1]}
            row["formula"] = position_floor(radius=s.x.body.radius, recovered=s.recovered, steps=row["steps"])
            row["formula, 64 bits"] = row["formula"] / 2**11
            rows.append(row)
    return pd.DataFrame(rows)
