# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables in HDF5: DataFrames as groups of one dataset per column, with units; a file is complete or absent.

HDF5's checksums cover a file: fletcher32 the data, format 1.10 the metadata. Strings have a fixed length, because HDF5
stores strings of variable length without a checksum.
"""

import contextlib
import io
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
import pandas as pd

from ..errors import CaseError
from .files import atomic

LARGE = 5000  # values from which a column is compressed


class Column(NamedTuple):
    """The number in a column, measure or check: SI unit ("" for a plain number), and its meaning in a sentence."""

    unit: str
    sentence: str


class WithTables:
    """What has each of its `tables` as an attribute, too."""

    def __getattr__(self, name: str) -> pd.DataFrame:
        tables: dict[str, pd.DataFrame] = self.__dict__.get("tables", {})
        if name in tables:
            return tables[name]
        raise AttributeError(f"no table {name!r}; there are {', '.join(tables)}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.__dict__["tables"]]


@contextlib.contextmanager
def new_file(path: Path) -> Iterator[h5py.File]:
    """An HDF5 file in memory that replaces `path` at the end of the block: a full disk leaves no half file."""
    content = io.BytesIO()
    with h5py.File(content, "w", libver="v110") as file:
        yield file
    with atomic(path) as temporary:
        temporary.write_bytes(content.getbuffer())


def write_attributes(target: h5py.HLObject, values: Mapping[str, object]) -> None:
    """Store `values` as attributes of a group or dataset."""
    for name, value in values.items():
        target.attrs[name] = np.bytes_(value.encode() or b"\0") if isinstance(value, str) else value


def attributes(target: h5py.HLObject) -> dict[str, Any]:
    """The attributes of a group or dataset, texts as str."""
    values = {name: target.attrs[name] for name in target.attrs}
    return {name: value.decode() if isinstance(value, bytes) else value for name, value in values.items()}


def members(group: h5py.Group, place: str = "") -> Iterator[tuple[str, h5py.Group | h5py.Dataset]]:
    """Names and members of a group, or of the one at a `place` in it, if there is one.

    Raises KeyError for a member that cannot be read, for which items() of h5py has None.
    """
    if place and place not in group:
        return
    for name in group[place] if place else group:
        path = f"{place}/{name}" if place else name
        try:
            yield name, group[path]
        except KeyError as error:
            raise KeyError(f"{path}: {error}") from None


def write_text(group: h5py.Group, name: str, text: str) -> None:
    """Store `text` as the dataset `name`."""
    group.create_dataset(name, data=np.array([text.encode() or b"\0"]), fletcher32=True)


def read_text(dataset: h5py.Dataset) -> str:
    """The text that `write_text` stored."""
    return str(dataset[0].decode())


@contextlib.contextmanager
def open_results(path: Path | str, what: str) -> Iterator[h5py.File]:
    """An HDF5 file to read. Raises CaseError if it is not there, or if it or what is read of it is damaged."""
    try:
        with h5py.File(path) as file:
            yield file
    except FileNotFoundError:
        raise CaseError(f"{path}: no such file; 'epdem run CASE' writes it") from None
    except Exception as error:  # HDF5 reports damage by almost any of them
        reason = " ".join(str(error).split()) or type(error).__name__
        raise CaseError(f"{path}: not {what}, or damaged ({reason}); run the case anew (--fresh)") from None


def write_array(group: h5py.Group, name: str, data: np.ndarray, *, checksum: bool = True) -> h5py.Dataset:
    """Store an array as the dataset `name`; a large one compressed."""
    large = {"compression": "gzip", "compression_opts": 1, "shuffle": True} if data.size > LARGE else {}
    return group.create_dataset(name, data=data, fletcher32=(checksum and data.size > 0) or None, **large)


def write_table(group: h5py.Group, table: pd.DataFrame, units: dict[str, str]) -> None:
    """Store `table` in `group`, its columns with their `units`."""
    for name in table.columns:
        column = table[name].to_numpy()
        if column.dtype == object or column.dtype.kind in "US":
            column = np.array([str(v).encode() for v in column])
        dataset = write_array(group, name, column)
        if unit := units.get(name):
            write_attributes(dataset, {"unit": unit})
    group.attrs["columns"] = np.array([name.encode() for name in table.columns], dtype="S")


def read_table(group: h5py.Group) -> pd.DataFrame:
    """The table that `write_table` stored in `group`, with the units of its columns in `attrs["units"]`."""
    columns, units = {}, {}
    try:
        for name in (name.decode() for name in group.attrs["columns"]):
            data = group[name][()]
            columns[name] = [v.decode() for v in data] if data.dtype.kind == "S" else data
            if unit := attributes(group[name]).get("unit"):
                units[name] = unit
    except Exception as error:  # HDF5 reports damage by almost any of them
        raise ValueError(f"table {group.name}: {error}") from None
    table = pd.DataFrame(columns)
    table.attrs["units"] = units
    return table


def same(one: object, other: object) -> bool:
    """Whether two objects, mappings of objects or tables are equal, of tables with rows their types, too."""
    if isinstance(one, pd.DataFrame):
        if not isinstance(other, pd.DataFrame) or list(one) != list(other):
            return False
        return len(one) == len(other) == 0 or bool(one.equals(other))
    if isinstance(one, Mapping):
        there = isinstance(other, Mapping) and one.keys() == other.keys()
        return there and all(same(value, other[name]) for name, value in one.items())  # type: ignore[index]
    return bool(one == other)


def write_csv(path: Path, table: pd.DataFrame) -> None:
    """`table` as a CSV file, whole or not at all."""
    with atomic(path) as temporary:
        table.to_csv(temporary, index=False)
