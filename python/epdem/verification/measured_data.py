# SPDX-License-Identifier: GPL-2.0-or-later
"""Measured impacts against every law on engines: sets of data/restitution, nothing fitted, misses included."""

import csv
import re
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd

from ..base import paths
from ..base.declarations import declarations
from ..base.files import results_folder
from ..case.impact import Case, parse
from ..case.toml import error_context, read_toml
from ..engines import ImpactEngine
from ..errors import CaseError
from ..impacts.experiment import Experiment, experiment
from ..impacts.plan import plan
from ..impacts.prediction import predict
from ..jobs.engine import require
from ..laws.strengths import default_numbers, find_law, strength_of_hardness
from ..studies.calibrate import EXPONENT
from ..theory.indentation import PYRAMID, VICKERS, Indentation
from .models import engine
from .runner import STUDIES, Progress, Row, compare_impacts, run, silent

QUANTITIES = ("e_n", "dent_width")
HEAD = ("title", "case", "source", "material", "read", "uncertainty")
COLUMNS = ("quantity", "value", "uncertainty", "speed", "strength of", "left out")
STRENGTHS = ("hardness", "yield_stress")


@dataclass(frozen=True)
class Measured:
    """One measured set: its head in words, and its points.

    A point has quantity, value and uncertainty in one unit, speed [m/s], the material whose `hardness` [HV] or
    `yield_stress` [Pa] is known. `left_out` are printed rows that are no points, each with its reason.
    """

    name: str
    head: dict[str, str]
    points: pd.DataFrame
    left_out: pd.DataFrame
    given: str  # which of STRENGTHS the set has


@dataclass(frozen=True)
class Validation:
    """points: one row per measured number, law and engine; summary: per set, law and engine; absent: laws left out."""

    sets: list[Measured]
    points: pd.DataFrame
    summary: pd.DataFrame
    absent: dict[str, str]
    folder: Path


def names() -> list[str]:
    """The sets that come with the package."""
    return sorted(path.stem for path in (paths.beside("data") / "restitution").glob("*.csv"))


def read(name: str) -> Measured:
    """A measured set by its name. Raises CaseError."""
    if name not in names():
        raise CaseError(f"--set {name!r} does not exist; there are {', '.join(names())}")
    path = paths.beside("data") / "restitution" / f"{name}.csv"
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]
    head = dict(line.removeprefix("# ").split(": ", 1) for line in lines if line.startswith("#"))
    if missing := [key for key in HEAD if key not in head]:
        raise CaseError(f"{path}: the head lacks {', '.join(missing)}; say where the numbers are from")
    titles, *rows = csv.reader(line for line in lines if not line.startswith("#"))
    columns = [re.sub(r" \[.*\]$", "", title) for title in titles]
    if odd := [row for row in rows if len(row) != len(columns)]:
        raise CaseError(f"{path}: row {','.join(odd[0])!r} has {len(odd[0])} values for {len(columns)} columns")
    table = pd.DataFrame(rows, columns=columns)
    given = [name for name in STRENGTHS if name in columns]
    if sorted(columns) != sorted([*COLUMNS, *given]) or len(given) != 1:
        raise CaseError(f"{path}: columns {', '.join(columns)}; must be {', '.join(COLUMNS)}, {' or '.join(STRENGTHS)}")
    if odd := [quantity for quantity in table["quantity"] if quantity not in QUANTITIES]:
        raise CaseError(f"{path}: quantity {odd[0]!r}, must be {' or '.join(QUANTITIES)}")
    for column in ("value", "uncertainty", "speed", *given):
        values = pd.to_numeric(table[column], errors="coerce")
        if values.isna().any():
            raise CaseError(f"{path}: {column} {table[column][values.isna()].iloc[0]!r} is no number; correct it")
        table[column] = values.astype(float)
    used = table["left out"] == ""
    return Measured(name, head, table[used].drop(columns="left out"), table[~used], given[0])


def case_of(measured: Measured, material: str, value: float, speeds: Sequence[float], law: str) -> Case:
    """The case of a set for a law, with one hardness [HV] or yield stress [Pa] of `material` and its speeds [m/s]."""
    path = paths.beside("cases") / measured.head["case"]
    data = read_toml(path)
    data["impact"]["speeds"] = [f"{v!r} m/s" for v in speeds]
    if measured.given == "hardness" and find_law(law).strength:
        numbers = default_numbers(law)
        solid, test = parse(data, path).materials[material], Indentation(value * VICKERS, PYRAMID)
        value = strength_of_hardness(numbers, test, solid, f"HV {value:g}") / numbers.ratio
    if measured.given == "yield_stress" or find_law(law).strength:
        data["materials"][material]["yield_stress"] = f"{value!r} Pa"
    return parse(data, path)


