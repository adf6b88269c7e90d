# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers of the theory: arguments are checked once, as whole arrays; one Gauss rule, bisection."""

from collections.abc import Callable
from functools import cache
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array: TypeAlias = NDArray[np.float64]
Real: TypeAlias = float | Array  # one number or many, which broadcast


def number(
    name: str,
    value: ArrayLike,
    *,
    low: float = 0.0,
    high: float = np.inf,
    low_ok: bool = False,
    high_ok: bool = True,
    infinite: bool = False,
) -> Real:
    """`value` as a float array between low and high, each in the range or not; infinite=True lets +inf pass.

    Raises ValueError that names the argument, the first bad value and the range.
    """
    x = np.asarray(value, dtype=float)
    good = (x >= low if low_ok else x > low) & (x <= high if high_ok else x < high)
    good &= np.isfinite(x) | (infinite & (x == np.inf))
    if not np.all(good):
        worst = x[~good].flat[0] if x.ndim else x
        open_ended = (np.isinf(high) and not infinite) or not high_ok
        left, right = "[" if low_ok else "(", f"{high:g}{')' if open_ended else ']'}"
        raise ValueError(f"{name} = {worst:g}, must lie in {left}{low:g}, {right}")
    return x if x.ndim else float(x)


def poisson_ratio(name: str, value: ArrayLike) -> Real:
    """`value` in (-1, 0.5]."""
    return number(name, value, low=-1.0, high=0.5)


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
        below, before = rises(middle), (a, b)
        a, b = np.where(below, middle, a), np.where(below, b, middle)
        if np.array_equal(a, before[0]) and np.array_equal(b, before[1]):
            break  # neighbouring numbers
    return a[()], b[()]  # numbers for numbers


def segment(opening: Real) -> Array:
    """acos y - y sqrt(1-y^2) for y = cos(opening), opening in [0, pi/2], to full relative accuracy.

    The integral of 2 sin^2 from 0 to the opening: the difference itself loses all digits at small openings.
    """
    x, w = gauss(16)
    angle = np.asarray(opening, float)
    return np.asarray(2 * angle * (np.sin(angle[..., None] * x) ** 2 @ w))
