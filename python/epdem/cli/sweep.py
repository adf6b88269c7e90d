# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands `epdem sweep` and `epdem status`."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.text import Text

from ..base.terminal import Shown, bar, frame_table, warned
from ..errors import CaseError
from .options import AsJson, CasePath, Engines, Force, Laws, Out, answer, refuse_options

if TYPE_CHECKING:  # slow to import
    from ..studies.sweep.run import SweepOutcome

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
    only: Annotated[
        str | None, typer.Option(help="run these points alone, as 7,9-12, beside other such calls; writes no table")
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="check and print the points; nothing runs")] = False,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="run failed points again")] = False,
    slurm: Annotated[
        list[str] | None,
        typer.Option(help="submit an array with these parameters of sbatch, as partition=P,time=1:00:00; repeat"),
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Run a case or scene at many points; the same command again runs only missing and changed points."""
    from ..studies.sweep.points import numbers, settings
    from ..studies.sweep.run import check_points, plan
    from ..studies.sweep.run import run as run_points
    from ..studies.sweep.slurm import parameters, submit
    from ..studies.sweep.table import points_of

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
    chosen = None if only is None else numbers(only, len(planned.points))
    folder = out or planned.default_folder
    if dry_run:
        refuse_options(case, "nothing runs", only=only, slurm=slurm, retry_failed=retry_failed, force=force)
        check_points(planned, range(1, len(planned.points) + 1), jobs, plans=True)
        title = f"{planned.name}: {len(planned.points)} points on {', '.join(planned.engines)}"
        document = {"case": planned.name, "points": planned.points}
        raise answer(document, [frame_table(title, points_of(planned))], as_json)
    if slurm:
        refuse_options(case, "the jobs of --slurm run all points", only=only)
        refuse_options(case, "give the jobs of a cluster by --slurm array_parallelism=N", jobs=jobs)
        array = submit(planned, folder, parameters(slurm), retry_failed=retry_failed, force=force)
        if array:
            text = f"{planned.name}: array {array} submitted; epdem status {folder} shows its progress"
            raise answer({"case": planned.name, "folder": str(folder), "array": array}, [text], as_json)
    with bar(planned.name, "points") as report:
        outcome = run_points(
            planned,
            folder,
            jobs=jobs,
            retry_failed=retry_failed,
            force=force,
            only=chosen,
            report=report,
        )
    if chosen is None:
        outcome.report()
    raise _answer(outcome, as_json, only=chosen is not None)


def status(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="folder of a sweep")],
    table: Annotated[bool, typer.Option("--table", help="write sweep.csv of what is there")] = False,
    as_json: AsJson = False,
) -> None:
    """Print the progress of a sweep: points waiting, running, done and failed, with times and reasons."""
    from ..impacts.prediction_report import plain
    from ..studies.sweep import folder as store
    from ..studies.sweep.table import write

    state = store.status(folder)
    if table:
        write(store.read(folder), folder)
    raise answer({name: plain(value) for name, value in state.items()}, _progress(state), as_json)


def _failed(failures: list[dict[str, Any]]) -> list[Shown]:
    """The first failed points, each with its reason."""
    shown: list[Shown] = [
        Text(f"point {row['point']} failed: {row['reason']}; {row['folder']}", style="red") for row in failures[:SHOWN]
    ]
    left = len(failures) - SHOWN
    return [*shown, Text(f"... and {left} more", style="red")] if left > 0 else shown


def _answer(result: "SweepOutcome", as_json: bool, *, only: bool) -> typer.Exit:
    from ..studies.sweep.folder import DONE, FAILED

    counts = {state: result.count(state) for state in (DONE, FAILED)}
    failures = result.table[result.table["status"] == FAILED][["point", "folder", "reason"]].to_dict("records")
    about = {"case": result.sweep.name, "passed": result.passed, "folder": str(result.folder), "ran": result.ran}
    outside = result.table[(result.table["status"] == DONE) & ~result.table["passed"]]["point"].nunique()
    text = f"{counts[DONE]} of {result.table['point'].nunique()} points done, {result.ran} of them just now"
    text += f"; {counts[FAILED]} failed (--retry-failed runs them again)" if counts[FAILED] else ""
    text += f"; {outside} outside tolerance" if outside else ""
    there = f"see {result.folder}/sweep.csv and report.html"
    if only:
        there = f"the same command without --only writes {result.folder}/sweep.csv and report.html"
    summary = f"{result.sweep.name}: {text}; {there}"
    document = about | counts | {"failures": failures, "warnings": result.warnings}
    return answer(document, [*_failed(failures), *warned(result.warnings), summary], as_json, result.passed)


def _progress(state: dict[str, Any]) -> list[Shown]:
    states = ", ".join(f"{state[name]} {name}" for name in ("waiting", "running", "done", "failed"))
    shown = [f"{state['case']}: {state['points']} points: {states}"]
    if state["done"] + state["failed"]:
        left = f"; about {state['work_left']:.3g} s of work left" if state["work_left"] else ""
        shown.append(f"{state['seconds']:.3g} s of work, longest point {state['longest']:.3g} s{left}")
    return [*shown, *_failed(state["failures"])]
