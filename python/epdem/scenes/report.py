# SPDX-License-Identifier: GPL-2.0-or-later
"""The output of a scene: checks, summary, JSON, figures."""

import json
import math
from collections.abc import Sequence

import numpy as np
from rich.console import Console

from ..base.folders import claim
from ..base.terminal import show_table, table
from ..case.measures import KINDS, Histogram, Load
from ..impacts.report import records
from .columns import units
from .measures import curve, values_of
from .run import SceneOutcome


def as_json(outcome: SceneOutcome) -> str:
    """The document of `epdem run --json` for a scene: of the measures the last frame, or row of a force or torque."""
    tables, measured = outcome.results.tables, list[dict[str, object]]()
    if outcome.case.scene.measure:
        row = records(tables["measures"].tail(1)) or records(tables["rows"][["step", "time"]].tail(1))
        loads = [m for m in outcome.case.scene.measure if isinstance(m, Load)]
        measured = [row[0] | {m.name: float(curve(m, tables)[1][-1]) for m in loads}]
    return json.dumps(
        {
            "case": outcome.case.name,
            "kind": outcome.case.scene.kind,
            "passed": outcome.passed,
            "steps": outcome.plan.steps,
            "time_step": outcome.plan.time_step,
            "seconds": outcome.seconds,
            "reused": outcome.reused,
            "resumed_from": outcome.resumed_from,
            "warnings": outcome.warnings,
            "checks": records(tables["checks"]),
            "measures": measured,
            "last_row": records(tables["rows"].tail(1))[0],
            "units": units(tables["rows"]),
        },
        indent=1,
    )


def show(outcome: SceneOutcome, console: Console) -> None:
    """Print checks and a summary line."""
    heads = ("check", "value", "expected", "unit", "error", "tolerance", "pass")
    shown = table(outcome.case.case.title, heads, left=("check", "unit"))
    for row in outcome.results.tables["checks"].to_dict("records"):
        shown.add_row(
            row["check"],
            f"{row['value']:.5g}",
            f"{row['expected']:.5g}",
            row["unit"],
            f"{row['error']:.1e}",
            f"{row['tolerance']:.1e}",
            "yes" if row["passed"] else "NO",
            style=None if row["passed"] else "red",
        )
    show_table(console, shown)
    _show_measures(outcome, console)
    for warning in outcome.warnings:
        console.print(f"warning: {warning}", style="yellow")
    p, rows = outcome.plan, outcome.results.tables["rows"]
    came = " (from results.h5)" if outcome.reused else ""
    if outcome.resumed_from is not None:
        came = f" (continued from step {outcome.resumed_from})"
    console.print(
        f"{outcome.case.name}: {int(rows['particles'].iloc[-1])} spheres, {p.steps} steps of {p.time_step:g} s, "
        f"{outcome.seconds:.1f} s{came}; see {outcome.folder}/report.html",
        soft_wrap=True,
    )


def _show_measures(outcome: SceneOutcome, console: Console) -> None:
    """Print the last value of each curve or the mean of the values of a histogram, the smallest and the largest."""
    tables = outcome.results.tables
    if not outcome.case.scene.measure:
        return
    heads = ("measure", "kind", "time [s]", "value", "smallest", "largest", "unit")
    shown = table("measures", heads, left=("measure", "kind"))
    for m in outcome.case.scene.measure:
        if isinstance(m, Histogram):
            values = values_of(outcome.plan, m, tables)
            kind, value = f"{m.kind}, mean", float(values.mean()) if values.size else math.nan
            time = tables["measures"]["time"].iloc[-1]
        else:
            times, values = curve(m, tables)
            kind, value, time = m.kind, float(values[-1]), times[-1]
        known = values[np.isfinite(values)]
        limits = (f"{known.min():.5g}", f"{known.max():.5g}") if known.size else ("nan", "nan")
        shown.add_row(m.name, kind, f"{time:.4g}", f"{value:.5g}", *limits, KINDS[m.kind].unit)
    show_table(console, shown)


def figures(outcome: SceneOutcome, formats: Sequence[str] = ("png",)) -> None:
    """Draw the charts of a scene into the folder of a run, which may write there."""
    from ..report.drawing import save
    from .charts import charts

    with claim(outcome.folder, force=True):
        for chart in charts(outcome):
            save(chart, outcome.folder, formats)
