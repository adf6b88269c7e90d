# SPDX-License-Identifier: GPL-2.0-or-later
"""Print the tables of docs/choose.md: lattices of spheres in LAMMPS beside finite elements (data/compaction).

.venv/bin/python bench/lattices.py             # pressed
.venv/bin/python bench/lattices.py --released  # pressed and released

`die` is one sphere between six rigid walls; in the other lattices all contacts are of spheres. The last line of a table
is the largest difference of LAMMPS from the lattices in numpy.
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


LAWS = {
    "`thornton`": words("thornton", 2.8),
    "`cavity`": words("cavity", 1.0),
    "`cavity`, `finite_strain`": words("cavity", 1.0, 1.6, 2.8, 0.82),
    "`cavity`, `finite_strain`, `compaction`": lammps_lattices.dense_law,
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
    worst = 0.0
    for mark in ("", "_soft", "_60", "_300"):
        for law, of_material in LAWS.items():
            dense = of_material is lammps_lattices.dense_law
            if not dense and mark in ("_60", "_300"):
                continue
            cells = []
            for name, density in DENSITIES.items():
                key = name + mark
                if (mark == "_300" and name == "hex") or (mark in ("_60", "_300") and name == "bcc"):
                    cells += ["-"] * len(density)  # no finite elements
                    continue
                curve = lammps_lattices.press(folder, name, MATERIALS[mark], 0.965, law=of_material)
                cells += [f"{100 * e:+.0f} %" for e in deviation(key, density, curve)]
                if dense:
                    worst = max(worst, beside_numpy(key, curve))
            print(f"| {law} | {MATERIALS[mark].E:g} |", " | ".join(cells), "|", flush=True)
    for mark in ("", "_soft"):
        d, axial, lateral = lammps_lattices.press_in_die(folder, MATERIALS[mark], 0.965)
        errors = deviation("die" + mark, DIE, (d, axial))
        at, szz, sxx = finite_elements("die" + mark, np.array(DIE))
        ratios = np.interp(-at, -d, lateral / np.maximum(axial, 1e-30))
        print(f"| die, {MATERIALS[mark].E:g} |", " | ".join(f"{100 * e:+.0f} %" for e in errors), "|")
        print(
            "| lateral over axial stress |",
            " | ".join(f"{r:.2f} ({s:.2f})" for r, s in zip(ratios, sxx / szz, strict=False)),
            "|",
        )
        worst = max(worst, beside_numpy("die" + mark, (d, axial, lateral)))
    print(f"numpy: {worst:.1e}")


def released(folder) -> None:
    """Recovery at shares of the peak over that of finite elements."""
    for name, E, nu, density, _, ways in RELEASES:
        d, P = lammps_lattices.press(folder, name, Material(E, nu, 1.0), density, steps=1600, back=1.8 / E)
        force = P * d**2
        turn = np.argmin(d)
        curve = np.stack([d[turn:] - d[turn], force[turn:] / force[turn:].max()])
        found = [recovery(curve, share) / ways[share] for share in SHARES]
        print(f"| {name} | {E:g} | {nu:g} | {density:g} |", " | ".join(f"{r:.2f}" for r in found), "|", flush=True)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        (released if "--released" in sys.argv else pressed)(Path(place))
