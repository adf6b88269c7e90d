# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem verify contacts`."""

from pathlib import Path
from typing import Annotated

import typer

from ...base.terminal import status
from ...cli.options import AsJson, Engines, Force, Out
from .answer import answer


def contacts(
    files: Annotated[list[Path] | None, typer.Argument(help="YAML files, a CSV file beside each; else ours")] = None,
    engine: Engines = None,
    out: Out = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Run the tests of plastic contacts, which other codes can run, too: forces of prescribed motions, and impacts.

    Default engines: embedded and liggghts. References and tolerances are in the files (docs/plastic_contacts.md).
    """
    from ..contacts import compare

    with status() as progress:
        outcome = compare(files or [], engines=engine or [], out=out, force=force, progress=progress)
    raise answer(outcome, as_json, f"table: {outcome.folder}/contacts.csv")
