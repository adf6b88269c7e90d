# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene from case file to results.h5: deck, run, tables, energy balance, checks; and its continuation."""

from collections.abc import Callable
from pathlib import Path

from ..base import __version__
from ..base.files import ResultsFolder, claim, results_folder
from ..base.paths import DEFAULT_ENGINE
from ..case.plausibility import case_warnings
from ..case.scene import load
from ..case.toml import LoadedCase, error_context, file_names, text_of
from ..case.toml import tables as toml_tables
from ..errors import CaseError, EngineError
from ..impacts.prediction import predict
from ..jobs.engine import Feature, check, refusal, refuse_ranks
from ..jobs.stage import Inputs, Stage, Tables, inputs, stage, without_comments
from .judge import checks, measures
from .judge.energy_balance import energy_balance
from .judge.summary import SceneOutcome
from .judge.warnings import lost_spheres, measured_warnings, passed_walls, planned_warnings
from .plan.plan import SceneEngine, ScenePlan, plan
from .plan.timestep import leading_impact
from .tables import network, results, stages

Progress = Callable[[int, int], None]  # (step, steps of the run)


def _stored(folder: Path, key: str) -> results.SceneResults | None:
    """The results in a folder if they belong to these inputs. Raises CaseError for a damaged file."""
    path = folder / "results.h5"
    if not path.exists():
        return None
    old = results.read(path)
    return old if old.attributes.get("inputs") == key else None


def run_plan(p: ScenePlan, engine: SceneEngine, folder: Path, *, ranks: int = 1) -> Tables:
    """Write a plan's deck into `folder`, run it, read its tables. Raises CaseError, EngineError."""
    check(engine, p)
    engine.write(p, folder)
    return engine.run(p, folder, ranks=ranks)


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
    planned: Callable[[ScenePlan], None] = lambda p: None,
) -> SceneOutcome:
    """Run a scene, or continue it from its last restart file. Raises CaseError, EngineError.

    `fresh` ignores stored results; `force` allows a folder in which there are other files; `planned` takes the plan.
    All input is checked and the engine looked for before anything is written or started.
    """
    model, text, place = case if isinstance(case, LoadedCase) else LoadedCase(load(case), text_of(case), case)
    with error_context(place):
        p = plan(model)
        measures.refuse_measures(p)
        domain = predict(leading_impact(model)).caveats  # of the law, at the highest speed of the scene
        notes = [*check(engine, p), *planned_warnings(p), *case_warnings(model), *domain]
    planned(p)
    refuse_ranks(engine, ranks)
    if resume and Feature.RESTART not in engine.features:
        said = f"--resume: a scene in {engine.name} runs from its start; leave it out"
        raise refusal(engine, p, said, advice="leave it out", fits=lambda features: Feature.RESTART in features)
    if reason := engine.missing():
        raise EngineError(reason)
    version = engine.version()
    with error_context(place):
        # names in the tables that the engine's files may lack
        facts = [wall.name for wall in p.scene.wall], [(phase.name, phase.end) for phase in p.phases]
        given = inputs(engine, p, version=version, facts=facts, ranks=ranks)
    beside = Path(str(place)).parent
    named = {name: (beside / name).read_bytes() for name in sorted(file_names(toml_tables(text, place)))}
    versions = {engine.name: version, "epdem": __version__}
    folder = results_folder(out, p.case.name, "" if engine.name == DEFAULT_ENGINE else engine.name)
    if resume and not folder.exists():
        raise CaseError(f"{folder}: no such folder, so no run to continue; run the case without --resume")
    total, begin, lost = p.steps, None, list[int]()
    with claim(folder, force=force, files=given.files, case=p.case.name) as kept:
        old = None if fresh or resume else _stored(folder, given.key)
        same = kept.job.get("inputs") == given.key
        if not (same or resume or force):
            notes += kept.set_aside()
        ended = None if fresh or resume or old or not same else _ended(engine, p, folder)

        def compute() -> tuple[Tables, dict[str, float]]:
            nonlocal begin, lost
            if resume:
                _refuse_resume(kept, given, versions)
                tables, begin, lost = engine.resume(p, folder, ranks=ranks, report=lambda step: report(step, total))
                return tables, {}
            kept.note(versions, inputs=given.key)
            engine.put(given.files, folder)
            return engine.run(p, folder, ranks=ranks, report=lambda step: report(step, total)), {}

        known = results.engine_tables(p, old.tables) if old else ended
        done = stage(given, compute, Stage(given, known, {"seconds": 0.0}) if known else None)
        if lost:
            steps = f"step{'s' * (len(lost) > 1)} {', '.join(map(str, lost))}"
            notes.append(
                f"{folder}: frames of {steps} are missing or not whole, and left out; --fresh runs the scene anew"
            )
        ran = _as_run(p, done.tables)
        tables = _judge(ran, done.tables, folder)
        about = {
            "case": p.case.name,
            "epdem": __version__,
            "engine": engine.name,
            f"version_{engine.name}": version,
            "ranks": ranks,
            "time_step": ran.time_step,
            "steps": ran.steps,
            "inputs": given.key,
            "seconds": done.seconds["seconds"],
        }
        decks = {name: text for name, text in given.files.items() if "/" not in name}  # without modules
        found = results.SceneResults(text, old.attributes if old else about, tables, decks, named)
        results.write(folder / "results.h5", ran, found, old)
    warnings = [*notes, *measured_warnings(ran, tables), *lost_spheres(ran, tables), *passed_walls(ran, tables)]
    return SceneOutcome(ran, folder, found, done.seconds["seconds"], done.reused, begin, warnings)


