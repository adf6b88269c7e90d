# SPDX-License-Identifier: GPL-2.0-or-later
"""All points of a sweep in one table, sweep.csv."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from ...base.tables import write_csv
from ...case.parts import MEASURES
from ...case.scene import parse
from ...case.units import to_si
from ...impacts.measurement import UNITS
from ...scenes.judge.checks import CHECKS
from ...scenes.tables.columns import UNITS as SCENE_UNITS
from ...scenes.tables.columns import unit_of_load
from ...scenes.tables.results import SceneResults
from . import folder as store
from .folder import Sweep


def points_of(sweep: Sweep) -> pd.DataFrame:
    """The points with what each sets."""
    return pd.DataFrame([{"point": n, **point} for n, point in enumerate(sweep.points, start=1)])


def collect(sweep: Sweep, folder: Path, only: Sequence[int] | None = None) -> pd.DataFrame:
    """A row for every row of every point, or of the points `only`: number, folder, keys in SI, state and reason, then
    the results.

    A point without results has one row. `attrs["units"]` gives the SI units by column.
    """
    rows: list[dict[str, Any]] = []
    for n in only or sweep.numbers:
        about = store.record(sweep, folder, n)
        head = {"point": n, "folder": f"{store.POINTS}/{sweep.identities[n - 1]}", **_keys(sweep, n)}
        head |= {"status": about["state"], "reason": about.get("reason", "")}
        results = about.get("rows") or {}
        found = zip(*results.values(), strict=True)
        rows += [head | dict(zip(results, values, strict=True)) for values in found] or [head]
    table = pd.DataFrame(rows)
    for name in ("engine", "law", "warnings"):
        if name in table:
            table[name] = table[name].fillna("")
    if "passed" in table:
        table["passed"] = table["passed"] == True  # noqa: E712  (None has not passed)
    table = table.infer_objects()
    units = {name: unit for name, unit in sweep.units.items() if unit and unit != "1"}
    for name in table.columns:
        if of_column := unit(name, sweep.tables) if sweep.scene else UNITS.get(name):
            units[name] = of_column
    table.attrs["units"] = units
    return table


def _keys(sweep: Sweep, number: int) -> dict[str, Any]:
    keys: dict[str, Any] = {}
    for name, value in sweep.points[number - 1].items():
        unit = sweep.units[name]
        if unit and isinstance(value, str):
            keys[name] = to_si(value, unit)
        else:
            keys[name] = value if isinstance(value, int | float | str) else repr(value)
    return keys


def write(sweep: Sweep, folder: Path) -> pd.DataFrame:
    """Collect the table of a sweep and store it as sweep.csv."""
    table = collect(sweep, folder)
    write_csv(folder / "sweep.csv", table)
    return table


def numbers_of(results: SceneResults) -> dict[str, float]:
    """COLUMN_last, _min, _max and _mean (over the last fifth) of every column of rows and measures, and each check.

    Forces and torques that a case measures are columns of the rows. The name of a check is its key (`CHECKS`).
    Of a press also PHASE_COLUMN of the stages, as stage1_relative_density.
    """
    numbers: dict[str, float] = {}
    for stage in results.tables["stages"].to_dict("records") if "stages" in results.tables else ():
        named = {f"{stage['phase']}_{name}": x for name, x in stage.items() if isinstance(x, float) and x == x}
        numbers |= named
    for curves in (results.tables["rows"], results.tables.get("measures")):
        if curves is None:
            continue
        tail = curves[curves["step"] > 0.8 * curves["step"].max()]
        for name in curves.columns.drop(["step", "time"]):
            numbers[f"{name}_last"] = float(curves[name].iloc[-1])
            numbers[f"{name}_min"] = float(curves[name].min())
            numbers[f"{name}_max"] = float(curves[name].max())
            numbers[f"{name}_mean"] = float(tail[name].mean())
    return numbers | {row["key"]: float(row["value"]) for row in results.tables["checks"].to_dict("records")}


def unit(name: str, case: Mapping[str, Any]) -> str | None:
    """The SI unit of a number of `numbers_of` of a scene with these TOML tables; None for a plain number."""
    if name in CHECKS:
        return CHECKS[name].unit or None
    parts = parse(dict(case)).parts
    column = name.rpartition("_")[0]
    if parts.stages:
        ends = [name.removeprefix(f"{x.name}_") for x in parts.phase if name.startswith(f"{x.name}_")]
        if of_stage := next((SCENE_UNITS[x] for x in ends if x in SCENE_UNITS), None):
            return of_stage
    kinds = {m.name: MEASURES[m.kind] for m in parts.measure}
    rows = {row.name: row for row in parts.row}
    known = kinds.get(column) or rows.get(column)
    return known.unit or None if known else SCENE_UNITS.get(column, unit_of_load(column))
