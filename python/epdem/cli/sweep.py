# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands `epdem sweep` and `epdem status`."""

import contextlib
import json
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..base.terminal import bar, console, show_table, table
from ..errors import CaseError
from .options import AsJson, CasePath, Engines, Force, Laws, Out, refuse_options

if TYPE_CHECKING:  # slow to import
    from rich.console import Console

    from ..studies.sweep.folder import Sweep
    from ..studies.sweep.run import Report, SweepOutcome

SHOWN = 20  # failed points


def sweep(
    case: CasePath,
    given: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="KEY=VALUES", help='values: "1 mm,2 mm", "1 GPa..2 GPa:16", "log:1 m/s..9 m/s:5"; repeat'
        ),
    ] = None,
    points: Annotated[Path | None, typer.Option("--points", help="CSV file, a column per key")] = None,
    latin_hypercube: Annotated[int | None, typer.Option(help="number of points within the ranges")] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="of the latin hypercube (default: 1)")] = None,
    engine: Engines = None,
    law: Laws = None,
    ranks: Annotated[int, typer.Option(min=1, max=1024, help="MPI ranks of each point")] = 1,
    jobs: Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="points at once (default: cores)")] = None,
    out: Out = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="check and print the points; nothing runs")] = False,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="run failed points again")] = False,
    slurm: Annotated[
        list[str] | None,
        typer.Option(help="jobs of a cluster with these parameters of sbatch, as partition=P,time=1:00:00; repeat"),
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Run a case or scene at many points; the same command again runs only missing and changed points."""
    from ..studies.pages import write_sweep_page
    from ..studies.sweep.points import settings
    from ..studies.sweep.run import check_points, plan
    from ..studies.sweep.run import run as run_points
    from ..studies.sweep.slurm import parameters, run_jobs

    if seed is not None and latin_hypercube is None:
        raise CaseError("--seed goes with --latin-hypercube; leave it out")
    planned = plan(
        case,
        settings(given or []),
        engines=engine or [],
        laws=law or [],
        ranks=ranks,
        table=points,
        latin_hypercube=latin_hypercube,
        seed=1 if seed is None else seed,
    )
    if dry_run:
        refuse_options(case, "nothing runs", slurm=slurm, retry_failed=retry_failed, force=force)
        check_points(planned, range(1, len(planned.points) + 1), jobs, plans=True)
        _show_points(planned, as_json, console())
        return
    if slurm:
        refuse_options(case, "give the jobs of a cluster by --slurm array_parallelism=N", jobs=jobs)
    by = partial(run_jobs, given=parameters(slurm)) if slurm else None
    with progress() as report:
        outcome = run_points(
            planned,
            out or planned.default_folder,
            jobs=jobs,
            by=by,
            retry_failed=retry_failed,
            force=force,
            report=report,
        )
    write_sweep_page(outcome)
    _show_outcome(outcome, as_json, console())
    raise typer.Exit(0 if outcome.passed else 1)


def status(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="folder of a sweep")],
    table: Annotated[bool, typer.Option("--table", help="write sweep.csv of what is there")] = False,
    as_json: AsJson = False,
) -> None:
    """Print the progress of a sweep: points waiting, running, done and failed, with times and reasons."""
    from ..impacts.report import plain
    from ..studies.sweep import folder as store
    from ..studies.sweep.slurm import status as ask
    from ..studies.sweep.table import write

    state = ask(folder)
    if table:
        write(store.read(folder), folder)
    if as_json:
        print(json.dumps({name: plain(value) for name, value in state.items()}, indent=1))
    else:
        _show_status(state, console())


def _show_points(sweep: "Sweep", as_json: bool, screen: "Console") -> None:
    """Print every point."""
    if as_json:
        print(json.dumps({"case": sweep.name, "points": sweep.points}, indent=1))
        return
    title = f"{sweep.name}: {len(sweep.points)} points on {', '.join(sweep.engines)}"
    shown = table(title, ("point", *sweep.points[0]))
    for n, point in enumerate(sweep.points, start=1):
        shown.add_row(str(n), *map(str, point.values()))
    show_table(screen, shown)


@contextlib.contextmanager
def progress() -> "Iterator[Report]":
    """A bar with the time left, on a terminal."""
    from rich.progress import MofNCompleteColumn, TimeRemainingColumn

    with bar(MofNCompleteColumn(), TimeRemainingColumn()) as shown:
        task = shown.add_task("points", total=None)
        yield lambda done, total: shown.update(task, completed=done, total=total)


def _show_outcome(result: "SweepOutcome", as_json: bool, screen: "Console") -> None:
    """Print the failed points and a summary."""
    from ..studies.sweep.folder import DONE, FAILED

    counts = {state: result.count(state) for state in (DONE, FAILED)}
    failed = result.table[result.table["status"] == FAILED]
    if as_json:
        failures = failed[["point", "folder", "reason"]].to_dict("records")
        about = {"case": result.sweep.name, "passed": result.passed, "folder": str(result.folder), "ran": result.ran}
        print(json.dumps(about | counts | {"failures": failures, "warnings": result.warnings}, indent=1))
        return
    for row in failed.head(SHOWN).to_dict("records"):
        screen.print(f"point {row['point']} failed: {row['reason']}", style="red", soft_wrap=True)
    if len(failed) > SHOWN:
        screen.print(f"... and {len(failed) - SHOWN} more", style="red")
    for warning in result.warnings:
        screen.print(f"warning: {warning}", style="yellow", soft_wrap=True)
    outside = result.table[(result.table["status"] == DONE) & ~result.table["passed"]]["point"].nunique()
    text = f"{counts[DONE]} of {len(result.sweep.points)} points done, {result.ran} of them just now"
    text += f"; {counts[FAILED]} failed (--retry-failed runs them again)" if counts[FAILED] else ""
    text += f"; {outside} outside tolerance" if outside else ""
    screen.print(f"{result.sweep.name}: {text}; see {result.folder}/sweep.csv and report.html", soft_wrap=True)


def _show_status(summary: dict[str, Any], screen: "Console") -> None:
    """Print the status of a sweep."""
    states = ", ".join(f"{summary[state]} {state}" for state in ("waiting", "running", "done", "failed"))
    screen.print(f"{summary['case']}: {summary['points']} points: {states}", soft_wrap=True)
    if summary["done"] + summary["failed"]:
        left = f"; about {summary['work_left']:.3g} s of work left" if summary["work_left"] else ""
        screen.print(f"{summary['seconds']:.3g} s of work, longest point {summary['longest']:.3g} s{left}")
    for row in summary["failures"][:SHOWN]:
        screen.print(f"point {row['point']} failed: {row['reason']}; {row['folder']}", soft_wrap=True)
    if len(summary["failures"]) > SHOWN:
        screen.print(f"... and {len(summary['failures']) - SHOWN} more")
