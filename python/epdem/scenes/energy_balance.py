# SPDX-License-Identifier: GPL-2.0-or-later
"""Energy balance of a scene for each frame. No term is a remainder, except the work of friction of one spring."""

import numpy as np
import pandas as pd

from .plan import ScenePlan


def kinetic(spheres: pd.DataFrame) -> pd.Series:
    """Kinetic energy [J] of each sphere's translation, as in the rows."""
    energy: pd.Series = 0.5 * spheres["mass"] * (spheres[["vx", "vy", "vz"]] ** 2).sum(axis=1)
    return energy


def rotation(spheres: pd.DataFrame) -> pd.Series:
    """Energy [J] of each sphere's spin; 0 if the table does not have it."""
    if "omega_x" not in spheres:
        return 0.0 * spheres["mass"]
    spin: pd.Series = (spheres[["omega_x", "omega_y", "omega_z"]] ** 2).sum(axis=1)
    return 0.2 * spheres["mass"] * spheres["radius"] ** 2 * spin


def work_of_walls(p: ScenePlan, rows: pd.DataFrame) -> np.ndarray:
    """Work [J] that moving walls have done up to each row: mean force or torque of the interval times the displacement.

    The torque of a drum counts normal forces on its flat facets too, which do no work: noise of 0.1 % of the energies.
    """
    dt = np.diff(p.time_at(rows["step"].to_numpy()), prepend=0.0)
    if "plate_force" in p.row_columns:
        return np.cumsum(rows["plate_force"].to_numpy() * -plate_velocity(p, rows) * dt)
    if "torque" in p.row_columns:
        (rotation_of_drum,) = p.rotations("drum")
        return np.cumsum(-rows["torque"].to_numpy() * rotation_of_drum.rate * dt)
    if "wall_power" in p.row_columns:
        return np.cumsum(rows["wall_power"].to_numpy() * dt)
    return np.zeros(len(rows))


def plate_velocity(p: ScenePlan, rows: pd.DataFrame) -> np.ndarray:
    """Velocity [m/s] of the plate along z in the interval that ends with each row."""
    phase = np.searchsorted([phase.end for phase in p.phases[:-1]], rows["step"])
    speeds: np.ndarray = np.array([phase.plate for phase in p.phases])[phase]
    return speeds


def _left(spheres: pd.DataFrame, steps: np.ndarray) -> np.ndarray:
    """Energy [J] of the spheres that left before each step, from their last frame: kinetic, plastic, adhesive and
    friction."""
    energy = kinetic(spheres) + rotation(spheres)
    for name in ("plastic_work", "adhesive_work", "friction_work"):
        energy = energy + spheres.get(name, 0.0)
    last = spheres.groupby("id")["step"].max()
    gone = last[last < steps[-1]]
    taken = np.zeros(steps.size)
    at_last = spheres.assign(energy=energy).sort_values("step").groupby("id")["energy"].last()
    for sphere, step in gone.items():
        taken[steps > step] += at_last[sphere]
    return taken


def energy_balance(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """One row per frame [J]: kinetic, gravity, elastic, plastic, work done by walls, left, and the balance.

    With friction or rolling also rotation; with adhesion the work lost by jumps, and `elastic` includes the surface
    energy. With partial slip also friction, the work of friction, and springs, the elastic energy of the springs.

    The balance is the sum of all energies less the work of walls, relative to the first frame with all spheres. The
    balance vanishes unless contacts have rolling friction, dashpots or a friction spring: then the balance is their
    work, and `friction` is the negative balance where friction work is not computed.
    """
    spheres, contacts = tables["particles"], tables["contacts"]
    steps = np.sort(spheres["step"].unique())
    gravity = spheres["mass"] * p.case.scene.gravity * spheres["z"]
    by_step = spheres.assign(kinetic=kinetic(spheres), rotation=rotation(spheres), gravity=gravity)
    sums = by_step.groupby("step")[["kinetic", "rotation", "gravity"]].sum()
    table = pd.DataFrame({"step": steps, "time": p.time_at(steps)})
    table["kinetic"], table["gravity"] = sums["kinetic"].to_numpy(), sums["gravity"].to_numpy()
    if p.model.spins:
        table["rotation"] = sums["rotation"].to_numpy()
    table["elastic"] = contacts.groupby("step")["elastic_energy"].sum().reindex(steps, fill_value=0.0).to_numpy()
    for name, column in (("plastic", "plastic_work"), ("adhesion", "adhesive_work")):
        if column in spheres:
            table[name] = spheres.groupby("step")[column].sum().reindex(steps).to_numpy()
        elif name == "plastic":
            table[name] = 0.0
    if "friction_work" in p.works:
        both = spheres.groupby("step")[["friction_work", "friction_energy"]].sum().reindex(steps)
        table["friction"], table["springs"] = both["friction_work"].to_numpy(), both["friction_energy"].to_numpy()
    rows = tables["rows"]
    table["work"] = np.interp(steps, rows["step"], work_of_walls(p, rows))
    table["left"] = _left(spheres, steps) if p.scene.open_boundary else 0.0
    present = spheres.groupby("step")["id"].count().reindex(steps).to_numpy()
    start = int(np.argmax(present == present.max()))
    rubbed = ["friction", "springs"] if "friction_work" in p.works else []
    kinds = ["kinetic", "rotation", "gravity", "elastic", "plastic", "adhesion", "left", *rubbed]
    total = table.reindex(columns=kinds, fill_value=0.0).sum(axis=1) - table["work"]
    table["balance"] = total - total.iloc[start]
    table = table.iloc[start:].reset_index(drop=True)
    if p.model.loses_energy and "friction_work" not in p.works:
        table["friction"] = -table["balance"]
    return table


def closure(table: pd.DataFrame) -> float:
    """Largest balance over the energy that moved: of the start, and what walls put in."""
    terms = table.reindex(columns=["kinetic", "rotation", "elastic", "plastic", "adhesion", "work"]).abs().max().sum()
    fall = abs(table["gravity"].iloc[0] - table["gravity"].min())
    return float(table["balance"].abs().max() / max(terms, fall, 1e-300))
