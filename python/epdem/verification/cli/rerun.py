# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem verify rerun`."""

import json
from pathlib import Path
from typing import Annotated

import typer

from ...base.terminal import console, status
from ...cli.options import AsJson


def rerun(
    file: Annotated[Path, typer.Argument(metavar="results.h5", help="results file of impacts or of a scene")],
    as_json: AsJson = False,
) -> None:
    """Repeat a stored run from its results file alone and compare: the same decks and numbers (exit code 0), or not."""
    from ..rerun import rerun as repeat

    with status() as progress:
        found = repeat(file, progress)
    if as_json:
        document = {"file": str(file), "same": found.same, "versions": found.versions, "differences": found.differences}
        print(json.dumps(document, indent=1))
        raise typer.Exit(0 if found.same else 1)
    screen = console()
    for name, (before, now) in found.versions.items():
        screen.print(f"{name}: {before} then, {now} now", style="yellow", soft_wrap=True)
    for name, difference in found.differences.items():
        screen.print(f"{name}: {difference or 'the same'}", style="red" if difference else None, soft_wrap=True)
    screen.print(f"{file}: {'everything is the same' if found.same else 'not everything is the same'}", soft_wrap=True)
    raise typer.Exit(0 if found.same else 1)
