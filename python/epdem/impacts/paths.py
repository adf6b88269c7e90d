# SPDX-License-Identifier: GPL-2.0-or-later
"""Chosen impacts of a trajectory, step by step, for figures."""

import numpy as np
import pandas as pd

from .engine import Trajectory
from .plan import Plan

CHOSEN = 3  # speeds: the lowest, that in the middle, the highest
SAMPLES = 200  # of each, about


def chosen(plan: Plan, path: Trajectory) -> pd.DataFrame:
    """speed [m/s], time [s] since first touch, overlap [m], force [N] of the first phase at the chosen speeds.

    From the sample before the contact to that after it; at most 2 SAMPLES a speed.
    """
    _, first = np.unique(plan.speed, return_index=True)
    places = np.unique(np.linspace(0, first.size - 1, CHOSEN).round().astype(int))
    tables = []
    for row in first[places]:
        force = path.force[row]
        loaded = np.flatnonzero(np.isfinite(force) & (force != 0))
        begin, end = max(loaded[0] - 1, 0), min(loaded[-1] + 2, np.isfinite(force).sum())
        kept = np.arange(begin, end)[:: max(1, (end - begin) // SAMPLES)]
        tables.append(
            pd.DataFrame(
                {
                    "speed": plan.speed[row],
                    "time": kept * path.time_step - plan.gap[row] / plan.speed[row],
                    "overlap": path.overlap[row, kept],
                    "force": force[kept],
                }
            )
        )
    return pd.concat(tables, ignore_index=True)
