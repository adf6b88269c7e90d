# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem verify motion`."""

import json
from pathlib import Path
from typing import Annotated

import typer

from ...base.terminal import console, show_table, status
from ...cli.options import AsJson, CasePath, Engines, Force, Laws, Out
from ..tables import frame_table


def motion(
    case: CasePath,
    file: Annotated[
        list[Path] | None,
        typer.Option("--motion", "-m", help="JSON or CSV file of a motion instead of our own six; repeat for more"),
    ] = None,
    engine: Engines = None,
    law: Laws = None,
    out: Out = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Prescribe the motion of two spheres and compare forces and torques between engines, step by step.

    Default engines: embedded and liggghts; the first one is what the others are compared with, at 1e-9 of its force.
    """
    from ...impacts.report import records
    from ..motion.compare import compare

    with status() as progress:
        outcome = compare(
            case, files=file or [], engines=engine or [], laws=law or [], out=out, force=force, progress=progress
        )
    if as_json:
        said = {"passed": outcome.passed, "folder": str(outcome.folder), "rows": records(outcome.rows)}
        print(json.dumps(said, indent=1))
    else:
        show_table(console(), frame_table("deviations from the first engine, over its largest force", outcome.rows))
        console().print(f"motions, forces and torques: {outcome.folder}/LAW/ENGINE/MOTION/motion.json")
    raise typer.Exit(0 if outcome.passed else 1)
