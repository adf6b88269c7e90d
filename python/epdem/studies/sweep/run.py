# SPDX-License-Identifier: GPL-2.0-or-later
"""A sweep from its command to its table: points, checks, runs of missing points."""

import contextlib
import ctypes
import errno
import math
import multiprocessing
import os
import re
import shutil
import signal
import time
import tomllib
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

import pandas as pd

from ...base import processes
from ...base.declarations import declarations
from ...base.files import claim, running
from ...case import impact, scene
from ...case.keys import keys_of
from ...case.scene import is_scene
from ...case.toml import LoadedCase, error_context, portable_text, with_whole_paths
from ...engines import DEFAULT_ENGINE, engine, scene_engine
from ...errors import CaseError, EpdemError, Stopped
from ...impacts import store as store_impacts
from ...impacts.experiment import experiment
from ...impacts.run import fill, prepare, stored_results
from ...jobs.engine import Feature, require
from ...jobs.engine import check as check_job
from ...scenes.plan.plan import plan as plan_scene
from ...scenes.run import run as run_scene
from . import folder as store
from . import points, table
from .folder import Sweep
from .points import Point, Value
from .table import numbers_of

_FORK = multiprocessing.get_context("fork")  # with all that is imported here: a start takes a few milliseconds
STOPPED = 143  # exit code of a process that received SIGTERM


class Died(Exception):
    """The process of an item ended before its result; the text says how."""


def cores() -> int:
    """Number of processors that this process may use."""
    return len(os.sched_getaffinity(0))


def each(function: Callable[[Any], Any], items: deque[Any], jobs: int) -> Iterator[tuple[Any, Any]]:
    """(item, function(item)) in the order of completion, at most `jobs` at once; Died for an item whose process died.

    Each item has its own process; `items`, which are taken, may grow meanwhile. Raises what `function` raises, and
    Stopped if a process received SIGTERM from another one. On any exception, Ctrl-C too, all processes are stopped.
    """
    team: dict[Connection, tuple[BaseProcess, Any]] = {}
    result: Any
    try:
        while items or team:
            while items and len(team) < jobs:
                ours, theirs = _FORK.Pipe(duplex=False)
                item = items.popleft()
                new = _FORK.Process(target=_work, args=(function, item, theirs, os.getpid()))
                with processes.uninterrupted():
                    new.start()
                    team[ours] = new, item
                theirs.close()  # so that no later process has it: its end is the end of this one
            for pipe in wait(list(team)):
                assert isinstance(pipe, Connection)
                process, item = team[pipe]
                good, result = True, None
                with contextlib.suppress(EOFError, OSError):
                    good, result = pipe.recv()
                with processes.uninterrupted():  # a signal within join would lose the exit code
                    process.join()
                    del team[pipe]
                pipe.close()
                if process.exitcode == STOPPED:
                    raise Stopped
                if not good:
                    raise result
                yield item, Died(_exit_reason(process.exitcode)) if process.exitcode else result
    finally:
        with processes.uninterrupted():
            for living, _ in team.values():
                living.terminate()
            for living, _ in team.values():
                while living.exitcode is None:  # Python drops a signal that comes during a fork
                    living.join(1.0)
                    living.terminate()


def _exit_reason(code: int | None) -> str:
    if code is not None and code < 0:
        return f"its process was ended by signal {-code}{' (out of memory?)' if code == -9 else ''}"
    return f"its process ended with exit code {code}"


def _keep_memory() -> None:
    """Keep freed memory for the next point: to get 13 MB from the kernel again took a third of a point's time."""
    trim_threshold, mmap_threshold = -1, -3  # of malloc.h
    with contextlib.suppress(AttributeError):  # a C library without it
        mallopt = ctypes.CDLL(None).mallopt
        mallopt(trim_threshold, 1 << 28)
        mallopt(mmap_threshold, 1 << 25)


def _work(function: Callable[[Any], Any], item: Any, pipe: Connection, parent: int) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all: our parent stops us in good order
    signal.signal(signal.SIGUSR2, signal.SIG_IGN)  # Slurm warns every process of a job; our parent queues it again
    try:
        processes.install_signal_handlers(signal.SIGTERM)
        processes.end_with_parent()  # a parent that is killed cannot
        _keep_memory()
        if os.getppid() == parent:
            try:
                answer = True, function(item)
            except Exception as error:
                answer = False, error
            pipe.send(answer)
    except Stopped:
        os._exit(STOPPED)  # without flushing or removing files of the parent
    except OSError:
        os._exit(1)
    os._exit(0)


