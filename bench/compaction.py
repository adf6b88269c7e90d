# SPDX-License-Identifier: GPL-2.0-or-later
"""Pressure of random packings under compaction in LAMMPS: cavity of the plugin beside mdr with psi_b = 0.

.venv/bin/python bench/compaction.py [seed ...]            # E/Y = 120, nu = 0.34; with --soft 30 and 0.2
.venv/bin/python bench/compaction.py --numpy [seed ...]  # beside numpy, with the sums of the same step
.venv/bin/python bench/compaction.py --walks             # energy that 100 random walks create

150 spheres of radii +-20 % without friction are pressed from a relative density of 0.40 by six rigid
walls (isostatic) or by two of them (die). Both codes start with the same positions.
bench/lattices.py has regular lattices beside finite elements.
"""

import re
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "engines"))

from dense_spheres import NU, E, Y
from walks import energies as energies_of
from walks import falls, one_body, walk

from bed import PLANE, Bed, Material
from epdem.engines.lammps import launcher

DENSITIES = np.array([0.65, 0.70, 0.75, 0.80, 0.85, 0.90, 0.93, 0.95, 0.965])
RIGID = 1e3  # modulus of the walls over that of the spheres; their yield stress over that of the spheres
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


def _run(folder, start, style, walls, *, die, dt, more):
    """Pressed spheres in LAMMPS: a pair style, the words of its walls over a region, more lines before the run.

    Walls are planes of which x0, x2, ... are the lower and upper ones of the axes.
    """
    x, radius, edge = start
    _, axes, seconds = _course(start, die)
    folder.mkdir(parents=True, exist_ok=True)
    rows = [
        f"{k + 1} 1 {2 * float(r)!r} 1.0 {' '.join(map(repr, map(float, p)))}"
        for k, (r, p) in enumerate(zip(radius, x, strict=True))
    ]
    box = [f"{-edge!r} {edge!r} {c}lo {c}hi" for c in "xyz"]
    atoms = ["x", "", f"{len(radius)} atoms", "1 atom types", "", *box, "", "Atoms", "", *rows, ""]
    (folder / "spheres.data").write_text("\n".join(atoms))
    lines = ["units si", "atom_style sphere", "atom_modify map array", "boundary f f f", "newton off"]
    lines += ["comm_modify vel yes", "read_data spheres.data", "neighbor 1.0 bin"]
    lines += ["neigh_modify every 10 delay 0 check no", *style]
    lines += [f"variable in equal step*{dt * SPEED[die]!r}", "variable out equal -v_in"]
    for a, axis in enumerate("xyz"):
        for sign in (1, -1):
            point, normal, moves = [0.0] * 3, [0.0] * 3, ["NULL"] * 3
            point[a], normal[a], moves[a] = sign * edge / 2, -sign, "v_out" if sign > 0 else "v_in"
            plane = " ".join(map(repr, [*map(float, point), *map(float, normal)]))
            move = f" move {' '.join(moves)}" if axis in axes else ""
            lines.append(f"region r{axis}{sign + 1} plane {plane}{move}")
            lines.append(f"fix w{axis}{sign + 1} all {walls.format(region=f'r{axis}{sign + 1}')}")
    lines += ["fix move all nve/sphere", *more, f"timestep {dt!r}", f"run {int(seconds / dt)}", ""]
    (folder / "in.press").write_text("\n".join(lines))
    launcher.run("in.press", folder, out="out.press", seconds=1800)


def press(folder, start, settings, *, die, softens=True, elastic=(E / Y, NU), dt=0.02):
    """(relative density, pressure over Y) of ep/cavity: mean force on the moving walls over their area."""
    _, _, edge = start
    _, axes, _ = _course(start, die)

    def law(factor):
        strain = " 0.82" if softens else ""
        return f"cavity {factor * elastic[0]!r} {elastic[1]!r} {factor!r} 1.6 2.8{strain} {settings}"

    forces = " ".join(f"f_w{axis}{side}[{1 + 'xyz'.index(axis)}]" for axis in axes for side in (0, 2))
    more = [f"fix drag all viscous {DRAG * 4 * np.pi / 3!r}", f"fix mean all ave/time 1 40 40 {forces} file loads.txt"]
    style = ["pair_style ep", f"pair_coeff * * {law(1.0)}"]
    _run(folder, start, style, f"wall/ep/region {{region}} {law(RIGID)}", die=die, dt=dt, more=[*more, "thermo 100000"])
    rows = np.loadtxt(folder / "loads.txt")
    way = SPEED[die] * dt * (rows[:, 0] - 20)
    side = edge if die else edge - 2 * way
    return _density(start, die, way), np.abs(rows[:, 1:]).mean(axis=1) / side**2


