# SPDX-License-Identifier: GPL-2.0-or-later
"""Output and exit code of the studies of the runner."""

import json
from typing import TYPE_CHECKING

import typer

from ...base.terminal import console, show_table
from ..tables import frame_table

if TYPE_CHECKING:  # slow to import
    from ..runner import Outcome


def answer(outcome: "Outcome", as_json: bool, note: str) -> typer.Exit:
    """Print the rows of a study, and a line with its files; the exit code is 1 if a row has not passed."""
    from ...impacts.report import records

    if as_json:
        said = {"passed": outcome.passed, "folder": str(outcome.folder), "rows": records(outcome.rows)}
        print(json.dumps(said, indent=1))
    else:
        show_table(console(), frame_table(outcome.study.title, outcome.rows))
        console().print(note, soft_wrap=True)
    return typer.Exit(0 if outcome.passed else 1)
