# SPDX-License-Identifier: GPL-2.0-or-later
"""A sweep from its command to its table: points, checks, missing points, executors."""

import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import pandas as pd

from ...base.folders import claim
from ...case.scene import is_scene
from ...case.toml import located, text_for_anywhere
from ...engines import DEFAULT_ENGINE, engine, scene_engine
from ...errors import CaseError
from ...impacts.engine import require
from . import folder as store
from . import local, points, table
from .evaluate import check, evaluate
from .folder import Sweep
from .keys import keys_of
from .points import Point, Value

Settings = Mapping[str, str | Sequence[Value]]
Report = Callable[[int, int], None]  # (points that have run, points of the sweep)


@dataclass(frozen=True)
class SweepOutcome:
    """What a sweep gives its caller: its table (see `table.collect`) and how many points ran just now."""

    sweep: Sweep
    folder: Path
    table: pd.DataFrame
    ran: int

    def count(self, state: str) -> int:
        """How many points are in a state."""
        return int(self.table[self.table["status"] == state]["point"].nunique())

    @property
    def passed(self) -> bool:
        """Whether every point is finished and within its tolerances."""
        return bool((self.table["status"] == store.DONE).all() and self.table["passed"].all())

    def _repr_html_(self) -> str:
        """In a notebook it shows its table."""
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
    text, folder = (text_for_anywhere(case), case.parent) if isinstance(case, Path) else (case, Path())
    data = tomllib.loads(text)
    keys, scene = keys_of(data), is_scene(data)
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
        points=tuple(
            {key: located(key, value, folder) for key, value in (row | point).items()} for row in rows for point in many
        ),
        engines=chosen,
        laws=tuple(dict.fromkeys(laws)),
        ranks=ranks,
        versions={tool.name: tool.version() for tool in tools},
    )


def check_points(sweep: Sweep, numbers: Iterable[int], jobs: int | None = None) -> None:
    """Raise CaseError for the first point whose case is wrong; nothing runs."""
    wrong = {n: e for n, e in local.each(partial(check, sweep), numbers, jobs or local.cores()) if e}
    if wrong:
        first = wrong[min(wrong)]
        raise first if isinstance(first, CaseError) else CaseError(f"{sweep.place(min(wrong))}: {first}")


def run(
    sweep: Sweep,
    folder: Path,
    *,
    jobs: int | None = None,
    retry_failed: bool = False,
    force: bool = False,
    report: Report = lambda done, total: None,
) -> SweepOutcome:
    """Run what of a sweep is missing or changed, by `jobs` processes on this machine, and write its table.

    Raises CaseError before anything runs if a point is wrong, OSError if results cannot be stored. Whatever ends it,
    the same call goes on where it ended.
    """
    numbers = store.to_do(sweep, folder, retry_failed=retry_failed)
    check_points(sweep, numbers, jobs)
    with claim(folder, force=force):
        store.write(sweep, folder)
        numbers = store.to_do(sweep, folder, retry_failed=retry_failed)
        report(0, len(numbers))
        work = partial(evaluate, sweep, folder)
        for done, (number, result) in enumerate(local.each(work, numbers, jobs or default_jobs(sweep)), start=1):
            if isinstance(result, local.Died):
                record_death(sweep, folder, number, str(result))
            report(done, len(numbers))
        return SweepOutcome(sweep, folder, table.write(sweep, folder), len(numbers))


def default_jobs(sweep: Sweep) -> int:
    """As many processes as there are cores for their ranks."""
    return max(1, local.cores() // sweep.ranks)


def record_death(sweep: Sweep, folder: Path, number: int, how: str) -> None:
    """Store a point that did not come to its end as failed."""
    store.end(sweep, folder, number, store.begin(sweep, folder, number), rows=None, reason=how)
