# SPDX-License-Identifier: GPL-2.0-or-later
"""Output of error against run time: table, work-precision figure, data file."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from ..base.tables import write_csv
from ..report.chart import GREY, INK, PALETTE, Axis, Chart, Panel, Series, save
from .cost import TARGETS, Outcome


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


def _cell(steps: float, nanoseconds: float) -> str:
    return "not reached" if np.isnan(steps) else f"{steps:.0f} steps, {nanoseconds / 1000:.3g} us"


def cheapest_table(models: pd.DataFrame) -> pd.DataFrame:
    """One row per model, in words."""
    rows = []
    for _, c in models.iterrows():
        hertz = "" if np.isnan(c["ratio_to_hertz"]) else f"{c['ratio_to_hertz']:.2f} +- {c['ratio_spread'] / 2:.2f}"
        row = {
            "model": c["model"],
            "order": "none" if np.isnan(c["order"]) else f"{c['order']:.2f}",
            "smallest error": f"{c['best_error']:.1e}",
            "ns per step": f"{c['ns_per_step']:.3g}",
            "over built-in hertz": hertz,
        }
        row |= {f"for {100 * t:g} %": _cell(c[f"steps_for_{t:g}"], c[f"ns_for_{t:g}"]) for t in TARGETS}
        row |= {"start-up": f"{c['startup'] * 1000:.0f} ms", "set-up": f"{c['setup'] * 1000:.1f} ms"}
        rows.append(row)
    return pd.DataFrame(rows)


def error_table(rows: pd.DataFrame) -> pd.DataFrame:
    """Errors of every model at every number of steps, largest and rms over speeds and phases."""
    names = {"e_n": "e_n", "contact_time": "time", "force_max": "peak force"}
    columns = {"model": "model", "steps": "steps"}
    columns |= {
        f"{q}_{kind}": f"{text} {short}"
        for q, text in names.items()
        for kind, short in (("error", "max"), ("rms", "rms"))
    }
    frame = rows[[*columns, "ns_per_impact"]].rename(columns=columns | {"ns_per_impact": "ns per impact"})
    return frame.map(lambda v: f"{v:.2g}" if isinstance(v, float) else str(v))


def bulk_table(bulk: pd.DataFrame) -> pd.DataFrame:
    """One row per model and step of a bulk scene, in words."""
    rows = [
        {
            "model": b.model,
            "share of the limit": f"{b.share:g}",
            "error of the mean": f"{b.error:.2g}",
            "rms error of a sphere": f"{b.rms:.2g}",
            "order": "-" if np.isnan(b.order) else f"{b.order:.2f}",
        }
        for b in bulk.itertuples()
    ]
    return pd.DataFrame(rows)


def tables(outcome: Outcome, bulk: pd.DataFrame | None) -> dict[str, pd.DataFrame]:
    """All tables by title; `bulk` is that of a bulk scene, if it ran."""
    found = {
        f"{outcome.case.case.title}: errors (max and rms over speeds and phases)": error_table(outcome.rows),
        "cheapest setting for an error of e_n (stepping time per impact)": cheapest_table(outcome.models),
    }
    if bulk is not None:
        found[f"{bulk['spheres'].iloc[0]} spheres in LIGGGHTS: dissipated energy"] = bulk_table(bulk)
    return found
