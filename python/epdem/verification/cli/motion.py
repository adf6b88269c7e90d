# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem verify motion`."""

from pathlib import Path
from typing import Annotated

import typer

from ...base.terminal import status
from ...cli.options import AsJson, CasePath, Engines, Force, Laws, Out
from .answer import answer


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
    from ..motion.compare import compare

    with status() as progress:
        outcome = compare(
            case, files=file or [], engines=engine or [], laws=law or [], out=out, force=force, progress=progress
        )
    raise answer(outcome, as_json, f"motions, forces and torques: {outcome.folder}/LAW/ENGINE/MOTION/motion.json")
