# SPDX-License-Identifier: GPL-2.0-or-later
"""An elastic sphere (R = 1) under radial pressure on equal caps: how much other contacts shorten the recovery of one.

Linear superposition of Lur'e's series: each contact presses with a flat pressure on a spherical cap. Displacements in
F/(E R).
"""

from itertools import product

import numpy as np
from numpy.typing import NDArray

from epdem.theory.numerics import Array, bisect, segment

DEGREES = 2000  # of the series; the terms fall with the third power


def _directions(nonzero: int) -> Array:
    """Unit vectors with this number of equal components and zeros elsewhere, of all signs."""
    found = [v for v in product((-1.0, 0.0, 1.0), repeat=3) if np.count_nonzero(v) == nonzero]
    return np.asarray(np.array(found) / np.sqrt(nonzero))


DIRECTIONS = {
    "plates": np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]),
    "sc": _directions(1),
    "bcc": _directions(3),  # its eight nearest planes
    "fcc": _directions(2),
}


def compliance(degree: Array, nu: float) -> Array:
    """c_l: inward displacement c_l p of a unit sphere with E = 1 under the radial pressure p P_l(cos theta). 0 of
    degree 1, which moves the sphere; 2 (1 - nu^2)/l of large degrees, the half-space."""
    n = np.asarray(degree, float)
    top = (1 + nu) * (4 * n * n - 2 - nu * (4 * n * n - 2 * n - 4))
    bottom = 2 * (n - 1) * (n * n + n + 1 + nu * (2 * n + 1))
    c = np.divide(top, bottom, out=np.zeros(n.shape), where=n > 1)
    return np.where(n == 0, 1 - 2 * nu, c)


def legendre(x: Array, degrees: int = DEGREES) -> Array:
    """P_0 to P_degrees at x, shape (degrees + 1, *x.shape)."""
    P = np.ones((degrees + 1, *np.shape(x)))
    P[1] = x
    for n in range(1, degrees):
        P[n + 1] = ((2 * n + 1) * x * P[n] - n * P[n - 1]) / (n + 1)
    return P


def shortening(directions: Array, radius: float, nu: float) -> float:
    """Mean displacement of one cap by equal forces on all caps, less that of its own force on a half-space; R = 1.
    Negative where the others press the sphere out below the contact."""
    cap = np.sqrt(1 - radius**2)
    P = legendre(np.array(cap), DEGREES + 1)
    n = np.arange(DEGREES + 1.0)
    p = np.concatenate([[(1 - cap) / 2], (P[:-2] - P[2:]) / 2])  # of a pressure 1 on the cap
    term = compliance(n, nu) * p * 2 * p / ((2 * n + 1) * (1 - cap)) / (np.pi * radius**2)
    by_all = np.tensordot(term, legendre(directions @ directions[0]), 1).sum()
    return float(by_all - 16 / (3 * np.pi**2) * (1 - nu**2) / radius)


def unloading_depth(share: float, tau: float) -> float:
    """Depth y of the unloading at which the force has fallen to a share of the peak (eq. 8.82)."""

    def above(y: Array) -> NDArray[np.bool_]:
        rest = 1 - y * y
        return np.asarray((1 - tau) * rest**1.5 + 2 / np.pi * tau * segment(np.arccos(y)) > share)

    return float(bisect(above, 0.0, 1.0)[0])


def recovery(directions: Array, share: float, *, force: float, radius: float, tau: float, E: float, nu: float) -> float:
    """Way [R] of each contact when all forces fall from `force` to a share of it; radius, tau: of the peak."""
    y = unloading_depth(share, tau)
    alone = (0.75 * (1 - tau) * y * y + 2 / np.pi * tau * y) * force * (1 - nu**2) / (E * radius)
    return float(alone + shortening(directions, radius, nu) * force * (1 - share) / E)
