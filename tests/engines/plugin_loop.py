# SPDX-License-Identifier: GPL-2.0-or-later
"""Small dense scenes for our loops: every combination of models that they know, run by them and by LIGGGHTS's own."""

from dataclasses import dataclass, replace

import numpy as np
from plugin_decks import ADHESIVE, Bodies, good

SPACING = 2e-3  # of the lattice [m]; radii are about half of it
COLUMNS = "x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz"
SAID, SAID_OF_WALLS = (f"epdem: {what} loop of LIGGGHTS for " for what in ("pair", "wall"))
SIMD = ("sse2", "avx2", "avx512")


@dataclass(frozen=True)
class Scene:
    """One way to combine all that changes what the loop does."""

    law: str = "thornton"
    tangential: str = "history"
    rolling: str = "off"
    cohesion: str = "off"
    types: int = 1
    freeze: bool = False
    ranks: int = 1
    rebuild: bool = False  # neighbour lists made anew every 7 steps
    loose: bool = False  # contacts open and close
    dashpot: bool = True  # of the tangential model; no_history cannot do without
    settings: tuple[str, ...] = ()
    walls: bool = False  # a floor, and a lid that shears

    def __str__(self):
        shown = {k: v for k, v in vars(self).items() if k != "settings" and (k != "walls" or v)}
        settings = "".join(f"-{s.replace(' ', '_')}" for s in self.settings)
        return "-".join(str(v) if isinstance(v, str) else f"{k}{v:d}" for k, v in shown.items()) + settings


def bodies(scene, cells=3):
    """4 cells^3 spheres, face-centred, jittered and stirred; radii and types at random where there are several."""
    rng = np.random.default_rng(11)
    edge = SPACING * np.sqrt(2) * (1.004 if scene.loose else 0.985)
    corner = np.stack(np.meshgrid(*[np.arange(cells)] * 3, indexing="ij"), -1).reshape(-1, 1, 3)
    x = ((corner + np.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]])) * edge).reshape(-1, 3)
    x += rng.uniform(-2e-5, 2e-5, x.shape)
    x[:, : 2 if scene.walls else 3] %= cells * edge
    n = len(x)
    radius = SPACING / 2 * (rng.uniform(0.98, 1.02, n) if scene.types > 1 else np.ones(n))
    kinds = rng.integers(1, scene.types + 1, n)
    speed = 2.0 if scene.loose else 0.3
    made = Bodies(kinds, radius, x, rng.uniform(-speed, speed, x.shape), rng.uniform(-400, 400, x.shape))
    room = [(0.0, float(cells * edge))] * 3
    if scene.walls:
        room[2] = (-SPACING, float(cells * edge + SPACING))
    return made.data(room, types=scene.types)


def walls(scene, models, cells=3):
    """A floor and a lid, pressed into the outer layers by 3 % of a radius; the lid moves along x."""
    edge = SPACING * np.sqrt(2) * (1.004 if scene.loose else 0.985)
    reach = 0.97 * SPACING / 2
    places = {"floor": f"{-reach!r}", "lid": f"{float((cells - 0.5) * edge + reach)!r} shear x 0.5"}
    return "".join(
        f"fix {name} all wall/gran {models} primitive type {min(2, scene.types)} zplane {place} store_force yes "
        f"{' '.join(scene.settings)}\n"
        for name, place in places.items()
    )


def deck(scene, *, steps=60, every=1, before="", end="", restart=None):
    """The scene's deck; `restart` goes on from a file."""

    def values(*three):
        return " ".join(map(repr, three[: scene.types]))

    def pairs(name, value, spread):
        n = scene.types
        table = " ".join(repr(value + spread * (i + j)) for i in range(n) for j in range(n))
        return f"fix {name} all property/global {name} peratomtypepair {n} {table}\n"

    damped = scene.dashpot or scene.tangential == "no_history" or "viscous on" in scene.settings
    models = (
        f"model ep/{scene.law} tangential {scene.tangential} cohesion {scene.cohesion} rolling_friction {scene.rolling}"
    )
    work = " f_plasticWork f_elasticEnergy f_loadedContacts" if "computePlasticWork on" in scene.settings else ""
    work += " f_adhesiveWork" if work and scene.law in ADHESIVE else ""
    work += " f_frictionWork f_frictionEnergy" if work and "partial_slip" in scene.tangential else ""
    work += "".join(f" f_force_{w}[{k}]" for w in ("floor", "lid") for k in (1, 2, 3)) if scene.walls else ""
    return (
        f"atom_style granular\natom_modify map array sort 0 0\nboundary p p {'f' if scene.walls else 'p'}\n"
        "newton off\ncommunicate single vel yes\nunits si\n"
        + ("processors 2 1 1\n" if scene.ranks == 2 else "")
        + (f"read_restart {restart}\n" if restart else "read_data packing.data\n")
        + f"neighbor {'2e-5' if scene.rebuild else '4e-4'} bin\nneigh_modify delay 0 "
        + ("every 7 check no\n" if scene.rebuild else "\n")
        + f"fix m1 all property/global youngsModulus peratomtype {values(1e8, 2e8, 5e7)}\n"
        + f"fix m2 all property/global poissonsRatio peratomtype {values(0.3, 0.25, 0.4)}\n"
        + f"fix p1 all property/global yieldPressure peratomtype {values(2e6, 4e6, 1e6)}\n"
        + f"fix p2 all property/global yieldStress peratomtype {values(7e5, 1.4e6, 3e5)}\n"
        + (pairs("workOfAdhesion", *WORK_OF_ADHESION[scene.law == "cavity_adhesive"]) if scene.law in ADHESIVE else "")
        + pairs("coefficientFriction", 0.3, 0.1)
        + (pairs("coefficientRestitution", 0.7, 0.05) if damped else "")
        + pairs("coefficientRollingFriction", 0.05, 0.03)
        + pairs("cohesionEnergyDensity", 2e4, 5e3)
        + f"pair_style gran {models} {' '.join(scene.settings)}\npair_coeff * *\n"
        + (walls(scene, models) if scene.walls else "")
        + "timestep 1e-6\n"
        + ("group still id <= 20\ngroup loose subtract all still\n" if scene.freeze else "")
        + ("fix still still freeze\nfix move loose nve/sphere\n" if scene.freeze else "fix move all nve/sphere\n")
        + "compute contacts all contact/atom\ncompute touching all reduce sum c_contacts\n"
        + f"dump d all custom {every} out.bin id {COLUMNS}{work}\ndump_modify d sort id\n"
        + "thermo_style custom step atoms c_touching\nthermo 1\nthermo_modify lost error norm no\n"
        + before
        + f"run {steps}\n"
        + end
    )


