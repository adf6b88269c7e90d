# SPDX-License-Identifier: GPL-2.0-or-later
"""Output of error against run time: table, work-precision figure, data file."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from ..base.tables import write_csv
from ..report.chart import GREY, INK, PALETTE, Axis, Chart, Panel, Series, save
from .cost import QUANTITIES, Outcome


def write(outcome: Outcome, folder: Path, formats: Sequence[str] = ("png",)) -> list[Path]:
    """cost.csv, a row for each model and number of steps, and the figure cost in `folder`; their paths."""
    write_csv(folder / "cost.csv", outcome.rows)
    return [folder / "cost.csv", *save(chart(outcome), folder, formats, data=False)]


def chart(outcome: Outcome) -> Chart:
    """The work-precision figure: error of e_n against stepping time and against steps.

    A colour is a law, a kind of points an engine; models of other codes are black and grey.
    """
    left: list[Series] = []
    right: list[Series] = []
    engines: list[str] = []
    laws: list[str] = []
    for label, part in outcome.rows.groupby("model", sort=False):
        engine, _, law = str(label).partition(", ")
        engines += [engine] if engine not in engines else []
        laws += [law] if law and law not in laws else []
        other = INK if engine.endswith("hertz") else GREY
        colour, k = laws.index(law) % len(PALETTE) if law else other, engines.index(engine)
        error, steps = part["e_n_error"].to_numpy(), part["steps"].to_numpy(float)
        left.append(Series("", part["ns_per_impact"].to_numpy(), error, colour, "solid", k))
        right.append(Series(str(label), steps, error, colour, "solid", k))
        right.append(Series("", steps, part["e_n_rms"].to_numpy(), colour, "dot", width=1.0))
    n = np.array([outcome.rows["steps"].min(), outcome.rows["steps"].max()], float)
    right.append(Series("order 2", n, 5 * n**-2.0, GREY, "dash"))
    error_axis = Axis("largest error of $e_n$", log=True)
    return Chart(
        "cost",
        f"{outcome.case.case.title}: error against run time",
        "Error of e_n against the stepping time of an impact and against the steps in the shortest contact, one curve "
        "for each model; dotted: root of the mean square.",
        [
            Panel(Axis("stepping time of an impact", "ns", log=True), error_axis, left),
            Panel(Axis("steps in the shortest contact", log=True), error_axis, right),
        ],
        beside=True,
    )


def tables(outcome: Outcome, bulk: pd.DataFrame | None) -> dict[str, pd.DataFrame]:
    """All tables by title; `bulk` is that of a bulk scene, if it ran."""
    errors = [f"{q}_{kind}" for q in QUANTITIES for kind in ("error", "rms")]
    found = {
        f"{outcome.case.case.title}: errors (max and rms over speeds and phases)": outcome.rows[
            ["model", "steps", *errors, "ns_per_impact"]
        ],
        "coarsest steps for an error of e_n, and their stepping time per impact": outcome.models,
    }
    if bulk is not None:
        found[f"{bulk['spheres'].iloc[0]} spheres in LIGGGHTS: dissipated energy"] = bulk
    return found
