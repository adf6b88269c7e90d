# SPDX-License-Identifier: GPL-2.0-or-later
"""Measured impacts against every law on engines: sets of data/restitution, nothing fitted, misses included."""

import re
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from ..base import paths
from ..base.folders import claim, results_folder
from ..base.tables import write_csv
from ..case.impact import Case, parse
from ..case.toml import named, read_toml
from ..engines import DEFAULT_ENGINE, ImpactEngine
from ..engines.embedded import Embedded
from ..errors import CaseError
from ..impacts.engine import require
from ..impacts.experiment import Experiment, experiment
from ..impacts.plan import plan
from ..impacts.prediction import predict
from ..impacts.run import run_and_compare
from ..laws.library import laws
from ..studies.calibrate import TABOR, pressure_of_hardness
from ..theory.backbones import JKR
from .models import engine

ENGINES = (Embedded.name, DEFAULT_ENGINE)  # of a study that names none
QUANTITIES = ("e_n", "dent_width")
HEAD = ("title", "case", "source", "material", "read")
COLUMNS = ("quantity", "value", "speed", "strength of")
STRENGTHS = ("hardness", "yield_stress")


@dataclass(frozen=True)
class Measured:
    """One measured set: its head in words, and its points (quantity, value, speed [m/s], material, Y [Pa])."""

    name: str
    head: dict[str, str]
    points: pd.DataFrame


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
    return sorted(path.stem for path in (paths.data() / "restitution").glob("*.csv"))


def read(name: str) -> Measured:
    """A measured set by its name. Raises CaseError."""
    if name not in names():
        raise CaseError(f"--set {name!r} does not exist; there are {', '.join(names())}")
    path = paths.data() / "restitution" / f"{name}.csv"
    lines = path.read_text(encoding="utf-8").splitlines()
    head = dict(line.removeprefix("# ").split(": ", 1) for line in lines if line.startswith("#"))
    if missing := [key for key in HEAD if key not in head]:
        raise CaseError(f"{path}: the head lacks {', '.join(missing)}; say where the numbers are from")
    titles, *rows = [line.split(",") for line in lines if line and not line.startswith("#")]
    columns = [re.sub(r" \[.*\]$", "", title) for title in titles]
    table = pd.DataFrame([dict(zip(columns, row, strict=True)) for row in rows])
    if tuple(columns[:4]) != COLUMNS or columns[4] not in STRENGTHS or not set(table["quantity"]) <= {*QUANTITIES}:
        raise CaseError(f"{path}: unknown column or quantity; there are {', '.join(COLUMNS)} and {STRENGTHS[0]}")
    table[["value", "speed"]] = table[["value", "speed"]].astype(float)
    strength = table.pop(columns[4]).astype(float)
    if columns[4] == "hardness":
        strength = strength.map(lambda hv: pressure_of_hardness(vickers=hv) / TABOR)
    return Measured(name, head, table.assign(yield_stress=strength))


def case_of(measured: Measured, material: str, yield_stress: float, speeds: Sequence[float]) -> Case:
    """The case of a set with one strength [Pa] and its speeds [m/s]."""
    path = paths.cases() / measured.head["case"]
    data = read_toml(path)
    data["materials"][material]["yield_stress"] = f"{yield_stress!r} Pa"
    data["impact"]["speeds"] = [f"{v!r} m/s" for v in speeds]
    return parse(data, path)


def _simulated(x: Experiment, row: pd.Series, quantity: str) -> float:
    """What a run of an impact gives for a quantity: e_n, or the width [m] of the contact at its largest overlap."""
    if quantity == "e_n":
        return float(row["e_n"])
    law = x.theory()
    if isinstance(law, JKR):
        raise CaseError(f"law {law.name}: the width of a dent under adhesion is not computed")
    return 2.0 * float(law.radius(row["overlap_max"]))


def _of_law(measured: Measured, law: str, tools: list[ImpactEngine], scratch: Path) -> list[dict[str, object]]:
    """One row for each point and engine. Raises CaseError if the law does not have its numbers in the set's case."""
    rows: list[dict[str, object]] = []
    for (material, strength), points in measured.points.groupby(["strength of", "yield_stress"]):
        speeds = np.unique(points["speed"])
        x = experiment(case_of(measured, str(material), float(strength), speeds.tolist()), law)
        prediction = predict(x)
        for tool in tools:
            run, _ = run_and_compare(plan(x, prediction), prediction, tool, scratch)
            for point in points.itertuples():
                row = run.iloc[int(np.flatnonzero(speeds == point.speed)[0])]
                found = _simulated(x, row, str(point.quantity))
                about = {"set": measured.name, "law": law, "engine": tool.name, "quantity": point.quantity}
                numbers = {"speed": point.speed, "yield_stress": strength, "measured": point.value, "found": found}
                rows.append(about | numbers | {"error": found / float(point.value) - 1.0})
    return rows


def summary(points: pd.DataFrame) -> pd.DataFrame:
    """Median and largest absolute error, and the signed largest, per set, law and engine."""
    groups = points.assign(size=points["error"].abs()).groupby(["set", "law", "engine"], sort=False)
    table = groups["size"].agg(points="count", median="median", largest="max").reset_index()
    worst = points.loc[groups["error"].apply(lambda e: e.abs().idxmax()).to_numpy()]
    return table.assign(signed=worst["error"].to_numpy(), where=worst["quantity"].to_numpy())


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
    progress: Callable[[str], None] = lambda text: None,
) -> Validation:
    """Run every law (or those `chosen`) against every set on every engine; validate.csv is in the folder.

    A law that needs numbers which a set's case does not have is left out. Raises CaseError, EngineError.
    """
    measured = [read(name) for name in dict.fromkeys(sets)] or [read(name) for name in names()]
    tools = [engine(name) for name in dict.fromkeys(engines or ENGINES)]
    require(*tools)
    absent: dict[str, str] = {}
    rows: list[dict[str, object]] = []
    folder = results_folder(out, "validate")
    with claim(folder, force=force, files=["validate.csv"]), tempfile.TemporaryDirectory() as scratch:
        for law in dict.fromkeys(chosen) or laws():
            for one in measured:
                progress(f"{one.name}, {law}")
                try:
                    with named(one.name):
                        rows += _of_law(one, law, tools, Path(scratch))
                except CaseError as error:
                    if chosen:
                        raise
                    absent[law] = str(error)
        points = pd.DataFrame(rows)
        same = points.groupby(["set", "quantity", "yield_stress", "speed"], sort=False)
        points.insert(0, "number", same.ngroup() + 1)
        write_csv(folder / "validate.csv", points)
    return Validation(measured, points, summary(points), absent, folder)
