# SPDX-License-Identifier: GPL-2.0-or-later
"""Spheres above a plane in every host: one scene, one adapter per host, the same table of all steps."""

import json
from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np
from hosts import CLASSES, LAMMPS, LIGGGHTS
from lammps_decks import run as run_lammps
from plugin_decks import good
from yade_native import title, yade

from epdem.base.declarations import declarations
from epdem.scenes.plan.meshes import stl_text

HOSTS = [LIGGGHTS, LAMMPS, CLASSES]
PLACE, VELOCITY, SPIN, FORCE, TORQUE = (slice(k, k + 3) for k in range(0, 15, 3))
PLASTIC, ELASTIC = 15, 16  # energies of a sphere
RUBBED, SPRINGS = 17, 18  # the same of friction with partial slip; YADE gives the sums to the first sphere


@dataclass(frozen=True)
class Scene:
    """Spheres [SI], and the plane z = 0 of the material with the number `plane`. materials: E, nu, density, and the
    parameters of the law by property. moves: (velocity, steps), one after the other, in place of free flight;
    velocities of each sphere are for heavy ones. restitution: of both dashpots."""

    law: str
    materials: list[dict[str, float]]
    x: Any
    v: Any
    dt: float
    steps: int = 0
    w: Any = None
    radius: Any = 1.0
    kinds: Any = 0
    plane: int | None = None
    moves: tuple = ()
    tangential: str = "off"
    friction: float = 0.0
    rolling: tuple[str, float] = ("off", 0.0)
    cohesion: tuple[str, float] = ("off", 0.0)
    restitution: float | None = None
    compaction: bool = False
    gravity: float = 0.0
    every: int = 1
    piece: int = 0  # steps of each run of LIGGGHTS and LAMMPS; 0: one run
    lines: str = ""  # runs of LIGGGHTS and LAMMPS in place of moves
    restart: bool = False  # LIGGGHTS and LAMMPS: a restart file between the first two runs; its step comes twice
    ranks: int = 1  # or threads of YADE
    floor: Any = "plane"  # or triangles in LIGGGHTS and LAMMPS, region or block in LAMMPS, facet or box in YADE
    boundary: str = "f f f"  # of LIGGGHTS and LAMMPS
    half: float | None = None  # half the side of the room [m]; None: all spheres stay in it
    skin: float | None = None  # of neighbour lists [m]; None: 0.3 of the smallest radius
    loop: str = ""  # EPDEM_LOOP of LIGGGHTS

    def spheres(self):
        """Lists of kinds, radii, places, velocities, spins."""
        x = np.asarray(self.x, float)
        n = len(x)
        w = np.zeros((n, 3)) if self.w is None else self.w
        rows = [np.broadcast_to(a, shape) for a, shape in ((self.kinds, n), (self.radius, n), (self.v, (n, 3)))]
        return [a.tolist() for a in (*rows[:2], x, rows[2], np.asarray(w, float))]

    def reach(self):
        """Half the side of the room [m]."""
        way = [steps * np.abs(v).max() for v, steps in self.moves or [(self.v, self.steps)]]
        return self.half or float(np.abs(self.x).max() + 5 * np.max(self.radius) + self.dt * sum(way))

    def lists(self):
        """The skin of neighbour lists [m]."""
        return self.skin or 0.3 * float(np.min(self.radius))

    def runs(self):
        """Lines of LIGGGHTS and LAMMPS, a text for each run: free flight, or the moves."""
        if self.lines:
            return [self.lines]
        if not self.moves:
            piece = self.piece or self.steps or 1
            return [f"run {min(piece, self.steps)}\n"] * max(1, self.steps // piece)
        lines = []
        for v, n in self.moves:
            if np.ndim(v) == 1:
                lines.append("unfix move\nfix move all move linear {!r} {!r} {!r}\nrun {}\n".format(*map(float, v), n))
                continue
            rows = enumerate(np.asarray(v, float).tolist(), 1)
            lines.append("".join(f"set atom {k} vx {a!r} vy {b!r} vz {c!r}\n" for k, (a, b, c) in rows) + f"run {n}\n")
        return lines

    def deck(self, begin, again, rest):
        """A deck; `begin` reads the data file, `again` a restart file, `rest` has {0} for the number of the dump. {1}:
        for a run after which the dump of LAMMPS finds the energies of a restart file."""
        first, *others = self.runs()
        if self.restart:
            others = ["write_restart middle\nclear\n", again, rest.format(1, "run 0\n"), *others]
        return begin + rest.format(0, "") + first + "".join(others)

    def stl(self):
        """The file of triangles."""
        return {} if isinstance(self.floor, str) else {"plate.stl": stl_text("plate", np.array(self.floor))}

    def names(self):
        """Properties of the law that the materials have, in the order of its declaration."""
        return [p.property for p in declarations()[self.law].parameters if p.property in self.materials[0]]

    def data(self, kinds, style=""):
        """A data file of LIGGGHTS or LAMMPS."""
        kind, radius, x, v, w = self.spheres()
        r, rows, speeds = self.reach(), [], []
        for k, i in enumerate(kind):
            own = 2 * radius[k], self.materials[i]["density"], *x[k]
            rows.append(f"{k + 1} {i + 1} {' '.join(map(repr, own))}")
            speeds.append(f"{k + 1} {' '.join(map(repr, (*v[k], *w[k])))}")
        box = [f"{-r!r} {r!r} {c}lo {c}hi" for c in "xyz"]
        head = ["x", "", f"{len(rows)} atoms", f"{kinds} atom types", "", *box, "", f"Atoms{style}", ""]
        return "\n".join([*head, *rows, "", "Velocities", "", *speeds, ""])


COLUMNS = "x y z vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz"


def liggghts(folder, s):
    n = len(s.materials)
    (rolling, mu_r), (cohesion, density) = s.rolling, s.cohesion
    slip = s.tangential.replace("partial", "ep/partial")
    rubs = " f_frictionWork f_frictionEnergy" * ("partial" in slip)
    cohesion = cohesion.replace("bond", "ep/bond")
    words = f"model ep/{s.law} tangential {slip} cohesion {cohesion} rolling_friction {rolling}"
    settings = "computePlasticWork on" + " compaction on" * s.compaction + " viscous on" * (s.restitution is not None)
    per_type = {"youngsModulus": "E", "poissonsRatio": "nu"} | {name: name for name in s.names()}
    values = {name: f"peratomtype {' '.join(repr(m[key]) for m in s.materials)}" for name, key in per_type.items()}
    pairs = {"coefficientFriction": s.friction, "coefficientRollingFriction": mu_r, "cohesionEnergyDensity": density}
    pairs |= {"coefficientRestitution": s.restitution or 1.0}
    values |= {name: f"peratomtypepair {n}{f' {value!r}' * n * n}" for name, value in pairs.items()}
    if "workOfAdhesion" in values:
        means = [sqrt(a["workOfAdhesion"] * b["workOfAdhesion"]) for a in s.materials for b in s.materials]
        values["workOfAdhesion"] = f"peratomtypepair {n} {' '.join(map(repr, means))}"
    plane = f"primitive type {(s.plane or 0) + 1} zplane 0.0"
    begin = f"atom_style granular\natom_modify map array sort 0 0\nboundary {s.boundary}\nnewton off\n"
    begin += "communicate single vel yes\nunits si\nhard_particles yes\nsoft_particles yes\n"
    begin += f"processors {s.ranks} 1 1\n" * (s.ranks > 1)
    text = f"neighbor {s.lists()!r} bin\nneigh_modify delay 0\n"
    text += "".join(f"fix {name} all property/global {name} {value}\n" for name, value in values.items())
    text += f"pair_style gran {words} {settings}\npair_coeff * *\n"
    if not isinstance(s.floor, str):
        text += f"fix plate all mesh/surface file plate.stl type {s.plane + 1}\n"
        plane = "mesh n_meshes 1 meshes plate"
    if s.plane is not None:
        text += f"fix floor all wall/gran {words} {plane} {settings}\n"
    text += f"fix fall all gravity {s.gravity!r} vector 0 0 -1\n" * (s.gravity > 0)
    text += f"fix move all nve/sphere\ntimestep {s.dt!r}\nthermo_modify lost error norm no\n"
    text += f"dump d all custom {s.every} out{{0}}.bin id {COLUMNS} f_plasticWork f_elasticEnergy{rubs}\n"
    files = {"spheres.data": s.data(n)} | s.stl()
    more = {"files": files, "env": {"EPDEM_LOOP": s.loop} if s.loop else None, "ranks": s.ranks}
    atoms = [begin + f"read_{name}\n" for name in ("data spheres.data", "restart middle")]
    done = good(folder, s.deck(*atoms, text), **more)
    found = np.concatenate([done.frames(f"out{k}.bin")[1] for k in range(1 + s.restart)])[:, :, 1:]
    return found if rubs else np.concatenate([found, np.zeros((*found.shape[:2], 2))], axis=2)


SHAPES = {"region": "plane 0 0 0 0 0 1", "block": "block INF INF INF INF -1 0 side out"}


def lammps(folder, s):
    end = f" tangential {s.tangential} {s.friction!r}" * (s.tangential != "off")
    end += "".join(
        f" {key} {name} {x!r}"
        for key in ("rolling", "cohesion")
        for name, x in [getattr(s, key)]
        if x and name != "off"
    )
    end += f" restitution {s.restitution!r}" * (s.restitution is not None) + " compaction on" * s.compaction
    words = [" ".join([s.law, *(repr(m[key]) for key in ("E", "nu", *s.names()))]) + end for m in s.materials]
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in ({"spheres.data": s.data(len(words), " # sphere")} | s.stl()).items():
        (folder / name).write_text(text)
    begin = f"units si\natom_style sphere\natom_modify map array sort 0 0\nboundary {s.boundary}\ncomm_modify vel yes\n"
    begin += f"processors {s.ranks} 1 1\n" * (s.ranks > 1) + "read_data spheres.data\npair_style ep energies\n"
    begin += "".join(f"pair_coeff {k} {k} {w}\n" for k, w in enumerate(words, 1))
    again = "atom_modify map array sort 0 0\ncomm_modify vel yes\nread_restart middle\n"
    text = f"neighbor {s.lists()!r} bin\nneigh_modify delay 0\n"
    shape = SHAPES.get(s.floor) if isinstance(s.floor, str) else ""
    text += f"region floor {shape}\n" if shape else ""
    wall = "wall/ep/region floor" if shape else "wall/ep zplane 0 NULL" if shape is None else "wall/ep mesh plate.stl"
    text += f"fix floor all {wall} {words[s.plane]}\n" if s.plane is not None else ""
    text += f"fix fall all gravity {s.gravity!r} vector 0 0 -1\n" * (s.gravity > 0)
    text += f"fix move all nve/sphere\ntimestep {s.dt!r}\n"
    works = " ".join(f"f_EP_HISTORY0[{k}]" for k in (1, 2, 4, 5))
    text += f"{{1}}dump d all custom {s.every} frames{{0}}.txt id {COLUMNS} {works}\n"
    text += "dump_modify d sort id header no format float %.17g\n"
    run_lammps(s.deck(begin, again, text), folder, ranks=s.ranks)
    rows = [np.loadtxt(folder / f"frames{k}.txt") for k in range(1 + s.restart)]
    return np.concatenate(rows).reshape(-1, len(s.x), 20)[:, :, 1:]


SCRIPT = """
s = json.load(open("scene.json"))
for m in s["materials"]:
    O.materials.append(EpMat(**m))
if s["plane"] is not None:
    of = {"material": s["plane"]}
    O.bodies.append(
        wall(0, axis=2, **of) if s["floor"] == "plane" else
        facet([(-300, -300, 0), (300, -300, 0), (0, 300, 0)], **of) if s["floor"] == "facet" else
        box((0, 0, -1), (90, 90, 1), fixed=True, **of))
moving = []
for kind, r, p, v, w in zip(*s["spheres"]):
    b = sphere(p, r, material=kind)
    b.state.vel, b.state.angVel = v, w
    b.state.blockedDOFs = "xyzXYZ" if s["moves"] else ""
    moving.append(O.bodies.append(b))
frames = []
def record():
    elastic = dict.fromkeys(moving, 0.0)
    for i in O.interactions:
        if i.isReal:
            for k in {i.id1, i.id2} & {*moving}:
                elastic[k] += i.phys.elasticEnergy * (1 if i.phys.wall else 0.5)
    of = [(O.bodies[k].state, O.forces.f(k), O.forces.t(k), elastic[k]) for k in moving]
    sums = dict(O.energy.items())
    rubbed = [[sums.get(key, 0) for key in ("frictionWork", "frictionElastic")]] + [[0, 0]] * len(of)
    frames.append([[*b.pos, *b.vel, *b.angVel, *f, *t, b.plasticWork, e, *r] for (b, f, t, e), r in zip(of, rubbed)])
path = [v for v, steps in s["moves"] for _ in range(steps)]
def move():
    for k, v in zip(moving, path[O.iter] if O.iter < len(path) else []):
        O.bodies[k].state.vel = v
end = "Grown" if s["law2"].get("compaction") else ""
pairs = s["ip2"]
if s["adhesion"]:
    pairs["workOfAdhesion"] = MatchMaker(matches=s["adhesion"])
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.25), Bo1_Wall_Aabb(), Bo1_Facet_Aabb(), Bo1_Box_Aabb()],
                          verletDist=s["skin"]),
    *([EpGrowth()] if end else []),
    InteractionLoop([globals()["Ig2_" + a + "_Sphere_ScGeom" + end]() for a in ("Sphere", "Wall", "Facet", "Box")],
                    [Ip2_EpMat_EpMat_EpPhys(**pairs)], [globals()["Law2_ScGeom_EpPhys_" + s["law"]](**s["law2"])]),
    PyRunner(command="record()", iterPeriod=s["every"], initRun=True),
    PyRunner(command="move()", iterPeriod=1, initRun=True, dead=not path),
    NewtonIntegrator(damping=0, gravity=(0, 0, -s["gravity"])),
]
O.dt, O.trackEnergy = s["dt"], True
O.run(len(path) + 1 if path else s["steps"] + 1, True)  # records the last step
np.save("frames.npy", frames)
"""


def in_yade(folder, s):
    names = {"E": "young", "nu": "poisson", "density": "density"} | {k: k for k in s.names() if k != "workOfAdhesion"}
    more = {"frictionAngle": float(np.arctan(s.friction)), "rollingFriction": s.rolling[1]}
    gammas = [m.get("workOfAdhesion") for m in s.materials]
    job = {
        "law": title(s.law),
        "materials": [{to: m[key] for key, to in names.items()} | more for m in s.materials],
        "spheres": s.spheres(),
        "moves": [(np.broadcast_to(v, (len(s.x), 3)).astype(float).tolist(), n) for v, n in s.moves],
        "law2": {"tangential": s.tangential, "rolling": s.rolling[0], "cohesion": s.cohesion[0]}
        | ({"compaction": True} if s.compaction else {}),
        "ip2": {"cohesionEnergyDensity": s.cohesion[1]}
        | ({} if s.restitution is None else {"en": s.restitution, "es": s.restitution}),
        "adhesion": [(i, j, sqrt(a * b)) for i, a in enumerate(gammas) for j, b in enumerate(gammas) if a and i <= j],
        "skin": s.lists() / 6,
    } | {key: getattr(s, key) for key in ("plane", "floor", "steps", "every", "gravity", "dt")}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.json").write_text(json.dumps(job))
    done = yade(SCRIPT, folder, s.ranks)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-3000:]
    return np.load(folder / "frames.npy")


RUN = {"liggghts": liggghts, "lammps": lammps, "yade": in_yade}


def frames(host, folder, scene):
    """Numbers of all spheres at the start and after every `every` steps, shape (frames, spheres, 19)."""
    return RUN[host](folder, scene)
