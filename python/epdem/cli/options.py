# SPDX-License-Identifier: GPL-2.0-or-later
"""Options that several commands share."""

import json
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.table import Table

from ..base.terminal import Shown, console, show_table
from ..errors import CaseError

FORMATS = ("png", "svg", "pdf")  # of figures
CasePath = Annotated[Path, typer.Argument(metavar="CASE", help="case file (TOML)")]
Engines = Annotated[
    list[str] | None,
    typer.Option("--engine", "-e", help="engine, as embedded ('epdem doctor' lists them); repeat for more"),
]
Laws = Annotated[
    list[str] | None,
    typer.Option(
        "--law",
        "-l",
        help="law instead of the case's, with its default numbers ('epdem predict' lists them); repeat for more",
    ),
]
Out = Annotated[Path | None, typer.Option("--out", "-o", help="folder for the results (default: runs/<case>)")]
Force = Annotated[bool, typer.Option("--force", help="write into a folder that holds other files")]
Replace = Annotated[bool, typer.Option("--force", help="replace an existing file")]
Formats = Annotated[
    list[str] | None,
    typer.Option(
        "--format",
        help="of the figures: png, svg or pdf (default: png); csv: also contacts.csv of a scene; repeat for more",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="print one JSON document and nothing else")]


def formats(chosen: list[str] | None) -> tuple[str, ...]:
    """The formats of figures, each once; png without any. Raises CaseError."""
    for name in chosen or []:
        if name not in FORMATS:
            raise CaseError(f"--format {name}: not one of {', '.join(FORMATS)}; choose one of these")
    return tuple(dict.fromkeys(chosen or ["png"]))


def refuse_options(place: object, reason: str, **given: object) -> None:
    """Raise CaseError for the first option of `given` with a value: no option of these has an effect here."""
    for name, value in given.items():
        if not (value is None or value is False or value == []):
            raise CaseError(f"{place}: --{name.replace('_', '-')}: {reason}; leave it out")


def answer(document: object, shown: Iterable[Shown], as_json: bool, passed: bool = True) -> typer.Exit:
    """Print a JSON document, or tables and lines; the exit code is 1 for what has not passed."""
    if as_json:
        print(json.dumps(document, indent=1, default=_value))
        return typer.Exit(0 if passed else 1)
    screen = console()
    for part in shown:
        if isinstance(part, Table):
            show_table(screen, part)
        else:
            screen.print(part, soft_wrap=True)
    return typer.Exit(0 if passed else 1)


def _value(value: Any) -> Any:
    """A table of a JSON document as a list of rows, a path as text."""
    from ..impacts.summary import records

    return str(value) if isinstance(value, Path) else records(value)


def warn(sentence: str) -> None:
    """Print a warning on standard error, for commands whose output is a list of files."""
    print(f"warning: {sentence}", file=sys.stderr)
