# SPDX-License-Identifier: GPL-2.0-or-later
"""Law meyer in closed form: eq. 8.83 and Hertz at its ends, its limit far above yield."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from epdem.theory import printed, restitution, yielding
from epdem.theory.backbones import Hertz, Meyer, Thornton

PAIR, P_Y, M = {"E_star": 1.1428571428571429e11, "R_star": 0.01}, 2.8e9, 0.032882003107573169
V_Y = yielding.yield_speed(p_y=P_Y, m_star=M, **PAIR)


def e_n(x, ratio):
    return restitution.e_n(Meyer(**PAIR, p_y=P_Y, x=x), m_star=M, speed=ratio * V_Y)


def test_without_hardening_it_is_equation_8_83_over_twelve_decades():
    ratio = np.geomspace(1e-6, 1e6, 400)
    assert e_n(0.0, ratio) == pytest.approx(printed.thornton_restitution(ratio * V_Y, v_y=V_Y), rel=1e-13, abs=0)
    ours, thornton = (c(**PAIR, p_y=P_Y) for c in (Meyer, Thornton))
    alpha = thornton.yield_overlap * np.geomspace(1e-3, 1e6, 100)
    for f in ("force", "work", "recovered_work", "pressure_max"):
        assert getattr(ours, f)(alpha) == pytest.approx(getattr(thornton, f)(alpha), rel=1e-13, abs=0)


def test_towards_an_exponent_of_1_it_is_hertz():
    """1 - e_n goes with 1 - x."""
    last = [1 - e_n(1 - h, np.array([10.0, 1000.0])) for h in (1e-4, 1e-5)]
    assert last[0] / last[1] == pytest.approx(10, rel=1e-3) and np.all(last[1] < 2e-5)
    alpha = np.geomspace(1e-8, 1e-3, 50)
    force = Meyer(**PAIR, p_y=P_Y, x=1 - 1e-9).force(alpha)
    assert force == pytest.approx(Hertz(**PAIR).force(alpha), rel=1e-7)


@given(st.floats(0, 0.999), st.floats(-0.01, 0.01))
def test_force_and_slope_are_continuous_at_yield(x, share):
    law = Meyer(**PAIR, p_y=P_Y, x=x)
    y, h = law.yield_overlap, 1e-6
    assert law.force(y * (1 + share)) == pytest.approx(law.force(y) * (1 + 1.5 * share), rel=share**2 + 1e-14)
    left, right = (law.force(y) - law.force(y * (1 - h))) / h, (law.force(y * (1 + h)) - law.force(y)) / h
    assert left == pytest.approx(right, rel=2 * h)


@given(st.floats(0, 0.9))
def test_far_above_yield_restitution_is_a_power_of_the_speed(x):
    """sqrt(3(4+x)/(5(2+x))) [(2+x)(4+x)/15]^((x-1)/(2(4+x))) (v/v_y)^((x-1)/(4+x)); x = 0: 1.185 (v/v_y)^(-1/4)."""
    ratio = 1e12
    power = (x - 1) / (4 + x)
    factor = np.sqrt(3 * (4 + x) / (5 * (2 + x))) * ((2 + x) * (4 + x) / 15) ** (power / 2)
    assert e_n(x, ratio) == pytest.approx(factor * ratio**power, rel=1e-4)


def test_a_harder_body_yields_where_the_pressure_has_grown_to_its_strength():
    """The pressure p_y q^x reaches 1.6 Y at q = (1.6 Y/p_y)^(1/x): Y = 2 p_y/1.6, x = 0.5: q = 4."""
    law = Meyer(**PAIR, p_y=P_Y, x=0.5)
    found = yielding.first_yield_speed(law, 2 * P_Y / 1.6, m_star=M, ratio=1.6)
    alpha = 16 * law.yield_overlap
    assert 0.5 * M * found**2 == pytest.approx(law.work(alpha), rel=1e-12)
