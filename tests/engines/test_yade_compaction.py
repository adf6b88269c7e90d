# SPDX-License-Identifier: GPL-2.0-or-later
"""Setting compaction of Law2_ScGeom_EpPhys_Cavity: forces, order, energy, contacts alone, threads, O.load, refusals."""

import numpy as np
import pytest
from plugin_compaction import NU, E, Y, alone
from scipy.optimize import brentq
from test_plugin_compaction import CLUSTER, FLOOR, MOVES, RADII, assert_second_order
from test_plugin_compaction import cluster as cluster_of_liggghts
from yade_native import ROOT, yade

from bed import Bed, Material
from scenes.parts_cases import parts
from scenes.scene_runs import run as run_scene
from scenes.scene_runs import write_case

pytestmark = pytest.mark.yade("module")

SCENES = f"""
import os

job = np.load("job.npz")
frames, energies = [], []

def record():
    frames.append([O.forces.f(k) for k in moving])
    energies.append([O.energy[k] if k in dict(O.energy.items()) else 0 for k in ("plasticWork", "contactElastic")])

def begin(density):
    O.reset()
    frames.clear(), energies.clear()
    moving.clear()
    O.materials.append(
        EpMat(young={E!r}, poisson={NU!r}, density=density, frictionAngle=0, yieldStress={Y!r}, finiteStrain=0.82)
    )

def floor(kind, place):
    if kind == "wall":
        O.bodies.append(wall(place, axis=2))
    elif kind == "facet":
        O.bodies.append(facet([(-300, -300, place), (300, -300, place), (0, 300, place)]))
    else:
        O.bodies.append(box((0, 0, place - 1), (90, 90, 1), fixed=True))

def spheres(x, radius, v, prescribed):
    for p, r, w in zip(x, radius, v):
        b = sphere(p, r)
        b.state.vel = w
        b.state.blockedDOFs = "xyzXYZ" if prescribed else ""
        moving.append(O.bodies.append(b))

def engines(on, dt, recorded=True, bound=1.25, growth=True, end="Grown"):
    shapes = ("Sphere", "Wall", "Facet", "Box")
    ig2 = [globals()["Ig2_" + s + "_Sphere_ScGeom" + (end if on else "")]() for s in shapes]
    bo1 = [Bo1_Sphere_Aabb(aabbEnlargeFactor=bound if on else -1), Bo1_Wall_Aabb(), Bo1_Facet_Aabb(), Bo1_Box_Aabb()]
    O.engines = [
        ForceResetter(),
        InsertionSortCollider(bo1, verletDist=0.05),
        *([EpGrowth()] if on and growth else []),
        InteractionLoop(ig2, [Ip2_EpMat_EpMat_EpPhys()], [Law2_ScGeom_EpPhys_Cavity(compaction=on)]),
        PyRunner(command="record()", iterPeriod=1, initRun=True, dead=not recorded),
        NewtonIntegrator(damping=0),
    ]
    O.dt = dt
    O.trackEnergy = recorded

def cluster(steps, kind="wall", on=True, **wrong):
    begin(1000)
    spheres(job["x"], job["radius"], job["way"], True)
    floor(kind, float(job["floor"]))
    engines(on, 1 / steps, **wrong)
    O.run(steps, True)

def back(steps):
    for k, w in zip(moving, -0.3 * job["way"]):
        O.bodies[k].state.vel = w
    O.run(steps + 1, True)
    return np.array(frames)

moving = []
"""

ALL = """
found = {}
for steps in (200, 400, 800):
    cluster(steps)
    found[f"n{steps}"] = back(steps)
found["energies"] = np.array(energies)
contacts = [i.phys for i in O.interactions if i.isReal]
found["of_contacts"] = [sum(p.plasticWork for p in contacts), sum(p.elasticEnergy for p in contacts)]
found["of_bodies"] = sum(b.state.plasticWork for b in O.bodies)
for kind in ("facet", "box"):
    cluster(400, kind)
    found[kind] = back(400)
cluster(400, on=False)
found["off"] = back(400)

def bits():
    rows = []
    for steps in (1, 99):
        O.run(steps, True)
        contacts = [(i.phys, i.phys.normalForce) for i in O.interactions.all(True)]
        rows += [[*force, p.deltaMax, p.addedOverlap, p.plasticWork] for p, force in contacts]
    return rows

cluster(200)
O.save("now.yade")
found["straight"] = bits()
O.load("now.yade")
found["loaded"] = bits()

begin(1000)
faces = np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])
spheres(2 * faces, np.ones(7), -0.1 * faces, True)
O.dt = 0.01
exec(open("page.py").read())
O.run(61, True)
found["six"] = [O.bodies[moving[0]].state.growth, *(i.phys.deltaMax for i in O.bodies[moving[0]].intrs())]

# pairs and spheres at each wall, elastic to fully plastic, with a second impact
for on in (True, False):
    for kind in ("wall", "facet", "box"):
        begin(2000)
        floor(kind, -1)
        spheres(job["alone"], job["radii_alone"], job["way_alone"], False)
        engines(on, 1e-4, recorded=False)
        O.run(2500, True)
        found[f"{kind}{on}"] = [[*O.bodies[k].state.pos, *O.bodies[k].state.vel] for k in moving]

try:
    Law2_ScGeom_EpPhys_Thornton(compaction=True)
except ValueError as error:
    print(error, file=sys.stderr)
for wrong in (dict(bound=1.2), dict(growth=False), dict(end="")):
    try:
        cluster(10, **wrong)
    except RuntimeError as error:
        print(error, file=sys.stderr)
np.savez("found.npz", **found)
"""

