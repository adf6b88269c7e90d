# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene from case file to results.h5: deck, run with progress, tables, ledger, checks; and its continuation."""

import hashlib
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from .. import __version__, paths
from ..case.impact import named
from ..case.scene import SceneCase, load
from ..errors import CaseError, EngineError
from ..files import write_texts
from ..impacts.prediction import predict
from . import checks, ledger, results
from .engine import SceneEngine
from .pairs import wall_impact
from .plan import ScenePlan, plan
from .timestep import highest_speed

Progress = Callable[[int, int], None]  # (step, of so many)


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
        """The case that was run."""
        return self.plan.case

    @property
    def passed(self) -> bool:
        """Whether every check holds."""
        checks = self.results.tables.get("checks")
        return checks is None or bool(checks["passed"].all())


def inputs_hash(p: ScenePlan, files: dict[str, str], version: str, ranks: int) -> str:
    """Hash of all that a result depends on: the case, every file written for the engine, its version, all of ours."""
    sha = hashlib.sha256(repr((__version__, p.case, sorted(files.items()), version, ranks)).encode())
    compiled = [paths.native("libepdem.so"), paths.native("libepdem_liggghts.so"), paths.launcher()]
    sources = [*paths.templates().rglob("*.j2"), *Path(__file__).parents[1].rglob("*.py")]
    for path in [*filter(None, compiled), *sorted(sources)]:
        sha.update(path.read_bytes())
    return sha.hexdigest()


def _refuse(engine: SceneEngine, ranks: int, resume: bool) -> None:
    """Raise CaseError for an option that the engine does not have, EngineError if it is not here."""
    if ranks > 1 and not engine.parallel:
        raise CaseError(f"--ranks {ranks}: a scene in {engine.name} runs on one core; leave it out")
    if resume and not engine.resumes:
        raise CaseError(f"--resume: a scene in {engine.name} runs from its start; leave it out")
    if reason := engine.missing():
        raise EngineError(reason)


def _clear(engine: SceneEngine, folder: Path) -> None:
    """Remove what an earlier run of the same folder left, and only that."""
    for pattern in engine.leftovers:
        for path in folder.glob(pattern):
            path.unlink()


def _same_files(folder: Path, files: dict[str, str]) -> bool:
    return all((folder / name).exists() and (folder / name).read_text() == text for name, text in files.items())


def _stored(path: Path) -> results.SceneResults | None:
    try:
        return results.read(path)
    except CaseError:
        return None  # of another version: made anew


def run(
    path: Path | str,
    engine: SceneEngine,
    *,
    out: Path | None = None,
    ranks: int = 1,
    fresh: bool = False,
    resume: bool = False,
    progress: Progress = lambda step, steps: None,
) -> SceneOutcome:
    """Run the scene in a case file, or continue it from its last restart file. Raises CaseError, EngineError."""
    start = time.perf_counter()
    case = load(path)
    with named(path):
        p = plan(case)
        files, warnings = engine.files(p), [*engine.notes(p), *_warnings(case)]
        _refuse(engine, ranks, resume)
    folder = out or Path("runs") / case.name / engine.subfolder
    inputs = inputs_hash(p, files, engine.version(), ranks)
    if not (fresh or resume):
        old = _stored(folder / "results.h5")
        if old is not None and old.attributes.get("inputs") == inputs:
            return SceneOutcome(p, folder, old, 0.0, reused=True, warnings=warnings)

    def tell(step: int) -> None:
        progress(step, p.steps)

    went_on = None
    if resume:
        if folder.exists() and not _same_files(folder, files):
            raise CaseError(f"{folder}: the case has changed since the run that is to be continued; run it anew (--fresh)")
        went_on = engine.resume(p, folder, ranks=ranks, tell=tell)
        warnings += _left_out(folder, went_on.lost)
    else:
        folder.mkdir(parents=True, exist_ok=True)
        _clear(engine, folder)
        write_texts(folder, files)
        engine.run(p, folder, ranks=ranks, tell=tell)
    tables = engine.read(p, folder, without=went_on.lost if went_on else ())
    _complete(p, tables)
    kept = results.SceneResults(
        Path(path).read_text(),
        {
            "case": case.name,
            "epdem": __version__,
            "time_step": p.time_step,
            "steps": p.steps,
            "engine": engine.name,
            "ranks": ranks,
            "inputs": inputs,
        },
        tables,
        {name: text for name, text in files.items() if "/" not in name},
    )
    seconds = kept.attributes["seconds"] = time.perf_counter() - start
    results.write(folder / "results.h5", kept)
    return SceneOutcome(
        p, folder, kept, seconds, resumed_from=went_on.step if went_on else None, warnings=warnings
    )


def _complete(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> None:
    """Add the ledger and the checks to the tables of a run."""
    if p.output.energy:
        tables["ledger"] = ledger.ledger(p, tables)
    tables["checks"] = checks.checks(p, tables)


def _left_out(folder: Path, lost: list[int]) -> list[str]:
    if not lost:
        return []
    steps = f"step {lost[0]}" if len(lost) == 1 else f"steps {', '.join(map(str, lost))}"
    return [f"{folder}: the frames of {steps} are missing or not whole, and left out; --fresh runs the scene anew"]


def _warnings(case: SceneCase) -> list[str]:
    """Where the scene leaves the domain of theory, in words: impacts on the walls at its highest speed."""
    first = case.scene.particles[0]
    x = wall_impact(case, first.material, first.radii()[0], case.scene.walls, highest_speed(case))
    return predict(x).warnings()
