# SPDX-License-Identifier: GPL-2.0-or-later
"""Pressure of random packings under compaction: ep/cavity in LIGGGHTS beside LAMMPS's mdr with psi_b = 0.

.venv/bin/python bench/compaction.py [seed ...]            # E/Y = 120, nu = 0.34; with --soft 30 and 0.2
.venv/bin/python bench/compaction.py --numpy [seed ...]  # beside numpy, with the sums of the same step
.venv/bin/python bench/compaction.py --lattices          # the table of docs/choose.md, from theory and data/compaction
.venv/bin/python bench/compaction.py --walks             # energy that 100 random walks create

150 spheres of radii +-20 % without friction are pressed from a relative density of 0.40 by six
walls (isostatic) or by two (die). Both codes start with the same positions.
"""

import re
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "engines"))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "verification"))

from plugin_compaction import E_STAR, GROWTH, HEAD, NU, E, Y, data, side_depths
from plugin_decks import good
from test_compaction import CAVITY, SOFT, finite_elements
from test_plugin_compaction import falls, walks

from epdem.engines.lammps import launcher
from epdem.theory.cavity import FINITE_STRAIN, Cavity
from epdem.theory.thornton import Thornton
from epdem.verification.theory.compaction import BCC, FCC, HEXAGONAL, SC, isotropic_pressure

DENSITIES = np.array([0.75, 0.80, 0.85, 0.90, 0.93, 0.95, 0.965])
SETTINGS = {
    "cavity, finite_strain, compaction": ("compaction on", True),
    "cavity, finite_strain": ("", True),
    "cavity": ("", False),
}


START, END = 0.40, 0.97  # relative densities of a press
SPEED = {False: 0.012, True: 0.02}  # of each moving wall, of six or of two (die)
DRAG = 0.2  # of the velocity [1/s]: the press is quasi-static


def packing(seed, n=150):
    """Centres and radii of spheres without overlap in a cube of the relative density START; mean volume 4 pi/3."""
    rng = np.random.default_rng(seed)
    radius = rng.uniform(0.8, 1.2, n)
    radius /= np.mean(radius**3) ** (1 / 3)
    edge = float((n * 4 * np.pi / 3 / START) ** (1 / 3))
    x = rng.uniform(-0.5, 0.5, (n, 3)) * (edge - 2)
    i, j = np.triu_indices(n, 1)
    for _ in range(3000):
        d = x[i] - x[j]
        r = np.linalg.norm(d, axis=1)
        overlap = np.maximum(1.02 * (radius[i] + radius[j]) - r, 0.0)
        push = d * (0.4 * overlap / np.maximum(r, 1e-9))[:, None]
        np.add.at(x, i, push)
        np.add.at(x, j, -push)
        limit = edge / 2 - 1.01 * radius[:, None]
        x = np.clip(x, -limit, limit)
        if overlap.max() < 2e-3:
            break
    return x, radius, edge


def _course(start, die):
    """Edge of the cube, the moving axes, the duration [s]."""
    x, radius, edge = start
    volume = len(radius) * 4 * np.pi / 3
    end = volume / END / edge**2 if die else (volume / END) ** (1 / 3)
    return edge, ("z" if die else "xyz"), (edge - end) / 2 / SPEED[die]


def _density(start, die, way):
    """Relative density after each of two walls of the moving axes has gone this way."""
    x, radius, edge = start
    now = edge - 2 * way
    return len(radius) * 4 * np.pi / 3 / (now * edge**2 if die else now**3)