REFUSED = (
    "Law2_ScGeom_EpPhys_Thornton.compaction = True: only Law2_ScGeom_EpPhys_Cavity has it",
    "epdem_yade: Law2_ScGeom_EpPhys_Cavity: Bo1_Sphere_Aabb.aabbEnlargeFactor = 1.2, compaction closes gaps of up to "
    "a quarter of the radii; give at least 1.25",
    "epdem_yade: Law2_ScGeom_EpPhys_Cavity: compaction needs the engine EpGrowth() before InteractionLoop; add it",
    "epdem_yade: Law2_ScGeom_EpPhys_Cavity: compaction misses contacts across gaps with Ig2_Sphere_Sphere_ScGeom; take "
    "Ig2_Sphere_Sphere_ScGeomGrown",
)


def scene(folder, text, threads=1):
    """What a script writes about its scenes, arrays by name, and its last words."""
    folder.mkdir(parents=True, exist_ok=True)
    page = (ROOT / "docs/yade.md").read_text().split("```python in engines/test_yade_compaction.py\n")[1]
    (folder / "page.py").write_text(page.split("```")[0])
    impacts = dict(zip(("alone", "radii_alone", "way_alone"), alone(12, aside=20.0), strict=True))
    np.savez(folder / "job.npz", x=CLUSTER, radius=RADII, way=MOVES, floor=FLOOR, **impacts)
    done = yade(SCENES + text, folder, threads)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-3000:]
    return dict(np.load(folder / "found.npz")), done.stderr


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    return scene(tmp_path_factory.mktemp("all"), ALL)


def test_forces_are_those_of_grown_spheres_with_an_error_of_second_order(found):
    assert_second_order({steps: found[0][f"n{steps}"] for steps in (200, 800)})


@pytest.mark.liggghts
def test_forces_are_those_of_liggghts(found, tmp_path):
    """Areas of contacts that have just yielded, under a root, make more of round-off."""
    other = cluster_of_liggghts(tmp_path, 200)
    assert np.abs(found[0]["n200"] - other).max() < 1e-8 * np.abs(other).max()


def test_facets_and_boxes_press_as_walls_do(found):
    forces = found[0]
    for kind in ("facet", "box"):
        assert np.abs(forces[kind] - forces["n400"]).max() < 1e-10 * np.abs(forces["n400"]).max()


def test_growth_alone_brings_two_spheres_into_contact(found):
    """The upper sphere stays 3e-3 away and is pressed all the same; without compaction it is not."""
    assert found[0]["n400"][400, 5, 2] > 0 == found[0]["off"][400, 5, 2]


def test_six_equal_contacts_have_the_growth_of_theory(found):
    """In the script of the page. The growth of a step follows from the dents of the step before."""
    growth, *largest = found[0]["six"]
    like = Material(E, NU, Y)
    bed = Bed(np.ones(7), np.zeros(6, int), np.arange(1, 7), like)
    for step in range(60):
        bed.step(np.full(6, 0.1 * 0.01 * step))
    assert bed.grown[0] > 5e-4
    x = brentq(lambda x: 6 * x**2 / (4 - 12 * x) - x**2 / (4 - 2 * x) - bed.grown[0], 0, 0.1)
    assert growth == pytest.approx(6 * x**2 / (4 - 12 * x), rel=1e-4)
    assert largest == pytest.approx([0.1 * 0.01 * 60] * 6, rel=1e-9)


