# SPDX-License-Identifier: GPL-2.0-or-later
"""Options that several commands share."""

import json
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

import typer

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


def laws_or_own(names: list[str] | None) -> list[str] | list[None]:
    """The laws named by --law, each once; None, the case's own, without any."""
    return list(dict.fromkeys(names)) if names else [None]


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


def print_files(paths: Iterable[Path], as_json: bool) -> None:
    """Print the files that a command has written."""
    names = list(map(str, paths))
    print(json.dumps({"files": names}) if as_json else "\n".join(names))


def warn(sentence: str) -> None:
    """Print a warning on standard error, for commands whose output is a list of files."""
    print(f"warning: {sentence}", file=sys.stderr)
