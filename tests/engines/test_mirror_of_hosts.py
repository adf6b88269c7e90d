# SPDX-License-Identifier: GPL-2.0-or-later
"""Like spheres that meet and their mirror image, half of them and a rigid plane, in every host: one motion to 1e-12.

Lengths in radii, E/Y = 30; spheres lie and move symmetrically to the plane z = 0 or hit a rigid plane there.
"""

import json

import numpy as np
import pytest
from lammps_decks import needs_lammps
from lammps_decks import run as run_lammps
from plugin_decks import good
from yade_native import title, yade

E, NU, Y, DENSITY = 30e6, 0.2, 1e6, 1e6
RIGID = 1e25
GAMMA = 0.02 * Y  # work of adhesion of two spheres; half of it at the plane
LAWS = {
    "hertz": {},
    "thornton": {"yieldPressure": 2.8 * Y},
    "johnson": {"yieldPressure": 3.0 * Y},
    "cavity": {"yieldStress": Y, "firstYieldRatio": 1.7, "plasticRatio": 2.8},
    "cavity, finite strain": {"yieldStress": Y, "firstYieldRatio": 1.6, "plasticRatio": 2.8, "finiteStrain": 0.82},
    "cavity, compaction": {"yieldStress": Y, "firstYieldRatio": 1.6, "plasticRatio": 2.8, "finiteStrain": 0.82},
    "meyer": {"yieldPressure": 2.8 * Y, "hardeningExponent": 0.3},
    "jkr": {"workOfAdhesion": GAMMA},
    "thornton_ning": {"workOfAdhesion": GAMMA, "yieldPressure": 2.8 * Y},
}
STRENGTHS = ("yieldPressure", "yieldStress")
DASHPOT = 0.7  # restitution of impacts that do not yield
SPEEDS = np.array([0.01, 0.1, 0.5, 1.0])
STEP, STEPS = 0.005, 1000
ALONE = np.array([[6.0 * k, 0.0, 1.001] for k in range(4)]), np.array([[0.0, 0.0, -v] for v in SPEEDS])
# one sphere above the plane, which a second presses from above and a third from the side
HEAP = (
    np.array([[0.0, 0.0, 1.001], [0.0, 0.0, 3.003], [1.98, 0.0, 1.4]]),
    np.array([[0, 0, -0.2], [0, 0, -0.8], [-0.5, 0, -0.1]]),
)


def images(law):
    """(places, velocities) above the plane z = 0, and with the mirror image below it."""
    x, v = HEAP if "compaction" in law else ALONE
    flip = [1.0, 1.0, -1.0]
    return (x, v), (np.concatenate([x, x * flip]), np.concatenate([v, v * flip]))


def liggghts(folder, law, options, x, v, plane):
    name, settings = law.split(",")[0], "computePlasticWork on" + " compaction on" * ("compaction" in law)
    settings += " viscous on" * ("viscous" in options) if name not in ("jkr", "thornton_ning") else ""
    rows = [f"{k + 1} 1 2.0 {DENSITY!r} {' '.join(map(repr, p))}" for k, p in enumerate(x.tolist())]
    speeds = [f"{k + 1} {' '.join(map(repr, w))} 0 0 0" for k, w in enumerate(v.tolist())]
    box = [f"-30 30 {c}lo {c}hi" for c in "xyz"]
    head = ["x", "", f"{len(x)} atoms", "2 atom types", "", *box]
    data = "\n".join([*head, "", "Atoms", "", *rows, "", "Velocities", "", *speeds, ""])
    lines = ["atom_style granular", "atom_modify map array sort 0 0", "boundary f f f", "newton off"]
    lines += ["communicate single vel yes", "units si", "hard_particles yes", "read_data spheres.data"]
    lines += [
        "neighbor 0.3 bin",
        "neigh_modify delay 0",
        f"fix m1 all property/global youngsModulus peratomtype {E} {RIGID * E}",
    ]
    lines += [f"fix m2 all property/global poissonsRatio peratomtype {NU} 0"]
    for key, value in LAWS[law].items():
        both = f"peratomtype {value!r} {value * (RIGID if key in STRENGTHS else 1)!r}"
        if key == "workOfAdhesion":
            both = f"peratomtypepair 2 {value!r} {value / 2!r} {value / 2!r} {value!r}"
        lines.append(f"fix {key} all property/global {key} {both}")
    lines.append(f"fix en all property/global coefficientRestitution peratomtypepair 2 {' '.join([str(DASHPOT)] * 4)}")
    lines += [f"pair_style gran model ep/{name} tangential off {settings}", "pair_coeff * *"]
    if plane:
        lines.append(f"fix floor all wall/gran model ep/{name} tangential off primitive type 2 zplane 0.0 {settings}")
    lines += ["fix move all nve/sphere", f"timestep {STEP!r}"]
    work = "f_plasticWork" if name != "hertz" and name != "jkr" else "mass"
    lines += [f"dump d all custom 1 out.bin id z vz fz {work}", "dump_modify d sort id", f"run {STEPS}", ""]
    return good(folder, "\n".join(lines), files={"spheres.data": data}).frames()[1][:, :, 1:]


