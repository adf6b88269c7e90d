# SPDX-License-Identifier: GPL-2.0-or-later
"""Options that several commands share, and the console they print on."""

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

CasePath = Annotated[Path, typer.Argument(metavar="CASE", help="case file (TOML)")]
Engines = Annotated[
    list[str] | None,
    typer.Option(
        "--engine", "-e", help="embedded, liggghts, yade, liggghts-hertz, liggghts-thornton_ning; repeat for more"
    ),
]
Laws = Annotated[
    list[str] | None,
    typer.Option("--law", "-l", help="hertz, thornton, johnson or cavity instead of the case's law; repeat for more"),
]
Out = Annotated[Path | None, typer.Option("--out", "-o", help="folder for the results (default: runs/<case>)")]
AsJson = Annotated[bool, typer.Option("--json", help="print one JSON document and nothing else")]


def console() -> Console:
    """As wide as the terminal, or wide enough for our tables in a pipe."""
    found = Console()
    return found if found.is_terminal else Console(width=170)


def quantity(option: str, text: str, unit: str) -> float:
    """The SI value > 0 of an option's text. Raises CaseError that names the option."""
    from ..case.units import to_si, within_limits
    from ..errors import CaseError

    try:
        value = within_limits(to_si(text, unit), unit)
    except ValueError as error:
        raise CaseError(f"{option} {text!r}: {error}") from None
    if not value > 0:
        raise CaseError(f"{option} {text!r}: must be > 0 {unit}")
    return value
