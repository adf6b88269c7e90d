# SPDX-License-Identifier: GPL-2.0-or-later
"""What must hold for a scene by routes that do not go through the contact law."""

import numpy as np
import pandas as pd

from ..case.scene import SceneCase
from ..impacts.prediction import predict
from .ledger import closure, kinetic, plate_velocity
from .pairs import wall_impact
from .plan import ScenePlan


Row = dict[str, object]


def _row(name: str, value: float, expected: float, tolerance: float) -> Row:
    error = abs(value / expected - 1.0) if expected else abs(value)
    return {
        "check": name,
        "value": value,
        "expected": expected,
        "error": error,
        "tolerance": tolerance,
        "passed": bool(error <= tolerance),
    }


def _below(name: str, value: float, limit: float, tolerance: float) -> Row:
    return {
        "check": name,
        "value": value,
        "expected": limit,
        "error": max(0.0, value / limit - 1.0),
        "tolerance": tolerance,
        "passed": bool(value <= limit * (1 + tolerance)),
    }


def _kept(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> list[Row]:
    if p.layout.loses:
        return []
    last = float(tables["rows"]["particles"].iloc[-1])
    return [_row("spheres in the room at the end", last, float(p.case.scene.count), 0.0)]


def floor_load(case: SceneCase, tables: dict[str, pd.DataFrame]) -> tuple[float, float]:
    """(mean floor load over the last fifth of the run, weight of the spheres) [N]."""
    rows, last = tables["rows"], tables["particles"]
    mass = last[last["step"] == last["step"].max()]["mass"].sum()
    tail = rows[rows["step"] > 0.8 * rows["step"].max()]
    return float(tail["floor_load"].mean()), float(mass * case.scene.gravity)


def bed_rebound(case: SceneCase, spheres: pd.DataFrame) -> tuple[float, float]:
    """(largest rise of the centre of mass from a place below, what e_n of theory allows: e_n^2 times its fall) [m].

    e_n is that of the bounciest pair at the speed of the fall. Spheres that land one after the other, and each impact
    within the bed, only take from it: e_n^2 v^2 is concave in v^2, so that a mean over falls is below that of the mean.
    """
    present = spheres.groupby("step")["id"].count()
    whole = spheres[spheres["step"].isin(present.index[present == present.max()])]
    sums = whole.assign(height=whole["mass"] * whole["z"], kinetic=kinetic(whole)).groupby("step")
    total = whole["mass"].sum() / sums.ngroups
    place = sums["height"].sum().to_numpy() / total
    fall = place[0] + sums["kinetic"].sum().iloc[0] / (total * case.scene.gravity) - place.min()
    names = {p.material for p in case.scene.particles}
    v, radius = float(np.sqrt(2 * case.scene.gravity * fall)), case.scene.particles[0].radii()[0]
    pairs = [(a, b) for a in names for b in names | {case.scene.walls}]
    e_n = max(float(predict(wall_impact(case, a, radius, b, v)).e_n[-1]) for a, b in pairs)
    return float((place - np.minimum.accumulate(place)).max()), e_n**2 * fall


def stiffness(p: ScenePlan, rows: pd.DataFrame) -> tuple[float, float]:
    """Secant stiffness [N/m] of (loading, unloading) between half the largest plate force and that force."""
    turn = p.phases[0].end
    load, unload = rows[rows["step"] <= turn], rows[rows["step"] > turn]
    way_up, up = load["plate_z"].to_numpy()[::-1], load["plate_force"].to_numpy()[::-1]
    way_down, down = unload["plate_z"].to_numpy(), unload["plate_force"].to_numpy()
    bottom, top = way_up[0], up[0]
    below = int(np.argmax(up < 0.5 * top)), int(np.argmax(down < 0.5 * top))
    return (
        float((top - up[below[0]]) / (way_up[below[0]] - bottom)),
        float((top - down[below[1]]) / (way_down[below[1]] - bottom)),
    )


def recovered(p: ScenePlan, rows: pd.DataFrame) -> tuple[float, float]:
    """Work [J] that the plate (put in, got back): its force, a mean over each interval, times its way."""
    speed = plate_velocity(p, rows)
    work = rows["plate_force"].to_numpy() * np.abs(speed) * np.diff(rows["step"], prepend=0) * p.time_step
    return float(work[speed < 0].sum()), float(work[speed > 0].sum())


def discharge(p: ScenePlan, spheres: pd.DataFrame) -> tuple[float, float]:
    """Mass flow [kg/s] through the outlet, between a fifth and 3/5 of the filling, and Beverloo's, with the bulk
    density of the bin when the outlet opens: W = 0.58 rho_b sqrt(g) (D - 1.4 d)^2.5."""
    s, outlet, steps = p.case.scene, p.layout.outlet, spheres["step"].unique()
    opened = steps[steps <= p.phases[0].end].max()
    total = spheres[spheres["step"] == opened]["mass"].sum()
    out = spheres[spheres["z"] < outlet].groupby("step")["mass"].sum().reindex(steps, fill_value=0.0)
    steady = out[(out > 0.2 * total) & (out < 0.6 * total)]
    rate = np.polyfit(steady.index.to_numpy() * p.time_step, steady.to_numpy(), 1)[0]
    full = spheres[spheres["step"] == opened]
    top = np.quantile(full["z"], 0.95)
    inside = full[(full["z"] > 0.2 * top) & (full["z"] < 0.7 * top)]
    area = np.pi / 4 * s.bin_diameter**2
    bulk = inside["mass"].sum() / (area * 0.5 * top)
    diameter = 2 * float(full["radius"].mean())
    return float(rate), float(0.58 * bulk * np.sqrt(s.gravity) * (s.outlet - 1.4 * diameter) ** 2.5)


def single_rebound(case: SceneCase) -> float:
    """Speed [m/s] at which one shot leaves a flat target, by theory alone."""
    material = case.scene.particles[0].material
    wall = case.scene.bed[0].material if case.scene.bed else case.scene.walls
    x = wall_impact(case, material, case.scene.particles[0].radii()[0], wall, case.scene.speed)
    return float(predict(x).e_n[-1] * case.scene.speed)


def rebounds(case: SceneCase, spheres: pd.DataFrame) -> tuple[float, int]:
    """(speed [m/s] farthest from the single shot's, count) of the shot that met the target and nothing else.

    Only those go straight up: a hit between two shots is never central.
    """
    side = np.hypot(spheres["vx"], spheres["vy"])
    straight = spheres[(spheres["vz"] > 0) & (side < 1e-9 * case.scene.speed)]
    speeds = straight.groupby("id")["vz"].max().to_numpy()
    if not speeds.size:
        return np.nan, 0
    return float(speeds[np.argmax(np.abs(speeds - single_rebound(case)))]), speeds.size


def checks(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """One row per check: value, expected, relative error, tolerance, passed."""
    case, found = p.case, _kept(p, tables)
    smooth = case.contact.wall_friction == 0.0 or (case.contact.friction == 0.0 and case.contact.wall_friction is None)
    smooth = smooth and not any("wall" in p.between for p in case.contact.pairs) and not case.contact.cohesion
    if case.scene.kind == "settle" and "floor_load" in tables["rows"] and "particles" in tables and smooth:
        load, weight = floor_load(case, tables)
        found.append(_row("floor load / weight (smooth walls: hydrostatic)", load, weight, 0.02))
    if case.scene.kind == "settle" and not case.scene.rate and case.scene.gravity and case.output.particles >= 20:
        found.append(_below("rebound of the bed / e_n^2 fall", *bed_rebound(case, tables["particles"]), 0.0))
    if case.scene.kind == "hopper" and case.output.particles >= 20:
        found.append(_row("mass flow / Beverloo", *discharge(p, tables["particles"]), 0.2))
    if case.scene.kind == "peening" and not case.scene.bed and case.output.particles >= 20:
        speed, count = rebounds(case, tables["particles"])
        found.append(
            _row(f"rebound of {count} shots that met the plate alone / e_n v", speed, single_rebound(case), 1e-3)
        )
    if case.scene.kind == "compaction":
        load, unload = stiffness(p, tables["rows"])
        found.append(_below("loading / unloading stiffness", load, unload, 0.0))
        put_in, back = recovered(p, tables["rows"])
        found.append(_below("work got back / put in", back, put_in, 0.0))
    if "ledger" in tables and "friction" not in tables["ledger"]:
        found.append(_row("energy: all terms but none as remainder", closure(tables["ledger"]), 0.0, 0.01))
    return pd.DataFrame(found, columns=["check", "value", "expected", "error", "tolerance", "passed"])


def fraction(volume: float, spheres: pd.DataFrame) -> float:
    """Volume share of spheres in `volume` [m^3]."""
    return float(4.0 / 3.0 * np.pi * (spheres["radius"] ** 3).sum() / volume)
