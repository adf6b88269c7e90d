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
from ..base.paths import DEFAULT_ENGINE, inputs_hash, library_hash
from ..case.scene import SceneCase, load
from ..case.toml import Read, named, names_in, text_of
from ..case.toml import tables as toml_tables
from ..case.warnings import case_warnings
from ..errors import CaseError, EngineError
from ..impacts.engine import Report, silent, texts
from ..impacts.prediction import predict
from . import checks, measures, pictures, results
from .engine import Resumed, SceneEngine, check_run
from .plan import ScenePlan, plan
from .timestep import leading_impact
from .warnings import lost_spheres, measured_warnings, planned_warnings

Progress = Callable[[int, int], None]  # (step, steps of the run)


@dataclass
class SceneOutcome:
    """What a run gives its caller."""

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
    """A checked case with its plan, engine and files."""

    text: str  # of the case
    plan: ScenePlan
    engine: SceneEngine
    files: dict[str, str]
    notes: list[str]
    named: dict[str, bytes]  # the files that the case names
    ranks: int
    report: Report

    @cached_property
    def versions(self) -> dict[str, str]:
        """Of the programs on which the numbers of a run depend."""
        return {self.engine.name: self.engine.version(), "epdem": f"{__version__} ({library_hash()[:12]})"}

    @cached_property
    def inputs(self) -> str:
        """Hash of all inputs of a result: case, files for the engine, version of the engine, sources of epdem."""
        facts = (self.plan.case, sorted(self.files.items()), self.engine.name, self.engine.version(), self.ranks)
        return inputs_hash([], *facts)


def _stored(path: Path) -> results.SceneResults | None:
    try:
        return results.read(path)
    except CaseError:
        return None  # of another version: made anew


def run_plan(
    p: ScenePlan, engine: SceneEngine, folder: Path, *, ranks: int = 1, report: Report = silent
) -> dict[str, pd.DataFrame]:
    """Write a plan's deck into `folder`, run it, read its tables. Raises CaseError, EngineError."""
    engine.check(p)
    engine.write(p, folder)
    return engine.run(p, folder, ranks=ranks, report=report)


def run(
    case: Path | str | Read,
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
    model, text, place = case if isinstance(case, Read) else Read(load(case), text_of(case), case)
    with named(place):
        p = plan(model)
        measures.refuse_measures(p)
        pictures.refuse_color(p)
        domain = predict(leading_impact(model)).caveats  # of the law, at the highest speed of the scene
        notes = [*engine.check(p), *planned_warnings(p), *case_warnings(model), *domain]
        files = texts(engine, p)
    check_run(engine, ranks=ranks, resume=resume)
    beside = Path(str(place)).parent
    contents = {name: (beside / name).read_bytes() for name in sorted(names_in(toml_tables(text, place)))}
    work = _Work(text, p, engine, files, notes, contents, ranks, lambda step: report(step, p.steps))
    folder = results_folder(out, p.case.name, "" if engine.name == DEFAULT_ENGINE else engine.name)
    if resume and not folder.exists():
        raise CaseError(f"{folder}: no such folder, so no run to continue; run the case without --resume")
    with claim(folder, force=force, files=files) as place:
        return _resumed(work, place) if resume else _reused(work, folder, fresh) or _anew(work, place)


def _reused(work: _Work, folder: Path, fresh: bool) -> SceneOutcome | None:
    old = None if fresh else _stored(folder / "results.h5")
    if old is None or old.attributes.get("inputs") != work.inputs:
        return None
    p = _as_run(work.plan, old.tables)
    warnings = [*work.notes, *measured_warnings(p, old.tables), *lost_spheres(p, old.tables)]
    return SceneOutcome(p, folder, old, 0.0, reused=True, warnings=warnings)


def _as_run(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> ScenePlan:
    if not p.ends_early:
        return p
    phases = tables["phases"]
    ends = dict(zip(phases["phase"], phases["end"].astype(int), strict=True))
    return p.ended(ends, dict(zip(phases["phase"], phases["until"], strict=True)))


def _anew(work: _Work, place: ResultsFolder) -> SceneOutcome:
    start = time.perf_counter()
    place.note(work.versions)
    tables = run_plan(work.plan, work.engine, place.folder, ranks=work.ranks, report=work.report)
    return _finish(work, place.folder, start, tables)


def _resumed(work: _Work, place: ResultsFolder) -> SceneOutcome:
    start, folder = time.perf_counter(), place.folder
    if not all(
        (folder / name).exists() and (folder / name).read_text(encoding="utf-8") == text
        for name, text in work.files.items()
    ):
        raise CaseError(f"{folder}: the case has changed since the run that is to be continued; run it anew (--fresh)")
    if place.versions != work.versions:
        was, now = (", ".join(f"{k} {v}" for k, v in versions.items()) for versions in (place.versions, work.versions))
        begun = f"{folder}: begun by {was or 'programs of unknown versions'}, and here is {now}"
        raise CaseError(f"{begun}; run it anew (--fresh)")
    tables, went_on = work.engine.resume(work.plan, folder, ranks=work.ranks, report=work.report)
    return _finish(work, folder, start, tables, went_on)


def _finish(
    work: _Work, folder: Path, start: float, tables: dict[str, pd.DataFrame], went_on: Resumed | None = None
) -> SceneOutcome:
    p = _as_run(work.plan, tables)
    if p.output.energy:
        if tables["particles"].empty:
            raise EngineError(
                f"{folder}: no frame holds a sphere; all have left the room, see the engine's output there"
            )
        tables["energy_balance"] = checks.energy_balance(p, tables)
    tables["checks"] = checks.checks(p, tables)
    if p.case.scene.measure:
        tables["rows"] = measures.with_loads(p, tables["rows"])
        tables["measures"], tables["histograms"] = measures.curves(p, tables), measures.histograms(p, tables)
    seconds = time.perf_counter() - start
    attributes = {
        "case": p.case.name,
        "epdem": __version__,
        "engine": work.engine.name,
        f"version_{work.engine.name}": work.engine.version(),
        "ranks": work.ranks,
        "time_step": p.time_step,
        "steps": p.steps,
        "inputs": work.inputs,
        "seconds": seconds,
    }
    decks = {name: text for name, text in work.files.items() if "/" not in name}  # without the modules of a deck
    left_out = []
    if went_on and went_on.lost:
        steps = ("step " if len(went_on.lost) == 1 else "steps ") + ", ".join(map(str, went_on.lost))
        advice = "are missing or not whole, and left out; --fresh runs the scene anew"
        left_out = [f"{folder}: the frames of {steps} {advice}"]
    kept = results.SceneResults(work.text, attributes, tables, decks, work.named)
    results.write(folder / "results.h5", p, kept)
    warnings = [*work.notes, *measured_warnings(p, tables), *lost_spheres(p, tables), *left_out]
    begin = went_on.step if went_on else None
    return SceneOutcome(p, folder, kept, seconds, resumed_from=begin, warnings=warnings)
