# SPDX-License-Identifier: GPL-2.0-or-later
"""From a case to results: predict, plan, run each engine, measure, compare, store.

A stage is done when its result is stored with the hash of its inputs: a second run takes it from there.
"""

import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from ..base import __version__
from ..base.files import claim, results_folder
from ..base.paths import inputs_hash
from ..case.impact import Case, parse
from ..case.toml import Read, named, read_toml, text_of
from ..case.warnings import case_warnings
from ..errors import CaseError
from . import store
from .comparison import compare, impacts_table
from .engine import Feature, ImpactEngine, is_text, refuse, require
from .experiment import Experiment, experiment
from .measurement import chosen, measure
from .plan import Plan, plan
from .prediction import Prediction, predict


@dataclass
class Outcome:
    """The result of a run."""

    case: Case
    folder: Path
    results: store.Results
    predictions: dict[str, Prediction]
    plans: dict[str, Plan]  # by law
    seconds: dict[str, float] = field(default_factory=dict)
    reused: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    @property
    def passed(self) -> bool:
        """Whether all rows are within the tolerances of the case."""
        return bool(self.results.comparison["passed"].all())


@dataclass(frozen=True)
class Stage:
    """The result of one engine for one plan: impacts as in `impacts_table`, its times [s], the texts of its deck,
    and chosen impacts step by step."""

    impacts: pd.DataFrame
    seconds: dict[str, float]
    decks: dict[str, str]
    paths: pd.DataFrame


def run_plan(p: Plan, tool: ImpactEngine, folder: Path, *, ranks: int = 1) -> Stage:
    """Write a plan's deck into `folder`, run it and measure it.

    Raises EngineError, and CaseError for what the engine cannot do.
    """
    start = time.perf_counter()
    folder.mkdir(parents=True, exist_ok=True)
    files = tool.write(p, folder)
    path = tool.run(p, folder, ranks=ranks)
    table = impacts_table(p, measure(p, path))
    seconds = {f"seconds_{k}": v for k, v in path.seconds.items()} | {"seconds": time.perf_counter() - start}
    decks = {f.name: f.read_text(encoding="utf-8") for f in files if is_text(f) and f.suffix != ".data"}
    return Stage(table, seconds, decks, chosen(p, path))


def run_and_compare(
    p: Plan,
    prediction: Prediction,
    tool: ImpactEngine,
    folder: Path,
    *,
    law: str | None = None,
    ranks: int = 1,
) -> tuple[pd.DataFrame, Stage]:
    """`run_plan`, and its impacts compared with their prediction: one row per speed.

    `law` is the name in the rows (None: the plan's law).
    """
    stage, x = run_plan(p, tool, folder, ranks=ranks), p.experiment
    return compare(tool.name, law or x.law.name, stage.impacts, prediction, x.check), stage


def write_deck(x: Experiment, tool: ImpactEngine, folder: Path, *, force: bool = False) -> list[Path]:
    """Write the deck of an experiment into `folder`, where `force` allows other files; its files. Raises CaseError."""
    if Feature.DECK not in tool.features:
        raise CaseError(f"engine {tool.name}: it reads no deck; use liggghts, lammps or yade")
    p = plan(x, predict(x))
    with claim(folder, force=force):
        return tool.write(p, folder)


def _inputs(p: Plan, tool: ImpactEngine, version: str, ranks: int) -> str:
    """Hash of all that the result of a stage depends on: the plan, the files an engine reads, its version, ours."""
    x = p.experiment
    numbers = (p.time_step, p.steps, p.phases, p.speed.tobytes(), p.gap.tobytes())
    bodies = (x.law, x.body, x.target, x.viscous_restitution)
    o = x.oblique
    friction = (o.angle.tobytes(), o.spin.tobytes(), o.friction, o.tangential) if o else None
    with tempfile.TemporaryDirectory(prefix="epdem-") as scratch:
        return inputs_hash(tool.write(p, Path(scratch)), numbers, bodies, friction, tool.name, version, ranks)


def _stored(path: Path) -> store.Results:
    try:
        return store.read(path)
    except CaseError:
        return store.Results()


def _beside_earlier(results: store.Results, old: store.Results) -> store.Results:
    if old.case_text != results.case_text:
        return results
    keep = [key for key in old.runs if key not in results.runs]
    rows = old.comparison
    rows = rows[[f"{law}/{name}" in keep for law, name in zip(rows["law"], rows["engine"], strict=True)]]
    return store.Results(
        results.case_text,
        old.attributes | results.attributes,
        pd.concat([results.comparison, rows], ignore_index=True),
        {k: old.impacts[k] for k in keep} | results.impacts,
        old.predictions | results.predictions,
        {k: old.runs[k] for k in keep} | results.runs,
        {k: v for k, v in old.decks.items() if k.rsplit("/", 1)[0] in keep} | results.decks,
        {k: old.paths[k] for k in keep} | results.paths,
    )


