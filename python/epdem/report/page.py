# SPDX-License-Identifier: GPL-2.0-or-later
"""The page of a study: report.html, one self-contained file.

A study hands over its parts: words, facts, charts, tables, listings, pictures. The page lays them out.
"""

import base64
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from ..base import readable
from ..base.files import write_text
from ..base.terminal import cell, digits_of, heads
from .chart import Chart, laid_out, save, svg

if TYPE_CHECKING:  # slow to import
    import pandas as pd

NAME = "report.html"
MOST_CELLS = 12_000  # of a table: about 0.8 MB


@dataclass(frozen=True)
class Facts:
    """Facts by name."""

    title: str
    facts: dict[str, str]
    kind: ClassVar[str] = "facts"


@dataclass(frozen=True)
class Rows:
    """A table that sorts by a click or the enter key on a heading. `units`, SI, by column; headings and numbers are in
    those that readers know."""

    title: str
    frame: "pd.DataFrame"
    units: dict[str, str] = field(default_factory=dict)
    note: str = ""
    kind: ClassVar[str] = "rows"

    @cached_property
    def shown(self) -> "tuple[pd.DataFrame, dict[str, str]]":
        """The first `row_limit` rows and the units of their columns, as readers know them."""
        return readable.columns(self.frame.head(self.row_limit), self.units)

    def heads(self) -> list[str]:
        """The headings: names with their units."""
        return [*heads(*self.shown).values()]

    def cells(self) -> list[list[str]]:
        frame, _ = self.shown
        return [[*map(cell, row, digits_of(frame))] for row in frame.itertuples(index=False)]

    @property
    def row_limit(self) -> int:
        """Largest number of rows of the page."""
        return int(max(1, MOST_CELLS // max(1, self.frame.shape[1])))

    @property
    def notes(self) -> str:
        """The note, with the number of rows where some are left out."""
        left = len(self.frame) - self.row_limit
        return f"{self.note} The first {self.row_limit} of {len(self.frame)} rows." if left > 0 else self.note


@dataclass(frozen=True)
class Lines:
    """Lines of a file, with the reason of each; folded up."""

    title: str
    lines: list[tuple[str, str]]
    kind: ClassVar[str] = "lines"


@dataclass(frozen=True)
class Picture:
    """A PNG file; `alt` says what the picture shows."""

    title: str
    alt: str
    file: Path
    kind: ClassVar[str] = "picture"

    @property
    def source(self) -> str:
        """The file in base64."""
        return base64.b64encode(self.file.read_bytes()).decode()


Part = Facts | Rows | Lines | Picture | Chart


@dataclass(frozen=True)
class Page:
    """A page: what was done and came out, in sentences; whether all checks hold (None: there are none); its parts.

    command repeats the study.
    """

    title: str
    sentences: list[str]
    parts: list[Part]
    passed: bool | None = None
    command: str = ""
    warnings: Sequence[str] = ()


def render(page: Page, folder: Path = Path(), formats: Sequence[str] = ()) -> str:
    """The page as HTML; a file of each of `formats` of its charts goes into `folder`."""
    from ..base import rendering  # slow to import

    def drawn(chart: Chart) -> str:
        chart = chart.readable()
        figure = laid_out(chart)
        if formats and chart.file:
            save(chart, folder, formats, figure=figure)
        return svg(figure)

    return rendering.render("report/page.html.j2", page=page, svg=drawn)


def write(path: Path, page: Page, formats: Sequence[str] = ()) -> Path:
    """Write a page to `path`, and beside it a file of each of `formats` of its charts; the path.

    The caller claims the folder.
    """
    write_text(path, render(page, path.parent, formats), sync=False)
    return path
