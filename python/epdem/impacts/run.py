# SPDX-License-Identifier: GPL-2.0-or-later
"""From a case to results: predict, plan, run each engine, measure, compare, store.

Judgement is made anew at each call, from the tables of a run or from stored ones (jobs/stage.py).
"""

import hashlib
import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from ..base import __version__
from ..base.files import claim, results_folder
from ..case.impact import Case, parse
from ..case.plausibility import case_warnings
from ..case.toml import LoadedCase, error_context, read_toml, text_of
from ..errors import CaseError
from ..jobs.engine import require
from ..jobs.stage import Inputs, Stage, Tables, inputs, stage
from . import store
from .engine import ImpactEngine, check_plan
from .experiment import experiment
from .measurement import CHECKED, compare, measure, sample_impacts
from .plan import Plan, plan
from .prediction import Prediction, predict

ALLOWED = 1.5  # measured error of e_n over the requested one, at most


@dataclass
class Outcome:
    """The result of a run."""

    case: Case
    folder: Path
    results: store.Results
    predictions: dict[str, Prediction]
    plans: dict[str, Plan]  # by law
    ranks: int
    how: dict[str, object]  # the options on which the numbers depend: ranks, steps (0: found for `error`), own_law
    seconds: dict[str, float] = field(default_factory=dict)
    reused: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    @property
    def passed(self) -> bool:
        """Whether all rows are within the tolerances of the case."""
        return bool(self.results.comparison["passed"].all())


def run_plan(
    p: Plan, tool: ImpactEngine, folder: Path, *, ranks: int = 1, version: str = "", stored: Stage | None = None
) -> Stage:
    """Tables `impacts` (see `measure`) and `paths` (chosen impacts step by step) of a plan: the `stored` ones, or
    those of a run in `folder`.

    version: of the engine, for results that are stored. Raises EngineError, and CaseError for what the engine cannot
    do.
    """
    now = inputs(tool, p, version=version, facts=_facts(p), ranks=ranks)

    def compute() -> tuple[Tables, dict[str, float]]:
        folder.mkdir(parents=True, exist_ok=True)
        tool.put(now.files, folder)
        path = tool.run(p, folder, ranks=ranks)
        tables = {"impacts": measure(p, path), "paths": sample_impacts(p, path)}
        return tables, {f"seconds_{name}": seconds for name, seconds in path.seconds.items()}

    return stage(now, compute, stored)


def _facts(p: Plan) -> object:
    """Numbers of a plan, which an engine without a deck reads and from which impacts are measured."""
    x, o = p.experiment, p.experiment.oblique
    friction = (o.angle.tobytes(), o.spin.tobytes(), o.friction, o.tangential) if o else None
    numbers = (p.time_step, p.steps, p.phases, p.speed.tobytes(), p.gap.tobytes())
    return x.law, x.body, x.target, x.viscous_restitution, friction, numbers


def stored_results(path: Path, *, fresh: bool = False) -> store.Results:
    """The results in a file; none of one that is missing, or with `fresh` damaged. Raises CaseError."""
    try:
        return store.read(path) if path.exists() else store.Results()
    except CaseError:
        if fresh:
            return store.Results()
        raise


def _stage(results: store.Results, key: str) -> Stage | None:
    """The stored stage of a law and an engine."""
    about = results.runs.get(key)
    if about is None:
        return None
    tables = {"impacts": results.impacts[key], "paths": results.paths[key]}
    seconds = {name: float(str(value)) for name, value in about.items() if name.startswith("seconds")}
    return Stage(Inputs({}, str(about.get("inputs"))), tables, seconds)


def _plan_hash(p: Plan) -> str:
    return hashlib.sha256(repr(_facts(p)).encode()).hexdigest()


def _kept(outcome: Outcome, old: store.Results) -> dict[str, pd.DataFrame]:
    """Rows of the comparison of each stored run, by key, that belongs to the case: its own numbers are those of the
    case, whatever its title, and its rows are judged by the case."""
    rows, case, found = old.comparison, outcome.case, dict[str, pd.DataFrame]()
    for key, about in old.runs.items():
        law, engine = key.split("/")
        if old.case_text == outcome.results.case_text:
            found[key] = rows[(rows["law"] == law) & (rows["engine"] == engine)]
            continue
        with suppress(CaseError):  # the case no longer has this law
            x = experiment(case, law)
            prediction = predict(x)
            if about.get("plan") == _plan_hash(plan(x, prediction)):
                found[key] = compare(engine, law, old.impacts[key], prediction, case.tolerances)
    return found


def _merge_earlier(results: store.Results, old: store.Results, kept: Mapping[str, pd.DataFrame]) -> store.Results:
    """The results and the stored ones of runs that are `kept` and not in the results."""
    keep = [key for key in kept if key not in results.runs]
    laws = {key.split("/")[0] for key in keep}
    return store.Results(
        results.case_text,
        old.attributes | results.attributes,
        pd.concat([results.comparison, *(kept[key] for key in keep)], ignore_index=True),
        {k: old.impacts[k] for k in keep} | results.impacts,
        {k: table for k, table in old.predictions.items() if k in laws} | results.predictions,
        {k: old.runs[k] for k in keep} | results.runs,
        {k: v for k, v in old.decks.items() if k.rsplit("/", 1)[0] in keep} | results.decks,
        {k: old.paths[k] for k in keep} | results.paths,
    )


