# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts of the hysteretic laws of LIGGGHTS and YADE, without adhesion and damping, in closed form.

Neither has a yield stress: their stiffnesses are given, and unloading follows another line than loading.
"""

import math
from dataclasses import dataclass

import numpy as np

from ...theory.numerics import Array, Real, gauss, number

_X, _W = gauss(32)


@dataclass(frozen=True)
class Impact:
    """Theory of impacts, arrays of one shape, SI."""

    e_n: Array
    contact_time: Array  # [s], until the force has gone
    force_max: Array  # [N]
    overlap_max: Array  # [m]
    residual_overlap: Array  # [m]
    work_in: Array  # [J]
    work_out: Array  # [J]


def plasticity_overlap(*, k_1: Real, k_p: Real, phi_f: Real, R_star: Real) -> Real:
    """Largest overlap [m] that still dents, [Luding 2008]: delta_p = k_p/(k_p - k_1) phi_f 2 R*.

    Stiffnesses k_p > k_1 > 0 [N/m], plasticity depth phi_f > 0, effective radius R_star [m] > 0; they broadcast.
    Raises ValueError.
    """
    k_1, k_p = number("k_1", k_1), number("k_p", k_p)
    number("k_p/k_1 - 1", k_p / k_1 - 1)
    return k_p / (k_p - k_1) * number("phi_f", phi_f) * 2 * number("R_star", R_star)


def luding(*, k_1: Real, k_p: Real, overlap_p: Real, m_star: Real, speed: Real) -> Impact:
    """An impact of the linear law of [Luding 2008] with k_c = 0.

    Loading F = k_1 delta. Unloading from delta_max < delta_p along k_2 = k_1 + (k_p - k_1) delta_max/delta_p to
    F = 0 at delta_max (1 - k_1/k_2), so that e_n^2 = k_1/k_2 with delta_max = v sqrt(m*/k_1), and
    t_c = (pi/2)(sqrt(m*/k_1) + sqrt(m*/k_2)). Beyond delta_p both branches follow k_p, and no more energy is lost:
    e_n^2 = 1 - k_1 delta_p^2 (1 - k_1/k_p)/(m* v^2).

    k_p >= k_1 > 0 [N/m], overlap_p = delta_p [m] > 0, m_star [kg] > 0, speed [m/s] > 0; they broadcast. Raises
    ValueError.
    """
    k_1, k_p = number("k_1", k_1), number("k_p", k_p)
    number("k_p/k_1 - 1", k_p / k_1 - 1, low_ok=True)
    k_1, k_p, limit, m, v = np.broadcast_arrays(
        k_1, k_p, number("overlap_p", overlap_p), number("m_star", m_star), number("speed", speed)
    )
    free = v * np.sqrt(m / k_1)  # delta_max if there were no delta_p
    beyond = free > limit
    turn = np.minimum(free, limit)
    k_2 = k_1 + (k_p - k_1) * turn / limit
    dent = turn * (1 - k_1 / k_2)
    # beyond delta_p: an oscillation about the dent, of which delta_p and the speed there are known
    swing = np.sqrt((turn - dent) ** 2 + k_1 * (free**2 - turn**2) / k_2)
    slow, fast = np.sqrt(m / k_1), np.sqrt(m / k_2)
    rest = np.where(beyond, np.arccos(np.minimum((turn - dent) / swing, 1.0)), 0.0)
    return Impact(
        e_n=swing / (fast * v),
        contact_time=slow * np.arcsin(turn / free) + fast * (rest + 0.5 * np.pi),
        force_max=k_2 * swing,
        overlap_max=dent + swing,
        residual_overlap=dent,
        work_in=0.5 * m * v**2,
        work_out=0.5 * k_2 * swing**2,
    )


def edinburgh(*, k_1: Real, k_2: Real, exponent: float, m_star: Real, speed: Real) -> Impact:
    """An impact of the power law of [Thakur et al. 2014] without adhesion.

    Loading F = k_1 delta^n, unloading F = k_2 (delta^n - delta_p^n) to the dent delta_p = s delta_max,
    s = (1 - k_1/k_2)^(1/n). Restitution depends on neither speed nor size:
    e_n^2 = (k_2/k_1)[1 + n s^(n+1) - (n+1) s^n]; for n = 1 that is k_1/k_2.

    k_2 >= k_1 > 0 [N/m^n], n = exponent >= 1, m_star [kg] > 0, speed [m/s] > 0; they broadcast. Raises ValueError.
    """
    k_1, k_2 = number("k_1", k_1), number("k_2", k_2)
    number("k_2/k_1 - 1", k_2 / k_1 - 1, low_ok=True)
    n = number("exponent", exponent, low=1.0, low_ok=True)
    k_1, k_2, m, v = np.broadcast_arrays(k_1, k_2, number("m_star", m_star), number("speed", speed))
    work = 0.5 * m * v**2
    top = ((n + 1) * work / k_1) ** (1 / (n + 1))
    s = (1 - k_1 / k_2) ** (1 / n)
    share = k_2 / k_1 * (1 + n * s ** (n + 1) - (n + 1) * s**n)
    # integral of du/sqrt(1 - u^(n+1)) from 0 to 1
    there = math.sqrt(math.pi) * math.gamma(1 / (n + 1)) / math.gamma(1 / (n + 1) + 0.5) / (n + 1)
    # on the way back u = 1 - (1 - s) q^2 takes the infinite slope at the top; the work of u..1 is a Gauss sum as well
    back = np.zeros(v.shape)
    for q, w in zip(_X, _W, strict=True):
        gap = (1 - s) * q * q
        mean = sum(wk * ((1 - gap * xk) ** n - s**n) for xk, wk in zip(_X, _W, strict=True))
        back = back + w * 2 * np.sqrt(1 - s) / np.sqrt((n + 1) * k_2 / k_1 * mean)
    return Impact(
        e_n=np.sqrt(share),
        contact_time=top / v * (there + back),
        force_max=k_1 * top**n,
        overlap_max=top,
        residual_overlap=s * top,
        work_in=work,
        work_out=share * work,
    )