SEPARATOR = " | "  # of the warnings of a row
SHARES = 4  # of points, for each job; a start of a process takes as long as some impacts
JOIN_TIMEOUT = 10.0  # [s] that another call may keep the folder while it writes the definition
FULL = 1 << 16  # bytes; with less free space on the disk, a failure is a full disk


def check(sweep: Sweep, number: int, *, plans: bool = False) -> CaseError | None:
    """The error of the case of a point, or None; `plans`: also errors of its plan and engines. Nothing runs."""
    data, place = sweep.data(number), sweep.place(number)
    try:
        if sweep.scene:
            parsed = scene.parse(data, place)
            with error_context(place):
                if plans:
                    check_job(scene_engine(sweep.engines[0]), plan_scene(parsed))
            return None
        case = impact.parse(data, place)
        if plans:
            numerics = case.numerics.model_copy(update={"error": None})  # no search
            loaded = LoadedCase(case.model_copy(update={"numerics": numerics}), "", place)
            prepare(loaded, [*map(engine, sweep.engines)], sweep.laws, sweep.ranks, Path())
            return None
        with error_context(place):
            for law in sweep.laws or (None,):
                experiment(case, law)
    except CaseError as error:
        return error
    return None


def evaluate(sweep: Sweep, folder: Path, number: int) -> None:
    """Run a point and store its results, or the reason of a failure.

    Raises OSError if results cannot be stored, and whatever stops the process; the point is then as if it had not run,
    except that a scene with restart files goes on from them.
    """
    about = store.begin(sweep, folder, number)
    place = store.point_folder(sweep, folder, number)
    try:
        rows = _scene(sweep, place) if sweep.scene else _impacts(sweep, number, place)
    except OSError:
        raise
    except Exception as error:  # of any kind: the other points run
        if shutil.disk_usage(place).free < FULL:
            raise OSError(errno.ENOSPC, "no space left on the disk", str(place)) from None
        reason = str(error) if isinstance(error, EpdemError) else f"{type(error).__name__}: {error}"
        reason = " ".join(reason.removeprefix(f"{place / store.CASE}: ").replace(f"{place}/", "").split())
        store.end(sweep, folder, number, about, rows=None, reason=reason)
    else:
        store.end(sweep, folder, number, about, rows=rows)


def _impacts(sweep: Sweep, number: int, place: Path) -> dict[str, list[Any]]:
    """The rows of the impacts of a point. Engines without decks run faster than a file is read."""
    file, stored, tools = place / store.CASE, place / "results.h5", [*map(engine, sweep.engines)]
    case = LoadedCase(impact.parse(sweep.data(number), sweep.place(number)), file.read_text(encoding="utf-8"), file)
    outcome = prepare(case, tools, sweep.laws, sweep.ranks, place)
    keeps = any(Feature.DECK in tool.features for tool in tools)
    fill(outcome, tools, sweep.versions, old=stored_results(stored) if keeps else None)
    if keeps:
        store_impacts.write(stored, outcome.results)
    table = outcome.results.comparison.assign(warnings=SEPARATOR.join(outcome.warnings))
    return {str(name): table[name].tolist() for name in table.columns}


def _scene(sweep: Sweep, place: Path) -> dict[str, list[Any]]:
    """The named numbers of a scene, in one row; a scene that was interrupted goes on from its last restart file."""
    tool = scene_engine(sweep.engines[0])

    def once(go_on: bool) -> dict[str, list[Any]]:
        outcome = run_scene(place / store.CASE, tool, out=place, ranks=sweep.ranks, resume=go_on, force=True)
        row = {"engine": tool.name, **numbers_of(outcome.results), "passed": outcome.passed}
        row["warnings"] = SEPARATOR.join(outcome.warnings)
        return {name: [value] for name, value in row.items()}

    interrupted = any(place.glob("restart.*.bin")) and not (place / "results.h5").exists()
    if interrupted and Feature.RESTART in tool.features:
        with contextlib.suppress(CaseError):  # refused before the engine starts: no whole restart file, another deck
            return once(True)
    return once(False)


