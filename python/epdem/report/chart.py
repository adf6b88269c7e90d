# SPDX-License-Identifier: GPL-2.0-or-later
"""A figure as data (panels of lines and points with their axes), and its drawing for papers and pages in one style.

A drawing is a PNG, SVG or PDF file with the data as CSV beside it, or an SVG element of a page.
"""

import csv
import io
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from ..base.files import atomic, write_texts
from ..base.readable import unit_for

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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

    columns: of small panels with the same x axis, each with its y axis as title. name: of its files, if it has a `file`
    beside a page. alt: what the figure shows, in words, for those who do not see it.
    """

    name: str
    title: str
    alt: str
    panels: list[Panel] = field(default_factory=list)
    beside: bool = False
    columns: int = 1
    heading: str = ""  # on a page; empty: the title
    file: bool = True
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

    def readable(self) -> "Chart":
        """The chart in units that readers know; all axes of one SI unit have the same one."""
        pairs = [
            (axis.unit, numbers)
            for panel in self.panels
            for axis, values in ((panel.x, [s.x for s in panel.series]), (panel.y, [s.y for s in panel.series]))
            for numbers in values
        ]
        units = dict.fromkeys(unit for unit, _ in pairs)
        read = {u: unit_for(u, np.concatenate([np.ravel(x) for unit, x in pairs if unit == u])) for u in units}

        def scaled(axis: Axis) -> tuple[Axis, float]:
            name, factor = read.get(axis.unit, (axis.unit, 1.0))
            low, high = (None if x is None else x / factor for x in (axis.low, axis.high))
            ticks = axis.ticks and {x / factor: text for x, text in axis.ticks.items()}
            return replace(axis, unit=name, low=low, high=high, ticks=ticks), factor

        panels = []
        for panel in self.panels:
            (x, by_x), (y, by_y) = scaled(panel.x), scaled(panel.y)
            series = [replace(s, x=np.asarray(s.x) / by_x, y=np.asarray(s.y) / by_y) for s in panel.series]
            panels.append(replace(panel, x=x, y=y, series=series))
        return replace(self, panels=panels)


def plain(text: str) -> str:
    """A label as plain text: $e_n$ becomes e_n."""
    return re.sub(r"\\mathrm|[$\\{}]", "", text)


STYLE: dict[str, Any] = {
    "font.size": 10.0,
    "font.sans-serif": ["DejaVu Sans"],
    "axes.grid": True,
    "grid.alpha": 0.3,
    "legend.fontsize": 8.0,
    "lines.markersize": 5.0,
    "svg.hashsalt": "epdem",  # the same figure gives the same file
}
DASHES = {"solid": "-", "dash": "--", "dot": ":", "dashdot": "-."}
MARKERS = "ox+^sDv"
WIDTH, HEIGHT = 7.0, 4.2  # of one panel [inch]
SMALL = 3.3, 2.1  # of one panel among columns [inch]
LEGEND_ROW = 0.22  # [inch]
DPI = 130
VARIABLES = {"#000000": "ink", "#0072b2": "blue", "#8c564b": "brown"}  # of a page: a dark page has lighter colours
BARE_DATE = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}


def laid_out(chart: Chart) -> "Figure":
    """The figure of a chart, whose places no longer change."""
    from matplotlib import rc_context

    with rc_context(STYLE):  # type: ignore[arg-type]
        figure = draw(chart)
        if engine := figure.get_layout_engine():
            engine.execute(figure)
        figure.set_layout_engine("none")
    return figure


def save(
    chart: Chart,
    folder: Path,
    formats: Sequence[str] = ("png",),
    *,
    data: bool = True,
    figure: "Figure | None" = None,
) -> list[Path]:
    """Draw a chart into `folder`, a file of each of `formats`, and write its `data` as CSV; their paths.

    The caller keeps the folder (`claim`). figure: of the chart, if it is drawn already.
    """
    from matplotlib import rc_context

    figure, paths = figure or laid_out(chart), [folder / f"{chart.name}.{kind}" for kind in formats]
    for kind, path in zip(formats, paths, strict=True):
        with rc_context(STYLE), atomic(path) as temporary:  # type: ignore[arg-type]
            figure.savefig(temporary, dpi=DPI, format=kind, metadata=BARE_DATE[kind])
    return paths + (write_texts(folder, {f"{chart.name}.csv": chart.csv()}) if data else [])


def svg(figure: "Figure") -> str:
    """The figure of a chart without its title as an element `svg` of a page.

    Black and PALETTE's dark colours are CSS variables of the page.
    """
    from matplotlib import rc_context
    from matplotlib.transforms import Bbox

    text, (width, height) = io.StringIO(), figure.get_size_inches()
    titles = [title.get_window_extent().y0 / figure.dpi for title in figure.texts]
    below = Bbox([[0.0, 0.0], [width, min([height, *titles])]])
    for title in figure.texts:
        title.set_visible(False)
    with rc_context(STYLE | {"svg.fonttype": "none"}):  # type: ignore[arg-type]
        figure.savefig(text, format="svg", transparent=True, bbox_inches=below, metadata={"Date": None})
    drawn = text.getvalue()
    drawn = re.sub(
        r"<metadata>.*?</metadata>|<style.*?</style>|<!--.*?-->", "", drawn[drawn.index("<svg") :], flags=re.S
    )
    drawn = re.sub(r'<g id="[^"]*">', "<g>", drawn.rstrip())  # one page has several drawings
    for colour, variable in VARIABLES.items():
        drawn = drawn.replace(colour, f"var(--{variable})")
    return drawn


def draw(chart: Chart) -> "Figure":
    """A chart with its title as a figure of matplotlib."""
    figure, grid = _grid(chart)
    n, columns = len(chart.panels), grid.shape[1]
    for k, (axes, panel) in enumerate(zip(grid.flat, chart.panels, strict=False)):
        for series in panel.series:
            axes.plot(series.x, series.y, **_style(series))
        alone = chart.columns > 1
        _scale(
            axes, panel, labels_x=chart.beside or k + columns >= n, labels_y=not alone and (k == 0 or not chart.beside)
        )
        if alone:
            axes.set_title(str(panel.y), loc="left", fontsize="medium")
            for name, axis in (("x", panel.x), ("y", panel.y)):
                if not axis.log:
                    axes.locator_params(axis=name, nbins=4)
    for axes in grid.flat[n:]:
        axes.remove()
    known = {
        label: handle for axes in grid.flat for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    if known:  # below the axes, where it covers no data
        for columns in range(min(len(known), 3), 0, -1):
            legend = figure.legend(
                list(known.values()), list(known), loc="outside lower center", ncols=columns, frameon=False
            )
            if columns == 1 or legend.get_window_extent().width <= figure.bbox.width:
                break
            legend.remove()
        figure.set_figheight(figure.get_figheight() + LEGEND_ROW * math.ceil(len(known) / columns))
    figure.suptitle(chart.title, fontsize=11, parse_math=False)
    return figure


def _grid(chart: Chart) -> tuple["Figure", np.ndarray]:
    from matplotlib.figure import Figure

    n, shares = len(chart.panels), [panel.share for panel in chart.panels]
    if chart.beside:
        figure = Figure(figsize=(5 * n, 4.5), layout="constrained")
        return figure, figure.subplots(1, n, sharey=True, squeeze=False)
    if chart.columns > 1:
        rows = math.ceil(n / chart.columns)
        figure = Figure(figsize=(SMALL[0] * chart.columns, SMALL[1] * rows), layout="constrained")
        grid = figure.subplots(rows, chart.columns, sharex=True, squeeze=False)
        for axes in grid.flat[n - chart.columns : n]:  # the last one of each column
            axes.tick_params(labelbottom=True)
        return figure, grid
    figure = Figure(figsize=(WIDTH, max(HEIGHT, HEIGHT * sum(shares) / max(shares))), layout="constrained")
    return figure, figure.subplots(n, 1, sharex=True, height_ratios=shares, squeeze=False)


def _style(series: Series) -> dict[str, Any]:
    style: dict[str, Any] = {"color": {INK: "k", GREY: "0.6"}.get(series.colour) or PALETTE[series.colour]}
    style |= {"ls": DASHES[series.dash] if series.dash else "none", "lw": series.width}
    if series.marker is not None:
        style |= {"marker": MARKERS[series.marker % len(MARKERS)], "mfc": "none"}
    return style | ({"label": series.name} if series.name else {})


def _scale(axes: "Axes", panel: Panel, *, labels_x: bool, labels_y: bool) -> None:
    from matplotlib.ticker import NullFormatter

    for name, axis, labelled in (("x", panel.x, labels_x), ("y", panel.y, labels_y)):
        setting: dict[str, Any] = {}
        if axis.log:  # zeros are left out, not drawn far below
            getattr(axes, f"set_{name}scale")("log", nonpositive="mask")
        if labelled:
            setting[f"{name}label"] = str(axis)
        if axis.low is not None or axis.high is not None:
            setting[f"{name}lim"] = axis.low, axis.high
        axes.set(**setting)
        if axis.ticks:
            getattr(axes, f"set_{name}ticks")(list(axis.ticks), list(axis.ticks.values()))
            getattr(axes, f"{name}axis").set_minor_formatter(NullFormatter())
