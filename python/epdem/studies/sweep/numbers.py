# SPDX-License-Identifier: GPL-2.0-or-later
"""The numbers of a scene that have names: what its rows end at and reach, and what its checks have found."""

import re
from collections.abc import Mapping
from typing import Any

from ...scenes.columns import UNITS, unit_of_load
from ...scenes.measures import unit_of_kind
from ...scenes.results import SceneResults

UNIT_OF_CHECK = {"floor_load": "N", "mass_flow": "kg/s"}


def numbers_of(results: SceneResults) -> dict[str, float]:
    """COLUMN_last, _min, _max and _mean (over the last fifth) of every column of rows and measures, and each check.

    Forces and torques that a case measures are columns of the rows.

    A check has the name of what it measures, without the numbers in it: "mass flow / Beverloo" is mass_flow.
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
    for row in results.tables["checks"].to_dict("records"):
        quantity = re.split(r" / |:", row["check"])[0]
        numbers["_".join(re.findall(r"[a-z]+", quantity.lower()))] = float(row["value"])
    return numbers


def unit(name: str, case: Mapping[str, Any]) -> str | None:
    """The SI unit of a number of `numbers_of` of a scene with these TOML tables; None for a plain number."""
    column = re.sub(r"_(last|min|max|mean)$", "", name)
    kinds = {m["name"]: m["kind"] for m in case.get("scene", {}).get("measure", [])}
    if column in kinds:
        return unit_of_kind(kinds[column]) or None
    return UNITS.get(column, UNIT_OF_CHECK.get(name)) or unit_of_load(column)
