# SPDX-License-Identifier: GPL-2.0-or-later
"""Setting compaction of Law2_ScGeom_EpPhys_Cavity: the script of the page, energies, O.load, refusals, a bed."""

import numpy as np
import pytest
from dense_spheres import CLUSTER, MOVES, NU, RADII, E, Y
from scipy.optimize import brentq
from yade_native import ROOT, yade

from bed import Bed, Material
from scenes.parts_cases import parts
from scenes.scene_runs import run as run_scene
from scenes.scene_runs import write_case

pytestmark = pytest.mark.yade("module")

SCRIPT = f"""
job = np.load("job.npz")
energies, moving = [], []

def begin(x, radius, v):
    O.reset()
    energies.clear(), moving.clear()
    O.materials.append(
        EpMat(young={E!r}, poisson={NU!r}, density=1000, frictionAngle=0, yieldStress={Y!r}, finiteStrain=0.82)
    )
    for p, r, w in zip(x, radius, v):
        b = sphere(p, r)
        b.state.vel, b.state.blockedDOFs = w, "xyzXYZ"
        moving.append(O.bodies.append(b))

def record():
    energies.append([O.energy[k] if k in dict(O.energy.items()) else 0 for k in ("plasticWork", "contactElastic")])

def cluster(steps, bound=1.25, growth=True, end="Grown", **law):
    begin(job["x"], job["radius"], job["v"])
    O.bodies.append(wall(0, axis=2))
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=bound), Bo1_Wall_Aabb()], verletDist=0.05),
        EpGrowth(dead=not growth),
        InteractionLoop([globals()["Ig2_" + s + "_Sphere_ScGeom" + end]() for s in ("Sphere", "Wall")],
                        [Ip2_EpMat_EpMat_EpPhys()], [Law2_ScGeom_EpPhys_Cavity(**{{"compaction": True}} | law)]),
        PyRunner(command="record()", iterPeriod=1, initRun=True),
        NewtonIntegrator(damping=0),
    ]
    O.dt, O.trackEnergy = 1 / steps, True
    O.run(steps, True)

def bits():
    rows = []
    for steps in (1, 99):
        O.run(steps, True)
        contacts = [(i.phys, i.phys.normalForce) for i in O.interactions.all(True)]
        rows += [[*force, p.deltaMax, p.addedOverlap, p.plasticWork] for p, force in contacts]
    return rows

found = {{}}
cluster(200)
O.save("now.yade")
found["straight"] = bits()
contacts = [i.phys for i in O.interactions if i.isReal]
found["energies"] = energies[-1]
found["of_contacts"] = sum(p.elasticEnergy for p in contacts)
found["of_bodies"] = sum(b.state.plasticWork for b in O.bodies)
O.load("now.yade")
found["loaded"] = bits()

faces = np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])
begin(2 * faces, np.ones(7), -0.1 * faces)
O.dt = 0.01
exec(open("page.py").read())
O.run(61, True)
found["six"] = [O.bodies[moving[0]].state.growth, *(i.phys.deltaMax for i in O.bodies[moving[0]].intrs())]

try:
    Law2_ScGeom_EpPhys_Thornton(compaction=True)
except ValueError as error:
    print(error, file=sys.stderr)
for wrong in (dict(bound=1.2), dict(growth=False), dict(end=""), dict(cohesion="sjkr"),
              dict(cohesion="bond", compaction=False)):
    try:
        cluster(10, **wrong)
    except RuntimeError as error:
        print(error, file=sys.stderr)
np.savez("found.npz", **found)
"""

REFUSED = (
    "Law2_ScGeom_EpPhys_Thornton.compaction = True: only Law2_ScGeom_EpPhys_Cavity and "
    "Law2_ScGeom_EpPhys_CavityAdhesive have it",
    "epdem_yade: Law2_ScGeom_EpPhys_Cavity: Bo1_Sphere_Aabb.aabbEnlargeFactor = 1.2, compaction closes gaps of up to "
    "a quarter of the radii; give at least 1.25",
    "epdem_yade: Law2_ScGeom_EpPhys_Cavity: compaction needs the engine EpGrowth() before InteractionLoop; add it",
    "epdem_yade: Law2_ScGeom_EpPhys_Cavity: compaction misses contacts across gaps with Ig2_Sphere_Sphere_ScGeom; take "
    "Ig2_Sphere_Sphere_ScGeomGrown",
    "epdem_yade: Law2_ScGeom_EpPhys_Cavity.cohesion = 'sjkr': contacts with compaction have bond or none",
    "epdem_yade: Law2_ScGeom_EpPhys_Cavity.cohesion = 'bond': it holds contacts with compaction; give compaction = "
    "True",
)


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """What the script writes about its scenes, arrays by name, and its last words."""
    folder = tmp_path_factory.mktemp("all")
    page = (ROOT / "docs/yade.md").read_text().split("```python in engines/test_yade_compaction.py\n")[1]
    (folder / "page.py").write_text(page.split("```")[0])
    np.savez(folder / "job.npz", x=CLUSTER, radius=RADII, v=MOVES)
    done = yade(SCRIPT, folder)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-3000:]
    return dict(np.load(folder / "found.npz")), done.stderr


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


def test_contacts_and_bodies_have_the_energies_of_the_simulation(found):
    """But for contacts that ended."""
    plastic, elastic = found[0]["energies"]
    assert found[0]["of_contacts"] == pytest.approx(elastic, rel=1e-9)
    assert found[0]["of_bodies"] == pytest.approx(plastic, rel=1e-9)


def test_a_loaded_scene_continues_to_the_bit(found):
    straight, loaded = found[0]["straight"], found[0]["loaded"]
    assert sorted(straight.tolist()) == sorted(loaded.tolist()) and straight[:, 4].max() > 0.01


def test_what_compaction_does_not_take_is_refused(found):
    """An engine of growth that is switched off is none."""
    assert tuple(found[1].strip().splitlines()[-len(REFUSED) :]) == REFUSED


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
