# SPDX-License-Identifier: GPL-2.0-or-later
"""Consoles, tables and progress. Text is printed unchanged, even if it has the form of rich's markup."""

import contextlib
import copy
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from typing import Any

from rich.cells import cell_len
from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, TextColumn, TimeElapsedColumn
from rich.table import Table
from rich.text import Text


def console() -> Console:
    """A console as wide as the terminal; in a pipe 170 columns, enough for every table."""
    screen = Console(markup=False, emoji=False, highlight=False)
    return screen if screen.is_terminal else Console(width=170, markup=False, emoji=False, highlight=False)


def table(title: str, heads: Iterable[str], *, left: Collection[str] = ()) -> Table:
    """An empty table; columns are aligned right but those named in `left`."""
    shown = Table(title=Text(title))
    for head in heads:
        shown.add_column(Text(head), justify="left" if head in left else "right", no_wrap=True)
    return shown


def make_table(
    title: str, columns: Sequence[tuple[str, str]], rows: Iterable[dict[Any, Any]], *, left: Collection[str] = ()
) -> Table:
    """A table of columns (head, form of a cell, with a row's values by name); a row that has not passed is red."""
    shown = table(title, [head for head, _ in columns], left=left)
    for row in rows:
        shown.add_row(*(form.format(**row) for _, form in columns), style=None if row["passed"] else "red")
    return shown


def show_table(screen: Console, shown: Table) -> None:
    """Print a table; where it is wider than the terminal, in parts, each with the first column: no text is cut."""
    for column in shown.columns:
        column.min_width = max(cell_len(str(text)) for text in (column.header, *column.cells))
    first, *others = shown.columns
    while True:
        part = copy.copy(shown)
        part.columns, others = [first, *others[:1]], others[1:]
        while others and 1 + sum(3 + (c.min_width or 0) for c in (*part.columns, others[0])) <= screen.width:
            part.columns.append(others.pop(0))
        screen.print(part)
        if not others:
            return
        shown.title = None


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
