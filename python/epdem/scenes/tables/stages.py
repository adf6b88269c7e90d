# SPDX-License-Identifier: GPL-2.0-or-later
"""Stages of a press: pressure, height, density, springback and energies at the end of each phase."""

import math

import numpy as np
import pandas as pd

from ...base.readable import in_words
from ...case.walls import PlaneWall, PlateWall
from ..plan.phases import Phase
from ..plan.plan import ScenePlan
from .columns import FORCE, NORMAL, last_frame, place, work_of_walls

SLOW = 1e-3  # inertial number below which a bed deforms as if at rest [GDR MiDi 2004, Eur. Phys. J. E 14, 341]
FITTED = 0.95  # relative density up to which a stage counts for a fit
Tables = dict[str, pd.DataFrame]


def towards(p: ScenePlan, phase: Phase) -> float:
    """Speed [m/s] of the punch towards the wall that it presses against, which may move, too."""
    axis, at = against(p, np.zeros(1))
    begin = p.triangles[p.stages.wall][0, 0, axis]
    speed = phase.velocity(p.stages.wall)[axis] - phase.velocity(p.stages.against)[axis]
    return speed * math.copysign(1.0, at[0] - begin)


def against(p: ScenePlan, time: np.ndarray) -> tuple[int, np.ndarray]:
    """Axis of the press and places [m] at times [s] of the wall that the punch presses against."""
    wall = next(w for w in p.scene.wall if w.name == p.stages.against)
    assert isinstance(wall, PlaneWall | PlateWall)
    axis = "xyz".index(wall.axis)
    return axis, np.full(time.shape, wall.at) if isinstance(wall, PlaneWall) else place(p, wall.name, axis, time)


def heights(p: ScenePlan, time: np.ndarray) -> np.ndarray:
    """Height [m] of the bed between the punch and the wall that it presses against at times [s]."""
    axis, at = against(p, time)
    return np.asarray(np.abs(place(p, p.stages.wall, axis, time) - at))


def volume(p: ScenePlan, tables: Tables) -> float:
    """Volume of the spheres [m^3], of the last frame; without frames that of the plan."""
    if "particles" in tables and not tables["particles"].empty:
        radius = last_frame(tables["particles"])["radius"].to_numpy()
        return float((4.0 / 3.0 * math.pi * radius**3).sum())
    return next(bed.solid_height * bed.area for bed in p.beds)


def with_densities(p: ScenePlan, tables: Tables) -> pd.DataFrame:
    """The rows with height and relative density of the bed in the middle of each row."""
    height = heights(p, p.middles(tables["rows"]))
    return tables["rows"].assign(height=height, relative_density=volume(p, tables) / (p.stages.area * height))


