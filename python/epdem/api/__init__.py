# SPDX-License-Identifier: GPL-2.0-or-later
"""The Python interface: what the commands do, with cases made of plain values and results as DataFrames.

Tables have the SI units of their columns in `attrs["units"]`. Progress goes to the logger "epdem".
"""

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, overload

import pandas as pd

from .. import theory
from ..engines import engine as engine_named
from ..engines import scene_engine
from ..errors import CaseError
from ..folders import write_own
from ..impacts.comparison import UNITS
from ..impacts.experiment import experiment
from ..impacts.prediction import Prediction
from ..impacts.prediction import predict as predict_experiment
from ..impacts.run import run as run_impacts
from ..impacts.run import write_deck
from ..scenes.plan import plan as plan_scene
from ..scenes.run import run as run_scene
from ..studies import fit
from ..studies.fit import Fit
from ..studies.sweep import run as study
from ..studies.sweep.run import SweepOutcome
from .cases import Case, Scene
from .results import Run, SceneRun, with_units

__all__ = ["Case", "Fit", "Run", "Scene", "SceneRun", "calibrate", "deck", "predict", "run", "sweep", "theory"]
log = logging.getLogger("epdem")


@overload
def run(
    case: Case,
    *,
    engines: Sequence[str] = ...,
    laws: Sequence[str] = ...,
    out: Path | str | None = ...,
    ranks: int = ...,
    fresh: bool = ...,
    force: bool = ...,
) -> Run: ...


@overload
def run(
    case: Scene,
    *,
    engines: Sequence[str] = ...,
    out: Path | str | None = ...,
    ranks: int = ...,
    fresh: bool = ...,
    force: bool = ...,
) -> SceneRun: ...


def run(
    case: Case | Scene,
    *,
    engines: Sequence[str] = ("liggghts",),
    laws: Sequence[str] = (),
    out: Path | str | None = None,
    ranks: int = 1,
    fresh: bool = False,
    force: bool = False,
) -> Run | SceneRun:
    """Run a case on every engine with every law (none: its own), or a scene on one engine. Raises EpdemError.

    Stored results in `out` (default: runs/<name>) are taken, unless `fresh`; `force` allows other files there.
    """
    place = None if out is None else Path(out)
    options: dict[str, Any] = {"out": place, "ranks": ranks, "fresh": fresh, "force": force}
    with case.as_file() as path:
        if isinstance(case, Scene):
            if len(engines) != 1 or laws:
                raise CaseError("a scene has its own law and runs on one engine")
            return SceneRun(run_scene(path, scene_engine(engines[0]), **options))
        tools = [engine_named(name) for name in engines]
        return Run(run_impacts(path, engines=tools, laws=laws, progress=log.info, **options))


def predict(case: Case, law: str | None = None) -> pd.DataFrame:
    """The prediction of theory for a case, one row for each speed; no engine runs. Raises CaseError."""
    found = predict_experiment(experiment(case.model, law))
    return with_units(pd.DataFrame({name: getattr(found, name) for name in Prediction.COLUMNS}), UNITS)


def deck(
    case: Case | Scene, out: Path | str, *, engine: str = "liggghts", law: str | None = None, force: bool = False
) -> list[Path]:
    """Write the deck of a case or scene into `out`, where `force` allows other files. Raises CaseError."""
    if isinstance(case, Scene):
        return write_own(Path(out), scene_engine(engine).files(plan_scene(case.model)), force=force)
    return write_deck(experiment(case.model, law), engine_named(engine), Path(out), force=force)


def sweep(
    case: Case | Scene,
    settings: study.Settings,
    *,
    engines: Sequence[str] = ("liggghts",),
    laws: Sequence[str] = (),
    out: Path | str | None = None,
    ranks: int = 1,
    jobs: int | None = None,
    latin_hypercube: int | None = None,
    seed: int = 1,
    retry_failed: bool = False,
) -> SweepOutcome:
    """Run a case or scene at many points, by `jobs` processes; its `table` has a row for every result.

    `settings` gives the values of keys by their dotted names, as a text ("1 mm..5 mm:9") or a sequence of values. What
    is finished in `out` (default: runs/<name>_sweep) does not run again. Raises CaseError, EngineError, OSError.
    """
    with case.as_file() as path:
        words: dict[str, Any] = {"engines": engines, "laws": laws, "ranks": ranks}
        planned = study.plan(path, settings, **words, latin_hypercube=latin_hypercube, seed=seed)
    folder = Path(out) if out is not None else Path("runs") / f"{planned.name}_sweep"
    return study.run(planned, folder, jobs=jobs, retry_failed=retry_failed, report=_report)


def calibrate(
    scene: Scene,
    targets: Mapping[str, float | str],
    free: Mapping[str, str],
    *,
    engine: str = "liggghts",
    tolerance: float = 0.01,
    out: Path | str | None = None,
    ranks: int = 1,
    jobs: int | None = None,
) -> Fit:
    """Find values of one to three keys of a scene with which numbers of its results have the values of `targets`.

    `free` gives the range of each key, "0.1..0.9" or "log:1 MPa..1 GPa"; the rest is as in `epdem.studies.fit.fit`.
    `scene.replace(found.values)` is the scene that was found. Raises CaseError, EngineError.
    """
    place = None if out is None else Path(out)
    with scene.as_file() as path:
        options: dict[str, Any] = {"engine": engine, "ranks": ranks, "tolerance": tolerance, "jobs": jobs}
        return fit.fit(path, targets, free, out=place, report=_report, **options)


def _report(done: int, total: int) -> None:
    log.info("%d of %d points", done, total)
