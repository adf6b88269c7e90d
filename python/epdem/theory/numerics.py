# SPDX-License-Identifier: GPL-2.0-or-later
"""Integration and root search of the theory: one Gauss rule, one bisection."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .checks import Array, Real


@cache
def gauss(nodes: int) -> tuple[Array, Array]:
    """Nodes and weights of Gauss and Legendre's rule on [0, 1], each of shape (nodes,)."""
    x, w = np.polynomial.legendre.leggauss(nodes)
    return 0.5 * (x + 1), 0.5 * w


def bisect(
    rises: Callable[[Any], NDArray[np.bool_] | bool], low: Real, high: Real, *, steps: int = 60
) -> tuple[Array, Array]:
    """The bracket (low, high) after `steps` halvings: `rises(x)` is true below the place sought and false above.

    low and high broadcast with what `rises` returns.
    """
    a, b = np.asarray(low, float), np.asarray(high, float)
    for _ in range(steps):
        if np.all(a == b):
            break
        middle = 0.5 * (a + b)
        below = rises(middle)
        a, b = np.where(below, middle, a), np.where(below, b, middle)
    return a[()], b[()]  # numbers for numbers


def segment(opening: Real) -> Array:
    """acos y - y sqrt(1-y^2) for y = cos(opening), opening in [0, pi/2], to full relative accuracy.

    The integral of 2 sin^2 from 0 to the opening: the difference itself loses all digits at small openings.
    """
    x, w = gauss(16)
    angle = np.asarray(opening, float)
    return np.asarray(2 * angle * (np.sin(angle[..., None] * x) ** 2 @ w))
