# SPDX-License-Identifier: GPL-2.0-or-later
"""Spheres with compaction in YADE, on paths or free: work of the forces, energies of the contacts, places."""

import json

import numpy as np
from yade_native import yade

from epdem.theory.cavity import FINITE_STRAIN

SCRIPT = """
job, words = np.load("job.npz"), json.load(open("words.json"))
way, free = job["way"], words["free"]
same = dict(density=words["density"], frictionAngle=words["angle"], finiteStrain=words["strain"])
kinds = [EpMat(young=E, poisson=nu, yieldStress=Y, **same) for E, nu, Y in words["materials"]]
O.materials.append(kinds)
for k, (x, r) in enumerate(zip(way[0], job["radii"])):
    b = sphere(x, r, material=kinds[k % len(kinds)])
    b.state.blockedDOFs = "" if free else "xyzXYZ"
    b.state.vel = job["v"][k]
    O.bodies.append(b)
place, force, elastic, lost = [], [], [], []

def record():
    t = len(force)
    energy = dict(O.energy.items())
    place.append([b.state.pos for b in O.bodies])
    force.append([O.forces.f(b.id) for b in O.bodies])
    elastic.append(sum(energy.get(k, 0) for k in ("contactElastic", "frictionElastic")))
    lost.append(sum(energy.get(k, 0) for k in ("plasticWork", "frictionWork")))
    if not free:
        for b, v in zip(O.bodies, (way[min(t + 1, len(way) - 1)] - way[t]) / O.dt):
            b.state.vel = v

O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.25)], verletDist=0.05),
    EpGrowth(),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeomGrown()], [Ip2_EpMat_EpMat_EpPhys()],
                    [Law2_ScGeom_EpPhys_Cavity(compaction=True, tangential=words["tangential"])]),
    PyRunner(command="record()", iterPeriod=1, initRun=True),
    NewtonIntegrator(damping=0),
]
O.dt = words["dt"]
O.trackEnergy = True
O.run(words["steps"] + 1, True)
np.savez("found.npz", place=place, force=force, elastic=elastic, lost=lost)
"""


def _run(folder, way, v, radii, materials, **words):
    folder.mkdir(parents=True)
    np.savez(folder / "job.npz", way=way, radii=radii, v=v)
    words = {"angle": 0.0, "tangential": "off", "strain": FINITE_STRAIN, "materials": materials} | words
    (folder / "words.json").write_text(json.dumps(words))
    done = yade(SCRIPT, folder)
    assert done.returncode == 0, done.stderr[-2000:]
    return np.load(folder / "found.npz")


def energies(folder, way, radii, materials, *, mu=0.0):
    """Work, elastic energy and energy lost of spheres on a path, shape (steps + 1, 1); mu: of partial slip."""
    words = {"tangential": "partial_slip", "angle": float(np.arctan(mu))} if mu else {}
    steps = len(way) - 1
    found = _run(
        folder, way, 0 * way[0], radii, materials, free=False, density=1000, dt=1 / steps, steps=steps, **words
    )
    F = found["force"]
    power = -0.5 * ((F[1:] + F[:-1]) * np.diff(way, axis=0)).sum((-1, -2))
    return [a[:, None] for a in (np.concatenate([[0.0], np.cumsum(power)]), found["elastic"], found["lost"])]


def flight(folder, x, v, radii, material, *, density, dt, steps):
    """Places of free spheres at all steps."""
    return _run(folder, x[None], v, radii, [material], free=True, density=density, dt=dt, steps=steps)["place"]
