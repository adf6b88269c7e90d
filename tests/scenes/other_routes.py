# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers of a scene's tables by routes that the product does not take."""

import numpy as np
import pandas as pd
import pytest

from epdem.scenes.plan.model import pair_law


def assert_frames(p, tables):
    """Each recorded phase ends with a frame and a row; the row has the kinetic energy of the frame's spheres."""
    spheres, rows = tables["particles"], tables["rows"].set_index("step").query("particles > 0")["kinetic_energy"]
    recorded = {phase.name for phase in p.scene.phase if phase.record}
    ends = tables["phases"].set_index("phase")["end"]
    ends = ends[ends.index.isin(recorded) & ends.isin(rows.index)]
    assert set(ends) <= set(spheres["step"]) and ends.iloc[-1] == rows.index[-1]
    energy = (0.5 * spheres["mass"] * (spheres[["vx", "vy", "vz"]] ** 2).sum(axis=1)).groupby(spheres["step"]).sum()
    assert rows[energy.index].to_numpy() == pytest.approx(energy.to_numpy(), rel=1e-6)


def assert_forces(p, contacts, spheres):
    """The normal forces of the engine in both end frames are the forces of theory at the overlaps of the frames."""
    for step in {contacts["step"].min(), contacts["step"].max()}:
        _assert_forces(p, contacts[contacts["step"] == step], spheres[spheres["step"] == step].set_index("id"))


def _assert_forces(p, last, ball):
    normal, force = (last[[f"{name}_{axis}" for axis in "xyz"]].to_numpy() for name in ("normal", "force"))
    found = (normal * force).sum(axis=1)
    assert found == pytest.approx(last["force"].to_numpy(), abs=1e-6 * np.abs(found).max())
    for row in last[last["wall"] == ""].head(20).itertuples():
        one, other = ball.loc[row.i], ball.loc[row.j]
        spec, E_star = pair_law(p.case, *(p.model.types[int(b["type"]) - 1].material for b in (one, other)))
        R_star = one["radius"] * other["radius"] / (one["radius"] + other["radius"])
        if spec.adheres or p.model.compaction:
            continue
        law = spec.theory(E_star=E_star, R_star=R_star, radius=max(one["radius"], other["radius"]))
        dent = law.residual_overlap(row.delta_max)
        expected = float(law.unloading_force(row.overlap, row.delta_max)) if row.overlap > dent else 0.0
        assert row.force == pytest.approx(expected, rel=1e-6, abs=1e-6 * np.abs(found).max())


def assert_coulomb(p, contacts, spheres):
    """No row has friction above mu times the load, the normal force with all dashpots: without cohesion, and with the
    pull-off forces of Johnson, Kendall and Roberts (1971). The load of dents has a history, and is left out."""
    if contacts.empty or p.model.law in ("thornton_ning", "cavity_adhesive"):
        return
    ball = spheres.set_index(["step", "id"])
    one, other = (
        ball.reindex(pd.MultiIndex.from_frame(contacts[["step", k]]))[["radius", "type"]].to_numpy() for k in "ij"
    )
    walls = contacts["wall"].map(p.wall_types).to_numpy()
    other = np.where(contacts[["j"]].to_numpy() > 0, other, np.column_stack([np.full(len(other), np.inf), walls]))
    pair = one[:, 1].astype(int) - 1, other[:, 1].astype(int) - 1
    normal, force = (contacts[[f"{name}_{axis}" for axis in "xyz"]].to_numpy() for name in ("normal", "force"))
    load = (normal * force).sum(axis=1)
    friction = np.linalg.norm(force - load[:, None] * normal, axis=1)
    if p.model.adheres:
        load += 3 * np.pi * np.array(p.model.adhesion)[pair] / (1 / one[:, 0] + 1 / other[:, 0])
    if p.model.cohesion:  # on the circle in which both bodies cut each other, so far from the centre of the first one
        a, delta = one[:, 0], contacts["overlap"].to_numpy()
        b = np.where(np.isinf(other[:, 0]), a, other[:, 0])
        d = a + b - delta
        away = np.where(np.isinf(other[:, 0]), a - delta, (d**2 + a**2 - b**2) / (2 * d))
        load += p.model.cohesion * np.pi * (a**2 - away**2)
    most = np.array(p.model.friction)[pair] * np.abs(load)
    worst = friction - most * (1 + 1e-9)
    digits = 1e-9 * np.abs(force).max()  # of files, whose normals are those of rounded places
    assert (worst <= digits).all(), contacts[worst > digits]


def porosity(p, frame):
    """Share of points of a measure's region, drawn at random, that lie in no sphere and no image of one."""
    limits = np.array(p.scene.measure[0].region.limits).reshape(3, 2)
    points = np.random.default_rng(1).uniform(*limits.T, (20_000, 3))
    length = np.array([high - low for low, high in (getattr(p.scene.room, axis) for axis in "xyz")])
    free = np.ones(len(points), bool)
    for sphere in frame.itertuples():
        away = points - (sphere.x, sphere.y, sphere.z)
        for k, repeats in enumerate([p.scene.periodic in (True, "x"), p.scene.periodic in (True, "y")]):
            away[:, k] -= repeats * length[k] * np.round(away[:, k] / length[k])
        free &= (away**2).sum(axis=1) > sphere.radius**2
    return free.mean()
