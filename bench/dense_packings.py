# SPDX-License-Identifier: GPL-2.0-or-later
"""Dense packings of some 20,000 spheres in LIGGGHTS, for the bench of its pair loop: decks, data, named scenes."""

import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "engines"))

from plugin_decks import per_pair

RADIUS, SHRINK = 2e-3, 0.999

DECK = """atom_style granular
atom_modify map array
boundary p p p
newton off
communicate single vel yes
units si
{processors}read_data packing.data
neighbor {skin} bin
neigh_modify delay 0{lists}
fix m1 all property/global youngsModulus peratomtype {E}
fix m2 all property/global poissonsRatio peratomtype {nu}
{restitution}{friction}fix p1 all property/global yieldPressure peratomtype {p_y}
fix p2 all property/global yieldStress peratomtype {Y}
fix p3 all property/global coefficientYieldRatio peratomtype {ratio}
{surface}pair_style gran model {model} tangential {tangential} {words}
pair_coeff * *
timestep {dt}
fix move all nve/sphere
compute contacts all contact/atom
compute touching all reduce sum c_contacts
thermo_style custom step atoms c_touching
thermo 100000
thermo_modify lost error norm no
run {warm}
{unload}{runs}"""


def packing(cells, spacing, jitter, speed=0.0, shear=0.0, types=1):
    """Data file of a jittered face-centred cubic packing in a periodic box: 4 cells^3 spheres.

    Random velocities to `speed` [m/s], and v_x to `shear` [m/s] as one sine wave over the height of the box; several
    types at random, then with radii that differ by up to 2 %.
    """
    rng = np.random.default_rng(3)
    edge = spacing * 2 * RADIUS * math.sqrt(2)
    corner = np.stack(np.meshgrid(*[np.arange(cells)] * 3, indexing="ij"), -1).reshape(-1, 1, 3)
    x = ((corner + np.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]])) * edge).reshape(-1, 3)
    x = (x + rng.uniform(-jitter, jitter, x.shape) * 2 * RADIUS) % (cells * edge)
    v = rng.uniform(-speed, speed, x.shape)
    v[:, 0] += shear * np.sin(2 * np.pi * x[:, 2] / (cells * edge))
    kind = rng.integers(1, types + 1, len(x)).tolist()
    diameter = (2 * RADIUS * (rng.uniform(0.98, 1.02, len(x)) if types > 1 else np.ones(len(x)))).tolist()
    lines = ["packing", "", f"{len(x)} atoms", f"{types} atom types", ""]
    lines += [f"0.0 {cells * edge!r} {c}lo {c}hi" for c in "xyz"]
    lines += [
        "",
        "Atoms",
        "",
        *(f"{i + 1} {kind[i]} {diameter[i]!r} 2500.0 {p[0]!r} {p[1]!r} {p[2]!r}" for i, p in enumerate(x.tolist())),
    ]
    lines += ["", "Velocities", "", *(f"{i + 1} {p[0]!r} {p[1]!r} {p[2]!r} 0 0 0" for i, p in enumerate(v.tolist()))]
    return "\n".join([*lines, ""])


def deck(
    model,
    *,
    steps,
    dt="1e-13",
    warm=2,
    unload=True,
    restitution=True,
    ranks=1,
    skin="8e-4",
    lists="",
    types=1,
    words="",
):
    model, _, tangential = model.partition("+")
    foreign = model == "thornton_ning"
    beside = {"rolling_friction": "coefficientRollingFriction", "cohesion": "cohesionEnergyDensity"}
    beside = "".join(per_pair(name, 0.1 if "Roll" in name else 1e3, types) for w, name in beside.items() if w in words)

    def per_type(first):
        return " ".join(repr(first * (1 + k)) for k in range(types))

    return DECK.format(
        model=model,
        tangential=tangential or "history",
        words=words,
        E=per_type(1e8),
        nu=" ".join(["0.3"] * types),
        p_y=per_type(1e6),
        Y=per_type(3.6e5),
        ratio=" ".join(["0.01"] * types),
        runs=f"run {steps}\n",
        dt=dt,
        skin=skin,
        lists=f" {lists}" if lists else "",
        warm=warm,
        processors="processors 2 1 1\n" if ranks == 2 else "",
        restitution=per_pair("coefficientRestitution", 0.7, types)
        if restitution or not model.startswith("ep/")
        else "",
        friction=per_pair("coefficientFriction", 0.5, types),
        surface=beside + (per_pair("surfaceEnergy", 0.0, types) if foreign else ""),
        unload=f"set group all diameter {2 * RADIUS * SHRINK!r}\n" if unload else "",
    )


FROZEN = {"data": (17, 1.01, 0.03), "steps": 100}
DYNAMIC = {"data": (17, 0.985, 0.002, 0.05), "steps": 150}
SHEARED = {"data": (17, 0.985, 0.002, 0.05, 0.5), "steps": 150}
THIN = {"skin": "1e-4", "lists": "every 18 check no"}
MOVING = {"dt": "2e-6", "unload": False, "warm": 50}
SCENES = {
    # spacing 1.01 and jitter 0.03: about half of the neighbours touch; loaded, then unloaded by a third
    "frozen": FROZEN | {"run": {}},
    "frozen, no restitution": FROZEN | {"run": {"restitution": False}},
    "frozen, 2 ranks": FROZEN | {"run": {"ranks": 2}},
    "moving": DYNAMIC | {"run": MOVING},
    "moving, two materials": DYNAMIC | {"data": (17, 0.985, 0.002, 0.05, 0.0, 2), "run": MOVING | {"types": 2}},
    "moving, 2 ranks": DYNAMIC | {"run": MOVING | {"ranks": 2}},
    # a thin skin, and the neighbour lists made anew every 18 steps for every model
    "moving, sheared": SHEARED | {"run": MOVING | THIN},
    "moving, sheared, 2 ranks": SHEARED | {"run": MOVING | THIN | {"ranks": 2}},
}
