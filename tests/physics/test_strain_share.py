# SPDX-License-Identifier: GPL-2.0-or-later
"""The share of a body in the strain of a contact: 1/2 of equal strengths, 1 of a body whose partner cannot yield."""

import math

import numpy as np
import pytest

from epdem.case.fields import Material
from epdem.impacts.experiment import RIGID_PLANE, pair_of, plane, sphere
from epdem.laws.strengths import default_numbers
from epdem.theory.backbones import Cavity
from epdem.theory.pair import curvature_share, strain_share


def body(make, Y, **size):
    numbers = {"young_modulus": "200 GPa", "poisson_ratio": 0.3, "density": "7850 kg/m^3"}
    return make(Material(yield_stress=f"{Y} Pa", **numbers), name="steel", **size)


def test_the_share_rises_in_a_straight_line_from_one_half_to_one_at_equal_pressures():
    """2.8 Y_1 = 1.6 Y_2 at Y_2/Y_1 = 1.75; at 1.1 and 1.4 by hand (1 + 0.1/0.75)/2 and (1 + 0.4/0.75)/2."""
    ratio = np.array([1.0, 1.1, 1.4, 1.75, 3.0, 1e9, math.inf])
    expected = [0.5, 17 / 30, 23 / 30, 1.0, 1.0, 1.0, 1.0]
    assert strain_share(7e7, 7e7 * ratio) == pytest.approx(expected, rel=1e-12)
    assert strain_share(7e7 * ratio, 7e7) == pytest.approx(1 - np.array(expected), abs=1e-12)
    assert float(strain_share(math.inf, math.inf)) == 0.5


@pytest.mark.parametrize(("c_Y", "c_P"), [(1.6, 2.8), (1.8, 2.7)])
def test_a_body_without_a_share_is_one_that_the_pressure_of_the_other_never_brings_to_yield(c_Y, c_P):
    """The peak pressure of the weaker body, at any overlap, beside c_Y Y of the stronger one, within 1 %."""
    peak = Cavity(E_star=1e11, R_star=1.0, Y=1e8, c_Y=c_Y, c_P=c_P).pressure_max(np.geomspace(1e-9, 1.0, 2001)).max()
    for Y, yields in ((0.99 * peak / c_Y, True), (1.01 * peak / c_Y, False)):
        assert (strain_share(Y, 1e8, hardening=c_P / c_Y) > 0) == yields


def test_the_share_of_a_pair_follows_from_its_strengths_and_the_parameters_of_the_law():
    """Steel on steel, on harder steel, on a wall that never yields; hertz has no strengths."""
    ball = body(sphere, 1e9, radius=0.01)
    walls = [body(plane, Y) for Y in (1e9, 1.1e9, 1.4e9, 5e9)]
    for name in ("thornton", "johnson", "cavity"):
        numbers = default_numbers(name)
        found = [pair_of(numbers, ball, wall).share for wall in (*walls, RIGID_PLANE)]
        assert found == pytest.approx([0.5, 17 / 30, 23 / 30, 1.0, 1.0])
        assert pair_of(numbers, walls[1], ball).share == pytest.approx(17 / 30)
    narrow = default_numbers("cavity")
    narrow.ratios["plastic_ratio"] = 2.0  # 2.0/1.6 = 1.25
    assert pair_of(narrow, ball, walls[1]).share == pytest.approx(0.7)
    assert pair_of(default_numbers("hertz"), ball, RIGID_PLANE).share == 0.5


def test_the_share_of_a_sphere_on_a_plane_is_in_its_range_for_every_radius():
    """1/(1/R) is R but for round-off, which is above R for one radius of eight."""
    R = np.linspace(4.5e-5, 6e-5, 1000)
    R_star = 1.0 / (1.0 / R + 1.0 / math.inf)
    assert (R_star > R).any() and (R_star < R).any()
    soft, rigid = (curvature_share(w, R_star=R_star, R1=R) for w in (1.0, 0.0))
    assert soft.max() == 1.0 and rigid.min() == 0.0
    assert soft == pytest.approx(np.ones(1000), abs=1e-15) and rigid == pytest.approx(np.zeros(1000), abs=1e-15)