def _simulated(x: Experiment, row: pd.Series, quantity: str) -> float:
    """Simulated value of a quantity: e_n, or the width [m] of the contact at its largest overlap."""
    if quantity == "e_n":
        return float(row["e_n"])
    if x.law.adheres:
        raise CaseError(f"law {x.law.name}: the width of a dent under adhesion is not computed")
    return 2.0 * float(x.theory().radius(row["overlap_max"]))


def _of_law(measured: Measured, law: str, tools: list[ImpactEngine], scratch: Path) -> list[dict[str, object]]:
    """One row for each point and engine. Raises CaseError if the law does not have its numbers in the set's case."""
    if EXPONENT in default_numbers(law).ratios:
        raise CaseError(f"law {law}: no set has a {EXPONENT}, without which the law is thornton")
    rows: list[dict[str, object]] = []
    for (material, given), points in measured.points.groupby(["strength of", measured.given]):
        speeds = np.unique(points["speed"])
        x = experiment(case_of(measured, str(material), float(given), speeds.tolist(), law), law)
        prediction = predict(x)
        for tool in tools:
            impacts, _ = compare_impacts(plan(x, prediction), prediction, tool, scratch)
            for point in points.itertuples():
                row = impacts.iloc[int(np.flatnonzero(speeds == point.speed)[0])]
                found = _simulated(x, row, str(point.quantity))
                about = {"set": measured.name, "law": law, "engine": tool.name, "quantity": point.quantity}
                numbers = {"speed": point.speed, measured.given: given, "measured": point.value, "found": found}
                off = {
                    "error": found / point.value - 1.0,
                    "in_uncertainties": (found - point.value) / point.uncertainty,
                }
                rows.append(about | numbers | {"uncertainty": point.uncertainty} | off)
    return rows


def summary(points: pd.DataFrame) -> pd.DataFrame:
    """Median and largest absolute error, the signed largest, and the rms error in uncertainties, per set, law and
    engine."""
    groups = points.assign(size=points["error"].abs()).groupby(["set", "law", "engine"], sort=False)
    table = groups["size"].agg(points="count", median="median", largest="max").reset_index()
    worst = points.loc[groups["error"].apply(lambda e: e.abs().idxmax()).to_numpy()]
    rms = groups["in_uncertainties"].agg(lambda e: float(np.sqrt((e**2).mean()))).to_numpy()
    return table.assign(signed=worst["error"].to_numpy(), where=worst["quantity"].to_numpy(), rms_in_uncertainties=rms)


def shown(table: pd.DataFrame) -> pd.DataFrame:
    """The summary in words; the sign is that of the largest error."""
    rows = [
        {
            "set": row.set,
            "law": row.law,
            "engine": row.engine,
            "points": str(row.points),
            "median error": f"{row.median:.1%}",
            "largest error": f"{row.signed:+.1%} ({row.where})",
            "rms in uncertainties": f"{row.rms_in_uncertainties:.1f}",
        }
        for row in table.itertuples()
    ]
    return pd.DataFrame(rows)


def validate(
    *,
    sets: Sequence[str] = (),
    engines: Sequence[str] = (),
    chosen: Sequence[str] = (),
    out: Path | None = None,
    force: bool = False,
    progress: Progress = silent,
) -> Validation:
    """Run every law (or those `chosen`) against every set on every engine; measured.csv in the folder has the points.

    A law that needs numbers which a set's case does not have is left out. Raises CaseError, EngineError.
    """
    measured = [read(name) for name in dict.fromkeys(sets)] or [read(name) for name in names()]
    tools = STUDIES["data"].tools(engines, engine)
    require(*tools)
    absent: dict[str, str] = {}
    folder = results_folder(out, "validate")
    with tempfile.TemporaryDirectory() as scratch:

        def rows() -> Iterator[Row]:
            numbers: dict[tuple[object, ...], int] = {}
            for law, one in product(dict.fromkeys(chosen) or declarations(), measured):
                progress(f"{one.name}, {law}")
                try:
                    with error_context(one.name):
                        found = _of_law(one, law, tools, Path(scratch))
                except CaseError as error:
                    if chosen:
                        raise
                    absent[law] = str(error)
                    continue
                for row in found:
                    point = tuple(row[key] for key in ("set", "quantity", "measured", "speed"))
                    yield {"number": numbers.setdefault(point, len(numbers) + 1)} | row

        points = run("data", rows(), folder, force=force).rows
    return Validation(measured, points, summary(points), absent, folder)