@dataclass(frozen=True)
class _Work:
    """A checked case with its engines and laws."""

    case: Case
    tools: list[ImpactEngine]
    versions: dict[str, str]
    predictions: dict[str, Prediction]
    plans: list[Plan]
    how: dict[str, object]  # the options on which the numbers depend: ranks, steps (0: searched), own_law


def _prepare(case: Case, place: object, tools: Sequence[ImpactEngine], laws: Sequence[str], ranks: int) -> _Work:
    """Check all input and look for every engine, before anything is written or started."""
    tools = list({tool.name: tool for tool in tools}.values())
    with named(place):
        chosen: list[str | None] = [*dict.fromkeys(laws)] or [None]
        experiments = [experiment(case, law) for law in chosen]
    require(*tools)
    predictions = {x.law.name: predict(x) for x in experiments}
    with named(place):
        plans = [plan(x, predictions[x.law.name]) for x in experiments]
        for p in plans:
            for tool in tools:
                refuse(tool, p, predictions[p.experiment.law.name], ranks=ranks)
    steps = 0 if case.numerics.error is not None else case.numerics.steps_in_contact
    how: dict[str, object] = {"ranks": ranks, "steps": steps, "own_law": not laws}
    return _Work(case, tools, {tool.name: tool.version() for tool in tools}, predictions, plans, how)


def _read(path: Path | str, steps: int | None) -> Read:
    data = read_toml(path)
    if steps is not None:
        data["numerics"] = data.get("numerics", {}) | {"steps_in_contact": steps}
        data["numerics"].pop("error", None)
    return Read(parse(data, path), text_of(path), path)


def run(
    case: Path | str | Read,
    *,
    engines: Sequence[ImpactEngine],
    laws: Sequence[str] = (),
    steps: int | None = None,
    out: Path | None = None,
    ranks: int = 1,
    fresh: bool = False,
    force: bool = False,
    progress: Callable[[str], None] = lambda text: None,
) -> Outcome:
    """Run a case on every engine with every law (none given: the case's own). Raises CaseError or EngineError.

    `steps` replaces the steps in contact of a case in a file. `fresh` ignores stored results; `force` allows a folder
    in which there are other files. All input is checked and every engine looked for before anything is written or
    started.
    """
    model, text, place = case if isinstance(case, Read) else _read(case, steps)
    work = _prepare(model, place, engines, laws, ranks)
    folder = results_folder(out, model.name)
    with claim(folder, force=force):
        return _run(text, work, folder, ranks, fresh, progress)


def _run(text: str, work: _Work, folder: Path, ranks: int, fresh: bool, progress: Callable[[str], None]) -> Outcome:
    stored = folder / "results.h5"
    old = _stored(stored)
    attributes = {"case": work.case.name, "epdem": __version__}
    attributes |= {f"version_{name}": version for name, version in work.versions.items()}
    results = store.Results(case_text=text, attributes=attributes)
    plans = {p.experiment.law.name: p for p in work.plans}
    outcome = Outcome(work.case, folder, results, work.predictions, plans, warnings=case_warnings(work.case))
    rows = []
    for p in work.plans:
        law = p.experiment.law.name
        prediction = work.predictions[law]
        outcome.warnings += prediction.warnings
        outcome.warnings += [f"{tool.name}: {note}" for tool in work.tools for note in tool.check(p)]
        results.predictions[law] = prediction.table()
        for tool in work.tools:
            key, inputs = f"{law}/{tool.name}", _inputs(p, tool, work.versions[tool.name], ranks)
            progress(f"{tool.name}, {law}: {p.n} impacts")
            if not fresh and old.runs.get(key, {}).get("inputs") == inputs:
                results.impacts[key], results.runs[key] = old.impacts[key], old.runs[key]
                results.paths[key] = old.paths[key]
                results.decks |= {k: v for k, v in old.decks.items() if k.startswith(key + "/")}
                outcome.reused.append(key)
            else:
                stage = run_plan(p, tool, folder / law / tool.name, ranks=ranks)
                results.impacts[key], results.paths[key] = stage.impacts, stage.paths
                results.runs[key] = stage.seconds | {"inputs": inputs, "time_step": p.time_step} | work.how
                results.decks |= {f"{key}/{name}": text for name, text in stage.decks.items()}
            spent = float(str(results.runs[key]["seconds"]))
            outcome.seconds[tool.name] = outcome.seconds.get(tool.name, 0.0) + spent
            rows.append(compare(tool.name, law, results.impacts[key], prediction, work.case.check))
            results.comparison = pd.concat(rows, ignore_index=True)
            store.write(stored, _beside_earlier(results, old))  # results are stored after each engine
    return outcome
