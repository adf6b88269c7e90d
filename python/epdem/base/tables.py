# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables in HDF5: DataFrames as groups of one dataset per column, with units; a file is complete or absent."""

import contextlib
import hashlib
import io
from collections.abc import Iterator, Mapping
from pathlib import Path

import h5py
import numpy as np
import pandas as pd

from ..errors import CaseError
from .files import atomic

SEAL = b"epdem blake2b "
LARGE = 5000  # values from which a column is compressed


class Hdf5:
    """An HDF5 file that grows in memory and reaches the disk by `save`, so that a full disk leaves no half file."""

    def __init__(self) -> None:
        self._bytes = io.BytesIO()
        self.file = h5py.File(self._bytes, "w")

    def save(self, path: Path) -> None:
        """Write the file to `path` in place of what is there. Raises OSError and leaves what is there."""
        self.file.close()
        with atomic(path) as temporary, temporary.open("wb") as stream:
            stream.write(self._bytes.getbuffer())
            stream.write(_seal(self._bytes.getbuffer()))


def _seal(data: bytes | memoryview) -> bytes:
    """What stands behind the data of a file, where HDF5 does not look: their hash."""
    return SEAL + hashlib.blake2b(data, digest_size=32).digest()


def _changed(path: Path) -> bool:
    """Whether the data are others than those that were written: HDF5 may read damaged ones for ever.

    A file without a seal is one that another program has written to.
    """
    data = path.read_bytes()
    at = len(data) - len(SEAL) - 32
    return at > 0 and data[at:].startswith(SEAL) and _seal(memoryview(data)[:at]) != data[at:]


@contextlib.contextmanager
def opened(path: Path | str, what: str) -> Iterator[h5py.File]:
    """An HDF5 file to read. Raises CaseError if it is not there, or if it or what is read of it is damaged."""
    try:
        if _changed(Path(path)):
            raise OSError("its data are not those that were written")
        with h5py.File(path) as file:
            yield file
    except FileNotFoundError:
        raise CaseError(f"{path}: no such file; 'epdem run CASE' writes it") from None
    except Exception as error:  # HDF5 reports damage by almost any of them
        reason = " ".join(str(error).split()) or type(error).__name__
        raise CaseError(f"{path}: not {what}, or damaged ({reason}); run the case again") from None


def unit_of(column: str, units: Mapping[str, str]) -> str:
    """The unit of a column by its name ("x_theory" has that of "x"); "" without."""
    return units.get(column.removesuffix("_theory"), "")


def write_table(group: h5py.Group, table: pd.DataFrame, units: dict[str, str]) -> None:
    """Store `table` in `group`, its columns with their `units` (see `unit_of`)."""
    for name in table.columns:
        column = table[name].to_numpy()
        if column.dtype == object or column.dtype.kind in "US":
            column = np.array([str(v).encode() for v in column])
        large = {"compression": "gzip", "compression_opts": 1, "shuffle": True} if column.size > LARGE else {}
        dataset = group.create_dataset(name, data=column, **large)
        if unit := unit_of(name, units):
            dataset.attrs["unit"] = unit
    group.attrs["columns"] = list(table.columns)


def read_table(group: h5py.Group) -> pd.DataFrame:
    """The table that `write_table` stored in `group`, with the units of its columns in `attrs["units"]`."""
    columns, units = {}, {}
    for name in group.attrs["columns"]:
        data = group[name][()]
        columns[name] = [v.decode() for v in data] if data.dtype.kind == "S" else data
        if "unit" in group[name].attrs:
            units[name] = group[name].attrs["unit"]
    table = pd.DataFrame(columns)
    table.attrs["units"] = units
    return table


def write_csv(path: Path, table: pd.DataFrame) -> None:
    """`table` as a CSV file, whole or not at all."""
    with atomic(path) as temporary:
        table.to_csv(temporary, index=False)
