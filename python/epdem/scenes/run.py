# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene from case file to results.h5: deck, run, tables, energy balance, checks; and its continuation."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import pandas as pd

from ..base import __version__
from ..base.files import ResultsFolder, claim, results_folder
from ..base.paths import DEFAULT_ENGINE
from ..case.plausibility import case_warnings
from ..case.scene import SceneCase, load
from ..case.toml import LoadedCase, error_context, file_names, text_of
from ..case.toml import tables as toml_tables
from ..errors import CaseError, EngineError
from ..impacts.prediction import predict
from ..jobs.engine import Report, silent
from ..jobs.stage import Inputs, Stage, Tables, compute, inputs, without_comments
from . import checks, measures, pictures, results, stages
from .engine import Resumed, SceneEngine, check_run
from .plan import ScenePlan, plan
from .timestep import leading_impact
from .warnings import lost_spheres, measured_warnings, planned_warnings

Progress = Callable[[int, int], None]  # (step, steps of the run)


@dataclass
class SceneOutcome:
    """Outcome of a scene run."""

    plan: ScenePlan
    folder: Path
    results: results.SceneResults
    seconds: float
    reused: bool = False
    resumed_from: int | None = None
    warnings: list[str] = field(default_factory=list)

    @property
    def case(self) -> SceneCase:
        return self.plan.case

    @property
    def passed(self) -> bool:
        """Whether all checks of the scene hold."""
        checks = self.results.tables.get("checks")
        return checks is None or bool(checks["passed"].all())


@dataclass(frozen=True)
class _Work:
    """A checked case with its plan, engine and inputs."""

    text: str  # of the case
    plan: ScenePlan
    engine: SceneEngine
    version: str  # of the engine
    inputs: Inputs
    notes: list[str]
    named: dict[str, bytes]  # the files that the case names
    ranks: int
    report: Report

    @cached_property
    def versions(self) -> dict[str, str]:
        """Versions of the programs that a continued run needs again."""
        return {self.engine.name: self.version, "epdem": __version__}


def _facts(p: ScenePlan) -> object:
    """Names in the tables that the engine's files may lack."""
    return [wall.name for wall in p.scene.wall], [(phase.name, phase.end) for phase in p.phases]


def _stored(folder: Path) -> results.SceneResults | None:
    try:
        return results.read(folder / "results.h5")
    except CaseError:
        return None  # of another version: made anew


def run_plan(
    p: ScenePlan, engine: SceneEngine, folder: Path, *, ranks: int = 1, report: Report = silent
) -> dict[str, pd.DataFrame]:
    """Write a plan's deck into `folder`, run it, read its tables. Raises CaseError, EngineError."""
    engine.check(p)
    now = inputs(engine, p, version="", ranks=ranks)
    return compute(engine, p, folder, _unchanged, now, ranks=ranks, report=report).tables


def _unchanged(tables: Tables) -> tuple[Tables, dict[str, float]]:
    return tables, {}


def run(
    case: Path | str | LoadedCase,
    engine: SceneEngine,
    *,
    out: Path | None = None,
    ranks: int = 1,
    fresh: bool = False,
    resume: bool = False,
    force: bool = False,
    report: Progress = lambda step, steps: None,
) -> SceneOutcome:
    """Run a scene, or continue it from its last restart file. Raises CaseError, EngineError.

    `fresh` ignores stored results; `force` allows a folder in which there are other files. All input is checked and
    the engine looked for before anything is written or started.
    """
    model, text, place = case if isinstance(case, LoadedCase) else LoadedCase(load(case), text_of(case), case)
    with error_context(place):
        p = plan(model)
        measures.refuse_measures(p)
        pictures.refuse_color(p)
        domain = predict(leading_impact(model)).caveats  # of the law, at the highest speed of the scene
        notes = [*engine.check(p), *planned_warnings(p), *case_warnings(model), *domain]
    check_run(engine, ranks=ranks, resume=resume)
    version = engine.version()
    with error_context(place):
        given = inputs(engine, p, version=version, facts=_facts(p), ranks=ranks)
    beside = Path(str(place)).parent
    contents = {name: (beside / name).read_bytes() for name in sorted(file_names(toml_tables(text, place)))}
    work = _Work(text, p, engine, version, given, notes, contents, ranks, lambda step: report(step, p.steps))
    folder = results_folder(out, p.case.name, "" if engine.name == DEFAULT_ENGINE else engine.name)
    if resume and not folder.exists():
        raise CaseError(f"{folder}: no such folder, so no run to continue; run the case without --resume")
    with claim(folder, force=force, files=given.files) as place:
        return _resumed(work, place) if resume else _computed(work, place, None if fresh else _stored(folder))


