# SPDX-License-Identifier: GPL-2.0-or-later
"""Units that readers know, for pages and the terminal: MPa, mm and degrees. Files and JSON keep SI."""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:  # slow to import
    import pandas as pd

# of an SI unit, from the largest: what a reader knows, how much of the SI unit it is, from which number on it is used
READ = {
    "Pa": (("GPa", 1e9, 1e10), ("MPa", 1e6, 1e5), ("kPa", 1e3, 1e2), ("Pa", 1.0, 0.0)),
    "m": (("mm", 1e-3, 1e-4), ("um", 1e-6, 0.0)),
    "rad": (("deg", math.pi / 180.0, 0.0),),
}


def unit_for(unit: str, values: Any) -> tuple[str, float]:
    """The unit in which numbers in an SI `unit` are shown, and how much of the SI unit it is."""
    known = READ.get(unit)
    if known is None:
        return unit, 1.0
    size = np.abs(np.asarray(values, float))
    largest = float(size[np.isfinite(size)].max(initial=0.0)) or 1.0  # zeros: mm, as most
    return next((name, factor) for name, factor, least in known if largest >= least)


def in_words(value: float, unit: str, digits: int = 4) -> str:
    """A number in an SI `unit` as text with a unit that readers know."""
    name, factor = unit_for(unit, value)
    return "-" if value != value else f"{value / factor + 0.0:.{digits}g} {name}".rstrip()


def columns(frame: "pd.DataFrame", units: Mapping[str, str]) -> tuple["pd.DataFrame", dict[str, str]]:
    """A table and the units of its columns as shown: all columns of one SI unit have the same one."""
    found = {name: unit for name, unit in units.items() if name in frame}
    read = {u: unit_for(u, frame[[n for n, unit in found.items() if unit == u]]) for u in dict.fromkeys(found.values())}
    changed = {name: frame[name] / read[unit][1] for name, unit in found.items() if read[unit][1] != 1.0}
    return frame.assign(**changed), {name: read[unit][0] for name, unit in found.items()}


def rows(frame: "pd.DataFrame", values: tuple[str, ...]) -> "pd.DataFrame":
    """A table whose column `unit` holds the SI unit of these `values` of each row, as shown."""
    found = frame.copy()
    for place in range(len(frame)):
        at = [frame.columns.get_loc(name) for name in values]
        unit, factor = unit_for(str(frame["unit"].iloc[place]), frame.iloc[place, at])
        found.iloc[place, at] = frame.iloc[place, at].to_numpy(float) / factor
        found.iloc[place, frame.columns.get_loc("unit")] = unit
    return found