def outcome(folder, scene, *, loop="", simd="", text=None, command=None, **options):
    """(all frames of the dump, what the run printed); `loop` and `simd` are EPDEM_LOOP and EPDEM_SIMD."""
    env = {k: v for k, v in (("EPDEM_LOOP", loop), ("EPDEM_SIMD", simd)) if v}
    files = {"packing.data": bodies(scene)}
    done = good(folder, text or deck(scene, **options), ranks=scene.ranks, files=files, env=env, command=command)
    return done.frames()[1], done.text


WORK_OF_ADHESION = (30.0, 5.0), (0.02, 0.005)  # of the first pair of types, more by type; the law refuses more
DIMENSIONS = {
    "law": ("hertz", "thornton", "johnson", "cavity", "meyer"),
    "tangential": ("history", "no_history", "off", "ep/partial_slip", "ep/partial_slip_2"),
    "rolling": ("off", "cdt", "epsd2"),
    "cohesion": ("off", "sjkr", "sjkr2"),
    "types": (1, 3),
    "freeze": (False, True),
    "ranks": (1, 2),
    "rebuild": (False, True),
    "loose": (False, True),
    "dashpot": (True, False),
    "viscous": (False, True),
    "work": (False, True),
    "torsion": (False, True),
    "slides": (False, True),
    "walls": (False, True),
}

WITH_ADHESION = DIMENSIONS | {
    "law": ADHESIVE,
    "tangential": ("history", "no_history", "off"),
    "cohesion": ("off",),
    "slides": (False,),
    "walls": (False,),
}


def scene_of(choice):
    """The scene of one value per dimension; settings that a model does not have are left out."""
    c = dict(choice)
    wanted = {
        "viscous on": c.pop("viscous"),
        "computePlasticWork on": c.pop("work"),
        "torsionTorque on": c.pop("torsion") and c["rolling"] != "off",
        "tangential_reduce on": c.pop("slides") and c["cohesion"] != "off",
    }
    return replace(Scene(**c), settings=tuple(s for s, on in wanted.items() if on))


# Scenes that the planted faults name: they stay the same when dimensions are added.
NAMED = (
    Scene(
        law="thornton",
        rolling="epsd2",
        cohesion="sjkr2",
        types=3,
        freeze=True,
        loose=True,
        dashpot=False,
        settings=("viscous on", "tangential_reduce on"),
    ),
    Scene(
        law="hertz",
        tangential="no_history",
        cohesion="sjkr",
        freeze=True,
        loose=True,
        dashpot=False,
        settings=("viscous on",),
    ),
    Scene(law="cavity", tangential="ep/partial_slip", types=3, loose=True, settings=("computePlasticWork on",)),
    Scene(law="thornton_ning", types=3, loose=True, settings=("computePlasticWork on",)),
    Scene(rolling="cdt", cohesion="sjkr", types=3, loose=True, settings=("computePlasticWork on",), walls=True),
)

DENSE = ("computePlasticWork on", "compaction on"), ("viscous on", "compaction on")
WITH_COMPACTION = (
    Scene(law="cavity", tangential="ep/partial_slip", types=3, settings=DENSE[0]),
    Scene(law="cavity", rolling="epsd2", types=3, loose=True, ranks=2, rebuild=True, settings=DENSE[1]),
    Scene(law="cavity", rolling="cdt", freeze=True, loose=True, walls=True, settings=DENSE[0]),
    Scene(law="cavity_adhesive", types=3, loose=True, settings=DENSE[0]),
)


def covering(dimensions=DIMENSIONS, seed=1, tries=60):
    """Few scenes in which every two values of two dimensions meet: each is the best of some random ones."""
    rng = np.random.default_rng(seed)
    names = list(dimensions)

    def pairs(choice):
        return {((a, choice[a]), (b, choice[b])) for k, a in enumerate(names) for b in names[k + 1 :]}

    missing = {
        ((a, x), (b, y))
        for k, a in enumerate(names)
        for b in names[k + 1 :]
        for x in dimensions[a]
        for y in dimensions[b]
    }
    chosen = []
    while missing:
        fixed = dict(sorted(missing, key=repr)[0])
        some = [{n: dimensions[n][rng.integers(len(dimensions[n]))] for n in names} | fixed for _ in range(tries)]
        best = max(some, key=lambda choice: len(pairs(choice) & missing))
        missing -= pairs(best)
        chosen.append(scene_of(best))
    return chosen
