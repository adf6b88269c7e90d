# SPDX-License-Identifier: GPL-2.0-or-later
"""The Python interface: the commands as functions of cases with plain values; results are DataFrames.

Tables have the SI units of their columns in `attrs["units"]`. Progress goes to the logger "epdem".
"""

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, overload

import pandas as pd

from .. import theory
from ..case.plausibility import case_warnings
from ..case.scene import is_scene
from ..case.toml import error_context, read_toml
from ..engines import DEFAULT_ENGINE, scene_engine
from ..engines import engine as engine_named
from ..engines.citations import Citations, citations
from ..errors import CaseError
from ..impacts.experiment import experiment
from ..impacts.measurement import UNITS
from ..impacts.plan import plan as plan_impacts
from ..impacts.prediction import predict as predict_experiment
from ..impacts.run import Outcome
from ..impacts.run import run as run_impacts
from ..jobs.stage import write_deck
from ..scenes.judge.summary import SceneOutcome
from ..scenes.judge.warnings import planned_warnings
from ..scenes.plan.plan import plan as plan_scene
from ..scenes.run import run as run_scene
from ..scenes.tables.columns import units as scene_units
from ..studies.calibrate import Calibration, from_measurement
from ..studies.fit import Fit, Targets, fit
from ..studies.sweep import run as study
from ..studies.sweep.run import SweepOutcome
from .files import (
    Case,
    Count,
    Many,
    Names,
    Ranks,
    Scene,
    Seed,
    Stored,
    Table,
    marked,
    names_arguments,
    read,
    take,
    two_lines,
    type_error,
)

__all__ = [
    "Calibration",
    "Case",
    "Fit",
    "Run",
    "Scene",
    "SceneRun",
    "Stored",
    "calibrate",
    "cite",
    "deck",
    "predict",
    "read",
    "run",
    "sweep",
    "theory",
]
log = logging.getLogger("epdem")
MEASUREMENT = {"e_n", "speed", "measured", "uncertainty", "hv", "hb", "dent_ratio", "indentation"}


class _Finished:
    """Verdict and folder of impacts or a scene that have run."""

    outcome: Outcome | SceneOutcome

    @property
    def passed(self) -> bool:
        """Whether all numbers are within the tolerances of the case, or all checks of the scene pass."""
        return self.outcome.passed

    @property
    def folder(self) -> Path:
        """Where results.h5, results.csv and the decks are."""
        return self.outcome.folder

    def report(self) -> Path:
        """Write report.html, one page with figures, tables and decks, into the folder; its path."""
        from ..report.pages import write_page

        return write_page(self.outcome)

    def __repr__(self) -> str:
        done = self.outcome
        kind, tables = "impacts", {"table": done.results.comparison} if isinstance(done, Outcome) else {}
        if isinstance(done, SceneOutcome):
            kind, tables = "scene", done.results.tables
        return two_lines(f"{kind} {done.case.name}", self.passed, self.folder, tables)


@dataclass(frozen=True, repr=False)
class Run(_Finished):
    """Results of impacts; a notebook shows the table. `outcome` also has plans, predictions and warnings."""

    outcome: Outcome

    @property
    def table(self) -> pd.DataFrame:
        """Measured and predicted numbers, one row for each speed, engine and law."""
        return marked(self.outcome.results.comparison, UNITS)

    def plot(self) -> Path:
        """Draw e_n.png, restitution against speed with theory; its path."""
        from ..report.impacts import save_figure

        return save_figure(self.outcome)

    def _repr_html_(self) -> str:
        return str(self.table.to_html(max_rows=20))


@dataclass(frozen=True, repr=False)
class SceneRun(_Finished):
    """Results of a scene; a notebook shows the checks. `outcome` also has the plan and warnings."""

    outcome: SceneOutcome

    @property
    def tables(self) -> dict[str, pd.DataFrame]:
        """rows, particles, contacts, energy_balance and checks, as far as the scene requests them."""
        return {name: marked(table, scene_units(table)) for name, table in self.outcome.results.tables.items()}

    def _repr_html_(self) -> str:
        return str(self.tables["checks"].to_html())


def _case(given: object) -> Case | Scene:
    """A case or scene, from an object or the path of its file."""
    if isinstance(given, Case | Scene):
        return given
    path = take("case", given, Path)
    return Scene.from_toml(path) if is_scene(read_toml(path)) else Case.from_toml(path)


@overload
def run(case: Case, **options: Any) -> Run: ...
@overload
def run(case: Scene, **options: Any) -> SceneRun: ...
@overload
def run(case: Path | str, **options: Any) -> Run | SceneRun: ...
@names_arguments  # type: ignore[misc]
def run(
    case: Case | Scene | Path | str,
    *,
    engines: str | Sequence[str] = (DEFAULT_ENGINE,),
    laws: str | Sequence[str] = (),
    out: Path | str | None = None,
    ranks: int = 1,
    fresh: bool = False,
    force: bool = False,
) -> Run | SceneRun:
    """Run a case on every engine with every law (none: its own), or a scene on one engine. Raises EpdemError.

    `case` can be the path of a case file. Stored results in `out` (default: runs/<name>) are taken, unless `fresh`;
    `force` allows other files there.
    """
    case = _case(case)
    engines, laws = take("engines", engines, Names), take("laws", laws, Names)
    ranks = take("ranks", ranks, Ranks)
    options: dict[str, Any] = {"out": take("out", out, Path | None), "ranks": ranks, "fresh": fresh, "force": force}
    if isinstance(case, Scene):
        if len(engines) != 1 or laws:
            raise CaseError("a scene has its own law and runs on one engine")
        tool, report = scene_engine(engines[0]), partial(log.info, f"{case.name}: step %d of %d")
        return SceneRun(run_scene(case.read, tool, report=report, **options))
    tools = [engine_named(name) for name in engines]
    return Run(run_impacts(case.read, engines=tools, laws=laws, progress=log.info, **options))


