# SPDX-License-Identifier: GPL-2.0-or-later
"""The page of a sweep, from the table of its points: restitution, or the numbers of scenes, over the keys."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from ..base.readable import in_words
from ..scenes.judge.checks import CHECKS
from .chart import PALETTE, Axis, Chart, Dash, Panel, Series
from .impacts import SPEED
from .page import Page, Part, Rows
from .pages import case_lines, command, origin, write_study_page

DONE, FAILED = "done", "failed"  # states of points
KINDS = ("last", "min", "max", "mean")  # numbers of one column of a scene
DASHES: tuple[Dash, ...] = ("solid", "dash", "dashdot", "dot")  # a curve over another one leaves it visible
PANEL_COLUMNS, MOST_PANELS = 3, 30  # of a chart
STAGES = ("_relative_density", "_springback", "_radial_pressure")  # of a press, drawn before its other columns


def write_sweep_page(
    folder: Path,
    table: pd.DataFrame,
    *,
    name: str,
    engines: Sequence[str],
    keys: Sequence[str],
    measures: Sequence[str] | None,
    case: str,
    versions: Mapping[str, str],
    passed: bool,
    warnings: Sequence[str],
    found: Sequence[str] = (),
) -> Path:
    """Write the page of a sweep into its folder; its path.

    table: the rows of all points with their `status`. keys: what the points set. measures: of a scene by name; None: a
    sweep of impacts. case: the text of its file. found: sentences on what a fit has found.
    """
    units, done = table.attrs.get("units", {}), table[table["status"] == DONE]
    failed = table[table["status"] == FAILED][["point", "folder", "reason"]]
    ended = f"{done['point'].nunique()} done, {len(failed)} failed"
    said = f"{table['point'].nunique()} points on {', '.join(engines)}: {ended}."
    keys = [key for key in keys if key in table] if len(done) else []
    charts = _restitution(done, keys, units) if measures is None else _by_key(done, keys, measures, units)
    parts: list[Part] = [*charts]
    parts += [Rows("Failed points", failed)] if len(failed) else []
    rows = table.drop(columns=["folder", "reason"])
    parts += [Rows("All points", rows, units, "sweep.csv beside this page has all rows and columns.")]
    parts += [case_lines(case), origin({f"version_{k}": v for k, v in versions.items()}, {})]
    title = f"Sweep of {name}"
    page = Page(title, [said, *found], parts, passed=passed, command=command(), warnings=warnings)
    return write_study_page(page, folder)


def _evenly(values: np.ndarray) -> np.ndarray:
    """As many of the values as there are colours, the first and the last among them."""
    places = np.linspace(0, len(values) - 1, min(len(PALETTE), len(values))).round().astype(int)
    return values[np.unique(places)] if len(values) else values


def _restitution(table: pd.DataFrame, keys: Sequence[str], units: dict[str, str]) -> list[Chart]:
    """e_n over each key that has several numbers, a curve for each value of the other keys; and over the speed."""
    speeds = table["speed"].nunique() if len(table) else 0
    numeric = [name for name in keys if table[name].dtype.kind in "fi" and table[name].nunique() > 1]
    over = {key: Axis(key.rpartition(".")[2], units.get(key, "")) for key in numeric}
    over |= {"speed": SPEED} if speeds > 1 or not numeric else {}
    charts = [_over(table, x, axis, [*keys, "speed"], units) for x, axis in over.items()]
    return [replace(charts[0], name="sweep"), *charts[1:]]


def _over(table: pd.DataFrame, x: str, axis: Axis, keys: list[str], units: dict[str, str]) -> Chart:
    """e_n over x, theory as lines and engines as points, for some of the values of the other `keys`."""
    others = [name for name in keys if name != x and table[name].nunique() > 1]
    lines = not others or bool((table.groupby(others)[x].nunique() > 1).any())
    if not lines:  # random points: all of a speed, without a line
        others = [name for name in others if name == "speed"]
    curves = [*table.groupby(others, sort=False)] if others else [((), table)]
    series: list[Series] = []
    for k, n in enumerate(_evenly(np.arange(len(curves)))):
        values, part = curves[n]
        said = ", ".join(_said(name, value, units) for name, value in zip(others, values, strict=True))
        for i, ((engine, law), rows) in enumerate(part.groupby(["engine", "law"], sort=False)):
            rows = rows.sort_values(x)
            at, label = rows[x].to_numpy(float), f"{engine}, {law}" + f": {said}" * bool(said)
            if lines:
                series.append(Series("", at, rows["e_n_theory"].to_numpy(float), k, DASHES[k % len(DASHES)]))
            series.append(Series(label, at, rows["e_n"].to_numpy(float), k, None, k + i))
    alt = f"Coefficient of restitution against {x}: {'theory as lines, ' * lines}engines as points."
    if len(curves) > len(PALETTE):
        alt += f" {len(PALETTE)} of {len(curves)} curves."
    return Chart(f"sweep_{x}", f"Restitution against {axis.label}", alt, [Panel(axis, Axis("e_n"), series)])


def _said(name: str, value: object, units: dict[str, str]) -> str:
    text = in_words(value, units.get(name, "")) if isinstance(value, float) else str(value)
    return f"{name.rpartition('.')[2]} = {text}"


def _by_key(table: pd.DataFrame, keys: Sequence[str], measured: Sequence[str], units: dict[str, str]) -> list[Chart]:
    """For each key with several values, the numbers of the scenes that change: the measures of the case, the stages of
    a press and the checks, of a case without measures all columns."""
    numeric = [name for name in keys if table[name].dtype.kind in "fi" and table[name].nunique() > 1] or ["point"]
    changing = _changing(table.drop(columns=["point", *keys]))
    chosen = {*measured, *CHECKS}
    wanted = [column for column in changing if not measured or column in chosen or column.endswith(STAGES)]
    # stable: else as in the table
    columns = sorted(wanted or changing, key=lambda column: (column not in measured, not column.endswith(STAGES)))
    shown = columns[:MOST_PANELS]
    left = [column for column in changing if column not in shown]
    charts = []
    for key in numeric:
        x = Axis(key.rpartition(".")[2], units.get(key, ""))
        lines = table[key].is_unique
        panels = [Panel(x, _axis(y, changing[y], units), _series(table, key, y, changing[y], lines)) for y in shown]
        alt = f"Against {key}: {', '.join(shown)}." + (f" {len(left)} columns are in the table alone." if left else "")
        name = "sweep" if key == numeric[0] else f"sweep_{key}"
        if panels:
            charts.append(Chart(name, f"Results against {key}", alt, panels, columns=min(PANEL_COLUMNS, len(panels))))
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


def _series(table: pd.DataFrame, key: str, column: str, kinds: list[str], lines: bool) -> list[Series]:
    """The numbers of a column over a key; lines: whether a line joins the points, of one value for each key."""
    table = table.sort_values(key)
    x, series = table[key].to_numpy(float), []
    for kind in kinds:
        k = KINDS.index(kind) if kind else len(KINDS)
        y = table[f"{column}_{kind}" if kind else column].to_numpy(float)
        series.append(Series(kind or "value", x, y, k, DASHES[k % len(DASHES)] if lines else None, k))
    return series