def table(p: ScenePlan, tables: Tables) -> pd.DataFrame:
    """One row per phase from the first in which the punch moves towards the wall against it, SI.

    asked, reached: pressure of a stage, and that at the step at which it was found to be there, within MISS; error: of
    reached, or of the peak where the peak is farther above the stage. pressure, opposite_pressure: at that step in
    phases with `until`, else means of the last row of the phase; peak: the largest in the phase. springback: axial
    strain since the end of the last phase of loading, in phases in which the punch moves away. radial_pressure: of the
    frame at the end of the phase. work, plastic, elastic: as in the energy balance.
    """
    stages, rows, phases = p.stages, tables["rows"].set_index("step"), p.phase_table
    speeds = [towards(p, phase) for phase in p.phases]
    first = next((n for n, speed in enumerate(speeds) if speed > 0.0), len(speeds))
    chosen = phases.iloc[first:][phases.iloc[first:]["end"] > phases.iloc[first:]["begin"]]
    ends = chosen["end"].to_numpy(int)
    found = pd.DataFrame({"phase": chosen["phase"].to_numpy(), "step": ends, "time": chosen["end_time"].to_numpy()})
    conditions = [p.phases[n].case.condition for n in chosen.index]
    of_punch = np.array([c is not None and c.wall == stages.wall for c in conditions])
    asked = [c.force for c in conditions if c and c.wall == stages.wall]
    found["asked"] = math.nan
    found.loc[of_punch, "asked"] = [math.nan if x is None else x / stages.area for x in asked]
    forces = (chosen["force"].fillna(chosen["value"]), chosen["opposite"])
    value, opposite = (force.to_numpy(float) / stages.area for force in forces)
    known = of_punch & np.isfinite(value)  # not where a bed without void has ended the run, maybe within a row
    found["pressure"] = np.where(known, value, rows[stages.pressure].reindex(ends, method="ffill"))
    found["opposite_pressure"] = np.where(known, opposite, rows[stages.opposite].reindex(ends, method="ffill"))
    found["reached"] = found["pressure"].where(found["asked"].notna())
    spans = zip(chosen["begin"], ends, found["pressure"], strict=True)
    found["peak"] = [max(end, rows[stages.pressure].loc[low + 1 : high].max()) for low, high, end in spans]
    # a bed that was pressed beyond its stage does not get its density back where the punch goes back
    error, beyond = (found[name] / found["asked"] - 1.0 for name in ("reached", "peak"))
    found["error"] = error.where(error.abs() >= beyond, beyond)
    found["height"] = heights(p, found["time"].to_numpy())
    found["relative_density"] = volume(p, tables) / (stages.area * found["height"])
    found["porosity"] = 1.0 - found["relative_density"]
    speed = pd.Series([speeds[n] for n in chosen.index])
    loaded = found["height"].where(speed > 0.0).ffill()
    found["springback"] = (found["height"] / loaded - 1.0).where(speed < 0.0)
    if stages.sides and "contacts" in tables:
        loads = normal_forces(p, tables["contacts"]).groupby("step")["load"].sum()
        normal = loads.reindex(ends, fill_value=0.0).to_numpy()
        found["radial_pressure"] = normal / (stages.perimeter * found["height"])
        axial = 0.5 * (found["pressure"] + found["opposite_pressure"])
        found["radial_over_axial"] = found["radial_pressure"] / axial.where(axial > 0.0)
    found["work"] = np.interp(ends, tables["rows"]["step"], work_of_walls(p, tables["rows"]))
    if "currents" in tables:
        found["conductance"] = tables["currents"].set_index("step")["conductance"].reindex(ends).to_numpy()
    if "energy_balance" in tables:
        energies = tables["energy_balance"].set_index("step")
        for name in ("plastic", "elastic"):
            found[name] = energies[name].reindex(ends).to_numpy()
    return found


def loaded(p: ScenePlan, stages: pd.DataFrame) -> pd.DataFrame:
    """The rows of the table for phases of loading."""
    names = [phase.name for phase in p.phases if towards(p, phase) > 0.0]
    return stages[stages["phase"].isin(names)]


def against_measured(p: ScenePlan, tables: Tables) -> list[str]:
    """One line: the relative density of the scene less the measured one where loading first reaches each pressure."""
    if (known := p.case.measured) is None:  # of a press alone
        return []
    pressure, density = (tables["rows"][name].to_numpy() for name in (p.stages.pressure, "relative_density"))
    if not (pressure > 0.0).any():
        return []
    rising = (pressure > 0.0) & (pressure > np.maximum.accumulate(np.append(-math.inf, pressure[:-1])))
    there = np.interp(known.pressures, pressure[rising], density[rising], left=math.nan, right=math.nan)
    found = [
        f"not reached at {in_words(at, 'Pa')}" if math.isnan(ours) else f"{ours - value:+.3f} at {in_words(at, 'Pa')}"
        for at, value, ours in zip(known.pressures, known.relative_densities, there, strict=True)
    ]
    return [f"relative density less the measured one: {', '.join(found)} ({known.source})"]


def normal_forces(p: ScenePlan, contacts: pd.DataFrame) -> pd.DataFrame:
    """step, i and `load`, the normal force on the sides [N], of each contact with them."""
    found = contacts[contacts["wall"].isin(p.stages.sides)]
    normal = np.abs((found[FORCE].to_numpy() * found[NORMAL].to_numpy()).sum(axis=1))
    return found[["step", "i"]].assign(load=normal)


def inertial_numbers(p: ScenePlan, stages: pd.DataFrame) -> pd.Series:
    """Inertial number v/h d sqrt(rho/P) at the end of each phase in which the punch moves; h, P of that time."""
    speed = {phase.name: abs(towards(p, phase)) for phase in p.phases}
    density = max(p.case.materials[part.material].density for part in p.scene.filled)
    rate = stages["phase"].map(speed) / stages["height"]
    pressure = stages["pressure"].clip(lower=0.0)
    moving = stages[(rate > 0.0) & (pressure > 0.0)].index
    found: pd.Series = 2.0 * p.largest * rate[moving] * np.sqrt(density / pressure[moving])
    return found


def compared(stages: pd.DataFrame) -> pd.DataFrame:
    """The rows of loading that lines through stages are fitted to: without those that are nearly solid."""
    return stages[stages["relative_density"] < FITTED]
