# SPDX-License-Identifier: GPL-2.0-or-later
"""Runner of the studies of `studies.toml`: rows of cases, engines and laws against the tolerances of quantities."""

import tomllib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import pandas as pd

from ..base.files import claim
from ..base.tables import write_csv
from ..impacts.engine import ImpactEngine
from ..impacts.measurement import compare
from ..impacts.plan import Plan
from ..impacts.prediction import Prediction
from ..impacts.run import run_plan

Row = dict[str, Any]
Progress = Callable[[str], None]
Tool = TypeVar("Tool")


def silent(text: str) -> None:
    """Discard progress."""


@dataclass(frozen=True)
class Study:
    """A table of studies.toml. tolerances: the largest value of a quantity, or the name of the column that holds it."""

    title: str
    file: str = ""
    engines: tuple[str, ...] = ()
    tolerances: dict[str, float | str] = field(default_factory=dict)

    def judged(self, row: Row) -> Row:
        """A row with `passed` and `reason`: the quantities above their tolerances; as it is if the study has none.

        None as a value: the quantity was not asked of this row.
        """
        if not self.tolerances:
            return row
        limits = {name: row[limit] if isinstance(limit, str) else limit for name, limit in self.tolerances.items()}
        wrong = [
            f"{name} = {row[name]:.2g}, at most {limit:g}"
            for name, limit in limits.items()
            if row[name] is not None and not row[name] <= limit
        ]
        return row | {"passed": not wrong, "reason": "; ".join(wrong)}

    def tools(self, named: Sequence[str], find: Callable[[str], Tool]) -> list[Tool]:
        """The engines that are named, each once, else those of the study. Raises CaseError."""
        return [find(name) for name in dict.fromkeys(named or self.engines)]


@dataclass(frozen=True)
class Outcome:
    """rows: of the study, judged; folder: of its results."""

    study: Study
    rows: pd.DataFrame
    folder: Path

    @property
    def passed(self) -> bool:
        return bool(self.rows["passed"].all())


STUDIES = {
    name: Study(**about | {"engines": tuple(about.get("engines", ()))})
    for name, about in tomllib.loads(Path(__file__).with_name("studies.toml").read_text(encoding="utf-8")).items()
}


def compare_impacts(p: Plan, prediction: Prediction, tool: ImpactEngine, folder: Path) -> tuple[pd.DataFrame, float]:
    """Impacts of a plan compared with their prediction, one row per speed, and run time [s].

    Raises EngineError, and CaseError for a plan that the engine refuses.
    """
    stage, x = run_plan(p, tool, folder), p.experiment
    rows = compare(tool.name, x.law.name, stage.tables["impacts"], prediction, x.check)
    return rows, stage.seconds["seconds"]


def run(name: str, rows: Iterable[Row], folder: Path, *, force: bool = False) -> Outcome:
    """Take the rows of a study, which run as they are taken, and write its table into `folder`."""
    study = STUDIES[name]
    with claim(folder, force=force, files=[study.file]):
        table = pd.DataFrame([study.judged(row) for row in rows])
        write_csv(folder / study.file, table)
    return Outcome(study, table, folder)