def lammps(folder, law, options, x, v, plane):
    name, words = law.split(",")[0], " ".join(f"{value!r}" for value in LAWS[law].values())
    # a wall's work of adhesion makes a geometric mean with that of the sphere
    of_wall = [
        value / 4 if k == "workOfAdhesion" else value * (RIGID if k in STRENGTHS else 1)
        for k, value in LAWS[law].items()
    ]
    end = " compaction on" * ("compaction" in law)
    end += f" normal_restitution {DASHPOT}" * ("viscous" in options and name not in ("jkr", "thornton_ning"))
    rows = [f"{k + 1} 1 2.0 {DENSITY!r} {' '.join(map(repr, p))}" for k, p in enumerate(x.tolist())]
    speeds = [f"{k + 1} {' '.join(map(repr, w))} 0 0 0" for k, w in enumerate(v.tolist())]
    box = "".join(f"-30 30 {c}lo {c}hi\n" for c in "xyz")
    text = f"x\n\n{len(x)} atoms\n1 atom types\n\n{box}\nAtoms # sphere\n\n" + "\n".join(rows) + "\n\nVelocities\n\n"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "spheres.data").write_text(text + "\n".join(speeds) + "\n")
    rigid = f"{name} {RIGID * E!r} 0 {' '.join(map(repr, of_wall))}"
    wall = f"fix floor all wall/ep zplane 0 NULL {rigid}{end}\n" if plane else ""
    deck = f"""units si
atom_style sphere
atom_modify map array sort 0 0
boundary f f f
comm_modify vel yes
read_data spheres.data
pair_style ep energies
pair_coeff * * {name} {E!r} {NU!r} {words}{end}
neighbor 0.3 bin
neigh_modify delay 0
{wall}fix move all nve/sphere
timestep {STEP!r}
dump d all custom 1 frames.txt id z vz fz f_EP_HISTORY0[1]
dump_modify d sort id header no format float %.17g
run {STEPS}
"""
    run_lammps(deck, folder)
    table = np.loadtxt(folder / "frames.txt")
    return table[:, 1:].reshape(-1, len(x), 4)


