# SPDX-License-Identifier: GPL-2.0-or-later
"""Overlap and force against time, against plain steps of the equation of motion."""

import numpy as np
import pytest

from epdem.theory.backbones import Cavity, Hertz, Johnson, Thornton
from epdem.verification.theory import energy

PAIR = {"E_star": 1.1428571428571429e11, "R_star": 0.01}
M = 0.032882003107573169
LAWS = {
    "hertz": Hertz(**PAIR),
    "thornton": Thornton(**PAIR, p_y=2.8e9),
    "johnson": Johnson(**PAIR, p_m=3e9),
    "cavity": Cavity(**PAIR, Y=1e9),
}


def runge_kutta(force, alpha, v, h):
    """One step h [s] of fourth order of m* alpha'' = -force(alpha)."""

    def rate(x, u):
        return u, -float(force(np.maximum(x, 0.0))) / M

    k1 = rate(alpha, v)
    k2 = rate(alpha + h / 2 * k1[0], v + h / 2 * k1[1])
    k3 = rate(alpha + h / 2 * k2[0], v + h / 2 * k2[1])
    k4 = rate(alpha + h * k3[0], v + h * k3[1])
    return tuple(x + h / 6 * (a + 2 * b + 2 * c + d) for x, a, b, c, d in zip((alpha, v), k1, k2, k3, k4, strict=True))


def motion(law, speed, times):
    """Overlaps [m] and forces [N] at `times` [s], equal steps from first touch, and the largest overlap.

    The backbone until v = 0, the elastic branch from there.
    """
    h, alpha, v, overlaps = times[1], 0.0, speed, [0.0]
    while (ahead := runge_kutta(law.force, alpha, v, h))[1] > 0:
        alpha, v = ahead
        overlaps.append(alpha)
    top, still, left, rising = alpha, v, h, len(overlaps)
    while abs(still) > 1e-13 * speed:  # Newton for the end of the loading, each time by one shorter step
        step = still * M / float(law.force(top))
        top, still = runge_kutta(law.force, top, still, step)
        left -= step
    alpha, v = runge_kutta(lambda x: law.unloading_force(x, top), top, 0.0, left)
    overlaps.append(alpha)
    for _ in times[len(overlaps) :]:
        alpha, v = runge_kutta(lambda x: law.unloading_force(x, top), alpha, v, h)
        overlaps.append(alpha)
    overlaps = np.array(overlaps)
    forces = np.append(law.force(overlaps[:rising]), law.unloading_force(overlaps[rising:], top))
    return overlaps, forces, top


# johnson: below, right behind (10.37 m/s) and far above the kink of its force, where its radius jumps;
# cavity: each phase
SPEEDS = {
    "hertz": [0.3, 30.0],
    "thornton": [0.57, 5.0, 50.0],
    "johnson": [3.0, 10.5, 60.0],
    "cavity": [0.15, 3.0, 60.0],
}


@pytest.mark.parametrize(("name", "speed"), [(name, v) for name, speeds in SPEEDS.items() for v in speeds])
def test_overlap_against_time_is_that_of_the_equation_of_motion(name, speed):
    """1e-7 of the largest, as `history` promises: 4001 points in its angle; 1000 Runge-Kutta steps are off by 2e-8."""
    law = LAWS[name]
    t, alpha, force = energy.history(law, m_star=M, speed=speed, samples=1001)
    overlaps, forces, top = motion(law, speed, t)
    assert np.abs(alpha - overlaps).max() < 1e-7 * top
    # the steepest of the force is the start of the unloading: 3/2 F_max over the recovered overlap (2 E* a)
    steepest = 2 * law.E_star * float(law.radius(top))
    assert np.abs(force - forces).max() < 1e-7 * top * steepest
