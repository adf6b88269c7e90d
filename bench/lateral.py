# SPDX-License-Identifier: GPL-2.0-or-later
"""Print lateral stress of lattices that are pressed, then released along z or on all sides, beside finite elements.

.venv/bin/python bench/lateral.py > docs/data/lateral.csv

Spheres with cavity, finite_strain and compaction in LIGGGHTS and LAMMPS: lattices in a periodic box; `die` is a simple
cubic lattice pressed along z alone, in LAMMPS one sphere between six rigid walls. Finite elements:
data/compaction/lateral.csv and unloading.csv.
"""

import csv
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "engines"))

import lammps_decks
import lammps_lattices
import plugin_decks

from bed import Material
from bed_lattices import distance_at
from dense_lattices import LATTICES, MATERIALS, TABLES
from epdem.theory.cavity import FINITE_STRAIN

DENSITIES = {
    "die": (0.65, 0.80, 0.90, 0.95),
    "sc": (0.80, 0.92),
    "fcc": (0.85, 0.95),
    "bcc": (0.80, 0.90),
    "hex": (0.80, 0.92),
}
PASSED = 0.91  # relative density above which layers of a die reach past the next one, where no walls stand between
SHARES = (0.5, 0.02)  # of the axial stress at the peak
Y = 1e6  # [Pa]
NAMES = ("axial", "lateral_over_axial", "left_50", "left_02", "strain_02")
DIGITS = (4, 3, 2, 2, 4)
STEPS = 1600
# cell and places of the spheres at first touch; distance of the planes at first touch is 1
CUBIC = np.eye(3)
BASES = {
    "sc": (2.0 * CUBIC, [(0, 0, 0)]),
    "fcc": (8**0.5 * CUBIC, [(0, 0, 0), (0.5, 0.5, 0), (0.5, 0, 0.5), (0, 0.5, 0.5)]),
    "bcc": (4 / 3**0.5 * CUBIC, [(0, 0, 0), (0.5, 0.5, 0.5)]),
    "hex": (np.diag([2.0, 2.0 * 3**0.5, 2.0]), [(0, 0, 0), (0.5, 0.5, 0)]),
}
DATA = "spheres.data"
LIGGGHTS = """units si
atom_style granular
atom_modify map array sort 0 0
boundary p p p
newton off
communicate single vel yes
read_data spheres.data
neighbor 0.3 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype {E!r}
fix m2 all property/global poissonsRatio peratomtype {nu!r}
fix p1 all property/global yieldStress peratomtype {Y!r}
fix p2 all property/global finiteStrain peratomtype {strain!r}
pair_style gran model ep/cavity tangential off compaction on
pair_coeff * *
compute p all pressure thermo_temp pair
thermo_style custom step lx lz c_p[1] c_p[2] c_p[3]
thermo_modify format float %.17g norm no
"""
LAMMPS = """units si
atom_style sphere
atom_modify map array sort 0 0
boundary p p p
newton off
comm_modify vel yes
read_data spheres.data
neighbor 0.3 bin
neigh_modify delay 0
pair_style ep
pair_coeff * * {law}
compute p all pressure thermo_temp pair
thermo_style custom step lx lz c_p[1] c_p[2] c_p[3]
thermo_modify format float %.17g norm no
"""


def data(name) -> str:
    """The spheres of three cells along each edge, as a data file."""
    cell, basis = BASES[name]
    corners = np.stack(np.meshgrid(*[np.arange(3)] * 3, indexing="ij"), -1).reshape(-1, 1, 3)
    x = ((corners + np.array(basis)).reshape(-1, 3) @ cell).tolist()
    box = [f"0 {3.0 * float(cell[k, k])!r} {c}lo {c}hi" for k, c in enumerate("xyz")]
    rows = [f"{k + 1} 1 2.0 1e21 {' '.join(map(repr, place))}" for k, place in enumerate(x)]
    return "\n".join(["x", "", f"{len(x)} atoms", "1 atom types", "", *box, "", "Atoms", "", *rows, ""])


def run(folder, host, text) -> np.ndarray:
    """Rows of thermo output: step and what the deck names."""
    if host == "lammps":
        out, _ = lammps_decks.run(text, folder)
    else:
        out = plugin_decks.good(folder, text).text
    found = []
    for line in out.splitlines():
        words = line.split()
        if len(words) == 6 and words[0].isdigit():
            found.append([float(w) for w in words])
    return np.array(found)


