# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks of the results of a scene by routes that do not use the contact law."""

import math
from dataclasses import dataclass

import numpy as np
import pandas as pd

from ...base.tables import Column
from ...case.outputs import BedRebound, FloorLoad, MassFlow, ReboundSpeed, TorqueOfBed, Unloading
from ...case.scene import SceneCase
from ...impacts.prediction import predict
from ...laws.strengths import ADHESION
from ..plan.model import pair_law
from ..plan.phases import REACHED
from ..plan.plan import ScenePlan
from ..plan.timestep import impact
from ..tables.columns import last_frame
from .energy_balance import closure, kinetic, largest_gain, rotation

Row = dict[str, object]
CHECKS = {  # the unit of value and expected; what passes
    "spheres_in_room": Column("", "all spheres are in the room at the end"),
    "floor_load": Column("N", "the floor load is the weight of the spheres (smooth walls: hydrostatic)"),
    "rebound_of_the_bed": Column("m", "the bed rises by at most e_n^2 times its fall"),
    "mass_flow": Column("kg/s", "the mass flow agrees with Beverloo's formula"),
    "rebound_speed": Column("m/s", "{count} shots that hit the plate alone leave it with e_n v"),
    "loading_stiffness": Column("N/m", "loading is at most as stiff as unloading"),
    "recovered_work": Column("J", "the plate recovers at most the work that it did"),
    "torque_of_the_bed": Column("N m", "the torque on the drum is the weight of the bed times its arm"),
    "force_on_all_walls": Column("N", "the force on all walls is the weight of the spheres"),
    "void": Column("", "number of pressed beds that lost all void, which ended the run"),
    "stage_pressure": Column("Pa", "each stage reaches its pressure and keeps it (here the one farthest from it)"),
    "reached_force": Column("N", "each force that ends a phase is the one asked for (here the farthest from it)"),
    "density": Column("", "largest relative density, which stays below 1"),
    "energy_residual": Column("", "the energy balance closes: no term is a remainder"),
    "energy_gained": Column("", "friction, the rest of the energy balance, is not negative"),
}
COLUMNS = ("key", "check", "value", "expected", "error", "tolerance", "unit", "passed")
AT_REST = 1e-2  # of the energy of a fall by a radius: kinetic energy of a bed at rest
MOST_PRESSED = 5.0  # of a wall, in weights of the bed: up to a tolerance of 10 % the sum of forces tells the weight
MANY = 20  # frames from which on motion is followed
LEAST_BED = 20  # spheres that have a bulk density
SHALLOW = 0.5  # of the outlet's diameter: a lower bed has neither bulk density nor a steady rate


def _row(key: str, value: float, expected: float, tolerance: float, *, passed: bool | None = None, **words: int) -> Row:
    """A check of CHECKS. passed: by default whether the relative error (absolute of 0) is within the tolerance."""
    unit, sentence = CHECKS[key]
    error = abs(value / expected - 1.0) if expected else abs(value)
    verdict = error <= tolerance if passed is None else passed
    cells = (key, sentence.format(**words), value, expected, error, tolerance, unit, bool(verdict))
    return dict(zip(COLUMNS, cells, strict=True))


def _below(key: str, value: float, limit: float) -> Row:
    """A check of CHECKS: the value is at most the limit; the error is the excess."""
    excess = value / limit - 1.0 if limit else math.copysign(math.inf, value) if value else 0.0
    return _row(key, value, limit, 0.0, passed=value <= limit) | {"error": max(0.0, excess)}


def floor_load(case: SceneCase, check: FloorLoad, tables: dict[str, pd.DataFrame]) -> tuple[float, float]:
    """(mean load over the last fifth of the run, weight of the spheres) [N]."""
    rows, mass = tables["rows"], last_frame(tables["particles"])["mass"].sum()
    tail = rows[rows["step"] > 0.8 * rows["step"].max()]
    return float(tail[check.row].mean()), float(mass * case.parts.gravity)


