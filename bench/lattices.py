# SPDX-License-Identifier: GPL-2.0-or-later
"""Print the tables behind docs/press.md as CSV: lattices of spheres in LAMMPS beside finite elements (data/compaction).

.venv/bin/python bench/lattices.py > docs/data/lattices.csv                      # pressed
.venv/bin/python bench/lattices.py --released > docs/data/lattices_released.csv  # pressed and released

`die` is one sphere between six rigid walls; in the other lattices all contacts are of spheres. Pressed lattices also
print the largest difference of LAMMPS from the lattices in numpy (stderr).
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "engines"))

import lammps_lattices

from bed import Material
from bed_lattices import (
    die_path,
    die_stresses,
    isotropic_pressure,
    lattice_path,
    press,
    recovery,
)
from dense_lattices import MATERIALS, RELEASES, deviation, finite_elements, parts

DENSITIES = {
    "fcc": (0.80, 0.90, 0.95),
    "bcc": (0.75, 0.90, 0.95),
    "sc": (0.65, 0.80, 0.90, 0.95),
    "hex": (0.65, 0.85, 0.95),
}
DIE = (0.60, 0.65, 0.75, 0.85, 0.90, 0.95)
SHARES = (0.75, 0.50, 0.25, 0.02)


def words(law, *numbers):
    """Words of a law that takes its strength from the yield stress."""
    return lambda m: " ".join(map(str, [law, m.E, m.nu, *numbers]))


DENSE = "cavity finite_strain compaction"
LAWS = {
    "thornton": words("thornton", 2.8),
    "cavity": words("cavity", 1.0),
    "cavity finite_strain": words("cavity", 1.0, 1.6, 2.8, 0.82),
    DENSE: lammps_lattices.dense_law,
}


def beside_numpy(name, curve) -> float:
    """Largest difference of the stresses of a curve from numpy over the peak."""
    lattice, material = parts(name)
    d = curve[0]
    path = die_path(material, d) if lattice is None else lattice_path(lattice, material, d)
    (F,) = press([path])
    theory = die_stresses(F, d) if lattice is None else (isotropic_pressure(lattice, F, d),)
    return max(np.abs(a - b).max() / b.max() for a, b in zip(curve[1:], theory, strict=True))


def pressed(folder) -> None:
    """Deviations of the pressure from finite elements."""
    print("law,E/Y,nu,lattice,density,quantity,value,finite_elements")
    worst = 0.0
    for mark in ("", "_soft", "_60", "_300"):
        material = MATERIALS[mark]
        for law, of_material in LAWS.items():
            if law != DENSE and mark in ("_60", "_300"):
                continue
            for name, density in DENSITIES.items():
                key = name + mark
                if (mark == "_300" and name == "hex") or (mark in ("_60", "_300") and name == "bcc"):
                    continue  # no finite elements
                curve = lammps_lattices.press(folder, name, material, 0.965, law=of_material)
                for d, error in zip(density, deviation(key, density, curve), strict=True):
                    line(law, material, name, d, "pressure_deviation", error)
                if law == DENSE:
                    worst = max(worst, beside_numpy(key, curve))
    for mark in ("", "_soft"):
        material = MATERIALS[mark]
        d, axial, lateral = lammps_lattices.press_in_die(folder, material, 0.965)
        distance, szz, sxx = finite_elements("die" + mark, np.array(DIE))
        ratios = np.interp(-distance, -d, lateral / np.maximum(axial, 1e-30))
        for at, error in zip(DIE, deviation("die" + mark, DIE, (d, axial)), strict=True):
            line(DENSE, material, "die", at, "pressure_deviation", error)
        for at, ratio, theirs in zip(DIE, ratios, sxx / szz, strict=True):
            line(DENSE, material, "die", at, "lateral_over_axial", ratio, f"{theirs:.2f}")
        worst = max(worst, beside_numpy("die" + mark, (d, axial, lateral)))
    print(f"numpy: {worst:.1e}", file=sys.stderr)


def line(law, material, name, density, quantity, value, theirs="") -> None:
    """One line of the table of pressed lattices."""
    rounded = round(value, 2) + 0.0  # without the sign of zero
    print(f"{law},{material.E:g},{material.nu:g},{name},{density:.2f},{quantity},{rounded:.2f},{theirs}", flush=True)


def released(folder) -> None:
    """Recovery at shares of the peak over that of finite elements."""
    print("lattice,E/Y,nu,density,force_left,recovery_over_finite_elements")
    for name, E, nu, density, _, ways in RELEASES:
        d, P = lammps_lattices.press(folder, name, Material(E, nu, 1.0), density, steps=1600, back=1.8 / E)
        force = P * d**2
        turn = np.argmin(d)
        curve = np.stack([d[turn:] - d[turn], force[turn:] / force[turn:].max()])
        for share in SHARES:
            print(f"{name},{E:g},{nu:g},{density:.2f},{share:g},{recovery(curve, share) / ways[share]:.2f}", flush=True)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        (released if "--released" in sys.argv else pressed)(Path(place))
