# SPDX-License-Identifier: GPL-2.0-or-later
"""results.h5 and results.csv: complete or absent, read as pandas DataFrames."""

from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from ..base import tables as h5
from .measurement import UNITS


@dataclass
class Results:
    """Results of a run. Tables are DataFrames, keyed "law/engine" (impacts, paths) or "law" (predictions).

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


def write(path: Path, results: Results, stored: Results | None = None) -> None:
    """Store `results` in the HDF5 file `path` and its comparison as CSV beside it.

    stored: results in the file; equal ones stay.
    """
    h5.write_csv(path.with_suffix(".csv"), results.comparison)
    if stored and h5.same(vars(results), vars(stored)):
        return
    with h5.new_file(path) as file:
        h5.write_attributes(file, results.attributes)
        h5.write_text(file, "case", results.case_text)
        h5.write_table(file.create_group("comparison"), results.comparison, UNITS)
        for kind in ("impacts", "predictions", "paths"):
            for key, table in getattr(results, kind).items():
                h5.write_table(file.create_group(f"{kind}/{key}"), table, UNITS)
        for key, about in results.runs.items():
            h5.write_attributes(file[f"impacts/{key}"], about)
        for key, text in results.decks.items():
            h5.write_text(file, f"decks/{key}", text)


def read(path: Path | str) -> Results:
    """The results in an HDF5 file that `write` made. Raises CaseError."""
    with h5.open_results(path, "a results file of epdem") as file:
        results = Results(h5.read_text(file["case"]), h5.attributes(file), h5.read_table(file["comparison"]))
        for law, group in h5.members(file, "predictions"):
            results.predictions[law] = h5.read_table(group)
        for law, engines in h5.members(file, "impacts"):
            for engine, group in h5.members(engines):
                key = f"{law}/{engine}"
                results.impacts[key] = h5.read_table(group)
                results.paths[key] = h5.read_table(file[f"paths/{key}"])
                results.runs[key] = {k: v for k, v in h5.attributes(group).items() if k != "columns"}
                for name, text in h5.members(file, f"decks/{key}"):
                    results.decks[f"{key}/{name}"] = h5.read_text(text)
        return results
