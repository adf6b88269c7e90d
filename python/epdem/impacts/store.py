# SPDX-License-Identifier: GPL-2.0-or-later
"""results.h5 and results.csv: written whole or not at all, read as pandas DataFrames."""

from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np
import pandas as pd

from ..errors import CaseError
from ..files import atomic
from .comparison import UNITS


@dataclass
class Results:
    """What a run leaves. Tables are DataFrames, keyed "law/engine" (impacts) or "law" (predictions).

    attributes: of the file (case name, versions); runs: of each law/engine (hash of its inputs, seconds).
    """

    case_text: str = ""
    attributes: dict[str, str] = field(default_factory=dict)
    comparison: pd.DataFrame = field(default_factory=pd.DataFrame)
    impacts: dict[str, pd.DataFrame] = field(default_factory=dict)
    predictions: dict[str, pd.DataFrame] = field(default_factory=dict)
    runs: dict[str, dict[str, object]] = field(default_factory=dict)
    decks: dict[str, str] = field(default_factory=dict)


def _write_table(group: h5py.Group, table: pd.DataFrame) -> None:
    for name in table.columns:
        column = table[name].to_numpy()
        if column.dtype == object or column.dtype.kind in "US":
            column = np.array([str(v).encode() for v in column])
        dataset = group.create_dataset(name, data=column)
        if unit := UNITS.get(name.split("_theory")[0]):
            dataset.attrs["unit"] = unit
    group.attrs["columns"] = list(table.columns)


def _read_table(group: h5py.Group) -> pd.DataFrame:
    columns = {}
    for name in group.attrs["columns"]:
        data = group[name][()]
        columns[name] = [v.decode() for v in data] if data.dtype.kind == "S" else data
    return pd.DataFrame(columns)


def write(path: Path, results: Results) -> None:
    """Store `results` in the HDF5 file `path` and its comparison as CSV beside it."""
    with atomic(path) as temporary, h5py.File(temporary, "w") as file:
        file.attrs.update(results.attributes)
        file["case"] = results.case_text
        _write_table(file.create_group("comparison"), results.comparison)
        for kind, tables in (("impacts", results.impacts), ("predictions", results.predictions)):
            for key, table in tables.items():
                _write_table(file.create_group(f"{kind}/{key}"), table)
        for key, attributes in results.runs.items():
            file[f"impacts/{key}"].attrs.update(attributes)
        for key, text in results.decks.items():
            file[f"decks/{key}"] = text
    with atomic(path.with_suffix(".csv")) as temporary:
        results.comparison.to_csv(temporary, index=False)


def read(path: Path | str) -> Results:
    """The results in an HDF5 file that `write` made. Raises CaseError."""
    try:
        with h5py.File(path) as file:
            found = Results(file["case"][()].decode(), dict(file.attrs), _read_table(file["comparison"]))
            for law, group in file.get("predictions", {}).items():
                found.predictions[law] = _read_table(group)
            for law, engines in file.get("impacts", {}).items():
                for engine, group in engines.items():
                    key = f"{law}/{engine}"
                    found.impacts[key] = _read_table(group)
                    found.runs[key] = {k: v for k, v in group.attrs.items() if k != "columns"}
                    for name, text in file.get(f"decks/{key}", {}).items():
                        found.decks[f"{key}/{name}"] = text[()].decode()
            return found
    except FileNotFoundError:
        raise CaseError(f"{path}: no such file; 'epdem run CASE' writes it") from None
    except (OSError, KeyError) as error:
        raise CaseError(f"{path}: not a results file of epdem ({error}); run the case again") from None
