# SPDX-License-Identifier: GPL-2.0-or-later
"""The numbers of a scene by key: what its rows and measures end at and reach, and the value of each check."""

from collections.abc import Mapping
from typing import Any

from ...case.measures import KINDS
from ...scenes.checks import CHECKS
from ...scenes.columns import COLUMNS, unit_of_load
from ...scenes.results import SceneResults


def numbers_of(results: SceneResults) -> dict[str, float]:
    """COLUMN_last, _min, _max and _mean (over the last fifth) of every column of rows and measures, and each check.

    Forces and torques that a case measures are columns of the rows. The name of a check is its key (scenes/checks.py).
    """
    numbers = {}
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
    column = name.rpartition("_")[0]
    kinds = {m["name"]: KINDS[m["kind"]] for m in case.get("scene", {}).get("measure", [])}
    known = kinds.get(column) or COLUMNS.get(column)
    return known.unit or None if known else unit_of_load(column)
