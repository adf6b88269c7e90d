# SPDX-License-Identifier: GPL-2.0-or-later
"""Measured impacts against every law on engines: sets of data/restitution, nothing fitted, misses included."""

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
from ..impacts.experiment import Experiment, bodies, experiment
from ..impacts.plan import plan
from ..impacts.prediction import predict
from ..jobs.engine import require
from ..laws.strengths import default_numbers, find_law, strength_of_hardness
from ..studies.calibrate import EXPONENT, hardness_test, specimen
from .models import engine
from .runner import STUDIES, Progress, Row, compare_impacts, run, silent

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
    heads = re.findall(r"^# (\w+): (.*)$", path.read_text(encoding="utf-8"), re.MULTILINE)
    table = pd.read_csv(path, comment="#", keep_default_na=False)
    table.columns = table.columns.str.replace(r" \[.*\]$", "", regex=True)
    (given,) = (column for column in STRENGTHS if column in table)
    used = table["left out"] == ""
    return Measured(name, dict(heads), table[used].drop(columns="left out"), table[~used], given)


def case_of(measured: Measured, material: str, value: float, speeds: Sequence[float], law: str) -> Case:
    """The case of a set for a law, with one hardness [HV] or yield stress [Pa] of `material` and its speeds [m/s]."""
    path = paths.beside("cases") / measured.head["case"]
    data = read_toml(path)
    data["impact"]["speeds"] = [f"{v!r} m/s" for v in speeds]
    if measured.given == "hardness" and find_law(law).strength:
        numbers = default_numbers(law)
        body = specimen(*bodies(parse(data, path)))
        value = strength_of_hardness(numbers, hardness_test(vickers=value), body, f"HV {value:g}") / numbers.ratio
    if measured.given == "yield_stress" or find_law(law).strength:
        data["materials"][material]["yield_stress"] = f"{value!r} Pa"
    return parse(data, path)


def _simulated(x: Experiment, impacts: pd.DataFrame, quantity: pd.Series) -> np.ndarray:
    """Simulated values of quantities: e_n, or the width [m] of the contact at its largest overlap."""
    if x.law.adheres and (quantity != "e_n").any():
        raise CaseError(f"law {x.law.name}: the width of a dent under adhesion is not computed")
    width = 2.0 * np.asarray(x.theory().radius(impacts["overlap_max"].to_numpy()))
    return np.where(quantity == "e_n", impacts["e_n"], width)


def _of_law(measured: Measured, law: str, tools: list[ImpactEngine], scratch: Path) -> Iterator[Row]:
    """One row for each point and engine. Raises CaseError if the law does not have its numbers in the set's case."""
    if EXPONENT in default_numbers(law).ratios:
        raise CaseError(f"law {law}: no set has a {EXPONENT}, without which the law is thornton")
    for (material, given), points in measured.points.groupby(["strength of", measured.given]):
        speeds, place = np.unique(points["speed"], return_inverse=True)
        x = experiment(case_of(measured, str(material), float(given), speeds.tolist(), law), law)
        prediction = predict(x)
        for tool in tools:
            impacts, _ = compare_impacts(plan(x, prediction), prediction, tool, scratch)
            found = _simulated(x, impacts.iloc[place], points["quantity"])
            for point, value in zip(points.to_dict("records"), found.tolist(), strict=True):
                about = {"set": measured.name, "law": law, "engine": tool.name, "quantity": point["quantity"]}
                about |= {"speed": point["speed"], measured.given: given, "measured": point["value"], "found": value}
                error, off = value / point["value"] - 1.0, (value - point["value"]) / point["uncertainty"]
                yield about | {"uncertainty": point["uncertainty"], "error": error, "in_uncertainties": off}


def summary(points: pd.DataFrame) -> pd.DataFrame:
    """Median and largest absolute error, the signed largest, and the rms error in uncertainties, per set, law and
    engine."""
    groups = points.assign(size=points["error"].abs()).groupby(["set", "law", "engine"], sort=False)
    table = groups["size"].agg(points="count", median="median", largest="max").reset_index()
    worst = points.loc[groups["error"].apply(lambda e: e.abs().idxmax()).to_numpy()]
    rms = groups["in_uncertainties"].agg(lambda e: float(np.sqrt((e**2).mean()))).to_numpy()
    return table.assign(signed=worst["error"].to_numpy(), where=worst["quantity"].to_numpy(), rms_in_uncertainties=rms)


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
                        found = list(_of_law(one, law, tools, Path(scratch)))
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
