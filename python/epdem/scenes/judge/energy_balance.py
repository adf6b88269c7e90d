# SPDX-License-Identifier: GPL-2.0-or-later
"""Energy balance of a scene for each frame, without the contact law. SI."""

import numpy as np
import pandas as pd

from ..plan.plan import ScenePlan
from ..plan.quantities import WORKS
from ..tables.columns import work_of_walls


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


def _lost_energy(spheres: pd.DataFrame, energy: pd.Series, steps: np.ndarray) -> np.ndarray:
    """Energy [J] of the spheres that left before each step, in their last frame."""
    at_last = spheres.assign(energy=energy).sort_values("step").groupby("id")[["step", "energy"]].last()
    gone = at_last[at_last["step"] < steps[-1]]
    by_step = gone.groupby("step")["energy"].sum().reindex(steps, fill_value=0.0)
    return np.asarray(by_step.cumsum().shift(fill_value=0.0))


def energy_balance(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """One row per frame [J]: kinetic, gravity, elastic, plastic, work done by walls, lost_spheres_energy, balance.

    gravity: with the spheres that have left, at their last height. elastic: with cohesion less its potential.
    With friction or rolling also rotation; with adhesion the work lost by jumps, and `elastic` includes the surface
    energy. With partial slip also friction, the work of friction, and springs, the elastic energy of the springs.

    The balance is the sum of all energies less the work of walls, relative to the frame in which the last spheres come
    in. The balance vanishes unless contacts have rolling friction, dashpots or a friction spring: then the balance is
    their work, and `friction` is the negative balance where friction work is not computed.
    """
    spheres, contacts, rows = tables["particles"], tables["contacts"], tables["rows"]
    own = {"kinetic": kinetic(spheres)} | ({"rotation": rotation(spheres)} if p.model.spins else {})
    own |= {"plastic": 0.0 * spheres["mass"]} | {
        work.term: spheres[name] for name, work in WORKS.items() if name in spheres
    }
    gravity = spheres["mass"] * p.scene.gravity * spheres["z"]
    terms = pd.DataFrame(own | {"gravity": gravity}).groupby(spheres["step"]).sum()
    steps = terms.index.to_numpy()
    terms["elastic"] = contacts.groupby("step")["elastic_energy"].sum().reindex(steps, fill_value=0.0)
    terms["lost_spheres_energy"] = 0.0
    if p.scene.open_boundary:
        terms["lost_spheres_energy"] = _lost_energy(spheres, sum(own.values()), steps)
        terms["gravity"] += _lost_energy(spheres, gravity, steps)
    table = terms.assign(work=np.interp(steps, rows["step"], work_of_walls(p, rows)))
    total = terms.sum(axis=1) - table["work"]
    start = spheres.groupby("id")["step"].min().max()  # from here on no sphere comes in; some may have left before
    table["balance"] = total - total[start]
    if p.model.loses_energy and "friction" not in table:
        table["friction"] = -table["balance"]
    table.insert(0, "time", p.time_at(steps))
    return table.loc[start:].reset_index()


def closure(table: pd.DataFrame) -> float:
    """Largest balance over the energy that moved: of the start, and what walls put in."""
    return float(table["balance"].abs().max() / _moved(table))


def largest_gain(table: pd.DataFrame) -> float:
    """The lowest work of friction, where it is the rest of the balance, over the energy that moved; at most 0."""
    return min(0.0, float(table["friction"].min() / _moved(table)))


def _moved(table: pd.DataFrame) -> float:
    terms = table.reindex(columns=["kinetic", "rotation", "elastic", "plastic", "adhesion", "work"]).abs().max().sum()
    return max(float(terms), float(abs(table["gravity"].iloc[0] - table["gravity"].min())), 1e-300)