@names_arguments
def predict(case: Case | Path | str, law: str | None = None) -> pd.DataFrame:
    """The prediction of theory for a case, one row for each speed; no engine runs. Raises CaseError."""
    found = _case(case)
    if not isinstance(found, Case):
        raise type_error("case", found, "give a Case, which theory predicts; a scene has no prediction")
    prediction = predict_experiment(experiment(found.model, take("law", law, str | None)))
    return marked(prediction.table(), UNITS)


@names_arguments
def deck(
    case: Case | Scene | Path | str,
    out: Path | str,
    *,
    engine: str = DEFAULT_ENGINE,
    law: str | None = None,
    force: bool = False,
    warn: Callable[[str], None] = log.warning,
) -> list[Path]:
    """Write the deck of a case or scene into `out`, where `force` allows other files. Raises CaseError."""
    case, folder = _case(case), take("out", out, Path)
    engine = take("engine", engine, str)
    law = take("law", law, str | None)
    if isinstance(case, Scene) and law is not None:
        raise CaseError(f"law = {law!r}: a scene has its own law; leave it out")
    with error_context(case.place):
        for sentence in case_warnings(case.model):
            warn(sentence)
        if isinstance(case, Case):
            x = experiment(case.model, law)
            return write_deck(engine_named(engine), plan_impacts(x, predict_experiment(x)), folder, force=force)
        p = plan_scene(case.model)
        for sentence in planned_warnings(p):
            warn(sentence)
        return write_deck(scene_engine(engine), p, folder, force=force)


@names_arguments
def cite(
    case: Case | Scene | Path | str,
    *,
    engines: str | Sequence[str] = (DEFAULT_ENGINE,),
    laws: str | Sequence[str] = (),
) -> Citations:
    """Citations of a case and its engines: text by cited subject.

    `cite(case).bibtex()` gives entries of BibTeX. Raises CaseError.
    """
    case, laws = _case(case), take("laws", laws, Names)
    if isinstance(case, Scene) and laws:
        raise CaseError(f"laws = {laws!r}: a scene has its own law; leave it out")
    tools = [engine_named(name).name for name in take("engines", engines, Names)]
    with error_context(case.place):
        return citations(case.model, laws or [case.model.law.name], tools)


@names_arguments
def sweep(
    case: Case | Scene | Path | str,
    settings: study.Settings,
    *,
    engines: str | Sequence[str] = (DEFAULT_ENGINE,),
    laws: str | Sequence[str] = (),
    out: Path | str | None = None,
    ranks: int = 1,
    jobs: int | None = None,
    latin_hypercube: int | None = None,
    seed: int = 1,
    retry_failed: bool = False,
) -> SweepOutcome:
    """Run a case or scene at many points, by `jobs` processes; its `table` has a row for every result.

    `settings` gives the values of keys by their dotted names, as a text ("1 mm..5 mm:9"), a sequence of values or one
    value. What is finished in `out` (default: runs/<name>_sweep) does not run again. Raises CaseError, EngineError,
    OSError.
    """
    planned = study.plan(
        _case(case).text,
        take("settings", settings, Table),
        engines=take("engines", engines, Names),
        laws=take("laws", laws, Names),
        ranks=take("ranks", ranks, Ranks),
        latin_hypercube=take("latin_hypercube", latin_hypercube, Count | None),
        seed=take("seed", seed, Seed),
    )
    folder = planned.default_folder if out is None else take("out", out, Path)
    processes = take("jobs", jobs, Count | None)
    return study.run(planned, folder, jobs=processes, retry_failed=retry_failed, report=_report)


@overload
def calibrate(case: Scene | Path | str, targets: Targets, free: Mapping[str, str], **options: Any) -> Fit: ...
@overload
def calibrate(case: Case | Path | str, **measurement: Any) -> Calibration: ...
@names_arguments
def calibrate(
    case: Case | Scene | Path | str,
    targets: Targets | None = None,
    free: Mapping[str, str] | None = None,
    **options: Any,
) -> Fit | Calibration:
    """Find the strength of the law of a Case from a measurement, or one to three keys of a Scene from its results.

    Of a Case, one measurement: e_n with speed (m/s, a text with a unit; lists of both for a law that hardens),
    measured=True (those of the case), hv or hb (with dent_ratio), indentation (a file of depth and force);
    uncertainty: of each of several e_n. Of a Scene: numbers of its results with the values `targets` and ranges of the
    keys that are `free`; out, engine, ranks, tolerance, jobs, force. `scene.replace(found.values)` is the scene that
    was found. Raises CaseError, EngineError.
    """
    found = _case(case)
    if isinstance(found, Case):
        if targets is not None or free is not None:
            raise type_error("case", found, "give a Scene for targets and free, or a measurement, as e_n and speed")
        if unknown := sorted(options.keys() - MEASUREMENT):
            raise CaseError(f"{unknown[0]}: no measurement of a Case; there are {', '.join(sorted(MEASUREMENT))}")
        e_n, speed = ([] if (v := options.pop(n, None)) is None else take(n, v, Many) for n in ("e_n", "speed"))
        if (curve := options.get("indentation")) is not None:
            options["indentation"] = take("indentation", curve, Path)
        return from_measurement(found.read, e_n=[float(x) for x in e_n], speed=speed, **options)
    goals = take("targets", targets, Table)
    ranges = take("free", free, Table)
    return fit(found.read, goals, ranges, **({"report": _report} | options))


def _report(done: int, total: int) -> None:
    log.info("%d of %d points", done, total)
