# SPDX-License-Identifier: GPL-2.0-or-later
"""Finite elements of pressed and released lattices (data/compaction), and the same lattices by the law in numpy."""

import csv
from pathlib import Path

import numpy as np

from bed import Material
from bed_lattices import (
    BCC,
    FCC,
    HEXAGONAL,
    SC,
    Lattice,
    die_path,
    die_stresses,
    distance_at,
    isotropic_pressure,
    lattice_path,
    press,
)

TABLES = Path(__file__).parents[1] / "data" / "compaction"
TETRAGONAL = Lattice((4, 2), (1.0, 1.1), 8.8)
LATTICES = {"fcc": FCC, "bcc": BCC, "sc": SC, "hex": HEXAGONAL, "tet": TETRAGONAL}
MATERIALS = {
    "": Material(120.0, 0.34, 1.0),
    "_soft": Material(30.0, 0.2, 1.0),
    "_60": Material(60.0, 0.3, 1.0),
    "_300": Material(300.0, 0.3, 1.0),
    "_300_25": Material(300.0, 0.25, 1.0),
}
STEPS = 200  # of a press: the forces are within 1e-3 of those of many steps

# relative densities and the deviation of the pressure from the tables [%]; of the die the axial stress
DEVIATIONS = {
    "fcc": ((0.80, 0.85, 0.90, 0.94, 0.96), (8, 5, 5, 2, -2)),
    "bcc": ((0.75, 0.82, 0.90, 0.95), (7, 7, 8, -2)),
    "sc": ((0.60, 0.70, 0.80, 0.90, 0.95), (0, 3, 2, -8, -22)),
    "hex": ((0.65, 0.75, 0.85, 0.92, 0.95), (10, 9, 8, 6, 1)),
    "die": ((0.60, 0.65, 0.75, 0.85, 0.90, 0.95), (-2, 9, 8, -12, -26, -40)),
    "fcc_soft": ((0.80, 0.85, 0.90, 0.94, 0.95, 0.96), (-9, -14, -16, -15, -14, -14)),
    "bcc_soft": ((0.75, 0.82, 0.90, 0.95), (-9, -14, -12, -10)),
    "sc_soft": ((0.60, 0.70, 0.80, 0.90, 0.95), (-11, -15, -10, -11, -14)),
    "hex_soft": ((0.65, 0.75, 0.85, 0.92, 0.95), (-7, -13, -8, -6, -6)),
    "die_soft": ((0.60, 0.65, 0.75, 0.85, 0.90, 0.95), (-10, -2, 10, 0, -9, -18)),
    "fcc_60": ((0.80, 0.85, 0.90, 0.95), (-3, -4, 5, 9)),
    "sc_60": ((0.65, 0.70, 0.80, 0.90, 0.95), (0, 10, 12, 1, -10)),
    "hex_60": ((0.65, 0.75, 0.85, 0.92, 0.95), (0, 8, 18, 15, 12)),
    "fcc_300": ((0.80, 0.85, 0.90, 0.95), (-11, -5, -2, -6)),
    "tet_300_25": ((0.60, 0.65, 0.70, 0.75, 0.80, 0.85, 0.90, 0.95), (12, 0, -1, 0, -1, -4, -11, -24)),
    "sc_300": ((0.65, 0.70, 0.80, 0.90, 0.95), (-7, -1, -1, -11, -24)),
}


def table(name):
    rows = np.genfromtxt(TABLES / f"{name}.csv", delimiter=",", skip_header=1)
    return rows[:, 0], rows[:, 1:]


def smooth(distance, values, at):
    """Local parabola, which takes out the steps of the mesh."""
    found, width = [], 0.12 * (distance.max() - distance.min())
    for x in at:
        near = np.abs(distance - x) < width
        found.append(np.polyfit(distance[near] - x, values[near], 2)[-1])
    return np.array(found)


def parts(name):
    """(lattice, material) of the name of a table; no lattice of a die."""
    lattice, mark, rest = name.partition("_")
    return LATTICES.get(lattice), MATERIALS[mark + rest]


def finite_elements(name, density):
    """(distance, pressure/Y) of a lattice at relative densities; (distance, axial, lateral stress) of a die."""
    d, F = table(name)
    lattice, _ = parts(name)
    if lattice is None:
        at = np.pi / 6 / density
        return at, *(smooth(d, stress, at) for stress in die_stresses(F, d))
    at = distance_at(lattice, density)
    return at, smooth(d, isotropic_pressure(lattice, F, d), at)


def pressed(names, densest=0.965, **options):
    """(distance of the first group, pressure) of lattices and (distance, axial, lateral stress) of dies, in numpy."""
    paths = []
    for name in names:
        lattice, material = parts(name)
        end = np.pi / 6 / densest if lattice is None else float(distance_at(lattice, densest))
        d = np.linspace(1.0, end, STEPS + 1)[1:]
        paths.append(die_path(material, d) if lattice is None else lattice_path(lattice, material, d))
    found = {}
    for name, path, F in zip(names, paths, press(paths, **options), strict=True):
        lattice, _ = parts(name)
        d = path.distances[:, -1 if lattice is None else 0]
        stresses = die_stresses(F, d) if lattice is None else (isotropic_pressure(lattice, F, d),)
        found[name] = (d, *stresses)
    return found


def deviation(name, density, curve):
    """Pressure, or axial stress, of a curve of `pressed` over finite elements, less 1."""
    at, reference, *_ = finite_elements(name, np.array(density))
    return np.interp(-at, -curve[0], curve[1]) / reference - 1


def unloading():
    """Rows of the finite elements that release: (lattice, E/Y, nu, D, force, {share of the force: way})."""
    with (TABLES / "unloading.csv").open() as file:
        for row in csv.DictReader(file):
            ways = {int(k[4:]) / 100: float(v) for k, v in row.items() if k.startswith("way_")}
            numbers = [float(row[k]) for k in ("E_over_Y", "nu", "density", "force")]
            yield row["lattice"], *numbers, ways


def stands(*, left=False):
    """Rows of the finite elements that stand before a release along z: (lattice, E/Y, D, axial, lateral stress).

    left: also the share of the lateral force at 2 % of the axial force.
    """
    names = ["E_over_Y", "density", "axial", "lateral", *["left_02"] * left]
    with (TABLES / "lateral.csv").open() as file:
        for row in csv.DictReader(file):
            if row["nu"] != "0.45":
                yield row["lattice"], *(float(row[k]) for k in names)


RELEASES = [row for row in unloading() if row[0] != "die"]
