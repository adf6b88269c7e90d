# SPDX-License-Identifier: GPL-2.0-or-later
"""Consoles, tables and progress. Text is printed unchanged, even if it has the form of rich's markup."""

import contextlib
import copy
import sys
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from itertools import repeat
from typing import TYPE_CHECKING, Protocol, TypeAlias

from rich.cells import cell_len
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.table import Table
from rich.text import Text

if TYPE_CHECKING:  # slow to import
    import numpy as np
    import pandas as pd

EVERY = 60.0  # [s] between lines of progress in a log
Shown: TypeAlias = Table | Text | str  # what `show` prints


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


def cell(value: object, digits: int = 5) -> str:
    """A value as text: five digits, a dash for NaN, yes or no for a truth value."""
    if type(value).__name__.startswith("bool"):  # numpy's, too
        return "yes" if value else "no"
    if isinstance(value, float):
        return "-" if value != value else f"{value + 0.0:.{digits}g}"  # no -0
    return str(value)


def digits_of(names: Iterable[object], digits: int = 5) -> list[int]:
    """The digits of columns: errors have two."""
    return [2 if str(name).endswith("error") else digits for name in names]


def heads(names: Iterable[object], units: Mapping[str, str]) -> dict[str, str]:
    """The heads of columns: their names with their units."""
    return {name: f"{name} [{units[name]}]" if units.get(name) else name for name in map(str, names)}


def frame_table(
    title: str,
    frame: "pd.DataFrame | Mapping[str, np.ndarray]",
    columns: Mapping[str, str] | None = None,
    *,
    digits: int = 5,
) -> Table:
    """The `columns` (head by name; all without any) of a frame or of arrays by name, errors with two digits; red: rows
    not `passed`."""
    columns = columns or heads(frame, {})
    left = [head for name, head in columns.items() if frame[name].dtype.kind not in "biufc"]
    shown, many = table(title, columns.values(), left=left), digits_of(columns, digits)
    passed = frame["passed"] if "passed" in frame else repeat(True)
    for *row, good in zip(*(frame[name] for name in columns), passed, strict=False):
        shown.add_row(*map(cell, row, many), style=None if good else "red")
    return shown


def warned(warnings: Iterable[str]) -> list[Text]:
    """Warnings as lines of the terminal."""
    return [Text(f"warning: {warning}", style="yellow") for warning in warnings]


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


class Bar(Protocol):
    """Takes how many are done, of how many, and where that is."""

    def __call__(self, done: int, total: int, where: str = "") -> None: ...


def _lines(what: str, counted: str) -> Bar:
    """Progress in a log: a line on standard error every EVERY seconds, from the second call on."""
    start = last = time.monotonic()
    first: int | None = None

    def say(done: int, total: int, where: str = "") -> None:
        nonlocal first, last
        now, first = time.monotonic(), done if first is None else first
        if now - last < EVERY:
            return
        last, rate = now, (done - first) / (now - start)
        left = f", {(total - done) / rate / 60:.0f} min left" if rate > 0 else ""
        place = f", {where}" if where else ""
        said = f"{what}: {done} of {total} {counted}{place}, {(now - start) / 60:.0f} min, {rate:.3g} {counted}/s{left}"
        print(said, file=sys.stderr, flush=True)

    return say


@contextlib.contextmanager
def bar(what: str, counted: str) -> Iterator[Bar]:
    """A progress bar on standard error that vanishes at the end, a line a minute where that is no terminal; yields the
    function that takes the progress of the `counted`."""
    if not sys.stderr.isatty():
        yield _lines(what, counted)
        return
    with Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn(counted),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
    ) as shown:
        task = shown.add_task(what, total=None)
        yield lambda done, total, where="": shown.update(task, completed=done, total=total)