def lattice(folder, host, name, material, density, along) -> np.ndarray:
    """(length along z over that at first touch, axial, lateral stress over Y) of all steps, shape (3, 2, steps)."""
    folder.mkdir(parents=True, exist_ok=True)
    kind = "sc" if name == "die" else name
    (folder / DATA).write_text(data(kind))
    law = lammps_lattices.dense_law(Material(material.E * Y, material.nu, Y))
    words = {"E": material.E * Y, "nu": material.nu, "Y": Y, "strain": FINITE_STRAIN, "law": law}
    text = (LAMMPS if host == "lammps" else LIGGGHTS).format(**words)
    end = np.pi / 6 / density if name == "die" else float(distance_at(LATTICES[name], density))
    text += "fix move all nve/sphere\ntimestep 1e-3\nthermo 1\n"
    back = 1.0 + 4.0 / material.E / end
    for axes, scale in (("z" if name == "die" else "xyz", end), ("z" if along == "z" else "xyz", back)):
        text += f"fix squeeze all deform 1 {' '.join(f'{a} scale {scale!r}' for a in axes)} remap x\nrun {STEPS}\n"
    rows = run(folder, host, text)
    # a box moves after the forces of a step
    parts = np.split(rows, np.flatnonzero(np.diff(rows[:, 0]) == 0) + 1)
    z, first = [], rows[0, 2]
    for part in parts:
        volume = part[:, 1] ** 2 * part[:, 2]
        before = np.append(volume[:1], volume[:-1])
        part[:, 3:] *= (volume / before)[:, None]
        z.append([np.append(part[:1, 2], part[:-1, 2]) / first, part[:, 5] / Y, part[:, 3:5].mean(axis=1) / Y])
    return np.array(z)


def die_between_walls(folder, material, density) -> np.ndarray:
    """The same of one sphere between six rigid walls in LAMMPS."""
    rows = np.array(lammps_lattices.press_in_die(folder, material, density, steps=STEPS, back=4.0 / material.E))
    second = int(np.argmin(rows[0])) + 1
    return np.stack([rows[:, second - STEPS - 1 : second], rows[:, second : second + STEPS + 1]])


def measures(curves) -> list[float]:
    """Axial stress and lateral over axial stress at the peak; lateral force left, and strain, at shares of it."""
    (z, axial, lateral), (length, out, side) = curves
    peak, width = axial[-1], length / z[-1]
    left = side * width / lateral[-1]  # of the force on the sides
    fall = np.minimum.accumulate(out / peak)
    return [
        peak,
        lateral[-1] / peak,
        *(float(np.interp(-s, -fall, left)) for s in SHARES),
        float(np.interp(-SHARES[-1], -fall, width - 1.0)),
    ]


def finite_elements() -> dict[tuple[str, float, float, float, str], list[float]]:
    """The same of finite elements."""
    found = {}
    with (TABLES / "lateral.csv").open() as file:
        for row in csv.DictReader(file):
            key = (row["lattice"], float(row["E_over_Y"]), float(row["nu"]), float(row["density"]), "z")
            numbers = [float(row[k] or "nan") for k in ("axial", "lateral", "left_50", "left_02", "strain_02")]
            found[key] = [numbers[0], numbers[1] / numbers[0], *numbers[2:]]
    with (TABLES / "unloading.csv").open() as file:
        for row in csv.DictReader(file):
            if row["lattice"] in LATTICES:
                key = (row["lattice"], float(row["E_over_Y"]), float(row["nu"]), float(row["density"]), "all")
                end = float(distance_at(LATTICES[row["lattice"]], float(row["density"])))
                found[key] = [*[np.nan] * 4, float(row["way_02"]) / end]
    return found


def columns(values) -> str:
    """Values as columns, NaN as nothing."""
    return ",".join("" if np.isnan(x) else f"{x:.{digits}f}" for x, digits in zip(values, DIGITS, strict=True))


def main() -> None:
    """Print the table."""
    known, nothing = finite_elements(), [np.nan] * len(NAMES)
    print("host,lattice,E/Y,nu,density,released," + ",".join((*NAMES, *(f"fe_{n}" for n in NAMES))))
    cases = [
        (mark, name, density, along, host)
        for mark in ("_soft", "_60", "", "_300")
        for name, densities in DENSITIES.items()
        for density in densities
        for along in (("z",) if name == "die" else ("z", "all"))
        for host in ("liggghts", "lammps")
        if (name, host) != ("die", "liggghts") or density < PASSED
    ]
    with tempfile.TemporaryDirectory() as place:
        for mark, name, density, along, host in cases:
            m, folder = MATERIALS[mark], Path(place) / f"{host}{mark}{name}{density}{along}"
            if (name, host) == ("die", "lammps"):
                of_spheres = measures(die_between_walls(folder, m, density))
            else:
                of_spheres = measures(lattice(folder, host, name, m, density, along))
            if along == "all":
                of_spheres[2:4] = nothing[2:4]
            of_elements = known.get((name, m.E, m.nu, density, along), nothing)
            key = f"{host},{name},{m.E:g},{m.nu:g},{density:.2f},{along}"
            print(f"{key},{columns(of_spheres)},{columns(of_elements)}", flush=True)


if __name__ == "__main__":
    main()
