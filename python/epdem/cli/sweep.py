# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands `epdem sweep` and `epdem status`."""

import json
from pathlib import Path
from typing import Annotated

import typer

from ..terminal import console
from .options import AsJson, CasePath, Engines, Laws, Out


def sweep(
    case: CasePath,
    given: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="KEY=VALUES", help='values: "1 mm,2 mm", "1 GPa..2 GPa:16", "log:1 m/s..9 m/s:5"; repeat'
        ),
    ] = None,
    points: Annotated[Path | None, typer.Option("--points", help="CSV file, a column per key")] = None,
    latin_hypercube: Annotated[int | None, typer.Option(help="so many points within the ranges")] = None,
    seed: Annotated[int, typer.Option(min=0, help="of the latin hypercube")] = 1,
    engine: Engines = None,
    law: Laws = None,
    ranks: Annotated[int, typer.Option(min=1, max=1024, help="MPI ranks of each point")] = 1,
    jobs: Annotated[int | None, typer.Option("--jobs", "-j", min=1, help="points at once (default: cores)")] = None,
    out: Out = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="check and print the points; nothing runs")] = False,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="run failed points again")] = False,
    force: Annotated[bool, typer.Option("--force", help="write into a folder that holds other files")] = False,
    as_json: AsJson = False,
) -> None:
    """A case or scene at many points; the same command again does only what is missing or has changed."""
    from ..studies.sweep import run as study
    from ..studies.sweep.points import settings
    from . import sweep_view

    planned = study.plan(
        case,
        settings(given or []),
        engines=engine or [],
        laws=law or [],
        ranks=ranks,
        table=points,
        latin_hypercube=latin_hypercube,
        seed=seed,
    )
    if dry_run:
        study.check_points(planned, range(1, len(planned.points) + 1), jobs)
        sweep_view.points(planned, as_json, console())
        return
    folder = out or Path("runs") / f"{planned.name}_sweep"
    with sweep_view.progress() as report:
        outcome = study.run(planned, folder, jobs=jobs, retry_failed=retry_failed, force=force, report=report)
    sweep_view.outcome(outcome, as_json, console())
    raise typer.Exit(0 if outcome.passed else 1)


def status(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="folder of a sweep")],
    as_json: AsJson = False,
) -> None:
    """How far a sweep is: points waiting, running, done and failed, with times and reasons."""
    from ..studies.sweep.run import status as ask
    from . import sweep_view

    found = ask(folder)
    if as_json:
        print(json.dumps(sweep_view.plain(found), indent=1))
    else:
        sweep_view.status(found, console())