def prepare(
    loaded: LoadedCase, tools: Sequence[ImpactEngine], laws: Sequence[str], ranks: int, folder: Path
) -> Outcome:
    """An outcome without results: all input is checked before anything is written or started."""
    case: Case = loaded.model
    with error_context(loaded.place):
        experiments = [experiment(case, law) for law in dict.fromkeys(laws or (None,))]
        predictions = {x.law.name: predict(x) for x in experiments}
        plans = {x.law.name: plan(x, predictions[x.law.name]) for x in experiments}
        warnings = case_warnings(case)
        if case.contact and case.tolerances.psi_2 == math.inf:
            given = "partial slip without a dashpot; take 'partial_slip' alone, or give check.psi_2"
            warnings.append(f"contact: psi_2 is not checked, because its reference is {given}")
        elif case.contact and case.contact.tangential == "history":
            said = "the reference of psi_2 is partial slip, from which one spring differs by up to 0.3"
            warnings.append(f"contact.tangential = 'history': {said}; leave check.psi_2 out")
        for law, p in plans.items():
            warnings += predictions[law].warnings
            for tool in tools:
                warnings += [f"{tool.name}: {note}" for note in check_plan(tool, p, predictions[law], ranks=ranks)]
    error = case.numerics.error or 0.0
    steps = 0 if error else case.numerics.steps_in_contact
    how: dict[str, object] = {"ranks": ranks, "steps": steps, "error": error, "own_law": not laws}
    results = store.Results(case_text=loaded.text)
    return Outcome(case, folder, results, predictions, plans, ranks, how, warnings=warnings)


def fill(
    outcome: Outcome,
    tools: Sequence[ImpactEngine],
    versions: Mapping[str, str],
    *,
    old: store.Results | None = None,
    progress: Callable[[str], None] = lambda text: None,
    keep: Callable[[], None] = lambda: None,
) -> None:
    """Run each law of an outcome on each engine, or take it from `old` results; `keep` is called after each."""
    results, rows = outcome.results, []
    results.attributes = {"case": outcome.case.name, "epdem": __version__}
    results.attributes |= {f"version_{name}": version for name, version in versions.items()}
    for law, p in outcome.plans.items():
        prediction = outcome.predictions[law]
        results.predictions[law] = prediction.table()
        for tool in tools:
            key = f"{law}/{tool.name}"
            progress(f"{tool.name}, {law}: {p.n} impacts")
            stored, version = _stage(old, key) if old else None, versions[tool.name]
            done = run_plan(p, tool, outcome.folder / key, ranks=outcome.ranks, version=version, stored=stored)
            results.impacts[key], results.paths[key] = done.tables["impacts"], done.tables["paths"]
            about = {"inputs": done.inputs.key, "plan": _plan_hash(p), "time_step": p.time_step}
            results.runs[key] = done.seconds | about | outcome.how
            decks = {Path(name).name: text for name, text in done.inputs.files.items() if not name.endswith(".data")}
            results.decks |= {f"{key}/{name}": text for name, text in decks.items()}
            if done.reused:
                outcome.reused.append(key)
            outcome.seconds[tool.name] = outcome.seconds.get(tool.name, 0.0) + done.seconds["seconds"]
            rows.append(compare(tool.name, law, results.impacts[key], prediction, outcome.case.tolerances))
            results.comparison = pd.concat(rows, ignore_index=True)
            keep()


def _read(path: Path | str, steps: int | None, error: float | None) -> LoadedCase:
    """A case with other steps in contact, or with another error of e_n, which then alone is checked."""
    data = read_toml(path)
    if steps is not None or error is not None:
        own = {k: v for k, v in data.get("numerics", {}).items() if k not in ("steps_in_contact", "error")}
        data["numerics"] = own | ({"steps_in_contact": steps} if error is None else {"error": error})
    case = parse(data, path)
    if error is not None:
        check = case.check.model_copy(update=dict.fromkeys(CHECKED, math.inf) | {"e_n": ALLOWED * error})
        case = case.model_copy(update={"check": check})
    return LoadedCase(case, text_of(path), path)


def run(
    case: Path | str | LoadedCase,
    *,
    engines: Sequence[ImpactEngine],
    laws: Sequence[str] = (),
    steps: int | None = None,
    error: float | None = None,
    out: Path | None = None,
    ranks: int = 1,
    fresh: bool = False,
    force: bool = False,
    progress: Callable[[str], None] = lambda text: None,
) -> Outcome:
    """Run a case on every engine with every law (none given: the case's own). Raises CaseError or EngineError.

    `steps` replaces the steps in contact of a case in a file, `error` finds them for a largest error of e_n. `fresh`
    ignores stored results; `force` allows a folder in which there are other files. All input is checked and every
    engine looked for before anything is written or started.
    """
    loaded = case if isinstance(case, LoadedCase) else _read(case, steps, error)
    tools, folder = list({tool.name: tool for tool in engines}.values()), results_folder(out, loaded.model.name)
    require(*tools)
    outcome = prepare(loaded, tools, laws, ranks, folder)
    versions, path = {tool.name: tool.version() for tool in tools}, folder / "results.h5"
    with claim(folder, force=force, case=outcome.case.name) as claimed:
        old = stored_results(path, fresh=fresh)
        kept, aside = _kept(outcome, old), list[list[str]]()

        def keep() -> None:
            new = {key: about["inputs"] for key, about in outcome.results.runs.items()}
            changed = any(k not in kept or new.get(k, x["inputs"]) != x["inputs"] for k, x in old.runs.items())
            if changed and not (force or aside):
                aside.append(claimed.set_aside())
                outcome.warnings += aside[0]
            store.write(path, _merge_earlier(outcome.results, old, kept), old)

        fill(outcome, tools, versions, old=None if fresh else old, progress=progress, keep=keep)
    return outcome
