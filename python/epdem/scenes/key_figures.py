# SPDX-License-Identifier: GPL-2.0-or-later
"""The figure that says most about a scene of its kind, as data."""

from collections.abc import Callable

import numpy as np
import pandas as pd

from ..case.kinds import Compaction, Drum, Hopper, Peening, Settle
from ..report.chart import INK, Axis, Chart, Panel, Series, plain
from . import checks
from .plan import ScenePlan

Tables = dict[str, pd.DataFrame]
TIME = Axis("time", "s")
BINS = 30


def _hopper(p: ScenePlan, s: Hopper, tables: Tables) -> list[Panel]:
    """Mass below the outlet against time, and the line of Beverloo from where a fifth has come out."""
    spheres = tables["particles"]
    steps = np.sort(spheres["step"].unique())
    below = spheres[spheres["z"] < p.scene.gates[0].at].groupby("step")["mass"].sum().reindex(steps, fill_value=0.0)
    time, out = p.time_at(steps), below.to_numpy()
    rate = checks.beverloo(checks.discharge(p, s, spheres), s.outlet, s.gravity)
    total = float(spheres[spheres["step"] == steps[-1]]["mass"].sum())
    begin = int(np.argmax(out > 0.2 * total))
    ends = time[begin] + np.array([0.0, 0.4 * total / rate])
    line = Series(f"Beverloo, {rate:.3g} kg/s", ends, out[begin] + rate * (ends - ends[0]), INK, "dash")
    return [Panel(TIME, Axis("mass below the outlet", "kg"), [Series("scene", time, out, 0), line])]


def _compaction(p: ScenePlan, s: Compaction, tables: Tables) -> list[Panel]:
    """Force on the plate against its displacement, loading and unloading."""
    rows = tables["rows"]
    way, force = (s.box[2] - rows["plate_z"]).to_numpy(), rows["plate_force"].to_numpy()
    loading = (rows["step"] <= p.phases[-2].end).to_numpy()
    series = [
        Series("loading", way[loading], force[loading], 0),
        Series("unloading", way[~loading], force[~loading], 1),
    ]
    return [Panel(Axis("displacement of the plate", "m"), Axis("plate_force", "N"), series)]


def _drum(p: ScenePlan, s: Drum, tables: Tables) -> list[Panel]:
    """Torque on the drum against time; without it the bed's centre of mass, which its turn carries up the wall."""
    rows = tables["rows"]
    if "torque" in rows:
        return [Panel(TIME, Axis("torque", "N m"), [Series("", rows["time"].to_numpy(), rows["torque"].to_numpy(), 0)])]
    sums = tables["particles"].eval("mx = mass * x").groupby("step")[["mx", "mass"]].sum()
    place = (sums["mx"] / sums["mass"]).to_numpy()
    return [Panel(TIME, Axis("x of the centre of mass", "m"), [Series("", p.time_at(sums.index.to_numpy()), place, 0)])]


def _peening(p: ScenePlan, s: Peening, tables: Tables) -> list[Panel]:
    """Speeds of the shot upwards after its impact, and e_n v of theory for one impact on the target."""
    spheres = tables["particles"]
    up = spheres[spheres["vz"] > 1e-3 * s.speed].groupby("id")["vz"].max().to_numpy()
    number, edges = np.histogram(up, BINS)
    expected = checks.single_rebound(p.case, s)
    series = [
        Series(f"{len(up)} spheres", np.repeat(edges, 2)[1:-1], np.repeat(number, 2), 0),
        Series("one impact, theory", [expected] * 2, [0.0, float(max(number.max(), 1))], INK, "dash"),
    ]
    return [Panel(Axis("rebound speed", "m/s"), Axis("number"), series)]


def _settle(p: ScenePlan, s: Settle, tables: Tables) -> list[Panel]:
    """Height below which 95 % of the spheres lie, and kinetic energy, against time."""
    rows, heights = tables["rows"], tables["particles"].groupby("step")["z"].quantile(0.95)
    moving = rows[rows["kinetic_energy"] > 0]
    energy = Series("", moving["time"].to_numpy(), moving["kinetic_energy"].to_numpy(), 1)
    return [
        Panel(
            TIME, Axis("height of 95 %", "m"), [Series("", p.time_at(heights.index.to_numpy()), heights.to_numpy(), 0)]
        ),
        Panel(TIME, Axis("kinetic_energy", "J", log=True), [energy]),
    ]


PANELS: dict[type, Callable[..., list[Panel]]] = {
    Hopper: _hopper,
    Compaction: _compaction,
    Drum: _drum,
    Peening: _peening,
    Settle: _settle,
}


def panels(p: ScenePlan, tables: Tables) -> list[Panel]:
    """The panels of the key figure; none of a scene of parts, and none where the tables lack the data."""
    s = p.case.scene
    frames = "particles" in tables and tables["particles"]["step"].nunique() > 1
    drawn = frames or isinstance(s, Compaction) or "torque" in tables["rows"]
    return PANELS[type(s)](p, s, tables) if drawn and type(s) in PANELS else []


def key(p: ScenePlan, tables: Tables) -> list[Chart]:
    """The key figure of a scene, if there is one."""
    found = panels(p, tables)
    said = plain(" and ".join(f"{panel.y.label} against {panel.x.label}" for panel in found))
    return [Chart("key", p.case.case.title, f"{said}.", found, heading=f"Key figure: {said}")] if found else []