def _ended(engine: SceneEngine, p: ScenePlan, folder: Path) -> Tables | None:
    """The tables of an engine that has run to its end, and whose results could not be stored: the disk was full."""
    try:
        return None if (folder / "results.h5").exists() else engine.read(p, folder)
    except EngineError:
        return None


def _refuse_resume(kept: ResultsFolder, given: Inputs, versions: dict[str, str]) -> None:
    """Raise CaseError for a run of other inputs or other programs."""
    folder = kept.folder
    if not all(
        (folder / name).exists()
        and without_comments((folder / name).read_text(encoding="utf-8")) == without_comments(text)
        for name, text in given.files.items()
    ):
        raise CaseError(f"{folder}: the case has changed since the run that is to be continued; run it anew (--fresh)")
    if kept.versions != versions:
        was, now = (", ".join(f"{k} {v}" for k, v in found.items()) for found in (kept.versions, versions))
        begun = f"{folder}: begun by {was or 'programs of unknown versions'}, and here is {now}"
        raise CaseError(f"{begun}; run it anew (--fresh)")


def _as_run(p: ScenePlan, tables: Tables) -> ScenePlan:
    if not p.ends_early:
        return p
    phases = tables["phases"]
    ends = dict(zip(phases["phase"], phases["end"].astype(int), strict=True))
    forces = (phases[name].astype(float) for name in ("value", "opposite", "force"))
    looked = zip(phases["held"].astype(int), *forces, strict=True)
    held = {x.name: at for x, at in zip(p.phases, looked, strict=True) if x.case.condition}
    return p.with_ends(ends, dict(zip(phases["phase"], phases["until"], strict=True)), held).with_ways(tables["rows"])


def _judge(p: ScenePlan, tables: Tables, folder: Path) -> Tables:
    """The tables of an engine with energy balance, checks and measures. Raises EngineError."""
    tables = dict(tables)
    if p.output.energy:
        if tables["particles"].empty:
            raise EngineError(
                f"{folder}: no frame holds a sphere; all have left the room, see the engine's output there"
            )
        tables["energy_balance"] = energy_balance(p, tables)
    if p.potentials:
        tables["currents"] = network.currents(p, tables)
    if p.scene.stages:
        tables["rows"] = stages.with_densities(p, tables)
        tables["stages"] = stages.table(p, tables)
    tables["checks"] = checks.checks(p, tables)
    if p.scene.measure:
        tables["rows"] = measures.with_loads(p, tables["rows"])
        tables["measures"], tables["histograms"] = measures.curves(p, tables), measures.histograms(p, tables)
    return tables
