# SPDX-License-Identifier: GPL-2.0-or-later
"""Functions of the C library that only the proof calls: other precisions, repeated impacts, prescribed motions."""

from ctypes import c_double, c_int64, c_size_t
from typing import Unpack

import numpy as np
import numpy.typing as npt

from ..laws.library import IMPACT_OUTPUT, Array, ImpactNumbers, Law, cases, pointer


def impacts_long_double(law: Law, *, steps: int, **numbers: Unpack[ImpactNumbers]) -> Array:
    """`Law.impacts` computed in long double, IMPACT_OUTPUT rounded at the end: a reference for round-off."""
    given = cases(steps=steps, **numbers)
    out = np.empty(given.shape, IMPACT_OUTPUT)
    law.call("epdem_impacts_long_double", c_size_t(given.size), pointer(given), pointer(out))
    return out


def bounces(law: Law, count: int, *, steps: int, **numbers: Unpack[ImpactNumbers]) -> tuple[np.void, Array]:
    """`count` impacts of one contact, each at the rebound speed of the one before, at most `steps` steps each.

    Returns the last impact (IMPACT_OUTPUT, its `steps` those of all impacts) and the rebound speeds [m/s].
    """
    first = cases(steps=steps, **numbers)
    out, speeds = np.empty(1, IMPACT_OUTPUT), np.full(count, np.nan)
    law.call("epdem_bounces", pointer(first), c_int64(count), pointer(out), pointer(speeds))
    return out[0], speeds


def motion(law: Law, steps: npt.ArrayLike, *, R_star: float, G_star: float, mu: float, nodes: int) -> Array:
    """Normal force and friction (3) [N] of one contact, (n, 4), in a prescribed motion, (n, 9).

    A step is overlap, closing speed times time step [m], unit normal (3), slip in the step (3) [m], rotation about the
    normal in it, mean of both bodies [rad]. The normal points to the body that the forces act on. nodes: 2 or 3 of
    partial slip, 0 for one spring.
    """
    given = np.ascontiguousarray(steps, dtype=np.float64)
    out = np.empty((len(given), 4))
    numbers = (c_double(R_star), c_double(G_star), c_double(mu), nodes)
    law.call("epdem_motion", *numbers, c_size_t(len(given)), pointer(given), pointer(out))
    return out
