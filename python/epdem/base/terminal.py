# SPDX-License-Identifier: GPL-2.0-or-later
"""Consoles, tables and progress. Text is printed unchanged, even if it has the form of rich's markup."""

import contextlib
import copy
import math
import sys
from collections.abc import Callable, Collection, Iterable, Iterator
from typing import TYPE_CHECKING, Literal

from rich.cells import cell_len
from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, TextColumn, TimeElapsedColumn
from rich.table import Column, Table
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


def show_table(screen: Console, shown: Table, spare: Iterable[str] = ()) -> None:
    """Print a table; where it is wider than the terminal, without columns of `spare`, from the first on, as few as
    will do, and with a line that names them. What is still too wide comes in parts, each with the first column."""
    absent = []
    for head in spare:
        if _width(shown) <= screen.width:
            break
        found = [column for column in shown.columns if str(column.header) == head]
        if found:
            shown.columns.remove(found[-1])
            absent.append(head)
    for column in shown.columns:
        column.min_width = _longest(column)  # else rich cuts words
    first, *others = shown.columns
    while True:
        part = copy.copy(shown)
        part.columns = [first, *others[:1]]
        others = others[1:]
        while others and _width(_with(part, others[0])) <= screen.width:
            part.columns.append(others.pop(0))
        screen.print(part)
        if not others:
            break
        shown.title = None
    if absent:
        screen.print(f"left out, as the terminal is narrow: {', '.join(absent)}")


def _with(shown: Table, column: Column) -> Table:
    wider = copy.copy(shown)
    wider.columns = [*shown.columns, column]
    return wider


def _width(shown: Table) -> int:
    """Of a table in which no text is cut."""
    return 1 + sum(3 + _longest(column) for column in shown.columns)


def _longest(column: Column) -> int:
    """Width of the longest text of a column, or of its longest word where it may wrap."""
    texts = [str(text) for text in (column.header, *column.cells)]
    parts = texts if column.no_wrap else [word for text in texts for word in text.split()]
    return max(column.min_width or 0, *map(cell_len, parts or [""]))


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
