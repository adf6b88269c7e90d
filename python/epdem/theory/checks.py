# SPDX-License-Identifier: GPL-2.0-or-later
"""Arguments are checked once, as whole arrays; the message names the argument and its range."""

from typing import TypeAlias

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