def bed_rebound(case: SceneCase, spheres: pd.DataFrame) -> tuple[float, float]:
    """(largest rise of the centre of mass above an earlier minimum, largest rise by theory: e_n^2 times its fall) [m].

    The pair with the largest e_n at the speed of the fall gives e_n. Landing one after the other and impacts within the
    bed only reduce the rise: e_n^2 v^2 is concave in v^2, so that its mean over falls is below its value at the mean.
    """
    present = spheres.groupby("step")["id"].count()
    whole = spheres[spheres["step"].isin(present.index[present == present.max()])]
    sums = whole.assign(height=whole["mass"] * whole["z"], kinetic=kinetic(whole) + rotation(whole)).groupby("step")
    total = whole["mass"].sum() / sums.ngroups
    place = sums["height"].sum().to_numpy() / total
    fall = place[0] + sums["kinetic"].sum().iloc[0] / (total * case.parts.gravity) - place.min()
    names = {p.material for p in case.parts.filled}
    v, radius = float(np.sqrt(2 * case.parts.gravity * fall)), case.parts.leading.radii()[0]
    pairs = [(a, b) for a in names for b in names | {*case.parts.wall_materials}]
    e_n = max(float(predict(impact(case, a, radius, b, v)).e_n[-1]) for a, b in pairs)
    return float((place - np.minimum.accumulate(place)).max()), e_n**2 * fall


def stiffness(p: ScenePlan, press: Unloading, rows: pd.DataFrame) -> tuple[float, float]:
    """Secant stiffness [N/m] of (loading, unloading) between half the largest force and that force."""
    turn = p.phases[-2].end
    load, unload = rows[rows["step"] <= turn], rows[rows["step"] > turn]
    way_up, up = load[press.position].to_numpy()[::-1], load[press.force].to_numpy()[::-1]
    way_down, down = unload[press.position].to_numpy(), unload[press.force].to_numpy()
    bottom, top = way_up[0], up[0]
    below = int(np.argmax(up < 0.5 * top)), int(np.argmax(down < 0.5 * top))
    forces = top - up[below[0]], top - down[below[1]]
    ways = way_up[below[0]] - bottom, way_down[below[1]] - bottom  # 0: the force is gone within the row of the turn
    load, unload = (float(force / way) if way > 0 else np.inf for force, way in zip(forces, ways, strict=True))
    return load, unload


def works_of_wall(p: ScenePlan, press: Unloading, rows: pd.DataFrame) -> tuple[float, float]:
    """Work [J] that a wall (put in, got back): its force, a mean over each interval, times the displacement."""
    row = next(row for row in p.scene.row if row.name == press.force)
    phase = np.searchsorted([phase.end for phase in p.phases[:-1]], rows["step"])
    speed = row.sign * np.array([phase.velocity(row.wall)[row.axis] for phase in p.phases])[phase]
    seconds = np.diff(p.time_at(rows["step"].to_numpy()), prepend=0.0)
    work = rows[press.force].to_numpy() * np.abs(speed) * seconds
    return float(work[speed < 0].sum()), float(work[speed > 0].sum())


@dataclass(frozen=True)
class Discharge:
    """Flow through an outlet: mass rate [kg/s], bulk density of the bed as it opens [kg/m^3], mean diameter [m],
    fraction of the bed that has passed at the end; why no rate is expected, or nothing."""

    rate: float
    bulk: float
    diameter: float
    passed: float
    unknown: str = ""


