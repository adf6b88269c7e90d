# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables in HDF5: DataFrames as groups of one dataset per column, with units; a file is complete or absent."""

import io
from pathlib import Path

import h5py
import numpy as np
import pandas as pd

from .files import atomic

LARGE = 5000  # values from which a column is compressed


class Hdf5:
    """An HDF5 file that grows in memory and reaches the disk by `save`, so that a full disk leaves no half file."""

    def __init__(self) -> None:
        self._bytes = io.BytesIO()
        self.file = h5py.File(self._bytes, "w")

    def save(self, path: Path) -> None:
        """Write the file to `path` in place of what is there. Raises OSError and leaves what is there."""
        self.file.close()
        with atomic(path) as temporary:
            temporary.write_bytes(self._bytes.getbuffer())


def write_table(group: h5py.Group, table: pd.DataFrame, units: dict[str, str]) -> None:
    """Store `table` in `group`; `units` gives the unit of a column by its name ("x_theory" has that of "x")."""
    for name in table.columns:
        column = table[name].to_numpy()
        if column.dtype == object or column.dtype.kind in "US":
            column = np.array([str(v).encode() for v in column])
        large = {"compression": "gzip", "compression_opts": 1, "shuffle": True} if column.size > LARGE else {}
        dataset = group.create_dataset(name, data=column, **large)
        if unit := units.get(name.split("_theory")[0]):
            dataset.attrs["unit"] = unit
    group.attrs["columns"] = list(table.columns)


def read_table(group: h5py.Group) -> pd.DataFrame:
    """The table that `write_table` stored in `group`."""
    columns = {}
    for name in group.attrs["columns"]:
        data = group[name][()]
        columns[name] = [v.decode() for v in data] if data.dtype.kind == "S" else data
    return pd.DataFrame(columns)


def write_csv(path: Path, table: pd.DataFrame) -> None:
    """`table` as a CSV file, whole or not at all."""
    with atomic(path) as temporary:
        table.to_csv(temporary, index=False)
