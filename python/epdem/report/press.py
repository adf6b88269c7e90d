# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of a press as data: force over displacement, density and its lines over pressure, springback, sides."""

import math
from collections.abc import Callable

import numpy as np
import pandas as pd

from ..base.readable import in_words
from ..jobs.stage import Tables
from ..scenes.plan.plan import ScenePlan
from ..scenes.tables import stages
from .chart import GREY, INK, PALETTE, Axis, Panel, Series

MEASURED_POINTS = 5  # kind of marker, as of measured impacts
PRESSURE = Axis("pressure", "Pa")
LEAST_POINTS = 3  # of a line through stages
LOWEST = 1e-3  # of the largest pressure: where curves begin
SLICES = 8  # of the bed, at most


def _curve(p: ScenePlan, tables: Tables) -> pd.DataFrame:
    """time, pressure, height and relative density of the rows, in their middle, and of the ends of phases."""
    rows, names = tables["rows"], ["time", "pressure", "height", "relative_density"]
    rows = rows.assign(time=p.middles(rows), pressure=rows[p.stages.pressure])
    return pd.concat([rows[names], tables["stages"][names]]).sort_values("time", kind="stable", ignore_index=True)


def force(p: ScenePlan, tables: Tables) -> list[Panel]:
    """Force on the punch over the way by which the plates approach, and the ends of the stages."""
    curve, ends, area = _curve(p, tables), tables["stages"], p.stages.area
    start = float(stages.heights(p, np.zeros(1))[0])
    borne = curve["pressure"] > LOWEST * curve["pressure"].max()
    curve = curve.iloc[max(0, int(borne.to_numpy().argmax()) - 1) :]
    way, load = start - curve["height"].to_numpy(), area * curve["pressure"].to_numpy()
    series = [Series("punch", way, load, GREY)]
    for k, stage in enumerate(ends[ends["asked"].notna()].to_dict("records")):
        named = f"{stage['phase']}, {in_words(stage['reached'], 'Pa', 3)}"
        at, load = start - stage["height"], area * stage["reached"]
        series.append(Series(named, [at], [load], k % len(PALETTE), None, k))
    return [Panel(Axis("displacement", "m"), Axis("force on the punch", "N"), series)]


def densification(p: ScenePlan, tables: Tables) -> list[Panel]:
    """Relative density against pressure, and the ends of the phases."""
    curve, ends, known = _curve(p, tables), tables["stages"], p.case.measured
    low = LOWEST * float(curve["pressure"].max())
    if low <= 0.0:
        return []
    curve, ends = curve[curve["pressure"] >= low], ends[ends["pressure"] >= low]
    series = [
        Series("punch", curve["pressure"].to_numpy(), curve["relative_density"].to_numpy(), 0),
        Series("ends of phases", ends["pressure"].to_numpy(), ends["relative_density"].to_numpy(), INK, None, 0),
    ]
    if known:
        x, y = np.array(known.pressures), np.array(known.relative_densities)
        series.append(Series("measured", x, y, INK, None, MEASURED_POINTS))
    return [Panel(Axis("pressure", "Pa", log=True), Axis("relative density"), series)]


def _fitted(p: ScenePlan, tables: Tables) -> pd.DataFrame | None:
    """The ends of loading that lines go through; None where they are too few."""
    ends = stages.compared(stages.loaded(p, tables["stages"]))
    return ends if len(ends) >= LEAST_POINTS else None


def heckel(p: ScenePlan, tables: Tables) -> list[Panel]:
    """ln 1/(1-D) against the largest pressure so far, and Heckel's line through the ends of loading; none without it.

    Heckel 1961, Trans. Metall. Soc. AIME 221, 671; the slope is the inverse of an apparent yield pressure.
    """
    if (ends := _fitted(p, tables)) is None:
        return []
    pressure, density = (_curve(p, tables)[name].to_numpy() for name in ("pressure", "relative_density"))
    rising = (pressure >= np.maximum.accumulate(pressure)) & (pressure > LOWEST * pressure.max()) & (density < 1.0)
    x, y = ends["pressure"].to_numpy(), -np.log(ends["porosity"].to_numpy())
    slope, begin = np.polyfit(x, y, 1)
    name = f"Heckel, {len(x)} points, 1/slope = {in_words(1.0 / slope, 'Pa', 3)}"
    series = [
        Series("punch", pressure[rising], -np.log(1.0 - density[rising]), 0),
        Series("ends of stages", x, y, INK, None, 0),
        Series(name, x, begin + slope * x, INK, "dash"),
    ]
    return [Panel(PRESSURE, Axis("ln 1/(1 - relative density)"), series)]


