# SPDX-License-Identifier: GPL-2.0-or-later
"""Stored results of impacts, scenes and sweeps: tables by name, whatever folder they come from."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from ..base import tables as h5
from ..errors import CaseError
from ..impacts import store
from ..impacts.measurement import UNITS
from ..scenes.tables import results as scene_results
from ..scenes.tables.columns import units as scene_units
from ..studies.sweep import folder as sweep_folder
from ..studies.sweep.table import collect
from .arguments import take


def with_units(table: pd.DataFrame, units: Mapping[str, str]) -> pd.DataFrame:
    """A copy with the units of its columns in `attrs["units"]`."""
    marked = table.copy()
    marked.attrs["units"] = {name: units[name] for name in map(str, marked) if name in units}
    return marked


@dataclass(frozen=True)
class Stored:
    """Results of a folder. Each of its `tables` is an attribute, too: `read("runs/settle_glass").rows`.

    Impacts have `comparison` (measured and predicted), `impacts`, `predictions` and `paths`; scenes the tables of
    `SceneRun.tables`; sweeps `points`. Tables have the SI units of their columns in `attrs["units"]`. title: kind and
    name. text: the case file.
    """

    folder: Path
    title: str
    passed: bool
    text: str
    tables: dict[str, pd.DataFrame]

    def __getattr__(self, name: str) -> pd.DataFrame:
        tables: dict[str, pd.DataFrame] = self.__dict__.get("tables", {})
        if name in tables:
            return tables[name]
        raise AttributeError(f"no table {name!r}; there are {', '.join(tables)}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.tables]

    def __repr__(self) -> str:
        return two_lines(self.title, self.passed, self.folder, self.tables)


def two_lines(title: str, passed: bool, folder: Path, tables: Mapping[str, pd.DataFrame]) -> str:
    """What ran with its verdict, and where its tables are with their numbers of rows."""
    sizes = ", ".join(f"{name} ({len(table)} rows)" for name, table in tables.items())
    return f"{title}: {'passed' if passed else 'not passed'}\n{folder}: {sizes}"


def read(folder: Path | str) -> Stored:
    """The results that a run, a scene or a sweep has stored in `folder`, or in a file results.h5. Nothing runs.

    Raises CaseError for a folder without results.
    """
    place = take("folder", folder, Path)
    if (place / sweep_folder.DEFINITION).exists():
        sweep = sweep_folder.read(place)
        points = collect(sweep, place)
        done = (points["status"] == sweep_folder.DONE).all() and "passed" in points and points["passed"].all()
        return Stored(place, f"sweep {sweep.name}", bool(done), sweep.case, {"points": points})
    path = place if place.is_file() else place / "results.h5"
    if not path.exists():
        raise CaseError(f"{place}: no results.h5 and no sweep; name the folder of a finished run")
    with h5.open_results(path, "a results file of epdem") as file:
        of_scene = h5.attributes(file).get("kind") == "scene"
    return _scene(path) if of_scene else _impacts(path)


def _scene(path: Path) -> Stored:
    found = scene_results.read(path)
    tables = {name: with_units(table, scene_units(table)) for name, table in found.tables.items()}
    passed = "checks" not in tables or bool(tables["checks"]["passed"].all())
    return Stored(path.parent, f"scene {found.attributes['case']}", passed, found.case_text, tables)


def _impacts(path: Path) -> Stored:
    found = store.read(path)
    tables = {"comparison": found.comparison}
    for name in ("impacts", "predictions", "paths"):
        parts: dict[str, pd.DataFrame] = getattr(found, name)
        names = ["law", "engine"] if name != "predictions" else ["law"]
        rows = [table.assign(**dict(zip(names, key.split("/"), strict=True))) for key, table in parts.items()]
        tables[name] = pd.concat(rows, ignore_index=True) if rows else pd.DataFrame()
    tables = {name: with_units(table, UNITS) for name, table in tables.items()}
    passed = bool(found.comparison["passed"].all())
    return Stored(path.parent, f"impacts {found.attributes['case']}", passed, found.case_text, tables)
