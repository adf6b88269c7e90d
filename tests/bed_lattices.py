# SPDX-License-Identifier: GPL-2.0-or-later
"""Regular lattices of equal spheres with compaction: pressing, holding and releasing, by symmetry.

Each sphere lies between the symmetry planes of its lattice. A plane at distance d from the centre has the overlap
alpha = R - d of a sphere with a rigid plane. Lengths in radii: R = 1.
"""

from dataclasses import dataclass

import numpy as np

from bed import PLANE, Bed, Material
from epdem.theory.cavity import FINITE_STRAIN
from epdem.theory.numerics import Array


@dataclass(frozen=True)
class Lattice:
    """Groups of equal planes. counts: planes in each group; ratios: their distances over that of the first group.

    cell: volume of the cell around a sphere over the cube of the distance of the first group.
    """

    counts: tuple[int, ...]
    ratios: tuple[float, ...]
    cell: float


SC = Lattice((6,), (1.0,), 8.0)
FCC = Lattice((12,), (1.0,), 2.0**2.5)
HEXAGONAL = Lattice((8,), (1.0,), 48.0**0.5)  # simple hexagonal
BCC = Lattice((8, 6), (1.0, 2.0 / 3.0**0.5), 32.0 / 27.0**0.5)
SIDES_AND_TOP = (4, 2)  # planes of a simple cubic lattice in a die


@dataclass(frozen=True)
class Path:
    """A sphere between groups of planes, whose distances [R] from its centre have the shape (steps, groups)."""

    counts: tuple[int, ...]
    material: Material
    distances: Array


def lattice_path(lattice: Lattice, material: Material, distance: Array) -> Path:
    """All planes move in proportion; distance: of the first group, (steps,)."""
    return Path(lattice.counts, material, np.multiply.outer(distance, lattice.ratios))


def die_path(material: Material, distance: Array) -> Path:
    """A simple cubic lattice in a die whose walls the spheres touch at the start; distance: half of the height."""
    return Path(SIDES_AND_TOP, material, np.stack([np.ones_like(distance), distance], axis=-1))


def press(paths: list[Path], *, c_strain: float = FINITE_STRAIN, grows: bool = True) -> list[Array]:
    """Forces on one plane of each group, (steps, groups) for each path; all paths have one length."""
    body = np.concatenate([np.full(sum(p.counts), k) for k, p in enumerate(paths)])
    materials = [p.material for p in paths]
    bed = Bed(np.ones(len(paths)), body, np.full(len(body), PLANE), materials, c_strain=c_strain, grows=grows)
    overlap = 1 - np.concatenate([np.repeat(p.distances, p.counts, axis=1) for p in paths], axis=1)
    forces = np.array([bed.step(now) for now in overlap])
    first = np.cumsum([0, *(n for p in paths for n in p.counts)])[:-1]
    groups = np.cumsum([0, *(len(p.counts) for p in paths)])
    return [forces[:, first[a:b]] for a, b in zip(groups, groups[1:], strict=False)]


def distance_at(lattice: Lattice, density: Array | float) -> Array:
    """Distance of the first group at a relative density: volume of a sphere over that of its cell."""
    return np.asarray((4 / 3 * np.pi / (lattice.cell * np.asarray(density))) ** (1 / 3))


def isotropic_pressure(lattice: Lattice, forces: Array, distance: Array) -> Array:
    """Pressure of a lattice pressed equally from all sides: the virial of the forces, (steps, groups)."""
    moments = forces * np.multiply.outer(distance, lattice.ratios) * lattice.counts
    return np.asarray(moments.sum(axis=1) / (3 * lattice.cell * distance**3))


def die_stresses(forces: Array, distance: Array) -> tuple[Array, Array]:
    """Axial and lateral stress of a simple cubic lattice in a die."""
    side, top = forces.T
    return top / 4, side / (4 * distance)


def released(densities: list[tuple[Lattice, Material, float]], *, steps: int = 200, way: float = 0.1) -> list[Array]:
    """Way of the first group [R] and its force over the peak, (2, steps), after pressing to a relative density.

    way: of the release, which ends there.
    """
    back = way * np.linspace(0.0, 1.0, steps) ** 2
    paths = []
    for lattice, material, density in densities:
        end = distance_at(lattice, density)
        loading = np.linspace(1.0, end, steps + 1)[1:]
        paths.append(lattice_path(lattice, material, np.concatenate([loading, end + back[1:]])))
    found = [F[steps - 1 :, 0] for F in press(paths)]
    return [np.stack([back, F / F[0]]) for F in found]


def side_force_left(material: Material, densities: Array, *, steps: int = 200, way: float = 0.12) -> Array:
    """Force on the sides of a die over that before, where the plates have none, after pressing to relative densities.

    way: of the release [R], in which the plates part.
    """
    ends = np.pi / 6 / densities
    paths = [np.append(np.linspace(1, end, steps + 1)[1:], np.linspace(end, end + way, 81)[1:]) for end in ends]
    left = [F[np.argmax(F[steps:, 1] <= 0) + steps, 0] / F[steps - 1, 0]
            for F in press([die_path(material, d) for d in paths])]  # fmt: skip
    return np.array(left)


def recovery(curve: Array, share: float) -> float:
    """Way [R] at which the force has fallen to a share of the peak; curve: of `released`."""
    way, force = curve
    return float(np.interp(-share, -force, way))
