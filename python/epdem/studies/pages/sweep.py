# SPDX-License-Identifier: GPL-2.0-or-later
"""The pages of a sweep and of a fit of a scene."""

from pathlib import Path

import numpy as np
import pandas as pd

from ...impacts.charts import SPEED
from ...report.chart import INK, PALETTE, Axis, Chart, Panel, Series
from ...report.page import Page, Part, Rows
from ..fit import Fit
from ..sweep.folder import DONE, FAILED
from ..sweep.run import SweepOutcome
from ..sweep.table import read_sweep
from . import common

KINDS = ("last", "min", "max", "mean")  # numbers of one column of a scene
COLUMNS, MOST_PANELS = 3, 30  # of a chart


def of_sweep(result: SweepOutcome) -> Path:
    """Write the page of a sweep into its folder."""
    table, sweep = result.table, result.sweep
    units = table.attrs.get("units", {})
    failed = table[table["status"] == FAILED][["point", "folder", "reason"]]
    said = f"{len(sweep.points)} points on {', '.join(sweep.engines)}: {result.count(DONE)} done, {len(failed)} failed."
    parts: list[Part] = [*(_by_key(result, units) if sweep.scene else [_by_speed(result)])]
    parts += [Rows("Failed points", failed)] if len(failed) else []
    rows = table.drop(columns=["folder", "reason"])
    parts += [Rows("All points", rows, units, "sweep.csv beside this page has all rows and columns.")]
    parts += [common.case_lines(sweep.case), common.origin({f"version_{k}": v for k, v in sweep.versions.items()}, {})]
    page = Page(f"Sweep of {sweep.name}", [said], parts, passed=result.passed, command=common.command())
    return common.written(page, result.folder)


def _evenly(values: np.ndarray) -> np.ndarray:
    """As many of the values as there are colours, the first and the last among them."""
    places = np.linspace(0, len(values) - 1, min(len(PALETTE), len(values))).round().astype(int)
    return values[np.unique(places)] if len(values) else values


def _by_speed(result: SweepOutcome) -> Chart:
    table, series = result.table[result.table["status"] == DONE], []
    for k, number in enumerate(_evenly(table["point"].unique())):
        part = table[table["point"] == number]
        keys = ", ".join(f"{name.rsplit('.', 1)[-1]} = {v}" for name, v in result.sweep.points[number - 1].items())
        for i, ((engine, law), rows) in enumerate(part.groupby(["engine", "law"], sort=False)):
            speed, label = rows["speed"].to_numpy(float), f"{engine}, {law}: {keys}"
            series.append(Series("", speed, rows["e_n_theory"].to_numpy(float), k))
            series.append(Series(label, speed, rows["e_n"].to_numpy(float), k, None, i))
    alt = "Coefficient of restitution of chosen points against speed: theory as lines, engines as points."
    return Chart("sweep", "Restitution of chosen points", alt, [Panel(SPEED, Axis("e_n"), series)])


def _by_key(result: SweepOutcome, units: dict[str, str]) -> list[Chart]:
    """For each key with several values, the numbers of the scenes that change, measures of the case first."""
    table = result.table[result.table["status"] == DONE]
    keys = [name for name in result.sweep.points[0] if name in table]
    numeric = [name for name in keys if table[name].dtype.kind in "fi" and table[name].nunique() > 1] or ["point"]
    changing = _changing(table.drop(columns=["point", *keys]))
    measured = [m["name"] for m in result.sweep.tables.get("scene", {}).get("measure", [])]
    columns = sorted(changing, key=lambda column: column not in measured)  # stable: else as in the table
    shown, left = columns[:MOST_PANELS], columns[MOST_PANELS:]
    charts = []
    for key in numeric:
        panels = [
            Panel(
                Axis(key, units.get(key, "")),
                _axis(column, changing[column], units),
                _series(table, key, column, changing[column]),
            )
            for column in shown
        ]
        alt = f"Against {key}: {', '.join(shown)}." + (f" {len(left)} columns are in the table alone." if left else "")
        name = "sweep" if key == numeric[0] else f"sweep_{key}"
        charts += (
            [Chart(name, f"Results against {key}", alt, panels, columns=min(COLUMNS, len(panels)))] if panels else []
        )
    return charts


def _changing(table: pd.DataFrame) -> dict[str, list[str]]:
    """The columns of a scene whose numbers change over the points, each with the kinds of its numbers; "": a check."""
    found: dict[str, list[str]] = {}
    for name in table.select_dtypes("number"):
        if table[name].nunique() > 1:
            column, _, kind = str(name).rpartition("_")
            plain = kind not in KINDS
            found.setdefault(str(name) if plain else column, []).append("" if plain else kind)
    return found


def _axis(column: str, kinds: list[str], units: dict[str, str]) -> Axis:
    return Axis(column, units.get("_".join(filter(None, (column, kinds[0]))), ""))


def _series(table: pd.DataFrame, key: str, column: str, kinds: list[str]) -> list[Series]:
    x, series = table[key].to_numpy(float), []
    for kind in kinds:
        k = KINDS.index(kind) if kind else 0
        y = table[f"{column}_{kind}" if kind else column].to_numpy(float)
        series.append(Series(kind or "check", x, y, k, None, k))
    return series


def of_fit(found: Fit) -> Path:
    """Write the page of a fit of a scene into the folder of its points."""
    folder = found.case.parents[2]
    table = read_sweep(folder).dropna(subset=list(found.targets))
    units = table.attrs.get("units", {}) | found.units
    panels = []
    for name, target in found.targets.items():
        for k, key in enumerate(found.values):
            x, y = table[key].to_numpy(float), table[name].to_numpy(float)
            shown = [
                Series("points", x, y, k, None, 0),
                Series("target", [x.min(), x.max()], [target] * 2, INK, "dash"),
            ]
            panels.append(Panel(Axis(key, units.get(key, "")), Axis(name, units.get(name, "")), shown))
    names = ", ".join(found.targets)
    said = [
        f"{', '.join(f'{key} = {value}' for key, value in found.values.items())} gives "
        + ", ".join(f"{n} = {v:.6g} {found.units[n]} (target {found.targets[n]:.6g})" for n, v in found.numbers.items())
        + ".",
        f"{found.points} scenes, {found.ran} of them just now; the case with these values is {found.case}.",
    ]
    alt = f"{names} of every scene of the fit against the keys that it frees; the target as a dashed line."
    charts = [Chart(f"fit{n}", "Target against key", alt, [panel]) for n, panel in enumerate(panels)]
    rows = Rows("All scenes", table[["point", *found.values, *found.targets]], units)
    case = common.case_lines(found.case.read_text(encoding="utf-8"))
    page = Page(f"Fit of {names}", said, [*charts, rows, case, common.origin({}, {})], command=common.command())
    return common.written(page, folder)
