# SPDX-License-Identifier: GPL-2.0-or-later
"""Consoles, tables and progress. Text is printed unchanged, even if it has the form of rich's markup."""

import contextlib
import math
import sys
from collections.abc import Callable, Collection, Iterable, Iterator
from typing import TYPE_CHECKING, Literal

from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, TextColumn, TimeElapsedColumn
from rich.table import Table
from rich.text import Text

if TYPE_CHECKING:  # slow to import, and most commands begin by printing nothing
    import pandas as pd


def console() -> Console:
    """As wide as the terminal, or wide enough for our tables in a pipe."""
    screen = Console(markup=False, emoji=False, highlight=False)
    return screen if screen.is_terminal else Console(width=170, markup=False, emoji=False, highlight=False)


def table(title: str, heads: Iterable[str], *, left: Collection[str] = (), wrap: bool = False) -> Table:
    """An empty table; columns are aligned right but those named in `left`. `wrap`: all but the first may wrap."""
    shown = Table(title=Text(title))
    for k, head in enumerate(heads):
        side: Literal["left", "right"] = "left" if head in left else "right"
        shown.add_column(Text(head), justify=side, no_wrap=not wrap or k == 0, min_width=6 if wrap else None)
    return shown


def show_table(screen: Console, shown: Table, spare: Iterable[str]) -> None:
    """Print a table; where it is wider than the terminal, without columns of `spare`, from the first on, as few as
    will do, and with a line that names them."""
    absent = []
    for head in spare:
        if screen.measure(shown, options=screen.options.update(max_width=10_000)).maximum <= screen.width:
            break
        found = [column for column in shown.columns if str(column.header) == head]
        if found:
            shown.columns.remove(found[-1])
            absent.append(head)
    screen.print(shown)
    if absent:
        screen.print(f"left out, as the terminal is narrow: {', '.join(absent)}", markup=False, highlight=False)


def cell(value: object) -> str:
    """A table cell: three digits, a dash for NaN."""
    if isinstance(value, float):
        return "-" if math.isnan(value) else f"{value:.3g}"
    return str(value)


def frame_table(title: str, frame: "pd.DataFrame") -> Table:
    """A DataFrame as a table; long headings wrap."""
    shown = table(title, map(str, frame.columns), wrap=True)
    for row in frame.itertuples(index=False):
        shown.add_row(*map(cell, row))
    return shown


@contextlib.contextmanager
def status() -> Iterator[Callable[[str], None]]:
    """A temporary line of progress on standard error; yields the function that changes it."""
    with Console(stderr=True).status("") as line:
        yield lambda text: line.update(Text(text))


def bar(*columns: ProgressColumn) -> Progress:
    """A progress bar on standard error that vanishes at the end; none where that is no terminal."""
    return Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        *columns,
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
        disable=not sys.stderr.isatty(),
    )
