# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene from case file to results.h5: deck, run with progress, tables, ledger, checks; and its continuation."""

import hashlib
import re
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

from .. import __version__, paths
from ..case.scene import SceneCase, load
from ..errors import CaseError, EngineError
from ..files import write_texts
from ..impacts.prediction import predict
from ..liggghts import launcher
from ..liggghts import scene_tables as tables
from ..liggghts.resume import write_resume
from ..liggghts.scene_deck import Deck, deck, write
from ..processes import ROW
from ..yade import scene_deck as yade
from ..yade import scene_tables as yade_tables
from . import checks, contacts, ledger, results
from .model import highest_speed, wall_impact

Tell = Callable[[int, int], None]  # (step, of so many)


@dataclass
class SceneOutcome:
    """What a run gives its caller."""

    case: SceneCase
    deck: Deck
    folder: Path
    results: results.SceneResults
    seconds: float
    reused: bool = False
    resumed_from: int | None = None
    warnings: list[str] = field(default_factory=list)

    @property
    def passed(self) -> bool:
        """Whether all checks of the scene hold."""
        checks = self.results.tables.get("checks")
        return checks is None or bool(checks["passed"].all())


def _inputs(folder_text: str, ranks: int) -> str:
    """Hash of all that a result depends on: deck, our binaries, sources."""
    sha = hashlib.sha256(f"{folder_text}{ranks}{__version__}".encode())
    sources = sorted(Path(__file__).parents[1].rglob("*.py"))
    for path in [*filter(None, [paths.native("libepdem_liggghts.so"), paths.launcher()]), *sources]:
        sha.update(path.read_bytes())
    return sha.hexdigest()


def last_restart(folder: Path) -> tuple[Path, int] | None:
    """The newest whole restart file: LIGGGHTS went on after it, so its row stands twice in succession."""
    log = folder / launcher.OUT
    if not log.exists():
        return None
    rows = [int(m.group(1)) for line in log.read_bytes().splitlines() if (m := ROW.match(line))]
    gone_on = {a for a, b in pairwise(rows) if a == b}
    whole = [(step, p) for step, p in _restarts(folder) if step in gone_on]
    return (whole[-1][1], whole[-1][0]) if whole else None


def _restarts(folder: Path) -> list[tuple[int, Path]]:
    return sorted((int(re.search(r"(\d+)\.bin$", p.name).group(1)), p) for p in folder.glob("restart.*.bin"))


def _prune(folder: Path, step: int) -> None:
    """Keep the newest restart file from before `step`, which the engine has gone on after, and all later ones."""
    for _, path in [(s, p) for s, p in _restarts(folder) if s < step][:-1]:
        path.unlink(missing_ok=True)


def _clear(folder: Path) -> None:
    """Remove what an earlier run of the same folder left, and only that."""
    for pattern in (
        "particles.*.bin",
        "contacts.*.txt",
        "wall_contacts*.txt",
        "restart.*.bin",
        "scene_*.vtk",
        "picture.*.ppm",
        "in.resume",
        "particles.*.npy",
        "contacts.*.npy",
    ):
        for path in folder.glob(pattern):
            path.unlink()


def run(
    path: Path | str,
    *,
    engine: str = "liggghts",
    out: Path | None = None,
    ranks: int = 1,
    fresh: bool = False,
    resume: bool = False,
    tell: Tell = lambda step, steps: None,
) -> SceneOutcome:
    """Run the scene in a case file, or continue it from its last restart file. Raises CaseError, EngineError."""
    case = load(path)
    if engine == "yade":
        return _run_yade(path, case, out, ranks, fresh, resume, tell)
    if engine != "liggghts":
        raise CaseError(f"--engine {engine}: a scene runs on liggghts or yade")
    d = deck(case)
    folder = out or Path("runs") / case.name
    stored = folder / "results.h5"
    start = time.perf_counter()

    def row(step: int) -> None:
        _prune(folder, step)
        tell(step, d.steps)

    if resume:
        found = last_restart(folder)
        if found is None:
            raise CaseError(f"{folder}: no restart file to continue from; set output.restarts in the case and run it")
        if not _same_deck(case, folder):
            raise CaseError(
                f"{folder}: the case has changed since the run that is to be continued; run it anew (--fresh)"
            )
        restart, step = found
        if step < d.steps:
            name = write_resume(case, folder, restart.name, step).name
            launcher.run(name, folder, ranks=ranks, append=True, tell=row)
        return _finish(path, case, d, folder, ranks, start, step)
    if not fresh and stored.exists():
        old = _old(stored)
        if old is not None and old.attributes.get("inputs") == _inputs(_texts(case), ranks):
            return SceneOutcome(case, d, folder, old, 0.0, reused=True, warnings=_warnings(case))
    if words := launcher.missing():
        raise EngineError(words)
    launcher.refuse_ranks(ranks)
    folder.mkdir(parents=True, exist_ok=True)
    _clear(folder)
    write(case, folder)
    launcher.run("in.scene", folder, ranks=ranks, tell=row)
    return _finish(path, case, d, folder, ranks, start, None)


