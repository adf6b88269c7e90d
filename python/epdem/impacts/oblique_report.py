# SPDX-License-Identifier: GPL-2.0-or-later
"""Table of a run of oblique impacts."""

import math

import pandas as pd
from rich.table import Table

from ..base.terminal import table
from .run import Outcome

HEADS = ["v_n [m/s]", "angle", "spin [rad/s]", "engine", "e_n", "e_t", "theory", "psi_1", "psi_2", "theory", "error"]
HEADS += ["f/mu", "regime", "rebound", "spin", "pass"]


def run_table(outcome: Outcome, rows: pd.DataFrame) -> Table:
    """One row per speed, angle, spin and engine of `rows`; the regime is predicted by theory."""
    friction = outcome.case.contact.friction if outcome.case.contact else 0.0
    shown = table(outcome.case.case.title, HEADS, left=("engine", "regime"))
    regimes = {law: p.rebound.regimes(friction) for law, p in outcome.predictions.items() if p.rebound}
    place = outcome.results.comparison.groupby(["law", "engine"]).cumcount()[rows.index]
    rows = rows.assign(regime=[regimes[law][k] for law, k in zip(rows["law"], place, strict=True)])
    for row in rows.sort_values(["law", "speed", "angle", "spin_before", "engine"], kind="stable").to_dict("records"):
        cells = [
            f"{row['speed']:.4g}",
            f"{math.degrees(row['angle']):.4g}",
            f"{row['spin_before']:.4g}",
            row["engine"],
            f"{row['e_n']:.4f}",
            f"{row['e_t']:.4f}",
            f"{row['e_t_theory']:.4f}",
            f"{row['psi_1']:.3f}",
            f"{row['psi_2']:.4f}",
            f"{row['psi_2_theory']:.4f}",
            f"{row['psi_2_error']:.1e}",
            f"{row['impulse_ratio'] / friction:.4f}",
            row["regime"],
            f"{math.degrees(row['rebound_angle']):.2f}",
            f"{row['spin']:.4g}",
            "yes" if row["passed"] else "NO",
        ]
        shown.add_row(*cells, style=None if row["passed"] else "red")
    return shown