def discharge(p: ScenePlan, flow: MassFlow, spheres: pd.DataFrame, part: tuple[float, float] = (0.2, 0.6)) -> Discharge:
    """The slope of the mass below the outlet against time, while it is between the two parts of the bed.

    NaN where fewer than two frames lie between them. The bulk density is that from 0.2 to 0.7 of the height of the bed
    above the outlet.
    """
    steps = np.sort(spheres["step"].unique())
    bed = spheres[(spheres["step"] == steps[steps <= p.phases[0].end].max()) & (spheres["z"] > flow.at)]
    if len(bed) < LEAST_BED:
        return Discharge(np.nan, np.nan, np.nan, 0.0, f"{len(bed)} spheres above the outlet as it opens are no bed")
    out = spheres[spheres["z"] < flow.at].groupby("step")["mass"].sum().reindex(steps, fill_value=0.0).to_numpy()
    passed = out / bed["mass"].sum()
    during = (passed > part[0]) & (passed < part[1])
    height = float(np.quantile(bed["z"], 0.95) - flow.at)
    low, high = flow.at + np.array([0.2, 0.7]) * height
    inside = bed[(bed["z"] > low) & (bed["z"] < high)]
    bulk = inside["mass"].sum() / (flow.volume(high) - flow.volume(low))
    diameter, unknown = 2 * float(bed["radius"].mean()), ""
    if not p.scene.gravity:
        unknown = "nothing falls without gravity"
    elif kinetic(bed).sum() > AT_REST * (bed["mass"] * p.scene.gravity * bed["radius"]).sum():
        unknown = "the bed still falls as the outlet opens; give a longer fill_time"
    elif flow.outlet <= 1.4 * diameter:
        unknown = f"the outlet of {flow.outlet:g} m is below 1.4 diameters of the spheres, where nothing flows"
    elif height < SHALLOW * flow.outlet:
        unknown = f"the bed of {height:.3g} m above the outlet is below half of the outlet's {flow.outlet:g} m"
    elif during.sum() < 2 and passed[-1] >= 0.6:
        unknown = "the bed flows out between two frames; give more output.particles"
    rate = np.polyfit(p.time_at(steps[during]), out[during], 1)[0] if during.sum() > 1 else np.nan
    return Discharge(float(rate), float(bulk), diameter, float(passed[-1]), unknown)


def beverloo(discharge: Discharge, flow: MassFlow, gravity: float) -> float:
    """W = 0.58 rho_b sqrt(g) (D - 1.4 d)^2.5 [kg/s] through an outlet D [m], times the factor of a steep cone.

    Beverloo, Leniger and van de Velde 1961, Chem. Eng. Sci. 15, 260; 1.4 stands for 1.2 to 1.6. NaN where no rate is
    expected.
    """
    if discharge.unknown:
        return math.nan
    flat = 0.58 * discharge.bulk * np.sqrt(gravity) * (flow.outlet - 1.4 * discharge.diameter) ** 2.5
    return float(flow.steepness * flat)