def press(folder, start, settings, *, die, softens=True, elastic=(E / Y, NU), dt=0.02):
    """(relative density, pressure over Y) in LIGGGHTS: mean force on the moving plates over their area."""
    x, radius, edge = start
    _, axes, seconds = _course(start, die)
    half, steps = edge / 2, int(seconds / dt)
    text = HEAD % {"settings": settings, "head": "", "atoms": "read_data spheres.data"}
    text = text.replace(f"youngsModulus peratomtype {E!r}", f"youngsModulus peratomtype {elastic[0] * Y!r}")
    text = text.replace(f"poissonsRatio peratomtype {NU!r}", f"poissonsRatio peratomtype {elastic[1]!r}")
    if not softens:
        text = text.replace("fix p2 all property/global finiteStrain peratomtype 0.82\n", "")
    files = {"spheres.data": data(x, radius, np.zeros_like(x), Y, half=edge)}
    meshes = []
    for a, axis in enumerate("xyz"):
        for sign in (-1, 1):
            name = f"{axis}{sign + 1}"
            files[f"{name}.stl"] = _plate(a, sign * half, 0.75 * edge)
            text += f"fix {name} all mesh/surface/stress file {name}.stl type 1\n"
            meshes.append(name)
            if axis in axes:
                v = [0.0, 0.0, 0.0]
                v[a] = -sign * SPEED[die]
                text += f"fix m{name} all move/mesh mesh {name} linear {v[0]!r} {v[1]!r} {v[2]!r}\n"
    moving = [m for m in meshes if m[0] in axes]
    forces_of = " ".join(f"f_{m}[{1 + 'xyz'.index(m[0])}]" for m in moving)
    text += (
        f"fix walls all wall/gran model ep/cavity tangential off mesh n_meshes 6 meshes {' '.join(meshes)} {settings}\n"
        f"fix move all nve/sphere\nfix drag all viscous {DRAG * Y * 4 * np.pi / 3!r}\ntimestep {dt!r}\n"
        f"fix mean all ave/time 1 40 40 {forces_of} file loads.txt\nthermo 100000\nrun {steps}\n"
    )
    good(folder, text, files=files, timeout=900)
    rows = np.loadtxt(folder / "loads.txt")
    way = SPEED[die] * dt * (rows[:, 0] - 20)
    side = edge if die else edge - 2 * way
    return _density(start, die, way), np.abs(rows[:, 1:]).mean(axis=1) / side**2 / Y


def _plate(axis, place, half):
    """STL text of a square plate normal to an axis."""
    corners = []
    for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        corner = [a * half, b * half]
        corner.insert(axis, place)
        corners.append(" ".join(map(repr, map(float, corner))))
    lines = ["solid plate"]
    for three in ((0, 1, 2), (0, 2, 3)):
        lines += ["facet normal 0 0 1", "outer loop", *(f"vertex {corners[k]}" for k in three), "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid plate", ""])


def press_mdr(folder, start, *, die, elastic=(E / Y, NU), dt=0.01):
    """The same of LAMMPS's mdr with psi_b = 0: pressure (die: axial stress) from the stresses of the spheres."""
    x, radius, edge = start
    _, axes, seconds = _course(start, die)
    folder.mkdir(parents=True, exist_ok=True)
    law = f"mdr {elastic[0]!r} {elastic[1]!r} 1.0 0 0.0 0 tangential linear_history 0.0 0.0 0.0 damping mdr 1"
    rows = [
        f"{k + 1} 1 {2 * float(r)!r} 1.0 {' '.join(map(repr, map(float, p)))}"
        for k, (r, p) in enumerate(zip(radius, x, strict=True))
    ]
    box = [f"{-edge!r} {edge!r} {c}lo {c}hi" for c in "xyz"]
    atoms = ["x", "", f"{len(radius)} atoms", "1 atom types", "", *box, "", "Atoms", "", *rows, ""]
    (folder / "spheres.data").write_text("\n".join(atoms))
    lines = ["units si", "atom_style sphere", "atom_modify map array", "boundary f f f", "newton off"]
    lines += [
        "comm_modify vel yes",
        "read_data spheres.data",
        "neighbor 1.0 bin",
        "neigh_modify every 10 delay 0 check no",
    ]
    lines += ["pair_style granular", f"pair_coeff * * {law}"]
    lines += [f"variable in equal step*{dt * SPEED[die]!r}", "variable out equal -v_in"]
    for a, axis in enumerate("xyz"):
        for sign in (1, -1):
            point, normal, moves = [0.0] * 3, [0.0] * 3, ["NULL"] * 3
            point[a], normal[a], moves[a] = sign * edge / 2, -sign, "v_out" if sign > 0 else "v_in"
            plane = " ".join(map(repr, [*map(float, point), *map(float, normal)]))
            move = f" move {' '.join(moves)}" if axis in axes else ""
            lines.append(f"region r{axis}{sign + 1} plane {plane}{move}")
            lines.append(f"fix w{axis}{sign + 1} all wall/gran/region granular {law} region r{axis}{sign + 1} contacts")
    lines += ["fix move all nve/sphere"]
    lines += [f"variable f{c} atom -{DRAG}*mass*v{c}" for c in "xyz"]
    lines += ["fix drag all addforce v_fx v_fy v_fz", f"timestep {dt!r}", "run 0"]
    lines += ["compute s all property/atom d_sigmaxx d_sigmayy d_sigmazz d_Velas"]
    trace = "3*c_s[3]" if die else "(c_s[1]+c_s[2]+c_s[3])"
    lines += [f"variable t atom {trace}*c_s[4]", "compute sum all reduce sum v_t", "thermo_style custom step c_sum"]
    lines += ["thermo 80", "thermo_modify format float %.10g lost warn", f"run {int(seconds / dt)}"]
    (folder / "in.mdr").write_text("\n".join([*lines, ""]))
    launcher.run("in.mdr", folder, log="log.mdr", seconds=1800)
    found = re.findall(r"^ +(\d+) +(-?[\d.]+(?:e[+-]\d+)?)$", (folder / "log.mdr").read_text(), re.M)
    step, total = np.array(found, float).T
    way = SPEED[die] * dt * step
    volume = len(radius) * 4 * np.pi / 3
    density = _density(start, die, way)
    return density[1:], -total[1:] / (3 * volume / density[1:])


