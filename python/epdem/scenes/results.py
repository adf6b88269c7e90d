# SPDX-License-Identifier: GPL-2.0-or-later
"""results.h5 of a scene: tables written whole or not at all, read as pandas DataFrames."""

from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np
import pandas as pd

from ..errors import CaseError
from ..files import atomic
from .columns import UNITS

@dataclass
class SceneResults:
    """Tables by name (rows, particles, contacts, ledger, checks), deck texts, attributes of the file."""

    case_text: str = ""
    attributes: dict[str, object] = field(default_factory=dict)
    tables: dict[str, pd.DataFrame] = field(default_factory=dict)
    decks: dict[str, str] = field(default_factory=dict)

    def __getattr__(self, name: str) -> pd.DataFrame:
        tables = self.__dict__.get("tables", {})
        if name in tables:
            return tables[name]
        raise AttributeError(f"no table {name!r}; there are {', '.join(tables)}")


def write(path: Path, results: SceneResults) -> None:
    """Store `results` in the HDF5 file `path`, its rows as CSV beside it."""
    with atomic(path) as temporary, h5py.File(temporary, "w") as file:
        file.attrs.update({"kind": "scene", **results.attributes})
        file["case"] = results.case_text
        for name, table in results.tables.items():
            group = file.create_group(name)
            group.attrs["columns"] = list(table.columns)
            for column in table.columns:
                data = table[column].to_numpy()
                if data.dtype == object or data.dtype.kind in "US":
                    data = np.array([str(v).encode() for v in data])
                large = {"compression": "gzip", "compression_opts": 1, "shuffle": True} if data.size > 5000 else {}
                stored = group.create_dataset(column, data=data, **large)
                if unit := UNITS.get(column):
                    stored.attrs["unit"] = unit
        for name, text in results.decks.items():
            file[f"decks/{name}"] = text
    with atomic(path.with_suffix(".csv")) as temporary:
        results.tables["rows"].to_csv(temporary, index=False)


def read(path: Path | str) -> SceneResults:
    """The results in a file that `write` made. Raises CaseError."""
    try:
        with h5py.File(path) as file:
            found = SceneResults(file["case"][()].decode(), dict(file.attrs))
            for name, group in file.items():
                if "columns" not in getattr(group, "attrs", {}):
                    continue
                columns = {}
                for column in group.attrs["columns"]:
                    data = group[column][()]
                    columns[column] = [v.decode() for v in data] if data.dtype.kind == "S" else data
                found.tables[name] = pd.DataFrame(columns)
            found.decks = {name: text[()].decode() for name, text in file.get("decks", {}).items()}
            return found
    except FileNotFoundError:
        raise CaseError(f"{path}: no such file; 'epdem run CASE' writes it") from None
    except (OSError, KeyError) as error:
        raise CaseError(f"{path}: not a results file of a scene ({error}); run the case again") from None