def flow_warnings(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> list[str]:
    """A sentence for each mass flow without an expected rate, and for an outlet that lets no sphere through."""
    found = []
    for check in (x for x in p.scene.check if isinstance(x, MassFlow) and "particles" in tables):
        spheres = tables["particles"]
        flow = discharge(p, check, spheres)
        if flow.unknown:
            found.append(f"the mass flow is not compared with Beverloo's formula: {flow.unknown}")
        elif flow.passed > 0.0 and math.isnan(flow.rate):
            found.append(
                f"the mass flow has no value: at the end {flow.passed:.2g} of the bed has passed the outlet, and a "
                "rate is that of two frames or more between 0.2 and 0.6; give a longer duration, or look for an arch"
            )
        if not (last_frame(spheres)["z"] < check.at).any() and not p.scene.open_boundary:
            found.append(f"no sphere passed the outlet{_bond_number(p)}")
    return found


def _bond_number(p: ScenePlan) -> str:
    """The pull-off force of two spheres of the first filling over the weight of one, in words; without adhesion ""."""
    if not p.model.adheres or not p.scene.gravity:
        return ""
    lead = p.scene.leading
    radius, material = lead.radii()[0], lead.material
    gamma = pair_law(p.case, material, material)[0].parameters[ADHESION]
    weight = 4 / 3 * math.pi * radius**3 * p.case.materials[material].density * p.scene.gravity
    bond = 0.75 * math.pi * gamma * radius / weight
    return f": the Bond number of its spheres (pull-off force over weight) is {bond:.3g}"


def bed_torque(p: ScenePlan, check: TorqueOfBed, tables: dict[str, pd.DataFrame]) -> tuple[float, float]:
    """(torque on the drum and growth of the bed's angular momentum, M g x_cm) about the y axis [N m], means over the
    second half of the run.

    The balance of angular momentum, without the contact law: it holds for any motion of the bed.
    """
    spheres, rows = tables["particles"], tables["rows"]
    m, r = spheres["mass"], spheres["radius"]
    momentum = m * (spheres["z"] * spheres["vx"] - spheres["x"] * spheres["vz"])
    if "omega_y" in spheres:
        momentum += 0.4 * m * r**2 * spheres["omega_y"]
    bed = pd.DataFrame({"arm": m * spheres["x"], "momentum": momentum}).groupby(spheres["step"]).sum()
    bed = bed[bed.index >= 0.5 * bed.index[-1]]
    times, seconds = p.time_at(bed.index.to_numpy()), np.diff(p.time_at(rows["step"].to_numpy()), prepend=0.0)
    during = (rows["step"] > bed.index[0]) & (rows["step"] <= bed.index[-1])
    torque = np.average(rows.loc[during, check.row], weights=seconds[during])
    growth = bed["momentum"].iloc[-1] - bed["momentum"].iloc[0]
    arm = np.average(bed["arm"].rolling(2).mean().iloc[1:], weights=np.diff(times))
    return float(torque + growth / (times[-1] - times[0])), float(p.scene.gravity * arm)


def single_rebound(case: SceneCase, s: ReboundSpeed) -> float:
    """Speed [m/s] at which one sphere leaves a flat target, by theory alone."""
    shot = next(fill for fill in case.parts.random_fills if fill.name == s.fill).particles[0]
    return float(predict(impact(case, shot.material, shot.radii()[0], s.target, s.speed)).e_n[-1] * s.speed)


def rebounds(spheres: pd.DataFrame, speed: float, expected: float) -> tuple[float, int]:
    """(speed [m/s] farthest from the expected one, count) of the shot that met the target and nothing else.

    Only those go straight up, of shot that came with `speed`: a hit between two shots is never central.
    """
    side = np.hypot(spheres["vx"], spheres["vy"])
    straight = spheres[(spheres["vz"] > 0) & (side < 1e-9 * speed)]
    speeds = straight.groupby("id")["vz"].max().to_numpy()
    if not speeds.size:
        return np.nan, 0
    return float(speeds[np.argmax(np.abs(speeds - expected))]), speeds.size


def _has_smooth_walls(p: ScenePlan) -> bool:
    contact = p.case.contact
    smooth = contact.wall_friction == 0.0 or (contact.friction == 0.0 and contact.wall_friction is None)
    return smooth and not any("wall" in pair.between for pair in contact.pairs) and not contact.cohesion


def _of_parts(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> list[Row]:
    """Walls carry the weight of a bed at rest, whose energy is far below the energy of a fall by a radius.

    No check where other bodies may carry the weight: a wall whose force is not in the rows, a frozen sphere.
    """
    there = {w.name for w in p.scene.planes} | {*p.scene.meshes, *p.phases[-1].gates}
    known = there <= {*p.loads} and not any(s.frozen for s in p.scene.table)
    if not (there and known) or p.scene.open_boundary or "particles" not in tables or not p.scene.gravity:
        return []
    last = last_frame(tables["particles"])
    weight = last["mass"] * p.scene.gravity
    if last.empty or kinetic(last).sum() > AT_REST * (weight * last["radius"]).sum():
        return []
    row = tables["rows"].iloc[-1]
    forces = [-float(row[f"{name}_force_z"]) for name in p.loads]
    of_largest = max(1.0, *(abs(f) / float(weight.sum()) for f in forces))  # a lid may press with many times the weight
    if of_largest > MOST_PRESSED:  # the weight vanishes in what presses
        return []
    return [_row("force_on_all_walls", sum(forces), float(weight.sum()), 0.02 * of_largest)]


STAGE = 0.02  # error of the pressure of a stage, or of a force that ends a phase


def reached_forces(p: ScenePlan) -> dict[str, tuple[float, float]]:
    """Phase -> (force found, force asked for) [N] on a wall whose force has ended a phase, but of a stage of a press.

    Not of walls that a force or a vibration drives, which the mean of a row ends.
    """
    of_stages = p.scene.stages and p.scene.stages.wall
    return {
        phase.name: (phase.value, c.force)
        for phase in p.phases
        if phase.reached == REACHED and phase.stops and (c := phase.case.condition) and c.force and c.wall != of_stages
    }


def _of_forces(p: ScenePlan) -> list[Row]:
    """Each force that ends a phase is the one asked for."""
    found = max(reached_forces(p).values(), key=lambda force: abs(force[0] / force[1] - 1.0), default=None)
    return [] if found is None else [_row("reached_force", *found, STAGE)]


def _of_stages(stages: pd.DataFrame) -> list[Row]:
    """Each stage has its pressure, and none is denser than its spheres."""
    rows, asked = [], stages[stages["asked"].notna()]
    if not asked.empty:
        worst = asked.loc[asked["error"].abs().idxmax()]
        rows.append(
            _row("stage_pressure", float(worst["asked"] * (1.0 + worst["error"])), float(worst["asked"]), STAGE)
        )
    if not stages.empty:
        densest = float(stages["relative_density"].max())
        rows.append(_below("density", densest, 1.0) | {"passed": densest < 1.0})
    return rows


def checks(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """One row per check: key, sentence, value, expected, relative error, tolerance, unit, passed."""
    rows, many = [], p.output.particles >= MANY
    if p.solid:
        rows.append(_row("void", 1.0, 0.0, 0.0))
    elif not p.scene.open_boundary:
        rows.append(_row("spheres_in_room", float(tables["rows"]["particles"].iloc[-1]), float(p.count), 0.0))
    for check in p.scene.check:
        match check:
            case FloorLoad() if "particles" in tables and _has_smooth_walls(p) and p.scene.gravity:  # or 0 is 0
                rows.append(_row("floor_load", *floor_load(p.case, check, tables), 0.02))
            case BedRebound() if many and p.scene.gravity and not p.model.adheres:  # what sticks swings back
                rows.append(_below("rebound_of_the_bed", *bed_rebound(p.case, tables["particles"])))
            case MassFlow() if many:
                flow = discharge(p, check, tables["particles"])
                if not flow.unknown:
                    rows.append(_row("mass_flow", flow.rate, beverloo(flow, check, p.scene.gravity), 0.2))
            case ReboundSpeed() if many and len(p.phases) == 1:
                expected = single_rebound(p.case, check)
                speed, count = rebounds(tables["particles"], check.speed, expected)
                allowed = max(1e-3, p.case.numerics.error)  # of the time step
                rows.append(_row("rebound_speed", speed, expected, allowed, count=count))
            case TorqueOfBed() if many and p.scene.gravity and not p.model.rolling:  # whose torque is no force
                rows.append(_row("torque_of_the_bed", *bed_torque(p, check, tables), 0.01))
            case Unloading():
                put_in, back = works_of_wall(p, check, tables["rows"])
                rows.append(_below("loading_stiffness", *stiffness(p, check, tables["rows"])))
                rows.append(_below("recovered_work", back, put_in))
    rows += _of_parts(p, tables)
    rows += _of_forces(p)
    rows += _of_stages(tables["stages"]) if "stages" in tables else []
    if "energy_balance" in tables and not p.model.loses_energy:
        rows.append(_row("energy_residual", closure(tables["energy_balance"]), 0.0, 0.01))
    elif "energy_balance" in tables and "friction_work" not in p.works:
        rows.append(_row("energy_gained", largest_gain(tables["energy_balance"]), 0.0, 0.01))
    return pd.DataFrame(rows, columns=COLUMNS)