def test_plastic_work_and_elastic_energy_are_the_work_of_the_spheres(found):
    """The floor rests. The contacts and the bodies have the energies of O.energy, but for contacts that ended."""
    forces, energies = found[0]["n800"], found[0]["energies"]
    steps = len(forces) - 1
    rate = np.where(np.arange(steps) < 800, 1.0, -0.3)[:, None, None] * MOVES / 800
    work = -np.cumsum((0.5 * (forces[1:] + forces[:-1]) * rate).sum(axis=(1, 2)))
    assert np.abs(work - energies[1:].sum(axis=1) + energies[0].sum()).max() < 2e-4 * work.max()
    assert found[0]["of_contacts"][1] == pytest.approx(energies[-1, 1], rel=1e-9)
    assert found[0]["of_bodies"] == pytest.approx(energies[-1, 0], rel=1e-9)


@pytest.mark.parametrize("kind", ["wall", "facet", "box"])
def test_contacts_alone_keep_every_bit(kind, found):
    on, off = found[0][f"{kind}True"], found[0][f"{kind}False"]
    assert np.array_equal(on, off)
    hit = np.linalg.norm(on[:, 3:] - alone(12)[2], axis=1)
    assert (hit > 1e-3).sum() == 36


def test_a_loaded_scene_continues_to_the_bit(found):
    straight, loaded = found[0]["straight"], found[0]["loaded"]
    assert sorted(straight.tolist()) == sorted(loaded.tolist()) and straight[:, 4].max() > 0.01


def test_engines_that_miss_contacts_across_gaps_are_refused(found):
    assert tuple(found[1].strip().splitlines()[-4:]) == REFUSED


def test_two_threads_give_the_forces_of_one(found, tmp_path):
    two, _ = scene(tmp_path, "cluster(400)\nnp.savez('found.npz', f=back(400))\n", threads=2)
    one = found[0]["n400"]
    assert np.abs(two["f"] - one).max() <= 1e-12 * np.abs(one).max()


def bed(folder, **law):
    """64 spheres in a periodic room, pressed by a plate to a relative density of 0.88 and released."""
    draw = np.random.default_rng(1)
    places = 3.15 * np.stack(np.meshgrid(*[np.arange(4)] * 3, indexing="ij"), -1).reshape(-1, 3) + [-4.7, -4.7, 1.6]
    rows = 1e-3 * np.column_stack([places + draw.uniform(0, 0.15, (64, 3)), draw.uniform(1.35, 1.5, 64)])
    (folder / "spheres.csv").write_text(
        "x,y,z,radius\n" + "".join(",".join(map(repr, r)) + "\n" for r in rows.tolist())
    )
    side = ["-6.3 mm", "6.3 mm"]
    plane = {"name": "floor", "kind": "plane", "axis": "z", "at": "0 mm", "material": "steel"}
    lid = {"name": "lid", "kind": "plate", "axis": "z", "center": ["0 mm", "0 mm", "13.3 mm"], "material": "steel"}
    ways = [("press", 8.75, -0.8), ("release", 2.0, 0.2)]
    phases = [
        {
            "name": name,
            "duration": f"{time} ms",
            "move": [{"wall": "lid", "kind": "linear", "velocity": ["0 m/s", "0 m/s", f"{speed} m/s"]}],
        }
        for name, time, speed in ways
    ]
    data = parts(
        room={"x": side, "y": side, "z": ["-1 mm", "15 mm"]},
        periodic=True,
        wall=[plane, lid | {"size": ["12.6 mm", "12.6 mm"]}],
        fill=[{"name": "table", "file": str(folder / "spheres.csv"), "material": "glass"}],
        phase=phases,
    )
    data["law"] = {"name": "cavity", "finite_strain": True, "compaction": True} | law
    data["output"] = {"rows": 40, "particles": 4, "contacts": 4, "energy": True, "loads": True}
    return data


@pytest.mark.liggghts
def test_a_bed_under_a_press_has_force_and_energies_of_liggghts(tmp_path):
    found = {}
    for tool in ("yade", "liggghts"):
        case = write_case(bed(tmp_path), tmp_path)
        found[tool] = run_scene(case, tool, out=tmp_path / tool).results
    yade, liggghts = found["yade"].energy_balance, found["liggghts"].energy_balance
    scale = liggghts["plastic"].max()
    assert yade["balance"].abs().max() < 0.02 * scale
    for column in ("plastic", "elastic", "kinetic", "work"):
        assert np.abs(yade[column] - liggghts[column]).max() < 0.02 * scale, column
    force = [found[tool].rows["lid_force_z"].max() for tool in found]
    assert force[0] == pytest.approx(force[1], rel=0.03)
    for tool, name in ((t, c) for t in found for c in ("overlap", "force", "added_overlap")):
        assert len(found[tool].contacts[name]) > 100
    across = found["yade"].contacts
    assert ((across["overlap"] < 0) & (across["force"] > 0)).any()