def _old(stored: Path) -> results.SceneResults | None:
    try:
        return results.read(stored)
    except CaseError:
        return None  # of another version: made anew


def _texts(case: SceneCase) -> str:
    from ..liggghts.scene_deck import texts

    return "\n".join(f"{name}\n{text}" for name, text in texts(case).items())


def _same_deck(case: SceneCase, folder: Path) -> bool:
    from ..liggghts.scene_deck import texts

    return all((folder / name).exists() and (folder / name).read_text() == text for name, text in texts(case).items())


def _finish(path, case, d, folder, ranks, start, resumed) -> SceneOutcome:
    found = {"rows": tables.rows(folder / launcher.OUT, d.time_step)}
    if d.frames:
        found["particles"] = tables.particles(folder, d)
    if d.contacts:
        found["contacts"] = contacts.contacts(case, d, folder, found["particles"])
    decks = sorted(folder.glob("*.in")) + sorted(folder.glob("in.*"))
    attributes = {"engine": "liggghts", "ranks": ranks, "inputs": _inputs(_texts(case), ranks)}
    return _store(path, case, d, folder, found, decks, attributes, start, resumed)


def _store(path, case, d, folder, found, decks, attributes, start, resumed=None, said=()) -> SceneOutcome:
    """Complete the tables of a run of any engine by ledger and checks, and write results.h5."""
    kept = results.SceneResults(
        Path(path).read_text(),
        {"case": case.name, "epdem": __version__, "time_step": d.time_step, "steps": d.steps, **attributes},
        found,
        {f.name: f.read_text() for f in decks},
    )
    if case.scene.kind == "compaction":
        tables.add_plate(case, d, found["rows"])
    if case.output.energy:
        found["ledger"] = ledger.ledger(case, d, found)
    found["checks"] = checks.checks(case, d, found)
    seconds = kept.attributes["seconds"] = time.perf_counter() - start
    results.write(folder / "results.h5", kept)
    return SceneOutcome(case, d, folder, kept, seconds, resumed_from=resumed, warnings=[*said, *_warnings(case)])


def _run_yade(path, case, out, ranks, fresh, resume, tell) -> SceneOutcome:
    """The same in YADE, in its own folder."""
    if ranks > 1 or resume:
        option = f"--ranks {ranks}" if ranks > 1 else "--resume"
        raise CaseError(f"{option}: a scene in YADE runs on one core from its start; leave it out")
    start = time.perf_counter()
    texts, d, said = yade.texts(case), deck(case), yade.warnings(case)
    yade.missing()
    folder = out or Path("runs") / case.name / "yade"
    inputs, stored = _inputs("\n".join([yade.version(), *texts.values()]), ranks), folder / "results.h5"
    if not fresh and (old := _old(stored)) is not None and old.attributes.get("inputs") == inputs:
        return SceneOutcome(case, d, folder, old, 0.0, reused=True, warnings=[*said, *_warnings(case)])
    folder.mkdir(parents=True, exist_ok=True)
    _clear(folder)
    write_texts(folder, texts)
    yade.run(folder, lambda step: tell(step, d.steps))
    attributes = {"engine": "yade", "ranks": ranks, "inputs": inputs}
    found = yade_tables.read(case, d, folder)
    return _store(path, case, d, folder, found, [folder / yade.SCRIPT], attributes, start, said=said)


def _warnings(case: SceneCase) -> list[str]:
    """Where the scene leaves the domain of theory, in words: impacts on the walls at its highest speed."""
    first = case.scene.particles[0]
    return predict(
        wall_impact(case, first.material, first.radii()[0], case.scene.walls, highest_speed(case))
    ).warnings()
