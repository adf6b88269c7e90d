# SPDX-License-Identifier: GPL-2.0-or-later
"""Pressure of regular lattices of equal spheres whose contacts grow by the dents of the others (compaction).

Each sphere lies between the symmetry planes of its lattice. A plane at distance d from the centre has the overlap
alpha = R - d of a sphere with a rigid plane, and x = alpha/R.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...theory.numerics import Array

Force = Callable[[Array], Array]  # force of a sphere on a rigid plane [N] at an overlap [m] > 0


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


def equal_contacts(n: int, x: Array) -> Array:
    """Growth over the radius of a sphere with n equal dents of depth x R: g = n x^2/(4 - 2 n x), n x < 1.6."""
    return np.asarray(n * x**2 / (4.0 - 2.0 * n * x))


def added_overlaps(counts: tuple[int, ...], x: Array) -> Array:
    """Overlap over the radius that each group of planes gains by the dents of all other planes, shape of x.

    x: depths of the dents over the radius, shape (groups, ...); negative across a gap.
    """
    dents = np.maximum(x, 0.0)
    n = np.array(counts).reshape(-1, *[1] * (dents.ndim - 1))
    growth = (n * dents**2).sum(axis=0) / (4.0 - 2.0 * np.minimum((n * dents).sum(axis=0), 1.6))
    return np.asarray(np.maximum(growth - equal_contacts(1, dents), 0.0))


def _forces(force: Force, counts: tuple[int, ...], x: Array, radius: float, grows: bool) -> Array:
    overlap = radius * (x + (added_overlaps(counts, x) if grows else 0.0))
    return np.where(overlap > 0.0, force(np.maximum(overlap, 1e-12 * radius)), 0.0)


def isotropic_pressure(lattice: Lattice, force: Force, distance: Array, radius: float, *, grows: bool = True) -> Array:
    """Pressure [Pa] of a lattice pressed equally from all sides; distance [m] of the first group of planes, (n,)."""
    distances = np.multiply.outer(lattice.ratios, distance)
    forces = _forces(force, lattice.counts, 1.0 - distances / radius, radius, grows)
    counts = np.array(lattice.counts)[:, None]
    return np.asarray((counts * forces * distances).sum(axis=0) / (3.0 * lattice.cell * distance**3))


def die_stresses(force: Force, distance: Array, radius: float, *, grows: bool = True) -> tuple[Array, Array]:
    """Axial and lateral stress [Pa] of a simple cubic lattice in a die whose walls the spheres touch at the start.

    distance [m]: half of the height of a sphere's cell, (n,).
    """
    x = np.stack([np.zeros_like(distance), 1.0 - distance / radius])
    side, top = _forces(force, (4, 2), x, radius, grows)
    return top / (4.0 * radius**2), side / (4.0 * radius * distance)


def relative_density(lattice: Lattice, distance: Array, radius: float) -> Array:
    """Volume of the spheres over the volume of their cells."""
    return np.asarray(4.0 / 3.0 * np.pi * radius**3 / (lattice.cell * distance**3))