def _as_run(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> ScenePlan:
    if not p.ends_early:
        return p
    phases = tables["phases"]
    ends = dict(zip(phases["phase"], phases["end"].astype(int), strict=True))
    return p.with_ends(ends, dict(zip(phases["phase"], phases["until"], strict=True)))


def _computed(work: _Work, place: ResultsFolder, old: results.SceneResults | None) -> SceneOutcome:
    """The outcome of stored tables if they belong to these inputs, else of a run."""
    stored, folder = None, place.folder
    if old and old.attributes.get("inputs") == work.inputs.key:
        stored = Stage(work.inputs, results.engine_tables(work.plan, old.tables), {})
    else:
        place.note(work.versions)
    stage = compute(
        work.engine, work.plan, folder, _unchanged, work.inputs, ranks=work.ranks, report=work.report, stored=stored
    )
    return _finish(work, folder, stage, old if stored else None)


def _resumed(work: _Work, place: ResultsFolder) -> SceneOutcome:
    start, folder = time.perf_counter(), place.folder
    if not all(
        (folder / name).exists()
        and without_comments((folder / name).read_text(encoding="utf-8")) == without_comments(text)
        for name, text in work.inputs.files.items()
    ):
        raise CaseError(f"{folder}: the case has changed since the run that is to be continued; run it anew (--fresh)")
    if place.versions != work.versions:
        was, now = (", ".join(f"{k} {v}" for k, v in versions.items()) for versions in (place.versions, work.versions))
        begun = f"{folder}: begun by {was or 'programs of unknown versions'}, and here is {now}"
        raise CaseError(f"{begun}; run it anew (--fresh)")
    tables, resumed_run = work.engine.resume(work.plan, folder, ranks=work.ranks, report=work.report)
    stage = Stage(work.inputs, tables, {"seconds": time.perf_counter() - start})
    return _finish(work, folder, stage, None, resumed_run)


def _judge(p: ScenePlan, tables: Tables, folder: Path) -> Tables:
    """The tables of an engine with energy balance, checks and measures. Raises EngineError."""
    tables = dict(tables)
    if p.output.energy:
        if tables["particles"].empty:
            raise EngineError(
                f"{folder}: no frame holds a sphere; all have left the room, see the engine's output there"
            )
        tables["energy_balance"] = checks.energy_balance(p, tables)
    tables["checks"] = checks.checks(p, tables)
    if p.scene.stages:
        tables["rows"] = stages.with_densities(p, tables)
        tables["stages"] = stages.table(p, tables)
    if p.scene.measure:
        tables["rows"] = measures.with_loads(p, tables["rows"])
        tables["measures"], tables["histograms"] = measures.curves(p, tables), measures.histograms(p, tables)
    return tables


def _finish(
    work: _Work, folder: Path, stage: Stage, old: results.SceneResults | None, resumed_run: Resumed | None = None
) -> SceneOutcome:
    """Judge the tables of a stage and store them; `old`: the file from which they come."""
    p = _as_run(work.plan, stage.tables)
    tables = _judge(p, stage.tables, folder)
    about = {
        "case": p.case.name,
        "epdem": __version__,
        "engine": work.engine.name,
        f"version_{work.engine.name}": work.version,
        "ranks": work.ranks,
        "time_step": p.time_step,
        "steps": p.steps,
        "inputs": work.inputs.key,
        "seconds": stage.seconds.get("seconds", 0.0),
    }
    decks = {name: text for name, text in work.inputs.files.items() if "/" not in name}  # without modules
    left_out = []
    if resumed_run and resumed_run.lost:
        steps = ("step " if len(resumed_run.lost) == 1 else "steps ") + ", ".join(map(str, resumed_run.lost))
        advice = "are missing or not whole, and left out; --fresh runs the scene anew"
        left_out = [f"{folder}: the frames of {steps} {advice}"]
    kept = results.SceneResults(work.text, old.attributes if old else about, tables, decks, work.named)
    if old is None or not kept.equals(old):
        results.write(folder / "results.h5", p, kept)
    warnings = [*work.notes, *measured_warnings(p, tables), *lost_spheres(p, tables), *left_out]
    begin = resumed_run.step if resumed_run else None
    seconds = stage.seconds.get("seconds", 0.0)
    return SceneOutcome(p, folder, kept, seconds, stage.reused, begin, warnings)
