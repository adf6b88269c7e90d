# SPDX-License-Identifier: GPL-2.0-or-later
"""From a case to results: predict, plan, run each engine, measure, compare, store.

A stage is done when its result is stored with the hash of its inputs: a second run takes it from there.
"""

import hashlib
import json
import shutil
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from .. import __version__, paths
from ..case.impact import Case, named, parse, read_toml
from ..engines import Engine, engine
from ..errors import CaseError, EngineError
from . import store
from .comparison import compare, impacts_table
from .engine import not_representable
from .experiment import experiment
from .measurement import measure
from .plan import Plan, plan
from .prediction import Prediction, predict


@dataclass
class Outcome:
    """What a run gives its caller."""

    case: Case
    folder: Path
    results: store.Results
    predictions: dict[str, Prediction]
    seconds: dict[str, float] = field(default_factory=dict)
    reused: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    @property
    def passed(self) -> bool:
        return bool(self.results.comparison["passed"].all())


def _digest(plan: Plan, tool: Engine, version: str, ranks: int) -> str:
    """Hash of all that the result of a stage depends on: plan, engine, our binaries, templates."""
    x, sha = plan.experiment, hashlib.sha256()
    numbers = [
        x.E_star,
        x.R_star,
        x.m_star,
        plan.time_step,
        plan.steps,
        x.body,
        x.target,
        x.law,
        x.viscous_restitution,
        __version__,
    ]
    sha.update(json.dumps([tool.name, version, ranks, repr(numbers)]).encode())
    sha.update(plan.speed.tobytes() + plan.gap.tobytes())
    binaries = [paths.native("libepdem.so"), paths.native("libepdem_liggghts.so"), paths.launcher()]
    sources = [*sorted(paths.templates().rglob("*.j2")), *sorted(Path(__file__).parents[1].rglob("*.py"))]
    for path in [*filter(None, binaries), *sources]:
        sha.update(path.read_bytes())
    return sha.hexdigest()


def _stage(
    plan: Plan, tool: Engine, folder: Path, ranks: int
) -> tuple[pd.DataFrame, dict[str, object], dict[str, str]]:
    """Run one engine on one plan: (table of impacts, seconds, deck texts)."""
    start = time.perf_counter()
    folder.mkdir(parents=True, exist_ok=True)
    files = tool.write(plan, folder)
    path = tool.run(plan, folder, ranks=ranks)
    table = impacts_table(plan, measure(plan, path))
    (folder / "path.bin").unlink(missing_ok=True)  # large, and everything asked of it is in the table
    seconds = {f"seconds_{k}": v for k, v in path.seconds.items()} | {"seconds": time.perf_counter() - start}
    return table, seconds, {f.name: f.read_text() for f in files if f.suffix != ".data"}


def _refuse(tool: Engine, plan: Plan, prediction: Prediction, ranks: int) -> None:
    """Raise CaseError if `tool` cannot run `plan` as it is."""
    if ranks > 1 and not tool.name.startswith("liggghts"):
        raise CaseError(f"--ranks {ranks}: engine {tool.name} runs on one rank; leave --ranks out")
    if tool.name == "embedded":
        return
    if hasattr(tool, "deck"):
        tool.deck(plan)
    for speed, overlap in zip(prediction.speed, prediction.overlap_max, strict=True):
        if why := not_representable(plan.experiment, float(overlap)):
            raise CaseError(f"{speed:.4g} m/s is not representable by positions ({why}); use --engine embedded for it")


def _stored(path: Path) -> store.Results:
    """What an earlier run left, or nothing; a file of another version is simply made anew."""
    try:
        return store.read(path)
    except CaseError:
        return store.Results()


def _beside_earlier(results: store.Results, old: store.Results) -> store.Results:
    """What is stored: these results, and those of other engines and laws that an earlier call left of the same case."""
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
    )


def run(
    case_path: Path | str,
    *,
    engines: list[str],
    laws: list[str],
    out: Path | None = None,
    ranks: int = 1,
    steps: int | None = None,
    fresh: bool = False,
    progress: Callable[[str], None] = lambda text: None,
) -> Outcome:
    """Run a case on every engine with every law (none given: the case's own). Raises CaseError or EngineError.

    `steps` replaces the case's steps in contact. All input is checked and every engine looked for before anything is
    written or started.
    """
    data = read_toml(case_path)
    if steps is not None:
        data["numerics"] = data.get("numerics", {}) | {"steps_in_contact": steps}
        data["numerics"].pop("error", None)
    case = parse(data, case_path)
    tools = [engine(name) for name in dict.fromkeys(engines)]
    with named(case_path):
        experiments = [experiment(case, law) for law in (list(dict.fromkeys(laws)) or [None])]
    for tool in tools:
        if reason := tool.missing():
            raise EngineError(f"engine {tool.name}: {reason}")
    if ranks > 1 and shutil.which("mpirun") is None:
        raise EngineError("--ranks needs mpirun, which was not found; apt-get install openmpi-bin")
    versions = {tool.name: tool.version() for tool in tools}
    predictions = {x.law.name: predict(x) for x in experiments}
    with named(case_path):
        plans = [plan(x, predictions[x.law.name]) for x in experiments]
    for p in plans:  # what an engine cannot do is said before any engine runs
        for tool in tools:
            with named(case_path):
                _refuse(tool, p, predictions[p.experiment.law.name], ranks)

    folder = out or Path("runs") / case.name
    stored = folder / "results.h5"
    old = store.Results() if fresh else _stored(stored)
    results = store.Results(
        case_text=Path(case_path).read_text(),
        attributes={"case": case.name, "epdem": __version__} | {f"version_{k}": v for k, v in versions.items()},
    )
    outcome = Outcome(case, folder, results, predictions)
    rows = []
    for x, p in zip(experiments, plans, strict=True):
        law, prediction = x.law.name, predictions[x.law.name]
        outcome.warnings += prediction.warnings()
        results.predictions[law] = pd.DataFrame({n: getattr(prediction, n) for n in Prediction.COLUMNS})
        for tool in tools:
            key, inputs = f"{law}/{tool.name}", _digest(p, tool, versions[tool.name], ranks)
            progress(f"{tool.name}, {law}: {p.n} impacts")
            if old.runs.get(key, {}).get("inputs") == inputs:
                results.impacts[key], results.runs[key] = old.impacts[key], old.runs[key]
                results.decks |= {k: v for k, v in old.decks.items() if k.startswith(key + "/")}
                outcome.reused.append(key)
            else:
                table, seconds, texts = _stage(p, tool, folder / law / tool.name, ranks)
                about = {"inputs": inputs, "time_step": p.time_step}
                results.impacts[key], results.runs[key] = table, seconds | about
                results.decks |= {f"{key}/{name}": text for name, text in texts.items()}
            spent = float(results.runs[key]["seconds"])
            outcome.seconds[tool.name] = outcome.seconds.get(tool.name, 0.0) + spent
            rows.append(compare(tool.name, law, results.impacts[key], prediction, case.check))
            results.comparison = pd.concat(rows, ignore_index=True)
            store.write(stored, _beside_earlier(results, old))  # what is done stays done, whatever comes next
    return outcome
