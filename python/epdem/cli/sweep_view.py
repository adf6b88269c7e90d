# SPDX-License-Identifier: GPL-2.0-or-later
"""The output of a sweep on the console."""

import contextlib
import json
from collections.abc import Iterator
from typing import Any

from rich.console import Console
from rich.progress import MofNCompleteColumn, TimeRemainingColumn

from ..base.terminal import bar, show_table, table
from ..studies.sweep.folder import DONE, FAILED, Sweep
from ..studies.sweep.run import Report, SweepOutcome

SHOWN = 20  # failed points


def points(sweep: Sweep, as_json: bool, console: Console) -> None:
    """Print every point."""
    if as_json:
        print(json.dumps({"case": sweep.name, "points": sweep.points}, indent=1))
        return
    title = f"{sweep.name}: {len(sweep.points)} points on {', '.join(sweep.engines)}"
    shown = table(title, ("point", *sweep.points[0]))
    for n, point in enumerate(sweep.points, start=1):
        shown.add_row(str(n), *map(str, point.values()))
    show_table(console, shown)


@contextlib.contextmanager
def progress() -> Iterator[Report]:
    """A bar with the time left, on a terminal."""
    with bar(MofNCompleteColumn(), TimeRemainingColumn()) as shown:
        task = shown.add_task("points", total=None)
        yield lambda done, total: shown.update(task, completed=done, total=total)


def outcome(result: SweepOutcome, as_json: bool, console: Console) -> None:
    """Print the failed points and a summary."""
    counts = {state: result.count(state) for state in (DONE, FAILED)}
    failed = result.table[result.table["status"] == FAILED]
    if as_json:
        failures = failed[["point", "folder", "reason"]].to_dict("records")
        about = {"case": result.sweep.name, "passed": result.passed, "folder": str(result.folder), "ran": result.ran}
        print(json.dumps(about | counts | {"failures": failures}, indent=1))
        return
    for row in failed.head(SHOWN).to_dict("records"):
        console.print(f"point {row['point']} failed: {row['reason']}", style="red", soft_wrap=True)
    if len(failed) > SHOWN:
        console.print(f"... and {len(failed) - SHOWN} more", style="red")
    outside = result.table[(result.table["status"] == DONE) & ~result.table["passed"]]["point"].nunique()
    text = f"{counts[DONE]} of {len(result.sweep.points)} points done, {result.ran} of them just now"
    text += f"; {counts[FAILED]} failed (--retry-failed runs them again)" if counts[FAILED] else ""
    text += f"; {outside} outside tolerance" if outside else ""
    console.print(f"{result.sweep.name}: {text}; see {result.folder}/sweep.csv and report.html", soft_wrap=True)


def status(summary: dict[str, Any], console: Console) -> None:
    """Print the status of a sweep."""
    states = ", ".join(f"{summary[state]} {state}" for state in ("waiting", "running", "done", "failed"))
    console.print(f"{summary['case']}: {summary['points']} points: {states}", soft_wrap=True)
    if summary["done"] + summary["failed"]:
        left = f"; about {summary['work_left']:.3g} s of work left" if summary["work_left"] else ""
        console.print(f"{summary['seconds']:.3g} s of work, longest point {summary['longest']:.3g} s{left}")
    for row in summary["failures"][:SHOWN]:
        console.print(f"point {row['point']} failed: {row['reason']}; {row['folder']}", soft_wrap=True)
    if len(summary["failures"]) > SHOWN:
        console.print(f"... and {len(summary['failures']) - SHOWN} more")