def press_numpy(start, *, die, dt=0.02):
    """The same of the law in numpy, with the sums of the step itself; units: Y, mean radius, mass of density Y."""
    x, radius, edge = start
    _, axes, seconds = _course(start, die)
    moves = np.array([axis in axes for axis in "xyz"])
    mass = 4 / 3 * np.pi * radius[:, None] ** 3
    x, v, a = x.copy(), np.zeros_like(x), np.zeros_like(x)
    i, j = np.triu_indices(len(x), 1)
    most, most_wall = np.full(len(i), -np.inf), np.full((len(x), 6), -np.inf)
    found, load = [], np.zeros(6)
    for step in range(1, int(seconds / dt) + 1):
        v += 0.5 * dt * a
        x += dt * v
        half = edge / 2 - SPEED[die] * dt * step * moves
        if step % 20 == 1:
            near = np.flatnonzero(np.linalg.norm(x[i] - x[j], axis=1) < 1.3 * (radius[i] + radius[j]))
        p, q = i[near], j[near]
        d = x[p] - x[q]
        r = np.linalg.norm(d, axis=1)
        overlap, at_wall = radius[p] + radius[q] - r, radius[:, None] - np.hstack([half + x, half - x])
        most[near], most_wall = np.maximum(most[near], overlap), np.maximum(most_wall, at_wall)
        depth_p, depth_q = side_depths(radius[p], radius[q], np.maximum(most[near], 0.0))
        depth_wall = np.maximum(most_wall, 0.0) / radius[:, None]
        sums = [
            np.bincount(p, depth_p**k, len(x)) + np.bincount(q, depth_q**k, len(x)) + (depth_wall**k).sum(axis=1)
            for k in (1, 2)
        ]
        growth = sums[1] / (4 - 2 * np.minimum(sums[0], GROWTH))
        u = radius[p] * np.maximum(growth[p] - depth_p**2 / (4 - 2 * depth_p), 0.0)
        u += radius[q] * np.maximum(growth[q] - depth_q**2 / (4 - 2 * depth_q), 0.0)
        u_wall = radius[:, None] * np.maximum(growth[:, None] - depth_wall**2 / (4 - 2 * depth_wall), 0.0)
        R_star = radius[p] * radius[q] / (radius[p] + radius[q])
        F = _force(R_star, overlap + u, most[near] + u)
        F_wall = _force(radius[:, None] + 0 * at_wall, at_wall + u_wall, most_wall + u_wall)
        most[near] = np.where(overlap + u > 0, most[near], -np.inf)  # what parts forgets
        most_wall[at_wall + u_wall <= 0] = -np.inf
        on_pair = d * (F / r)[:, None]
        a = F_wall[:, :3] - F_wall[:, 3:] - DRAG * mass.mean() * v
        for k in range(3):
            a[:, k] += np.bincount(p, on_pair[:, k], len(x)) - np.bincount(q, on_pair[:, k], len(x))
        a /= mass
        v += 0.5 * dt * a
        load += F_wall.sum(axis=0)
        if step % 40 == 0:
            way = SPEED[die] * dt * (step - 20)
            side = edge if die else edge - 2 * way
            found.append((_density(start, die, way), load.reshape(2, 3)[:, moves].mean() / 40 / side**2))
            load[:] = 0.0
    return np.array(found).T