Settings = Mapping[str, str | Sequence[Value]]
Report = Callable[[int, int], None]  # (points that have run, points of the sweep)


@dataclass(frozen=True)
class SweepOutcome:
    """Outcome of a sweep: its table (see `table.collect`) and the number of points that ran in this call."""

    sweep: Sweep
    folder: Path
    table: pd.DataFrame
    ran: int

    def count(self, state: str) -> int:
        return int(self.table[self.table["status"] == state]["point"].nunique())

    @property
    def passed(self) -> bool:
        """Whether every point is finished and within its tolerances."""
        return bool((self.table["status"] == store.DONE).all() and self.table["passed"].all())

    @property
    def warnings(self) -> list[str]:
        """Each warning of the points once, whatever its numbers, with the number of points and the first of them."""
        found: dict[str, tuple[str, int, set[int]]] = {}
        texts = self.table.get("warnings", pd.Series("", index=self.table.index)).fillna("")
        for number, text in zip(self.table["point"], texts, strict=True):
            for sentence in filter(None, str(text).split(SEPARATOR)):
                kind = re.sub(r"[-+]?\d[\d.e+-]*", "#", sentence)
                found.setdefault(kind, (sentence, int(number), set()))[2].add(int(number))
        total = len(self.sweep.points)
        return [f"{len(all_)} of {total} points, here point {first}: {said}" for said, first, all_ in found.values()]

    def report(self, found: Sequence[str] = ()) -> Path:
        """Write report.html, one page with figures and the table, into the folder; its path.

        found: sentences on what a fit has found.
        """
        from ...report.sweeps import write_sweep_page

        sweep = self.sweep
        measures = [m["name"] for m in sweep.tables["scene"].get("measure", [])] if sweep.scene else None
        return write_sweep_page(
            self.folder,
            self.table,
            name=sweep.name,
            engines=sweep.engines,
            keys=[*sweep.points[0]],
            measures=measures,
            case=sweep.case,
            versions=sweep.versions,
            passed=self.passed,
            warnings=self.warnings,
            found=found,
        )

    def __repr__(self) -> str:
        states = ", ".join(f"{n} {state}" for state in store.STATES if (n := self.count(state)))
        title = f"sweep {self.sweep.name}: {states} of {len(self.sweep.points)} points"
        return f"{title}\n{self.folder}: table ({len(self.table)} rows)"

    def _repr_html_(self) -> str:
        return str(self.table.to_html(max_rows=20))


def plan(
    case: Path | str,
    settings: Settings,
    *,
    engines: Sequence[str] = (),
    laws: Sequence[str] = (),
    ranks: int = 1,
    table: Path | None = None,
    latin_hypercube: int | None = None,
    seed: int = 1,
) -> Sweep:
    """A sweep of a case (path of a file, or TOML text) with all its points, not yet checked.

    Raises CaseError, EngineError. Names of files among the values count from the folder of the file.
    """
    text, folder = (portable_text(case), case.parent) if isinstance(case, Path) else (case, Path())
    data = tomllib.loads(text)
    keys, scene = keys_of(data), is_scene(data)
    if table or "law.name" in settings:  # which laws the points choose, each of them says when it is read
        for law in declarations():
            keys = keys_of(data | {"law": {"name": law}}) | keys
    if ranks < 1:
        raise CaseError(f"ranks = {ranks}: must be at least 1")
    axes = points.axes(settings, keys)
    rows: list[Point] = points.table(table, keys) if table else [{}]
    if both := set(axes) & set(rows[0]):
        raise CaseError(f"--set {min(both)}: the key is in {table} too; keep one")
    if not axes and not table:
        raise CaseError("a sweep needs points: --set KEY=VALUES or --points FILE.csv")
    if latin_hypercube is not None and not axes:
        raise CaseError("--latin-hypercube needs ranges; add --set KEY=LOW..HIGH")
    many = points.grid(axes) if latin_hypercube is None else points.latin_hypercube(axes, latin_hypercube, seed)
    chosen = tuple(dict.fromkeys(engines)) or (DEFAULT_ENGINE,)
    if scene and (len(chosen) > 1 or laws):
        raise CaseError("a scene has its own law and runs on one engine; leave out --law, or sweep law.name")
    tools = [scene_engine(name) if scene else engine(name) for name in chosen]
    require(*tools)
    return Sweep(
        name=str(data.get("case", {}).get("name", "case")),
        case=text,
        points=tuple(with_whole_paths(row | point, folder) for row in rows for point in many),
        engines=chosen,
        laws=tuple(dict.fromkeys(laws)),
        ranks=ranks,
        versions={tool.name: tool.version() for tool in tools},
    )


