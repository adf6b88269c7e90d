# SPDX-License-Identifier: GPL-2.0-or-later
"""results.h5 and results.csv: complete or absent, read as pandas DataFrames."""

from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from ..base.tables import (
    Hdf5,
    attributes,
    opened,
    read_table,
    read_text,
    write_attributes,
    write_csv,
    write_table,
    write_text,
)
from .comparison import UNITS


@dataclass
class Results:
    """What a run leaves. Tables are DataFrames, keyed "law/engine" (impacts, paths) or "law" (predictions).

    attributes: of the file (case name, versions); runs: of each law/engine (hash of its inputs, seconds).
    """

    case_text: str = ""
    attributes: dict[str, str] = field(default_factory=dict)
    comparison: pd.DataFrame = field(default_factory=pd.DataFrame)
    impacts: dict[str, pd.DataFrame] = field(default_factory=dict)
    predictions: dict[str, pd.DataFrame] = field(default_factory=dict)
    runs: dict[str, dict[str, object]] = field(default_factory=dict)
    decks: dict[str, str] = field(default_factory=dict)
    paths: dict[str, pd.DataFrame] = field(default_factory=dict)


def write(path: Path, results: Results) -> None:
    """Store `results` in the HDF5 file `path` and its comparison as CSV beside it."""
    stored = Hdf5()
    file = stored.file
    write_attributes(file, results.attributes)
    write_text(file, "case", results.case_text)
    write_table(file.create_group("comparison"), results.comparison, UNITS)
    for kind, tables in (("impacts", results.impacts), ("predictions", results.predictions), ("paths", results.paths)):
        for key, table in tables.items():
            write_table(file.create_group(f"{kind}/{key}"), table, UNITS)
    for key, about in results.runs.items():
        write_attributes(file[f"impacts/{key}"], about)
    for key, text in results.decks.items():
        write_text(file, f"decks/{key}", text)
    stored.save(path)
    write_csv(path.with_suffix(".csv"), results.comparison)


def read(path: Path | str) -> Results:
    """The results in an HDF5 file that `write` made. Raises CaseError."""
    with opened(path, "a results file of epdem") as file:
        results = Results(read_text(file["case"]), attributes(file), read_table(file["comparison"]))
        for law, group in file.get("predictions", {}).items():
            results.predictions[law] = read_table(group)
        for law, engines in file.get("impacts", {}).items():
            for engine, group in engines.items():
                key = f"{law}/{engine}"
                results.impacts[key] = read_table(group)
                results.paths[key] = read_table(file[f"paths/{key}"])
                results.runs[key] = {k: v for k, v in attributes(group).items() if k != "columns"}
                for name, text in file.get(f"decks/{key}", {}).items():
                    results.decks[f"{key}/{name}"] = read_text(text)
        return results
