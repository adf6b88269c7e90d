# SPDX-License-Identifier: GPL-2.0-or-later
"""Table and figure of a run of oblique impacts."""

import math
from typing import TYPE_CHECKING

import numpy as np
from rich.table import Table

from ..base.terminal import table
from .run import Outcome

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEADS = ["v_n [m/s]", "angle", "spin [rad/s]", "engine", "e_n", "e_t", "theory", "psi_1", "psi_2", "theory", "error"]
HEADS += ["f/mu", "regime", "rebound", "spin", "pass"]


def run_table(outcome: Outcome) -> Table:
    """One row per speed, angle, spin and engine; the regime is that of theory."""
    friction = outcome.case.contact.friction if outcome.case.contact else 0.0
    shown = table(outcome.case.case.title, HEADS, left=("engine", "regime"))
    regimes = {law: p.rebound.regimes(friction) for law, p in outcome.predictions.items() if p.rebound}
    rows = outcome.results.comparison
    place = rows.groupby(["law", "engine"]).cumcount()
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


def figure(outcome: Outcome) -> "Figure":
    """psi_2 against psi_1: theory with partial slip and the line of sliding; engines as points, errors below."""
    from matplotlib import pyplot as plt

    fig, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(7, 6), height_ratios=(3, 1.3), layout="constrained")
    rows, colour = outcome.results.comparison, 0
    for law, prediction in outcome.predictions.items():
        r = prediction.rebound
        assert r is not None
        for speed in np.unique(prediction.speed):
            line = prediction.speed == speed
            order = np.argsort(r.psi_1[line])
            above.plot(
                r.psi_1[line][order],
                r.psi_2[line][order],
                "-",
                color=f"C{colour}",
                lw=1.2,
                label=f"partial slip, {law} {speed:.3g} m/s, e_n = {prediction.e_n[line][0]:.3f}",
            )
            part = rows[(rows["law"] == law) & (rows["speed"] == speed)]
            for (name, points), marker in zip(part.groupby("engine", sort=False), "ox+^sD", strict=False):
                style = {"color": f"C{colour}", "ls": "none", "marker": marker, "ms": 5, "mfc": "none"}
                above.plot(points["psi_1"], points["psi_2"], label=str(name), **style)
                below.plot(points["psi_1"], points["psi_2_error"], **style)
            colour += 1
    below.axhline(outcome.case.check.psi_2, color="0.6", lw=0.8, ls="--")
    above.axhline(0, color="0.7", lw=0.6)
    above.set(ylabel=r"$\psi_2$, slip after the impact")
    above.set_title(outcome.case.case.title, parse_math=False)
    below.set(xlabel=r"$\psi_1$, slip before the impact, over $\mu v_n/\kappa$", ylabel="error of psi_2", yscale="log")
    above.legend(fontsize=7)
    for axes in (above, below):
        axes.grid(alpha=0.3)
    return fig
