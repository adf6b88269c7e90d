# SPDX-License-Identifier: GPL-2.0-or-later
"""results.h5 of a scene: tables, complete or absent, read as pandas DataFrames."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from ..base import tables as h5
from . import vtkhdf
from .columns import units
from .plan import ScenePlan

FILES = "files"  # group of the files that the case names


@dataclass
class SceneResults:
    """Tables by name (rows, particles, contacts, energy_balance, checks), deck texts, attributes of the file.

    files: the contents of those that the case names; None: of an earlier version, which did not store them.
    """

    case_text: str = ""
    attributes: dict[str, object] = field(default_factory=dict)
    tables: dict[str, pd.DataFrame] = field(default_factory=dict)
    decks: dict[str, str] = field(default_factory=dict)
    files: dict[str, bytes] | None = field(default_factory=dict)

    def __getattr__(self, name: str) -> pd.DataFrame:
        tables: dict[str, pd.DataFrame] = self.__dict__.get("tables", {})
        if name in tables:
            return tables[name]
        raise AttributeError(f"no table {name!r}; there are {', '.join(tables)}")


def write(path: Path, p: ScenePlan, results: SceneResults) -> None:
    """Store `results` in the HDF5 file `path`, which ParaView shows, and its rows as CSV beside it."""
    stored = h5.Hdf5()
    file = stored.file
    h5.write_attributes(file, {"kind": "scene", **results.attributes})
    h5.write_text(file, "case", results.case_text)
    for name, table in results.tables.items():
        h5.write_table(file.create_group(name), table, units(table))
    vtkhdf.write(file, p, results.tables)
    for name, text in results.decks.items():
        h5.write_text(file, f"decks/{name}", text)
    group = file.create_group(FILES)
    for n, (name, content) in enumerate((results.files or {}).items()):
        data = np.frombuffer(content, np.uint8)
        h5.write_attributes(
            group.create_dataset(str(n), data=data, compression="gzip", fletcher32=True), {"name": name}
        )
    stored.save(path)
    h5.write_csv(path.with_suffix(".csv"), results.tables["rows"])


def read(path: Path | str) -> SceneResults:
    """The results in a file that `write` made. Raises CaseError."""
    with h5.opened(path, "a results file of a scene") as file:
        results = SceneResults(h5.read_text(file["case"]), h5.attributes(file))
        for name, group in file.items():
            if "columns" in getattr(group, "attrs", {}):
                results.tables[name] = h5.read_table(group)
        results.decks = {name: h5.read_text(text) for name, text in file.get("decks", {}).items()}
        stored = file[FILES].values() if FILES in file else None
        results.files = None if stored is None else {h5.attributes(x)["name"]: x[()].tobytes() for x in stored}
        return results
