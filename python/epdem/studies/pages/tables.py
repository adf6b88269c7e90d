# SPDX-License-Identifier: GPL-2.0-or-later
"""The pages of studies that are tables in the first place: crosscheck, cost, stability, sweep, fit, validate."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from ...base.folders import claim
from ...impacts.charts import SPEED
from ...impacts.comparison import UNITS
from ...report.chart import GREY, INK, PALETTE, Axis, Chart, Panel, Series
from ...report.drawing import save
from ...report.page import Facts, Page, Part, Rows, write
from .. import cost_report
from ..cost import Outcome as Cost
from ..crosscheck import Crosscheck
from ..fit import Fit
from ..stability.suite import Outcome as Stability
from ..stability.suite import summary
from ..sweep.folder import DONE, FAILED
from ..sweep.run import SweepOutcome
from ..sweep.table import read_sweep
from ..validate import Validation
from . import common, impacts

MOST_PANELS = 4
LABELS = {"e_n": "e_n", "dent_width": "width of the dent [m]"}


def of_crosscheck(check: Crosscheck) -> Path:
    """Write the page of a run on all engines with the table of models in front."""
    base = impacts.page(check.outcome, common.command())
    models = len(check.table) - 1
    said = f"{models} models ran the case; their values are those at {check.table['speed'].iloc[0]:.4g} m/s."
    note = "Errors are the largest over speeds and phases; swap to restart: changes of e_n in variants of the set-up."
    parts: list[Part] = [Rows("All models", check.table, UNITS, note)]
    parts += [Facts("Laws and theories of their own", check.notes)] if check.notes else []
    parts += [Facts("Left out", check.absent)] if check.absent else []
    page = replace(base, sentences=[said, *base.sentences], parts=parts + base.parts)
    return common.written(page, check.outcome.folder)


def of_cost(outcome: Cost, bulk: pd.DataFrame | None, folder: Path) -> Path:
    """Write the page of error against run time."""
    parts: list[Part] = [
        cost_report.chart(outcome),
        Rows("Cheapest setting for an error of e_n", cost_report.cheapest_table(outcome.models)),
        Rows("Errors and times", outcome.rows, {"ns_per_impact": "ns"}),
    ]
    if bulk is not None:
        parts.insert(2, Rows("Bulk scene in LIGGGHTS", cost_report.bulk_table(bulk)))
    names = ", ".join(outcome.models["model"])
    said = (
        f"Error of e_n and stepping time of {names} at {outcome.rows['steps'].nunique()} numbers of steps in contact."
    )
    parts.append(common.origin({}, {}))
    page = Page(f"{outcome.case.case.title}: error against run time", [said], parts, command=common.command())
    return common.written(page, folder)


def of_stability(outcome: Stability, path: Path) -> Path:
    """Write the page of the extreme cases to `path`."""
    verdicts = outcome.verdicts
    count = verdicts["status"].value_counts()
    parts: list[Part] = [Rows("By engine and law", summary(verdicts)), Rows("Every case", verdicts)]
    named = {"Round-off": outcome.roundoff, "Bulk scenes": outcome.bulk, "Precisions of YADE": outcome.precisions}
    parts += [Rows(title, table) for title, table in named.items() if not table.empty]
    parts.append(common.origin({}, {}))
    said = f"{len(verdicts)} extreme cases: " + ", ".join(f"{n} {status}" for status, n in count.items()) + "."
    page = Page("Stiff and extreme cases", [said], parts, passed=outcome.passed, command=common.command())
    return write(path, lambda: page)


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
            panels.append(
                Panel(Axis(key, units.get(key, "")), Axis(name.replace("_", " "), units.get(name, "")), shown)
            )
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


def of_sweep(result: SweepOutcome) -> Path:
    """Write the page of a sweep into its folder."""
    table, sweep = result.table, result.sweep
    units = table.attrs.get("units", {})
    failed = table[table["status"] == FAILED][["point", "folder", "reason"]]
    said = f"{len(sweep.points)} points on {', '.join(sweep.engines)}: {result.count(DONE)} done, {len(failed)} failed."
    parts: list[Part] = [_by_key(result, units) if sweep.scene else _by_speed(result)]
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
    """e_n of chosen points against speed, theory as lines."""
    table, series = result.table[result.table["status"] == DONE], []
    for k, number in enumerate(_evenly(table["point"].unique())):
        part = table[table["point"] == number]
        keys = ", ".join(f"{name.rsplit('.', 1)[-1]} = {v}" for name, v in result.sweep.points[number - 1].items())
        for i, ((engine, law), rows) in enumerate(part.groupby(["engine", "law"], sort=False)):
            speed, label = rows["speed"].to_numpy(float), f"{engine}, {law}: {keys}"
            series.append(Series("", speed, rows["e_n_theory"].to_numpy(float), k))
            series.append(Series(label, speed, rows["e_n"].to_numpy(float), k, None, i))
    alt = "Coefficient of restitution of chosen points against impact speed: theory as lines, engines as points."
    return Chart("sweep", "Restitution of chosen points", alt, [Panel(SPEED, Axis("$e_n$"), series)])


def _by_key(result: SweepOutcome, units: dict[str, str]) -> Chart:
    """Numbers of a scene against the key that the points change."""
    table = result.table[result.table["status"] == DONE]
    keys = [name for name in result.sweep.points[0] if name in table and table[name].dtype.kind in "fi"]
    key = keys[0] if keys else "point"
    changing = [
        name for name in table.select_dtypes("number") if name.endswith(("_mean", "_max")) and table[name].std() > 0
    ]
    panels = []
    for k, name in enumerate(changing[:MOST_PANELS]):
        series = Series("", table[key].to_numpy(float), table[name].to_numpy(float), k, None, 0)
        panels.append(Panel(Axis(key, units.get(key, "")), Axis(name.replace("_", " "), units.get(name, "")), [series]))
    return Chart("sweep", "Numbers of the scenes", f"{', '.join(changing[:MOST_PANELS])} against {key}.", panels)


def validation_chart(v: Validation) -> Chart:
    """What the first engine gives over the measured value, for every law and point."""
    points = v.points[v.points["engine"] == v.points["engine"].iloc[0]]
    series = [
        Series(law, own["number"].to_numpy(float), 1.0 + own["error"].to_numpy(float), k, None, k)
        for k, (law, own) in enumerate(points.groupby("law", sort=False))
    ]
    series.append(Series("measured", [1.0, float(points["number"].max())], [1.0, 1.0], GREY, "solid", width=0.8))
    first = points.drop_duplicates("number")
    names = ", ".join(f"{r.number} {r.set} {LABELS[r.quantity]} {r.measured:g}" for r in first.itertuples())
    alt = f"Law over measured value for every law; the measured numbers are {names}."
    x = Axis("measured number, in the order of the table")
    return Chart("validate", "Laws against measured impacts", alt, [Panel(x, Axis("law over measured"), series)])


def of_validation(v: Validation) -> Path:
    """Draw the figure of measured sets and write their page into the folder of the study."""
    chart = validation_chart(v)
    parts: list[Part] = [chart, Rows("By set, law and engine", v.summary), Rows("Every point", v.points)]
    parts += [Facts(one.head["title"], {k: one.head[k] for k in ("source", "material", "read")}) for one in v.sets]
    parts += [Facts("Left out", v.absent)] if v.absent else []
    parts.append(common.origin({}, {}))
    said = f"{len(v.points)} comparisons with measured numbers; nothing is fitted, and no law has a tolerance here."
    page = Page("Laws against measured impacts", [said], parts, command=common.command())
    with claim(v.folder, force=True):
        save(chart, v.folder)
        return common.written(page, v.folder)
