# SPDX-License-Identifier: GPL-2.0-or-later
"""Yield and pressures: the chapter's tables, and mathematics that the fields must obey."""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from epdem.theory import printed, yielding
from epdem.theory.backbones import Cavity, Thornton

NU = [0, 0.1, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5]
P_Y0 = [1.29931, 1.39448, 1.49859, 1.55435, 1.61280, 1.67411, 1.73848, 1.87724]
DEPTH = [0.3819, 0.4149, 0.4478, 0.4643, 0.4809, 0.4975, 0.5142, 0.5479]


def test_first_yield_under_a_sphere_for_any_poisson_ratio():
    p_0, depth = printed.first_yield(np.array(NU))
    assert p_0 == pytest.approx(P_Y0, abs=6e-6)  # 5 printed decimals
    assert depth == pytest.approx(DEPTH, abs=6e-5)
    assert round(float(printed.first_yield(0.3)[0]), 1) == 1.6 == yielding.FIRST_YIELD_ROUNDED
    assert printed.first_yield_mean(0.3) == pytest.approx(printed.FIRST_YIELD_MEAN, abs=0.03)  # 8.79 rounds


def test_first_yield_is_the_maximum_of_the_axial_stress_for_any_poisson_ratio():
    """30 digits: s_r - s_z of Hertz's half-ellipse (Johnson 1985, 3.45), its maximum by the root of a derivative taken
    numerically; 1e-12 leaves room for the 1e-16 of nu + 1 at nu = -0.99."""
    nu = np.array([-0.99, -0.97, -0.95, -0.9, -0.6, -0.2, 0.0, 0.3, 0.5])
    found = np.array(printed.first_yield(nu)).T
    for n, (p_0, depth) in zip(nu, found, strict=True):
        with mp.workdps(30):

            def difference(z, n=float(n)):
                return -(1 + n) * (1 - z * mp.atan(1 / z)) + mp.mpf(3) / 2 / (1 + z * z)

            z = mp.findroot(lambda x: mp.diff(difference, x), (0.4 * (1 + n), 0.8 * (1 + n)), solver="anderson")
            assert p_0 == pytest.approx(float(1 / difference(z)), rel=1e-12, abs=0)
            assert depth == pytest.approx(float(z), rel=1e-12, abs=0)


def test_fully_plastic_pressure_lies_where_the_expanding_cavity_ends():
    """8.80 against 8.81: from E* a/(Y R*) of about 40, within a sixth, the cavity's pressure reaches 2.8 to 3.0 Y."""
    low, high = printed.fully_plastic_mean(np.array([1e9, 2e9]))
    assert low == pytest.approx([2.8e9, 5.6e9]) and high == pytest.approx([3e9, 6e9])
    assert printed.cavity_mean(40.0) == pytest.approx(2.4, abs=0.02)  # (2/3)(1 + ln(40/3)), still below
    x = 3 * np.exp(1.5 * 2.8 - 1)  # 8.81 solved for p_m = 2.8 Y
    assert printed.cavity_mean(x) == pytest.approx(2.8, rel=1e-14) and printed.cavity_end(2.8) == pytest.approx(x)
    # the law cavity is there at ln(a_P/a_Y) = 1.5 (c_P - 2 c_Y/3) from a_Y, E* a_Y/(Y R*) = pi c_Y/2
    law = Cavity(E_star=1.0, R_star=1.0, Y=1e-3)
    assert 1e3 * law.radius(law.plastic_overlap) == pytest.approx(33.84, abs=0.01)
    assert 1e3 * law.a_Y * np.exp(1.5 * (2.8 - 3.2 / 3)) == pytest.approx(33.84, abs=0.01) and round(x, 1) == 73.6
    with pytest.raises(ValueError, match="Y"):
        printed.fully_plastic_mean(-1.0)


@given(st.tuples(*[st.floats(-1e3, 1e3)] * 3), st.floats(-1e3, 1e3))
def test_criteria_see_neither_hydrostatic_pressure_nor_order(s, p):
    for criterion in (printed.von_mises, printed.tresca):
        value = criterion(*s)
        assert criterion(s[2], s[0], s[1]) == pytest.approx(value, abs=1e-12)
        assert criterion(*(x + p for x in s)) == pytest.approx(value, abs=1e-9)
        assert criterion(value, 0, 0) == pytest.approx(value)  # uniaxial: yield at Y
    assert printed.von_mises(*s) <= printed.tresca(*s) + 1e-9 <= 2 / np.sqrt(3) * printed.von_mises(*s) + 2e-9


def test_the_harder_body_yields_only_below_1_75_times_the_softer_ones_stress():
    law = Thornton(E_star=1.14e11, R_star=0.01, p_y=2.8e9)
    speeds = yielding.first_yield_speed(law, np.array([1e9, 1.74e9, 1.76e9, np.inf]), m_star=0.0329)
    assert list(np.isfinite(speeds)) == [True, True, False, False]
