# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of a scene as data, and its bed as a picture."""

import numpy as np

from ..report.chart import GREY, INK, Axis, Chart, Panel, Series
from ..report.page import Picture
from .run import SceneOutcome

TIME = Axis("time $t$", "s")
ROWS = {
    "kinetic_energy": Axis("kinetic energy", "J"),
    "floor_load": Axis("load on the floor", "N"),
    "plate_force": Axis("force on the plate", "N"),
}
COLOURS = {"kinetic": 0, "elastic": 2, "plastic": 1, "friction": 4, "springs": 3, "left": 6, "adhesion": 5}
MOST = 3000  # spheres in the picture of a bed
# viridis at eleven places: from slow to fast
SCALE = ["440154", "482576", "414487", "35608d", "2a788e", "21918c", "22a884", "43bf71", "7ad151", "bddf26", "fde725"]


def charts(outcome: SceneOutcome) -> list[Chart]:
    """scene, what the rows hold against time, and energy, the ledger, if there is one."""
    return [rows(outcome), *([ledger(outcome)] if "ledger" in outcome.results.tables else [])]


def rows(outcome: SceneOutcome) -> Chart:
    """What the rows hold against time."""
    table, title = outcome.results.tables["rows"], outcome.case.case.title
    shown = [name for name in ROWS if name in table]
    names = ", ".join(ROWS[name].label for name in shown)
    time = table["time"].to_numpy()
    panels = [Panel(TIME, ROWS[name], [Series("", time, table[name].to_numpy(), k)]) for k, name in enumerate(shown)]
    return Chart("scene", title, f"Against time: {names}.", panels)


def ledger(outcome: SceneOutcome) -> Chart:
    """Every term of the ledger against time."""
    table = outcome.results.tables["ledger"]
    time, series = table["time"].to_numpy(), []
    gravity = table["gravity"] - table["gravity"].min()
    if gravity.max() > 0:
        series.append(Series("gravity, above its lowest", time, gravity.to_numpy(), INK, "dashdot"))
    for name, colour in COLOURS.items():
        if name in table and table[name].abs().max() > 0:
            label = "friction (remainder)" if name == "friction" and "springs" not in table else name
            series.append(Series(label, time, table[name].to_numpy(), colour))
    if table["work"].abs().max() > 0:
        series.append(Series("work of the walls", time, table["work"].to_numpy(), INK, "dash"))
    if "friction" not in table or "springs" in table:
        series.append(Series("left over", time, table["balance"].to_numpy(), GREY))
    alt = "Energy balance against time: what moves, what is stored and what has been lost."
    return Chart("energy", f"{outcome.case.case.title}: energy", alt, [Panel(TIME, Axis("energy", "J"), series)])


def bed(outcome: SceneOutcome) -> list[Picture]:
    """The spheres of the last frame seen along y, the nearest in front, coloured by speed; none without frames."""
    table = outcome.results.tables.get("particles")
    if table is None or table.empty:
        return []
    frame = table[table["step"] == table["step"].max()]
    last = frame.sort_values("y", ascending=False).tail(MOST)
    x, z, r = (last[name].to_numpy() for name in ("x", "z", "radius"))
    speed = np.sqrt((last[["vx", "vy", "vz"]] ** 2).sum(axis=1)).to_numpy()
    place = (10 * speed / (np.quantile(speed, 0.98) or 1.0)).clip(0, 10).round().astype(int)
    low, high, bottom, top = (x - r).min(), (x + r).max(), (z - r).min(), (z + r).max()
    unit = 1000 / max(high - low, top - bottom)  # so many points of the picture in a metre
    circles = [
        f'<circle cx="{(a - low) * unit:.1f}" cy="{(top - b) * unit:.1f}" r="{c * unit:.1f}" fill="#{SCALE[k]}"/>'
        for a, b, c, k in zip(x, z, r, place, strict=True)
    ]
    size = f"{(high - low) * unit:.0f} {(top - bottom) * unit:.0f}"
    time = last["step"].iloc[0] * outcome.plan.time_step
    seen = f"the {MOST} nearest spheres" if len(frame) > MOST else "all spheres"
    alt = f"The bed at {time:.3g} s from the front: {seen}; bright ones are fast, up to {speed.max():.3g} m/s."
    svg = (
        f'<svg viewBox="0 0 {size}" stroke="#0008" stroke-width="0.7" style="max-height:34rem">{"".join(circles)}</svg>'
    )
    return [Picture("The bed", alt, svg=svg)]
