# SPDX-License-Identifier: GPL-2.0-or-later
"""All points of a sweep in one table: sweep.csv and sweep.h5, and how they are read."""

from pathlib import Path
from typing import Any

import pandas as pd

from ...base.tables import Hdf5, opened, read_table, write_attributes, write_csv, write_table, write_text
from ...case.units import to_si
from ...errors import CaseError
from ...impacts.comparison import UNITS
from . import folder as store
from . import numbers
from .folder import Sweep

TABLE = "sweep.h5"


def collect(sweep: Sweep, folder: Path) -> pd.DataFrame:
    """A row for every row of every point: its number, folder, keys in SI, state and reason, then its results.

    A point without results has one row. `attrs["units"]` gives the SI units by column.
    """
    columns: dict[str, list[Any]] = {}
    count = 0
    for n, about in enumerate(store.records(sweep, folder), start=1):
        rows = about.get("rows") or {}
        size = len(next(iter(rows.values()))) if rows else 1
        head = {"point": n, "folder": f"{store.POINTS}/{sweep.identities[n - 1]}", **_keys(sweep, n)}
        head |= {"status": about["state"], "reason": about.get("reason", "")}
        for name, value in head.items():
            columns.setdefault(name, []).extend([value] * size)
        for name, values in rows.items():
            filled = columns.setdefault(name, [])
            filled.extend([None] * (count - len(filled)))
            filled.extend(values)
        count += size
    table = pd.DataFrame({name: values + [None] * (count - len(values)) for name, values in columns.items()})
    for name in ("engine", "law"):
        if name in table:
            table[name] = table[name].fillna("")
    if "passed" in table:
        table["passed"] = table["passed"] == True  # noqa: E712  (None has not passed)
    table = table.infer_objects()
    units = {name: unit for name, unit in sweep.units.items() if unit and unit != "1"}
    for name in table.columns:
        if of_column := numbers.unit(name, sweep.tables) if sweep.scene else UNITS.get(name):
            units[name] = of_column
    theory = {f"{name}_theory": u for name, u in units.items() if f"{name}_theory" in table}
    table.attrs["units"] = units | theory
    return table


def _keys(sweep: Sweep, number: int) -> dict[str, Any]:
    """The keys that a point sets: quantities in SI, numbers as they are, all else as text."""
    keys: dict[str, Any] = {}
    for name, value in sweep.points[number - 1].items():
        unit = sweep.units[name]
        if unit and isinstance(value, str):
            keys[name] = to_si(value, unit)
        else:
            keys[name] = value if isinstance(value, int | float | str) else repr(value)
    return keys


def write(sweep: Sweep, folder: Path) -> pd.DataFrame:
    """Collect the table of a sweep and store it as sweep.csv and sweep.h5."""
    table = collect(sweep, folder)
    stored = Hdf5()
    write_attributes(stored.file, {"case": sweep.name})
    write_text(stored.file, "case_text", sweep.case)
    write_table(stored.file.create_group("sweep"), table, table.attrs["units"])
    stored.save(folder / TABLE)
    write_csv(folder / "sweep.csv", table)
    return table


def read_sweep(folder: Path | str) -> pd.DataFrame:
    """The table of a sweep from its folder; see `collect`. Raises CaseError."""
    path = Path(folder) / TABLE
    if not path.exists():
        raise CaseError(f"{path}: no table of a sweep; 'epdem sweep CASE --out {folder}' writes it")
    with opened(path, "a table of a sweep") as file:
        return read_table(file["sweep"])
