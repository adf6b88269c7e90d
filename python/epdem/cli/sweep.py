# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands `epdem sweep` and `epdem status`."""

import json
from pathlib import Path
from typing import Annotated

import typer

from ..base.terminal import console
from ..errors import CaseError
from .options import AsJson, CasePath, Engines, Force, Laws, Out, refuse


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
    executor: Annotated[str, typer.Option(help="local, or slurm: jobs of a cluster")] = "local",
    slurm: Annotated[
        list[str] | None, typer.Option(help="partition=P,time=1:00:00,..., or a file of #SBATCH lines; repeat")
    ] = None,
    write_script: Annotated[
        Path | None, typer.Option(help="write a batch script to submit by hand; nothing runs")
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Run a case or scene at many points; the same command again runs only missing and changed points."""
    from ..studies.pages import of_sweep
    from ..studies.sweep import slurm as study
    from ..studies.sweep.points import settings
    from ..studies.sweep.run import check_points, plan
    from . import sweep_view

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
    if dry_run or write_script:
        reason = "nothing runs"
        local = None if executor == "local" else executor
        refuse(case, reason, executor=local, jobs=jobs if write_script else None, retry_failed=retry_failed)
        refuse(
            case, reason, json=as_json and write_script, slurm=None if write_script else slurm, force=force and dry_run
        )
    if dry_run:
        check_points(planned, range(1, len(planned.points) + 1), jobs)
        sweep_view.points(planned, as_json, console())
        return
    folder = out or planned.default_folder
    if write_script:
        study.write_script(planned, folder, slurm or [], write_script, force=force)
        print(f"sbatch {write_script}")
        return
    with sweep_view.progress() as report:
        outcome = study.execute(
            planned, folder, executor, slurm or [], jobs=jobs, retry_failed=retry_failed, force=force, report=report
        )
    of_sweep(outcome)
    sweep_view.outcome(outcome, as_json, console())
    raise typer.Exit(0 if outcome.passed else 1)


def status(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="folder of a sweep")],
    table: Annotated[bool, typer.Option("--table", help="write sweep.csv and sweep.h5 of what is there")] = False,
    as_json: AsJson = False,
) -> None:
    """Print the progress of a sweep: points waiting, running, done and failed, with times and reasons."""
    from ..impacts.report import plain
    from ..studies.sweep import folder as store
    from ..studies.sweep.status import status as ask
    from ..studies.sweep.table import write
    from . import sweep_view

    state = ask(folder)
    if table:
        write(store.read(folder), folder)
    if as_json:
        print(json.dumps({name: plain(value) for name, value in state.items()}, indent=1))
    else:
        sweep_view.status(state, console())


def points(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="folder of a sweep")],
    task: Annotated[int, typer.Option(min=1, help="this task's number")],
    tasks: Annotated[int, typer.Option(min=1, help="how many tasks share the points")],
) -> None:
    """A task of a batch script: its share of the points of a sweep."""
    from ..studies.sweep import folder as store
    from ..studies.sweep.slurm import share, work

    work(folder, share(range(1, len(store.read(folder).points) + 1), task, tasks))
