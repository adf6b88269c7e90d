# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures for a paper: every chart in one style, as PNG, SVG or PDF, with its data as CSV beside it."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.files import atomic, write_texts
from .chart import GREY, INK, PALETTE, Axis, Chart, Panel, Series

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STYLE: dict[str, Any] = {
    "font.size": 10.0,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "legend.fontsize": 8.0,
    "lines.markersize": 5.0,
    "svg.hashsalt": "epdem",  # the same figure gives the same file
}
DASHES = {"solid": "-", "dash": "--", "dot": ":", "dashdot": "-."}
MARKERS = "ox+^sDv"
WIDTH, HEIGHT = 7.0, 4.2  # of one panel [inch]
LEGEND_ROW = 0.22  # [inch]
BARE_DATE = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}


def save(
    chart: Chart, folder: Path, formats: Sequence[str] = ("png",), *, data: bool = True, comment: str = ""
) -> list[Path]:
    """Draw a chart into `folder`, a file of each of `formats`, and write its `data` as CSV; their paths.

    `comment` is stored in a PNG file. The caller keeps the folder (`claim`).
    """
    from matplotlib import rc_context

    with rc_context(STYLE):  # type: ignore[arg-type]
        figure = draw(chart)
        paths = []
        for kind in formats:
            path = folder / f"{chart.name}.{kind}"
            about = BARE_DATE[kind] | ({"Comment": comment} if comment and kind == "png" else {})
            with atomic(path) as temporary:
                figure.savefig(temporary, dpi=130, format=kind, metadata=about)
            paths.append(path)
    return paths + (write_texts(folder, {f"{chart.name}.csv": chart.csv()}) if data else [])


def draw(chart: Chart) -> "Figure":
    """A chart as a figure of matplotlib, without pyplot: it is only saved, and needs no backend."""
    from matplotlib.figure import Figure

    n, shares = len(chart.panels), [panel.share for panel in chart.panels]
    if chart.beside:
        figure = Figure(figsize=(5 * n, 4.5), layout="constrained")
        grid = figure.subplots(1, n, sharey=True, squeeze=False)
    else:
        size = (WIDTH, max(HEIGHT, HEIGHT * sum(shares) / max(shares)))
        figure = Figure(figsize=size, layout="constrained")
        grid = figure.subplots(n, 1, sharex=True, height_ratios=shares, squeeze=False)
    for k, (axes, panel) in enumerate(zip(grid.flat, chart.panels, strict=True)):
        for series in panel.series:
            axes.plot(series.x, series.y, **_style(series))
        _scale(axes, panel, labels_x=chart.beside or k == n - 1, labels_y=k == 0 or not chart.beside)
    known = {
        label: handle for axes in grid.flat for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    if known:  # below the axes, where it covers no data
        columns = min(len(known), 3)
        figure.set_figheight(figure.get_figheight() + LEGEND_ROW * math.ceil(len(known) / columns))
        figure.legend(list(known.values()), list(known), loc="outside lower center", ncols=columns, frameon=False)
    figure.suptitle(chart.title, fontsize=11, parse_math=False)
    return figure


def _style(series: Series) -> dict[str, Any]:
    style: dict[str, Any] = {"color": {INK: "k", GREY: "0.6"}.get(series.colour) or PALETTE[series.colour]}
    style |= {"ls": DASHES[series.dash] if series.dash else "none", "lw": series.width}
    if series.marker is not None:
        style |= {"marker": MARKERS[series.marker % len(MARKERS)], "mfc": "none"}
    return style | ({"label": series.name} if series.name else {})


def _scale(axes: "Axes", panel: Panel, *, labels_x: bool, labels_y: bool) -> None:
    from matplotlib.ticker import NullFormatter

    for name, axis, labelled in (("x", panel.x, labels_x), ("y", panel.y, labels_y)):
        setting: dict[str, Any] = {f"{name}scale": "log" if axis.log else "linear"}
        if labelled:
            setting[f"{name}label"] = str(axis)
        if limits := _limits(axis, [v for s in panel.series for v in np.atleast_1d(getattr(s, name))]):
            setting[f"{name}lim"] = limits
        axes.set(**setting)
        if axis.ticks:
            getattr(axes, f"set_{name}ticks")(list(axis.ticks), list(axis.ticks.values()))
            getattr(axes, f"{name}axis").set_minor_formatter(NullFormatter())


def _limits(axis: Axis, values: Sequence[float]) -> tuple[float | None, float | None] | None:
    """The limits that an axis asks for; room about a single value, which has no range of its own."""
    if axis.low is not None or axis.high is not None:
        return axis.low, axis.high
    finite = [float(v) for v in values if math.isfinite(v) and (v > 0 or not axis.log)]
    if not finite or min(finite) != max(finite):
        return None
    only = finite[0]
    return (only / 2, only * 2) if axis.log else (only - (abs(only) / 2 or 1.0), only + (abs(only) / 2 or 1.0))
