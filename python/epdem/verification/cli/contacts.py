# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem verify contacts`."""

import json
from pathlib import Path
from typing import Annotated

import typer

from ...base.terminal import console, show_table, status
from ...cli.options import AsJson, Engines, Force, Out
from ..tables import frame_table


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
    from ...impacts.report import records
    from ..contacts import compare

    with status() as progress:
        outcome = compare(files or [], engines=engine or [], out=out, force=force, progress=progress)
    if as_json:
        said = {"passed": outcome.passed, "folder": str(outcome.folder), "rows": records(outcome.rows)}
        print(json.dumps(said, indent=1))
    else:
        show_table(console(), frame_table("errors over the tolerances of the files", outcome.rows))
        console().print(f"table: {outcome.folder}/contacts.csv")
    raise typer.Exit(0 if outcome.passed else 1)
