# SPDX-License-Identifier: GPL-2.0-or-later
"""Electric currents through the contacts of each frame, between walls with potentials. SI."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import spsolve

from ...jobs.stage import Tables
from ...theory.pair import contact_conductance
from ..plan.plan import ScenePlan
from .columns import Array, bodies

Index = npt.NDArray[np.signedinteger[Any]]


def node_currents(i: Index, j: Index, conductance: Array, potential: Array) -> Array:
    """Current [A] out of each node into the network; 0 where the potential is unknown.

    i, j: nodes of each contact, from 0; conductance [S] of each; potential [V] of each node, NaN: unknown. Nodes that
    no contact joins to a node with a potential carry no current.
    """
    n, touch = len(potential), conductance > 0.0
    i, j, g = i[touch], j[touch], conductance[touch]
    known = np.isfinite(potential)
    ends = np.concatenate([i, j]), np.concatenate([j, i])
    links = coo_array((np.concatenate([g, g]), ends), shape=(n, n)).tocsr()
    part = connected_components(links, directed=False)[1]
    unknown = ~known & np.isin(part, part[known])
    found = np.where(known, potential, 0.0)
    if unknown.any():
        matrix = coo_array((np.asarray(links.sum(axis=1)).ravel(), (np.arange(n),) * 2), shape=(n, n)).tocsr() - links
        rows = matrix[unknown]
        found[unknown] = spsolve(rows[:, unknown].tocsc(), -(rows[:, known] @ potential[known]))
    flow = g * (found[i] - found[j])
    currents = np.bincount(i, flow, n) - np.bincount(j, flow, n)
    return np.asarray(np.where(known, currents, 0.0))


def currents(p: ScenePlan, tables: Tables) -> pd.DataFrame:
    """One row per frame: step, time, WALL_current [A] from each wall with a potential into the spheres; of two walls
    their conductance [S], current over voltage."""
    contacts, potentials = tables["contacts"], p.potentials
    first, second = bodies(p, contacts, tables["particles"])
    of_type = np.array([0.0, *(p.case.materials[t.material].electrical_conductivity or 0.0 for t in p.model.types)])
    k_i, k_j = (of_type[body["type"].to_numpy(int)] for body in (first, second))
    at_wall = (contacts["j"] == 0).to_numpy()
    carries = ~at_wall | contacts["wall"].isin([*potentials]).to_numpy()
    conductance = np.zeros(len(contacts))
    radius = contacts["contact_radius"].to_numpy()
    conductance[carries] = contact_conductance(k_i=k_i[carries], k_j=k_j[carries], radius=radius[carries])
    number = {name: n for n, name in enumerate(potentials)}
    wall = contacts["wall"].map(number).fillna(0).to_numpy(int)
    found = []
    for step in np.unique(tables["particles"]["step"]):
        at = (contacts["step"] == step).to_numpy()
        names, nodes = np.unique(contacts.loc[at, ["i", "j"]].to_numpy(), return_inverse=True)
        i, j = len(number) + nodes.reshape(-1, 2).T
        j = np.where(at_wall[at], wall[at], j)
        potential = np.array([*potentials.values(), *np.full(len(names), np.nan)])
        found.append([step, *node_currents(i, j, conductance[at], potential)[: len(number)]])
    table = pd.DataFrame(found, columns=["step", *(f"{name}_current" for name in number)]).astype({"step": "int64"})
    table.insert(1, "time", p.time_at(table["step"].to_numpy()))
    table.attrs["units"] = {f"{name}_current": "A" for name in number}
    if len(number) == 2:
        high, low = potentials.values()
        table["conductance"] = table.iloc[:, 2] / (high - low)
    return table