def press_mdr(folder, start, *, die, elastic=(E / Y, NU), dt=0.01):
    """The same of LAMMPS's mdr with psi_b = 0: pressure (die: axial stress) from the stresses of the spheres."""
    law = f"mdr {elastic[0]!r} {elastic[1]!r} 1.0 0 0.0 0 tangential linear_history 0.0 0.0 0.0 damping mdr 1"
    more = [f"variable f{c} atom -{DRAG}*mass*v{c}" for c in "xyz"]
    more += ["fix drag all addforce v_fx v_fy v_fz", f"timestep {dt!r}", "run 0"]
    more += ["compute s all property/atom d_sigmaxx d_sigmayy d_sigmazz d_Velas"]
    trace = "3*c_s[3]" if die else "(c_s[1]+c_s[2]+c_s[3])"
    more += [f"variable t atom {trace}*c_s[4]", "compute sum all reduce sum v_t", "thermo_style custom step c_sum"]
    more += ["thermo 80", "thermo_modify format float %.10g lost warn"]
    style = ["pair_style granular", f"pair_coeff * * {law}"]
    _run(folder, start, style, f"wall/gran/region granular {law} region {{region}} contacts", die=die, dt=dt, more=more)
    found = re.findall(r"^ +(\d+) +(-?[\d.]+(?:e[+-]\d+)?)$", (folder / "out.press").read_text(), re.M)
    step, total = np.array(found, float).T
    way = SPEED[die] * dt * step
    volume = len(start[1]) * 4 * np.pi / 3
    density = _density(start, die, way)
    return density[1:], -total[1:] / (3 * volume / density[1:])


def press_numpy(start, *, die, elastic: tuple[float, float] = (E / Y, NU), dt=0.02):
    """The same of the law in numpy, with the sums of the step itself; units: Y, mean radius, mass of density Y."""
    x, radius, edge = start
    _, axes, seconds = _course(start, die)
    moves = np.array([axis in axes for axis in "xyz"])
    mass, n = 4 / 3 * np.pi * radius[:, None] ** 3, len(radius)
    x, v, a = x.copy(), np.zeros_like(x), np.zeros_like(x)
    i, j = np.triu_indices(n, 1)
    bodies = np.concatenate([i, np.repeat(np.arange(n), 6)]), np.concatenate([j, np.full(6 * n, PLANE)])
    plane = Material(RIGID * elastic[0], elastic[1], RIGID)
    bed = Bed(radius, *bodies, Material(*elastic, 1.0), plane=plane, c_strain=0.82)
    found, load = [], np.zeros(6)
    for step in range(1, int(seconds / dt) + 1):
        v += 0.5 * dt * a
        x += dt * v
        half = edge / 2 - SPEED[die] * dt * step * moves
        d = x[i] - x[j]
        r = np.linalg.norm(d, axis=1)
        at_wall = radius[:, None] - np.hstack([half + x, half - x])
        F = bed.step(np.concatenate([radius[i] + radius[j] - r, at_wall.ravel()]))
        F, F_wall = F[: len(i)], F[len(i) :].reshape(n, 6)
        on_pair = d * (F / r)[:, None]
        a = F_wall[:, :3] - F_wall[:, 3:] - DRAG * mass.mean() * v
        for k in range(3):
            a[:, k] += np.bincount(i, on_pair[:, k], n) - np.bincount(j, on_pair[:, k], n)
        a /= mass
        v += 0.5 * dt * a
        load += F_wall.sum(axis=0)
        if step % 40 == 0:
            way = SPEED[die] * dt * (step - 20)
            side = edge if die else edge - 2 * way
            found.append((_density(start, die, way), load.reshape(2, 3)[:, moves].mean() / 40 / side**2))
            load[:] = 0.0
    return np.array(found).T


def energies() -> None:
    """Print the largest fall of the dissipation over the largest work of 100 random walks."""
    for steps in (3000, 6000):
        with tempfile.TemporaryDirectory() as folder:
            found = walk("liggghts", Path(folder), one_body(), [(E, NU, Y)], steps, count=100, seed=11)
        work, elastic, _ = energies_of(found)
        print(f"{steps} steps: {falls(work, elastic).max():.2e}", flush=True)


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
    """Print deviations of LAMMPS from numpy in per cent."""
    density, pressure = press_numpy(start, die=die)
    reference = np.interp(DENSITIES, density, pressure)
    print("numpy P/Y".ljust(38), *(f"{p:6.3f}" for p in reference))
    with tempfile.TemporaryDirectory() as folder:
        density, pressure = press(Path(folder), start, "compaction on", die=die)
    error = 100 * (np.interp(DENSITIES, density, pressure) / reference - 1)
    print("  LAMMPS".ljust(38), " ".join(f"{e:+6.2f}" for e in error), "%", flush=True)


def main() -> None:
    """Print the requested comparison."""
    options, seeds = [x for x in sys.argv[1:] if x.startswith("-")], [int(x) for x in sys.argv[1:] if x.isdigit()]
    if options == ["--walks"]:
        return energies()
    print("relative density".ljust(38), " ".join(f"{d:6.3f}" for d in DENSITIES))
    for seed in seeds or [331, 557, 913]:
        for die in (False, True):
            print(f"seed {seed}, {'die' if die else 'isostatic'}")
            if options == ["--numpy"]:
                beside_numpy(packing(seed), die)
            else:
                beside_mdr(packing(seed), die, (30.0, 0.2) if options == ["--soft"] else (E / Y, NU))


if __name__ == "__main__":
    main()