def shares(numbers: Sequence[int], jobs: int) -> deque[list[int]]:
    """Points in shares of one process each: more shares than jobs, for points take unlike times."""
    size = math.ceil(len(numbers) / (SHARES * jobs)) or 1
    return deque(list(numbers[first : first + size]) for first in range(0, len(numbers), size))


def check_points(sweep: Sweep, numbers: Sequence[int], jobs: int | None = None, *, plans: bool = False) -> None:
    """Raise CaseError for the first point that `check` finds wrong; nothing runs."""
    jobs, wrong = jobs or cores(), dict[int, CaseError]()

    def wrong_points(share: list[int]) -> dict[int, CaseError]:
        return {n: error for n in share if (error := check(sweep, n, plans=plans))}

    for share, found in each(wrong_points, shares(numbers, jobs), jobs):
        wrong |= {share[0]: CaseError(f"{sweep.place(share[0])}: {found}")} if isinstance(found, Died) else found
    if wrong:
        raise wrong[min(wrong)]


def work(sweep: Sweep, folder: Path, numbers: Sequence[int], jobs: int) -> Iterator[int]:
    """Run points by `jobs` processes on this machine; yields how many have just ended.

    A point whose process dies is stored as failed, and the rest of its share runs in another process.
    """

    def run_points(share: list[int]) -> None:
        for number in share:
            evaluate(sweep, folder, number)

    for number in numbers:  # of a point that failed before
        (store.point_folder(sweep, folder, number) / store.FINISHED).unlink(missing_ok=True)
    waiting = deque([number] for number in numbers) if sweep.scene else shares(numbers, jobs)
    for share, found in each(run_points, waiting, jobs):
        rest: list[int] = []
        left = [n for n in share if isinstance(found, Died) and not store.is_finished(sweep, folder, n)]
        if left:
            dead, *rest = left
            store.end(sweep, folder, dead, store.begin(sweep, folder, dead), rows=None, reason=str(found))
            waiting += [rest] if rest else []
        yield len(share) - len(rest)


def run(
    sweep: Sweep,
    folder: Path,
    *,
    jobs: int | None = None,
    retry_failed: bool = False,
    force: bool = False,
    only: Sequence[int] | None = None,
    report: Report = lambda done, total: None,
) -> SweepOutcome:
    """Run the missing and changed points of a sweep and write its table.

    only: numbers of points; the table of the outcome has only these and is not written, so that several calls may be at
    work on other points in one folder. jobs: processes on this machine (default: as many as it has cores for). Raises
    CaseError before anything runs if a point is wrong, OSError if results cannot be stored. Whatever ends it, the same
    call goes on where it ended.
    """
    check_points(sweep, store.to_do(sweep, folder, retry_failed=retry_failed, only=only), jobs)
    with _share(sweep, folder, force) if only else claim(folder, force=force):
        if not only:
            store.write(sweep, folder)
        numbers, done = store.to_do(sweep, folder, retry_failed=retry_failed, only=only), 0
        report(done, len(numbers))
        for ended in work(sweep, folder, numbers, jobs or max(1, cores() // sweep.ranks)):
            done += ended
            report(done, len(numbers))
        found = table.collect(sweep, folder, only) if only else table.write(sweep, folder)
        return SweepOutcome(sweep, folder, found, len(numbers))


@contextlib.contextmanager
def _share(sweep: Sweep, folder: Path, force: bool) -> Iterator[None]:
    """A folder with the definition of the sweep, which other calls use, too. Raises CaseError."""
    end = time.monotonic() + JOIN_TIMEOUT
    while not store.is_stored(sweep, folder):
        try:
            with claim(folder, force=force):
                store.write(sweep, folder)
        except CaseError:
            if time.monotonic() > end or not running(folder):
                raise
            time.sleep(0.1)  # another call writes the definition
    yield
