# SPDX-License-Identifier: GPL-2.0-or-later
"""Dense packings of some 20,000 spheres in LIGGGHTS, for the bench of its pair loop: decks, data, named scenes."""

import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "engines"))

from plugin_decks import ADHESIVE, per_pair

RADIUS, SHRINK = 2e-3, 0.999

DECK = """atom_style granular
atom_modify map array
boundary {boundary}
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
{hardening}{surface}pair_style gran model {model} tangential {tangential} {words}
pair_coeff * *
{bed}timestep {dt}
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
    bed=False,
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
        boundary="p p f" if bed else "p p p",
        bed=(
            f"fix floor all wall/gran model {model} tangential history {words} primitive type 1 zplane 0.0\n"
            "fix weight all gravity 9.81 vector 0 0 -1\n"
            if bed
            else ""
        ),
        E=per_type(1e8),
        nu=" ".join(["0.3"] * types),
        p_y=per_type(1e6),
        Y=per_type(3.6e5),
        ratio=" ".join(["0.01"] * types),
        hardening="fix p4 all property/global hardeningExponent scalar 0.3\n" if model == "ep/meyer" else "",
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
        surface=beside
        + (per_pair("surfaceEnergy", 0.0, types) if foreign else "")
        + (per_pair("workOfAdhesion", 0.1, types) if model.removeprefix("ep/") in ADHESIVE else ""),
        unload=f"set group all diameter {2 * RADIUS * SHRINK!r}\n" if unload else "",
    )


SIZES = (1.2e-3, 1.5e-3, 1.8e-3, 2.1e-3, 2.4e-3)  # radii of the bed
EDGE, HEIGHT, COUNT = 0.08, 0.6, 8000
POURED = """atom_style granular
atom_modify map array
boundary p p f
newton off
communicate single vel yes
units si
region box block 0 {edge} 0 {edge} 0 {height}
create_box 1 box
neighbor 8e-4 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 1e7
fix m2 all property/global poissonsRatio peratomtype 0.3
{pairs}pair_style gran model hertz tangential history
pair_coeff * *
fix floor all wall/gran model hertz tangential history primitive type 1 zplane 0.0
fix weight all gravity 9.81 vector 0 0 -1
{templates}fix mix all particledistribution/discrete 15485867 {n} {shares}
fix fill all insert/pack seed 15485863 distributiontemplate mix insert_every once overlapcheck yes all_in yes &
 vel constant 0 0 -1 region box particles_in_region {count}
timestep 1e-5
fix move all nve/sphere
run 30000
dump d all custom 1 bed.txt id radius x y z
run 0
"""


def poured():
    """The deck of a bed of five sizes that falls on a floor and comes to rest; its last positions are in bed.txt."""
    templates = "".join(
        f"fix t{k} all particletemplate/sphere {seed} atom_type 1 density constant 2500 radius constant {r!r}\n"
        for k, (r, seed) in enumerate(zip(SIZES, (15485917, 15485927, 15485933, 15485941, 15485959), strict=True))
    )
    return POURED.format(
        edge=EDGE,
        height=HEIGHT,
        count=COUNT,
        n=len(SIZES),
        templates=templates,
        shares=" ".join(f"t{k} {1 / len(SIZES)!r}" for k in range(len(SIZES))),
        pairs=per_pair("coefficientRestitution", 0.3, 1) + per_pair("coefficientFriction", 0.5, 1),
    )


def bed_data(text):
    """The data file of the bed from bed.txt."""
    rows = [line.split() for line in text.splitlines()[9:]]
    lines = ["bed", "", f"{len(rows)} atoms", "1 atom types", "", f"0.0 {EDGE} xlo xhi", f"0.0 {EDGE} ylo yhi"]
    lines += [f"0.0 {HEIGHT} zlo zhi", "", "Atoms", ""]
    return "\n".join([*lines, *(f"{i} 1 {2 * float(r)!r} 2500.0 {x} {y} {z}" for i, r, x, y, z in rows), ""])


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
    # five sizes that came to rest on a floor, under their weight
    "settled bed": {"data": None, "steps": 200, "run": {"dt": "1e-6", "unload": False, "warm": 20, "bed": True}},
    "moving, 2 ranks": DYNAMIC | {"run": MOVING | {"ranks": 2}},
    # a thin skin, and the neighbour lists made anew every 18 steps for every model
    "moving, sheared": SHEARED | {"run": MOVING | THIN},
    "moving, sheared, 2 ranks": SHEARED | {"run": MOVING | THIN | {"ranks": 2}},
}
