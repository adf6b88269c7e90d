# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of a scene as data, and its bed as a picture."""

import numpy as np

from ..case.measures import Histogram
from ..report.chart import GREY, INK, PALETTE, Axis, Chart, Panel, Series
from ..report.page import Picture
from .columns import last_frame
from .key_figures import key
from .measures import curve, unit
from .pictures import colour, unit_of
from .run import SceneOutcome

TIME = Axis("time $t$", "s")
ROWS = {
    "kinetic_energy": Axis("kinetic energy", "J"),
    "floor_load": Axis("load on the floor", "N"),
    "plate_force": Axis("force on the plate", "N"),
}
COLOURS = {"kinetic": 0, "rotation": INK, "elastic": 2, "plastic": 1, "friction": 4, "springs": 3, "left": 6}
COLOURS["adhesion"] = 5
MOST = 3000  # spheres in the picture of a bed
# viridis at eleven places: from low to high
SCALE = ["440154", "482576", "414487", "35608d", "2a788e", "21918c", "22a884", "43bf71", "7ad151", "bddf26", "fde725"]


def charts(outcome: SceneOutcome) -> list[Chart]:
    """The key figure of the kind; scene, what the rows hold against time; energy, the energy balance; measures."""
    energy = [energy_balance(outcome)] if "energy_balance" in outcome.results.tables else []
    return [*key(outcome.plan, outcome.results.tables), rows(outcome), *energy, *measured(outcome)]


def rows(outcome: SceneOutcome) -> Chart:
    """What the rows hold against time."""
    table, title = outcome.results.tables["rows"], outcome.case.case.title
    shown = [name for name in ROWS if name in table]
    names = ", ".join(ROWS[name].label for name in shown)
    time = table["time"].to_numpy()
    panels = [Panel(TIME, ROWS[name], [Series("", time, table[name].to_numpy(), k)]) for k, name in enumerate(shown)]
    return Chart("scene", title, f"Against time: {names}.", panels, heading="Rows against time")


def measured(outcome: SceneOutcome) -> list[Chart]:
    """measures, each curve against time, and one chart for each histogram."""
    title, tables, drawn = outcome.case.case.title, outcome.results.tables, []
    panels, names = [], []
    for k, m in enumerate(outcome.case.scene.measure):
        name = m.name
        if not isinstance(m, Histogram):
            series = Series("", *curve(m, tables), k % len(PALETTE))
            panels.append(Panel(TIME, Axis(name.replace("_", " "), unit(m)), [series]))
            names.append(name)
        else:
            part = tables["histograms"].query("measure == @name")
            edges = np.repeat(np.append(part["low"], part["high"].iloc[-1]), 2)
            heights = np.concatenate([[0], np.repeat(part["number"], 2), [0]])
            axes = Axis(m.kind.replace("_", " "), unit(m)), Axis("number")
            alt = f"Histogram of {m.kind.replace('_', ' ')}: {int(part['number'].sum())} values."
            chart = Chart(
                f"scene_{name}", f"{title}: {name}", alt, [Panel(*axes, [Series("", edges, heights, k % len(PALETTE))])]
            )
            drawn.append(chart)
    if panels:
        drawn.insert(0, Chart("scene_measures", f"{title}: measures", f"Against time: {', '.join(names)}.", panels))
    return drawn


def energy_balance(outcome: SceneOutcome) -> Chart:
    """Every term of the energy balance against time."""
    table = outcome.results.tables["energy_balance"]
    time, series = table["time"].to_numpy(), []
    gravity = table["gravity"] - table["gravity"].min()
    if gravity.max() > 0:
        series.append(Series("gravity, above its lowest", time, gravity.to_numpy(), INK, "dashdot"))
    for name, shade in COLOURS.items():
        if name in table and table[name].abs().max() > 0:
            label = "friction (remainder)" if name == "friction" and "springs" not in table else name
            series.append(Series(label, time, table[name].to_numpy(), shade))
    if table["work"].abs().max() > 0:
        series.append(Series("work of the walls", time, table["work"].to_numpy(), INK, "dash"))
    if "friction" not in table or "springs" in table:
        series.append(Series("left over", time, table["balance"].to_numpy(), GREY))
    alt = "Energy balance against time: what moves, what is stored and what has been lost."
    return Chart(
        "energy",
        f"{outcome.case.case.title}: energy",
        alt,
        [Panel(TIME, Axis("energy", "J"), series)],
        heading="Energy balance",
    )


def bed(outcome: SceneOutcome) -> list[Picture]:
    """The spheres of the last frame seen along y, the nearest in front, by `output.color`; none without frames."""
    table = outcome.results.tables.get("particles")
    if table is None or table.empty:
        return []
    frame = last_frame(table)
    last = frame.sort_values("y", ascending=False).tail(MOST)
    x, z, r = (last[name].to_numpy() for name in ("x", "z", "radius"))
    field = outcome.plan.output.color
    value = colour(last, field).to_numpy()
    least = min(value.min(), 0.0)
    place = (10 * (value - least) / ((np.quantile(value, 0.98) - least) or 1.0)).clip(0, 10).round().astype(int)
    low, high, bottom, top = (x - r).min(), (x + r).max(), (z - r).min(), (z + r).max()
    unit = 1000 / max(high - low, top - bottom)  # so many points of the picture in a metre
    circles = [
        f'<circle cx="{(a - low) * unit:.1f}" cy="{(top - b) * unit:.1f}" r="{c * unit:.1f}" fill="#{SCALE[k]}"/>'
        for a, b, c, k in zip(x, z, r, place, strict=True)
    ]
    size = f"{(high - low) * unit:.0f} {(top - bottom) * unit:.0f}"
    time = last["step"].iloc[0] * outcome.plan.time_step
    seen = f"the {MOST} nearest spheres" if len(frame) > MOST else "all spheres"
    most = f"{value.max():.3g} {unit_of(last, field)}".strip()
    alt = f"The bed at {time:.3g} s from the front: {seen}; bright ones have the largest {field}, up to {most}."
    svg = (
        f'<svg viewBox="0 0 {size}" stroke="#0008" stroke-width="0.7" style="max-height:34rem">{"".join(circles)}</svg>'
    )
    return [Picture("The bed", alt, svg=svg)]
