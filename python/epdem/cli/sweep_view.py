# SPDX-License-Identifier: GPL-2.0-or-later
"""The output of a sweep on the console."""

import contextlib
import json
import math
import sys
from collections.abc import Iterator
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.table import Table

from ..studies.sweep.folder import DONE, FAILED, Sweep
from ..studies.sweep.run import Report, SweepOutcome

SHOWN = 20  # failed points


def points(sweep: Sweep, as_json: bool, console: Console) -> None:
    """Print every point."""
    if as_json:
        print(json.dumps({"case": sweep.name, "points": sweep.points}, indent=1))
        return
    table = Table(title=f"{sweep.name}: {len(sweep.points)} points on {', '.join(sweep.engines)}")
    for head in ("point", *sweep.points[0]):
        table.add_column(head, justify="right")
    for n, point in enumerate(sweep.points, start=1):
        table.add_row(str(n), *map(str, point.values()))
    console.print(table)


@contextlib.contextmanager
def progress() -> Iterator[Report]:
    """A bar with the time left, on a terminal."""
    with Progress(
        TextColumn("points"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
        disable=not sys.stderr.isatty(),
    ) as bar:
        task = bar.add_task("", total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def plain(found: dict[str, Any]) -> dict[str, Any]:
    """The status for JSON: null for what is not known."""
    return {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in found.items()}


def outcome(found: SweepOutcome, as_json: bool, console: Console) -> None:
    """Print the failed points and a summary."""
    counts = {state: found.count(state) for state in (DONE, FAILED)}
    failed = found.table[found.table["status"] == FAILED]
    if as_json:
        failures = failed[["point", "folder", "reason"]].to_dict("records")
        about = {"case": found.sweep.name, "passed": found.passed, "folder": str(found.folder), "ran": found.ran}
        print(json.dumps(about | counts | {"failures": failures}, indent=1))
        return
    for row in failed.head(SHOWN).to_dict("records"):
        console.print(f"point {row['point']} failed: {row['reason']}", style="red", highlight=False, soft_wrap=True)
    if len(failed) > SHOWN:
        console.print(f"... and {len(failed) - SHOWN} more", style="red", highlight=False)
    outside = found.table[(found.table["status"] == DONE) & ~found.table["passed"]]["point"].nunique()
    said = f"{counts[DONE]} of {len(found.sweep.points)} points done, {found.ran} of them just now"
    said += f"; {counts[FAILED]} failed (--retry-failed runs them again)" if counts[FAILED] else ""
    said += f"; {outside} outside tolerance" if outside else ""
    console.print(f"{found.sweep.name}: {said}; see {found.folder}/sweep.csv", highlight=False, soft_wrap=True)


def status(found: dict[str, Any], console: Console) -> None:
    """Print the status of a sweep."""
    states = ", ".join(f"{found[state]} {state}" for state in ("waiting", "running", "done", "failed"))
    console.print(f"{found['case']}: {found['points']} points: {states}", highlight=False, soft_wrap=True)
    if found["done"] + found["failed"]:
        left = f"; about {found['work_left']:.3g} s of work left" if found["work_left"] else ""
        console.print(
            f"{found['seconds']:.3g} s of work, longest point {found['longest']:.3g} s{left}", highlight=False
        )
    for row in found["failures"][:SHOWN]:
        console.print(f"point {row['point']} failed: {row['reason']}; {row['folder']}", highlight=False, soft_wrap=True)
    if len(found["failures"]) > SHOWN:
        console.print(f"... and {len(found['failures']) - SHOWN} more", highlight=False)
