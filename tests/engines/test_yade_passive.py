# SPDX-License-Identifier: GPL-2.0-or-later
"""Energy of clusters with compaction in YADE: elastic cycles, random walks; paths are those of LAMMPS."""

import json

import numpy as np
import pytest
from lammps_decks import needs_lammps
from lammps_walks import FLIGHT, falls, fly, nine_spheres, one_body, paths, two_bodies
from plugin_compaction import NU, E, Y
from test_lammps_passive import BEDS, HARD, SOFT, SOFTEST
from yade_native import yade

from bed import Material
from epdem.theory.cavity import FINITE_STRAIN, Cavity

pytestmark = pytest.mark.yade("module")

SCENE = """
job = np.load("job.npz")
way, radii = job["way"], job["radii"]
words = json.load(open("words.json"))
same = dict(density=1000, frictionAngle=words["angle"], finiteStrain=words["strain"])
kinds = [EpMat(young=E, poisson=nu, yieldStress=Y, **same) for E, nu, Y in words["materials"]]
O.materials.append(kinds)
n = words["spheres"]
for k, (x, r) in enumerate(zip(way[0], radii)):
    b = sphere(x, r, material=kinds[k % n % len(kinds)])
    b.state.blockedDOFs = "xyzXYZ"
    O.bodies.append(b)
force, elastic, lost = [], [], []

def record():
    t = len(force)
    energy = dict(O.energy.items())
    force.append([O.forces.f(b.id) for b in O.bodies])
    elastic.append(sum(energy.get(k, 0) for k in ("contactElastic", "frictionElastic")))
    lost.append(sum(energy.get(k, 0) for k in ("plasticWork", "frictionWork")))
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
O.dt = 1 / (len(way) - 1)
O.trackEnergy = True
O.run(len(way), True)
np.savez("found.npz", force=force, elastic=elastic, lost=lost)
"""


def energies(folder, way, radii, materials, *, spheres, tangential="off", angle=0.0):
    """Work, elastic energy and energy lost of spheres on a path, shape (steps + 1,)."""
    folder.mkdir(parents=True)
    np.savez(folder / "job.npz", way=way, radii=radii)
    words = {"materials": materials, "tangential": tangential, "angle": angle, "strain": FINITE_STRAIN}
    (folder / "words.json").write_text(json.dumps(words | {"spheres": spheres}))
    done = yade(SCENE, folder)
    assert done.returncode == 0, done.stderr[-2000:]
    found = np.load(folder / "found.npz")
    F = found["force"]
    power = -0.5 * ((F[1:] + F[:-1]) * np.diff(way, axis=0)).sum((-1, -2))
    return np.concatenate([[0.0], np.cumsum(power)]), found["elastic"], found["lost"]


@pytest.mark.parametrize("elastic", [HARD, SOFT, SOFTEST], ids=lambda m: f"{m[0]:g}")
def test_elastic_cycles_lose_nothing_and_plastic_ones_some(elastic, tmp_path):
    """Three cycles of six spheres that press a seventh, to half, all and 1.2 of the overlap of first yield."""
    material = Material(*elastic)
    law = Cavity(E_star=material.E / (1 - material.nu**2), R_star=1.0, Y=material.Y, c_strain=FINITE_STRAIN)
    x, radii, ways = one_body()
    depth = 2 * law.yield_overlap * np.sin(3 * np.pi * np.linspace(0, 1, 601)) ** 2  # two like bodies
    lost = {}
    for level in (0.5, 0.999, 1.2):
        way = 2.0 * ways * (1.0 - 0.5 * level * depth[:, None, None])
        work, *_ = energies(tmp_path / f"{level}", way, radii, [elastic], spheres=7)
        lost[level] = work[-1] / work.max()
    assert abs(lost[0.5]) < 1e-12 and abs(lost[0.999]) < 1e-12 < 0.01 < lost[1.2]


WALKS = {
    "one body": (one_body(), "E/Y 30", "off", 0.0),
    "two of two sizes": (two_bodies(0.5), "unlike", "off", 0.0),
    "hard and soft": (two_bodies(1.0), "hard and soft", "off", 0.0),
    "friction": (two_bodies(0.5), "unlike", "partial_slip", float(np.arctan(0.3))),
}


@pytest.mark.parametrize("name", WALKS)
def test_walks_create_no_energy(name, tmp_path):
    cluster, bed, tangential, angle = WALKS[name]
    found = []
    for steps in (500, 1000):
        way, radii = paths(cluster, steps, count=1)
        parts = energies(
            tmp_path / f"{steps}", way, radii, BEDS[bed], spheres=len(radii), tangential=tangential, angle=angle
        )
        work, elastic, lost = (part[:, None] for part in parts)
        found.append((falls(work, elastic, 10).max(), np.abs(work - elastic - lost).max() / work.max()))
    assert found[0][0] < 1e-4 and found[1][0] < 2e-5
    assert found[0][1] < 4e-4 and found[1][1] < 0.35 * found[0][1]


FREE = """
job = np.load("job.npz")
E, nu, Y, strain = job["law"].tolist()
O.materials.append(EpMat(young=E, poisson=nu, density=Y, frictionAngle=0, yieldStress=Y, finiteStrain=strain))
for x, r, v in zip(job["x"], job["radius"], job["v"]):
    b = sphere(x, r)
    b.state.vel = v
    O.bodies.append(b)
frames = []

def record():
    frames.append([b.state.pos for b in O.bodies])

O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.25)], verletDist=0.05),
    EpGrowth(),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeomGrown()], [Ip2_EpMat_EpMat_EpPhys()],
                    [Law2_ScGeom_EpPhys_Cavity(compaction=True)]),
    PyRunner(command="record()", iterPeriod=1, initRun=True),
    NewtonIntegrator(damping=0),
]
O.dt = float(job["dt"])
O.run(int(job["steps"]) + 1, True)
np.savez("found.npz", x=frames)
"""


@needs_lammps
def test_nine_free_spheres_fly_alike_in_lammps(tmp_path):
    """Places at all steps. YADE has the velocities of half steps: without forces at the start those are the same."""
    x, radius, v = nine_spheres()
    steps = 1500
    lammps, *_ = fly(tmp_path / "lammps", [(E, NU, Y)], steps, density=Y)
    folder = tmp_path / "yade"
    folder.mkdir()
    law = [E, NU, Y, FINITE_STRAIN]
    np.savez(folder / "job.npz", x=x, radius=radius, v=v, law=law, dt=FLIGHT / steps, steps=steps)
    done = yade(FREE, folder)
    assert done.returncode == 0, done.stderr[-2000:]
    found = np.load(folder / "found.npz")["x"]
    assert np.abs(found - lammps).max() < 1e-12 * np.abs(x).max()
