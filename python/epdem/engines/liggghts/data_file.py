# SPDX-License-Identifier: GPL-2.0-or-later
"""The data file of LAMMPS and LIGGGHTS: spheres with positions and velocities."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ...base.rendering import number


@dataclass(frozen=True)
class Spheres:
    """Equal spheres: atom type (from 1), diameter [m], density [kg/m^3], places [m] and velocities [m/s], (n, 3).

    `spin` about y [rad/s], shape (n,); None: none.
    """

    type: int
    diameter: float
    density: float
    place: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray | None = None


def text(title: str, types: int, box: Iterable[tuple[float, float]], groups: Iterable[Spheres]) -> str:
    """A data file of `types` atom types in a `box` of three (low, high) [m]; ids from 1 in the order of the groups."""
    atoms: list[str] = []
    velocities: list[str] = []
    for group in groups:
        body = f"{group.type} {number(group.diameter)} {number(group.density)}"
        spins = ["0"] * len(group.place) if group.spin is None else [number(w) for w in group.spin.tolist()]
        for place, velocity, spin in zip(group.place.tolist(), group.velocity.tolist(), spins, strict=True):
            id = len(atoms) + 1
            atoms.append(f"{id} {body} {' '.join(map(number, place))}")
            velocities.append(f"{id} {' '.join(map(number, velocity))} 0 {spin} 0")
    sides = [f"{number(low)} {number(high)} {a}lo {a}hi" for a, (low, high) in zip("xyz", box, strict=True)]
    head = [f"{' '.join(title.split())}: id type diameter density x y z", "", f"{len(atoms)} atoms"]
    head += [f"{types} atom types", *sides, ""]
    return "\n".join([*head, "Atoms", "", *atoms, "", "Velocities", "", *velocities, ""])