def _force(R_star, overlap, most):
    """The force of cavity with finite_strain at overlaps below their largest values, 0 of those that do not touch."""
    F, on = np.zeros_like(overlap), overlap > 0
    law = Cavity(E_star=E_STAR / Y, R_star=R_star[on], Y=1.0, c_strain=0.82)
    F[on] = np.nan_to_num(law.unloading_force(np.minimum(overlap[on], most[on]), most[on]))
    return F


LATTICES = {
    "fcc": (FCC, (0.80, 0.90, 0.96)),
    "bcc": (BCC, (0.75, 0.90, 0.965)),
    "sc": (SC, (0.60, 0.80, 0.95)),
    "hex": (HEXAGONAL, (0.70, 0.85, 0.95)),
}
LAWS = {  # class, parameters, whether spheres grow
    "`thornton`": (Thornton, {"p_y": 2.8}, False),
    "`cavity`": (Cavity, {"Y": 1.0}, False),
    "`cavity`, `finite_strain`": (Cavity, {"Y": 1.0, "c_strain": FINITE_STRAIN}, False),
    "`cavity`, `finite_strain`, `compaction`": (Cavity, {"Y": 1.0, "c_strain": FINITE_STRAIN}, True),
}


def lattices() -> None:
    """Print deviations of the pressure of lattices from finite elements."""
    for ratio, table, law_of in ((120, "", CAVITY), (30, "_soft", SOFT)):
        for name, (law, parameters, grows) in LAWS.items():
            force, errors = law(E_star=law_of.E_star, R_star=1.0, **parameters).force, []
            for key, (lattice, densities) in LATTICES.items():
                distance, pressure = finite_elements(key + table, np.array(densities))
                errors += (isotropic_pressure(lattice, force, distance, 1.0, grows=grows) / pressure - 1).tolist()
            print(f"| {name} | {ratio} |", " | ".join(f"{100 * e:+.0f} %" for e in errors), "|")


def energies() -> None:
    """Print the largest fall of the dissipation over the largest work of 100 random walks."""
    for steps in (3000, 6000):
        with tempfile.TemporaryDirectory() as folder:
            work, elastic, _ = walks(Path(folder), steps, count=100, seed=11)
        print(f"{steps} steps: {falls(work, elastic):.2e}", flush=True)


def beside_mdr(start, die, elastic) -> None:
    """Print deviations from mdr in per cent."""
    with tempfile.TemporaryDirectory() as folder:
        density, pressure = press_mdr(Path(folder) / "mdr", start, die=die, elastic=elastic)
        reference = np.interp(DENSITIES, density, pressure)
        print("mdr P/Y".ljust(38), *(f"{p:6.3f}" for p in reference))
        for name, (settings, softens) in SETTINGS.items():
            density, pressure = press(Path(folder) / name, start, settings, die=die, softens=softens, elastic=elastic)
            error = 100 * (np.interp(DENSITIES, density, pressure) / reference - 1)
            print(f"  {name:36}", " ".join(f"{e:+6.1f}" for e in error), "%", flush=True)


def beside_numpy(start, die) -> None:
    """Print deviations of LIGGGHTS from numpy in per cent."""
    density, pressure = press_numpy(start, die=die)
    reference = np.interp(DENSITIES, density, pressure)
    print("numpy P/Y".ljust(38), *(f"{p:6.3f}" for p in reference))
    with tempfile.TemporaryDirectory() as folder:
        density, pressure = press(Path(folder), start, "compaction on", die=die)
    error = 100 * (np.interp(DENSITIES, density, pressure) / reference - 1)
    print("  LIGGGHTS".ljust(38), " ".join(f"{e:+6.2f}" for e in error), "%", flush=True)


def main() -> None:
    """Print the requested comparison."""
    options, seeds = [x for x in sys.argv[1:] if x.startswith("-")], [int(x) for x in sys.argv[1:] if x.isdigit()]
    if options == ["--lattices"]:
        return lattices()
    if options == ["--walks"]:
        return energies()
    print("relative density".ljust(38), " ".join(f"{d:6.3f}" for d in DENSITIES))
    for seed in seeds or [101, 102]:
        for die in (False, True):
            print(f"seed {seed}, {'die' if die else 'isostatic'}")
            if options == ["--numpy"]:
                beside_numpy(packing(seed), die)
            else:
                beside_mdr(packing(seed), die, (30.0, 0.2) if options == ["--soft"] else (E / Y, NU))


if __name__ == "__main__":
    main()
