# SPDX-License-Identifier: GPL-2.0-or-later
"""Output of error against run time: table, work-precision figure, data file."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from ..base.tables import write_csv
from ..report.chart import GREY, INK, PALETTE, Axis, Chart, Dash, Panel, Series, save
from .cost import QUANTITIES, Outcome

DASHES: tuple[Dash, ...] = ("solid", "dashdot")  # of laws, one after the other when the palette begins again


def write(outcome: Outcome, folder: Path, formats: Sequence[str] = ("png",)) -> list[Path]:
    """cost.csv, a row for each model and number of steps, and the figure cost in `folder`; their paths."""
    write_csv(folder / "cost.csv", outcome.rows)
    return [folder / "cost.csv", *save(chart(outcome.rows, outcome.case.case.title), folder, formats, data=False)]


def chart(rows: pd.DataFrame, title: str) -> Chart:
    """The work-precision figure of an outcome's rows: error of e_n against time per contact and against steps.

    Colour and kind of line are a law, a kind of points an engine; models of other codes are black. Each law has the
    errors of the first engine, which the other engines repeat.
    """
    left: list[Series] = []
    right: list[Series] = []
    engines: list[str] = []
    laws: list[str] = []
    for label, part in rows.groupby("model", sort=False):
        engine, _, law = str(label).partition(", ")
        error, steps = part["e_n_error"].to_numpy(), part["steps"].to_numpy(float)
        is_new = engine not in engines
        engines += [engine] if is_new else []
        k = engines.index(engine)
        colour, line = INK, DASHES[0]
        if law:
            laws += [law] if law not in laws else []
            colour = laws.index(law) % len(PALETTE)
            line = DASHES[laws.index(law) // len(PALETTE)]
        left.append(Series(engine if is_new else "", part["ns_per_impact"].to_numpy(), error, colour, line, k))
        if not law or k == 0:
            right.append(Series(law or engine, steps, error, colour, line if law else "dot", k))
    n = np.array([rows["steps"].min(), rows["steps"].max()], float)
    right.append(Series("order 2", n, 5 * n**-2.0, GREY, "dash"))
    error_axis = Axis("largest error of $e_n$", log=True)
    return Chart(
        "cost",
        f"{title}: error against run time",
        "Error of e_n against the time of a contact, steps times time per step, and against the steps in the shortest "
        "contact, one curve for each model.",
        [
            Panel(Axis("time of a contact", "ns", log=True), error_axis, left),
            Panel(Axis("steps in the shortest contact", log=True), error_axis, right),
        ],
        beside=True,
    )


def tables(outcome: Outcome) -> dict[str, pd.DataFrame]:
    """All tables by title."""
    errors = [f"{q}_{kind}" for q in QUANTITIES for kind in ("error", "rms")]
    return {
        f"{outcome.case.case.title}: errors (max and rms over speeds and phases)": outcome.rows[
            ["model", "steps", *errors, "ns_per_impact"]
        ],
        "coarsest steps for an error of e_n, and their stepping time per impact": outcome.models,
    }