SCRIPT = """
job = json.load(open("job.json"))
found = {}
for name, scene in job["scenes"].items():
    O.reset()
    law, grows = scene["law"], "compaction" in name
    same = dict(density=job["density"], frictionAngle=0, **scene["options"])
    O.materials.append(EpMat(young=job["E"], poisson=job["nu"], **same))
    O.materials.append(EpMat(young=job["rigid"] * job["E"], poisson=0, **{**same, **scene["of_plane"]}))
    if scene["plane"]:
        O.bodies.append(wall(0, axis=2, material=1))
    moving = []
    for p, w in zip(scene["x"], scene["v"]):
        b = sphere(p, 1, material=0)
        b.state.vel = w
        moving.append(O.bodies.append(b))
    frames = []
    def record():
        of = [O.bodies[k].state for k in moving]
        frames.append([[s.pos[2], s.vel[2], O.forces.f(k)[2], 0] for s, k in zip(of, moving)])
    end = "Grown" if grows else ""
    pairs = dict(en=job["dashpot"]) if scene["viscous"] else {}
    if scene["adhesion"]:
        pairs["workOfAdhesion"] = MatchMaker(matches=((0, 0, scene["adhesion"]), (0, 1, scene["adhesion"] / 2)))
    law2 = globals()["Law2_ScGeom_EpPhys_" + law](**(dict(compaction=True) if grows else {}))
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.25), Bo1_Wall_Aabb()], verletDist=0.05),
        *([EpGrowth()] if grows else []),
        InteractionLoop([globals()["Ig2_" + s + "_Sphere_ScGeom" + end]() for s in ("Sphere", "Wall")],
                        [Ip2_EpMat_EpMat_EpPhys(**pairs)], [law2]),
        PyRunner(command="record()", iterPeriod=1, initRun=True),
        NewtonIntegrator(damping=0),
    ]
    O.dt = job["dt"]
    O.run(job["steps"], True)
    found[name] = np.array(frames)
np.savez("found.npz", **found)
"""


@pytest.fixture(scope="module")
def in_yade(tmp_path_factory):
    """Frames of all laws, by law, option and image; one start of YADE."""
    scenes = {}
    for law in LAWS:
        for options in OPTIONS[law]:
            for k, (x, v) in enumerate(images(law)):
                numbers = {a: b for a, b in LAWS[law].items() if a != "workOfAdhesion"}
                scenes[f"{law} {options} {k}"] = {
                    "law": title(law.split(",")[0]),
                    "options": numbers,
                    "of_plane": {a: b * RIGID for a, b in numbers.items() if a in STRENGTHS},
                    "plane": k == 0,
                    "x": x.tolist(),
                    "v": v.tolist(),
                    "viscous": "viscous" in options,
                    "adhesion": LAWS[law].get("workOfAdhesion"),
                }
    folder = tmp_path_factory.mktemp("yade")
    job = {"scenes": scenes, "E": E, "nu": NU, "density": DENSITY, "rigid": RIGID, "dashpot": DASHPOT}
    (folder / "job.json").write_text(json.dumps(job | {"dt": STEP, "steps": STEPS}))
    done = yade(SCRIPT, folder)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-3000:]
    return dict(np.load(folder / "found.npz"))


OPTIONS = {law: ["alone"] if law in ("jkr", "thornton_ning") else ["alone", "viscous"] for law in LAWS}
CASES = [(law, options) for law in LAWS for options in OPTIONS[law]]


def assert_one(half, whole):
    """Places, velocities, forces and plastic works of the spheres above the plane."""
    n = half.shape[1]
    for column in range(half.shape[2]):
        a, b = half[..., column], whole[:, :n, column]
        assert np.abs(a - b).max() <= 1e-12 * max(np.abs(a).max(), 1e-300), column
    assert half[..., 1].max() > 0 and np.abs(half[..., 2]).max() > 0


@pytest.mark.liggghts
@pytest.mark.parametrize(("law", "options"), CASES)
def test_mirror_images_are_one_in_liggghts(law, options, tmp_path):
    half, whole = images(law)
    assert_one(
        liggghts(tmp_path / "half", law, options, *half, True), liggghts(tmp_path / "all", law, options, *whole, False)
    )


@needs_lammps
@pytest.mark.parametrize(("law", "options"), CASES)
def test_mirror_images_are_one_in_lammps(law, options, tmp_path):
    half, whole = images(law)
    assert_one(
        lammps(tmp_path / "half", law, options, *half, True), lammps(tmp_path / "all", law, options, *whole, False)
    )


@pytest.mark.yade("module")
@pytest.mark.parametrize(("law", "options"), CASES)
def test_mirror_images_are_one_in_yade(law, options, in_yade):
    assert_one(*(in_yade[f"{law} {options} {k}"] for k in (0, 1)))
