# SPDX-License-Identifier: GPL-2.0-or-later
"""The page of a study: report.html, one self-contained file.

A study hands over its parts: words, facts, charts, tables, listings, pictures. The page lays them out.
"""

import base64
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from ..base.files import write_text
from ..base.terminal import cell, heads
from .chart import Chart, svg

if TYPE_CHECKING:  # slow to import
    import pandas as pd

NAME = "report.html"
MOST_CELLS = 12_000  # of a table: about 0.8 MB
HEAD = 4096  # bytes in which the mark of a page stands


@dataclass(frozen=True)
class Facts:
    """Facts by name."""

    title: str
    facts: dict[str, str]
    kind: ClassVar[str] = "facts"


@dataclass(frozen=True)
class Rows:
    """A table that sorts by a click or the enter key on a heading. `units` by column, in the headings."""

    title: str
    frame: "pd.DataFrame"
    units: dict[str, str] = field(default_factory=dict)
    note: str = ""
    kind: ClassVar[str] = "rows"

    def heads(self) -> list[str]:
        """The headings: names with their units."""
        return [*heads(self.frame, self.units).values()]

    def cells(self) -> list[list[str]]:
        """The texts of the first `row_limit` rows."""
        return [[*map(cell, row)] for row in self.frame.head(self.row_limit).itertuples(index=False)]

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


def render(page: Page, mark: str = "") -> str:
    """The page as HTML."""
    from ..base import rendering  # slow to import

    return rendering.render("report/page.html.j2", page=page, mark=mark, drawn=svg)


def write(path: Path, page: Callable[[], Page], *, mark: str = "") -> Path:
    """Write the page that `page()` returns to `path`, unless a page with this mark is there.

    The caller claims the folder. mark: hash of the results that the page shows.
    """
    if mark and path.exists():
        with path.open("rb") as stream:
            if f'content="{mark}"'.encode() in stream.read(HEAD):
                return path
    write_text(path, render(page(), mark), sync=False)
    return path
