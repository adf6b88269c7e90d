# SPDX-License-Identifier: GPL-2.0-or-later
"""A figure as data: panels of lines and points with their axes; `drawing` draws the figure for papers and pages."""

import csv
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Literal

import numpy as np

Dash = Literal["solid", "dash", "dot", "dashdot"]
INK, GREY = -1, -2  # colours beside the palette
# Okabe and Ito's palette, which colour-blind readers can tell apart
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#8C564B")
Numbers = Sequence[float] | np.ndarray | float


@dataclass(frozen=True)
class Series:
    """A curve or points: x and y of one shape (n,), in the SI units of the axes.

    name: in the legend, with mathematics between dollar signs; empty: not there. colour: place in PALETTE, INK or GREY.
    dash: of the line; None: points alone. marker: kind of the points; None: a line alone.
    """

    name: str
    x: Numbers
    y: Numbers
    colour: int = INK
    dash: Dash | None = "solid"
    marker: int | None = None
    width: float = 1.2


@dataclass(frozen=True)
class Axis:
    """Label with mathematics between dollar signs, unit (empty: a pure number), logarithmic or not."""

    label: str
    unit: str = ""
    log: bool = False
    low: float | None = None  # limits; None: as the data need
    high: float | None = None
    ticks: dict[float, str] | None = None  # texts at places, instead of numbers

    def __str__(self) -> str:
        return f"{self.label} [{self.unit}]" if self.unit else self.label


@dataclass(frozen=True)
class Panel:
    """One pair of axes and its series; `share` of the height of a figure."""

    x: Axis
    y: Axis
    series: list[Series]
    share: float = 1.0


@dataclass(frozen=True)
class Chart:
    """A figure: panels that share the x axis one above the other, or `beside` each other with the same y axis.

    columns: of small panels with the same x axis, each with its y axis as title. name: of its files. alt: what the
    figure shows, in words, for those who do not see it.
    """

    name: str
    title: str
    alt: str
    panels: list[Panel] = field(default_factory=list)
    beside: bool = False
    columns: int = 1
    heading: str = ""  # on a page; empty: the title
    kind: ClassVar[str] = "chart"

    def csv(self) -> str:
        """The data: one row for each point of each series."""
        text = io.StringIO()
        table = csv.writer(text, lineterminator="\n")
        table.writerow(("panel", "series", "x", "y"))
        for panel in self.panels:
            place = f"{plain(str(panel.y))} against {plain(str(panel.x))}"
            for series in panel.series:
                for x, y in zip(np.atleast_1d(series.x), np.atleast_1d(series.y), strict=True):
                    table.writerow((place, plain(series.name), f"{x:.9g}", f"{y:.9g}"))
        return text.getvalue()


def plain(text: str) -> str:
    """A label as plain text: $e_n$ becomes e_n."""
    return re.sub(r"\\mathrm|[$\\{}]", "", text)
