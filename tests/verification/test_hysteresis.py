# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts under luding and edinburgh, which the product integrates, against their closed forms."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from epdem.verification.models.theories import Edinburgh, Luding

M, K_1, DELTA_P = 0.0329, 8.8e7, 1.25e-3
TIGHT = 1e-6  # the tolerance of a step of the integration is 1e-10; across the kink of luding 2e-7 are left


def luding(k_1, k_p, limit, v):
    """F = k_1 x; back along k_2 = k_1 + (k_p - k_1) top/limit, and on both ways along k_p beyond the limit."""
    free = v * math.sqrt(M / k_1)  # the largest overlap without a limit
    turn = min(free, limit)
    k_2 = k_1 + (k_p - k_1) * turn / limit
    dent = turn * (1 - k_1 / k_2)
    # beyond the limit: an oscillation about the dent, of which the limit and the speed there are known
    swing = math.sqrt((turn - dent) ** 2 + k_1 * (free**2 - turn**2) / k_2)
    rest = math.acos((turn - dent) / swing) if free > limit else 0.0
    slow, fast = math.sqrt(M / k_1), math.sqrt(M / k_2)
    return {
        "e_n": swing / (fast * v),
        "contact_time": slow * math.asin(turn / free) + fast * (rest + 0.5 * math.pi),
        "force_max": k_2 * swing,
        "overlap_max": dent + swing,
        "residual_overlap": dent,
        "work_out": 0.5 * k_2 * swing**2,
    }


def edinburgh(k_1, k_2, n, v):
    """e_n^2 = (k_2/k_1)[1 + n s^(n+1) - (n+1) s^n], s = (1 - k_1/k_2)^(1/n) the dent over the largest overlap."""
    work, s = 0.5 * M * v**2, (1 - k_1 / k_2) ** (1 / n)
    top = ((n + 1) * work / k_1) ** (1 / (n + 1))
    share = k_2 / k_1 * (1 + n * s ** (n + 1) - (n + 1) * s**n)
    there = math.sqrt(math.pi) * math.gamma(1 / (n + 1)) / math.gamma(1 / (n + 1) + 0.5) / (n + 1)

    def rate(q):  # of the overlap u = 1 - (1 - s) q^2 on the way back, which takes the infinite slope at the top
        u = 1 - (1 - s) * q * q
        given = k_2 / k_1 * (1 - u ** (n + 1) - (n + 1) * s**n * (1 - u))
        return 2 * (1 - s) * q / math.sqrt(given)

    back, _ = quad(rate, 1e-6, 1, epsabs=1e-13, epsrel=1e-12)
    first = 1e-6 * rate(1e-6)  # the rate is even in q
    return {
        "e_n": math.sqrt(share),
        "contact_time": top / v * (there + first + back),
        "force_max": k_1 * top**n,
        "overlap_max": top,
        "residual_overlap": s * top,
        "work_out": share * work,
    }


def compare(law, v, closed):
    found = law.impact(m_star=M, speed=v, size=0.01)
    assert {name: found[name] for name in closed} == pytest.approx(closed, rel=TIGHT, abs=0)
    assert found["work_in"] == pytest.approx(0.5 * M * v**2, rel=1e-14)


@pytest.mark.parametrize("speed", [0.05, 3.0, 40.0, 64.0, 66.0, 150.0])
def test_luding_is_the_motion_of_its_force_law_below_and_beyond_the_plasticity_depth(speed):
    """delta_max passes delta_p at 64.65 m/s."""
    law = Luding(K_1, 5 * K_1, 0.05, 0.01)
    assert law.limit == pytest.approx(DELTA_P, rel=1e-15)
    compare(law, speed, luding(K_1, 5 * K_1, DELTA_P, speed))


@pytest.mark.parametrize("n", [1.0, 1.5, 2.0])
@pytest.mark.parametrize("ratio", [1.3, 5.0])
def test_edinburgh_is_the_motion_of_its_force_law_and_knows_no_speed(n, ratio):
    k_1 = K_1 if n == 1 else 1.5e10
    for v in (0.1, 10.0):
        compare(Edinburgh(k_1, ratio * k_1, n), v, edinburgh(k_1, ratio * k_1, n, v))
    other = Edinburgh(1.0, ratio, n).impact(m_star=1.0, speed=1.0, size=1.0)["e_n"]
    assert other == pytest.approx(edinburgh(k_1, ratio * k_1, n, 10.0)["e_n"], rel=TIGHT)


@pytest.mark.parametrize("speed", np.geomspace(0.01, 300, 7))
def test_without_hysteresis_both_are_elastic(speed):
    """k_p -> k_1: a linear spring, t_c = pi sqrt(m/k); k_2 = k_1, n = 1.5: Hertz, t_c = 2.9432751843 delta_max/v."""
    spring = Luding(K_1, (1 + 1e-10) * K_1, 0.05, 0.01).impact(m_star=M, speed=speed, size=0.01)
    assert spring["e_n"] == pytest.approx(1.0, rel=TIGHT)
    assert spring["contact_time"] == pytest.approx(math.pi * math.sqrt(M / K_1), rel=TIGHT)
    hertz = Edinburgh(1.5e10, 1.5e10, 1.5).impact(m_star=M, speed=speed, size=0.01)
    assert hertz["e_n"] == pytest.approx(1.0, rel=TIGHT) and hertz["residual_overlap"] == 0
    assert hertz["contact_time"] == pytest.approx(2.9432751843 * hertz["overlap_max"] / speed, rel=TIGHT)


def test_luding_goes_on_smoothly_at_the_plasticity_depth():
    v, law = DELTA_P * math.sqrt(K_1 / M), Luding(K_1, 5 * K_1, 0.05, 0.01)
    below, above = (law.impact(m_star=M, speed=v * (1 + s), size=0.01) for s in (-1e-9, 1e-9))
    for name in ("e_n", "contact_time", "force_max", "overlap_max", "residual_overlap"):
        # continuous; arccos of nearly 1 makes a root of the step: sqrt(4e-9) of a part of the contact time
        tolerance = 1e-4 if name == "contact_time" else TIGHT
        assert below[name] == pytest.approx(above[name], rel=tolerance), name
    assert below["e_n"] == pytest.approx(math.sqrt(1 / 5), rel=TIGHT)