def kawakita(p: ScenePlan, tables: Tables) -> list[Panel]:
    """P/C against P, C = 1 - D0/D with the density D0 at which the punch meets the bed, and the line through the ends
    of loading, P/C = 1/(a b) + P/a; none without it.

    Kawakita and Luedde 1971, Powder Technol. 4, 61.
    """
    pressure, density = (_curve(p, tables)[name].to_numpy() for name in ("pressure", "relative_density"))
    ends = _fitted(p, tables)
    if ends is None or not (pressure > 0.0).any():
        return []
    first = float(density[np.argmax(pressure > 0.0)])
    x = ends["pressure"].to_numpy()
    y = x / (1.0 - first / ends["relative_density"].to_numpy())
    slope, begin = np.polyfit(x, y, 1)
    name = f"Kawakita, {len(x)} points, a = {1.0 / slope:.3g}, 1/b = {in_words(begin / slope, 'Pa', 3)}"
    series = [Series("ends of stages", x, y, INK, None, 0), Series(name, x, begin + slope * x, INK, "dash")]
    return [Panel(PRESSURE, Axis("pressure/C", "Pa"), series)]


def springback(p: ScenePlan, tables: Tables) -> list[Panel]:
    """Axial strain since the end of loading against pressure, a curve for each release, named by its end."""
    curve, ends = _curve(p, tables), tables["stages"]
    loaded = ends["height"].where(ends["springback"].isna()).ffill()
    series: list[Series] = []
    for n in np.flatnonzero(ends["springback"].notna()):
        during = curve[curve["time"].between(ends["time"][n - 1], ends["time"][n])]
        strain = 100.0 * (during["height"] / loaded[n] - 1.0)
        name, colour = f"{ends['phase'][n]}, {100.0 * ends['springback'][n]:.3g} %", len(series) % len(PALETTE)
        series.append(Series(name, during["pressure"].to_numpy(), strain.to_numpy(), colour))
    return [Panel(PRESSURE, Axis("springback", "%"), series)] if series else []


def sides(p: ScenePlan, tables: Tables) -> list[Panel]:
    """Height over the wall against the punch, and the pressure on the sides there at the end of each loading."""
    if not p.stages.sides or "contacts" not in tables:
        return []
    loads = stages.normal_forces(p, tables["contacts"])
    axis, start = stages.against(p, p.time_at(loads["step"].to_numpy()))
    places = tables["particles"].set_index(["step", "id"])["xyz"[axis]]
    above = np.abs(places.reindex(pd.MultiIndex.from_frame(loads[["step", "i"]])).to_numpy() - start)
    series: list[Series] = []
    for stage in stages.loaded(p, tables["stages"]).to_dict("records"):
        there, height = (loads["step"] == stage["step"]).to_numpy(), stage["height"]
        slices = max(1, min(SLICES, math.floor(height / (2.0 * p.largest))))
        load, edges = np.histogram(above[there], slices, (0.0, height), weights=loads["load"][there])
        pressure, colour = np.repeat(load / (p.stages.perimeter * height / slices), 2), len(series) % len(PALETTE)
        series.append(Series(stage["phase"], pressure, np.repeat(edges, 2)[1:-1], colour))
    axes = Axis("normal pressure on the sides", "Pa", low=0.0), Axis("height over the lower plate", "m", low=0.0)
    return [Panel(*axes, series)] if series else []


def conductance(p: ScenePlan, tables: Tables) -> list[Panel]:
    """Conductance between punch and floor against pressure, at the ends of loading and of releases."""
    ends, series = tables["stages"], []
    if "conductance" not in ends:
        return []
    loading = ends["springback"].isna()
    for name, at, marker in (("loading", loading, 0), ("release", ~loading, 1)):
        x, y = (ends[column][at].to_numpy() for column in ("pressure", "conductance"))
        series.append(Series(name, x, y, marker, "solid" if name == "loading" else None, marker))
    return [Panel(PRESSURE, Axis("conductance", "S"), series)]


ENDS = f"the ends of loading below a relative density of {stages.FITTED}."
# name of the key figure: heading, caption, and its panel, or none where the tables lack the data
FIGURES: dict[str, tuple[str, str, Callable[[ScenePlan, Tables], list[Panel]]]] = {
    "punch_force": (
        "Force over displacement",
        "Force on the punch over the way by which the plates have approached; markers: ends of the stages.",
        force,
    ),
    "densification": (
        "Density over pressure",
        "Relative density over the pressure on the punch; circles: ends of the phases.",
        densification,
    ),
    "heckel": ("Heckel's line", f"The largest pressure so far, and Heckel's line through {ENDS}", heckel),
    "kawakita": ("Kawakita's line", f"C: reduction of the volume. Kawakita's line goes through {ENDS}", kawakita),
    "springback": (
        "Springback",
        "Axial strain since the end of loading over the pressure that is left on the punch.",
        springback,
    ),
    "side_pressure": (
        "Pressure on the sides by height",
        "Normal force on the sides over their area, in slices of the bed, at the end of each loading.",
        sides,
    ),
    "conductance": (
        "Conductance over pressure",
        "Conductance between punch and floor over the pressure on the punch, at the ends of the phases.",
        conductance,
    ),
}
