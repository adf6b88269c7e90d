# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts with adhesion: limits, what is lost, changes of units, and arrays."""

import numpy as np
import pytest
from test_adhesion_impacts import E, M, R, adhesive_work, law_of

from epdem.theory import adhesion, restitution
from epdem.theory.backbones import Hertz, Thornton
from epdem.theory.thornton_ning import ThorntonNing

V_S = 0.0162490834


@pytest.mark.parametrize("p_y", [3.04e9, 1e9, 0.5e9, 0.1e9])
def test_restitution_vanishes_at_the_sticking_speed_and_only_below_it(p_y):
    law = law_of(p_y)
    V_s = adhesion.sticking_speed(law, m_star=M)
    below, above = np.geomspace(1e-4, 1 - 1e-9, 40) * V_s, V_s * (1 + np.geomspace(1e-9, 1e4, 40))
    assert np.all(adhesion.e_n(law, m_star=M, speed=below) == 0)
    assert np.all(adhesion.e_n(law, m_star=M, speed=above) > 0)
    assert V_s >= adhesion.sticking_speed(law_of(None), m_star=M)


@pytest.mark.parametrize(("p_y", "V_y"), [(3.04e9, 0.63494633), (1e9, 0.02359088), (0.5e9, 0.0)])
def test_speed_of_first_yield(p_y, V_y):
    """Printed to 8 digits of quadrature; 0: a_0 < a_y, but the attraction alone carries the contact beyond a_y."""
    law = law_of(p_y)
    found = adhesion.yield_speed(law, m_star=M)
    assert found == pytest.approx(V_y, abs=6e-9)
    assert adhesion.yield_speed(law_of(None), m_star=M) == np.inf
    if V_y:
        assert adhesion.impact(law, m_star=M, speed=V_y * 0.9999).plastic_work == 0
        assert adhesion.impact(law, m_star=M, speed=V_y * 1.001).plastic_work > 0
    else:
        assert adhesion.impact(law, m_star=M, speed=1e-6).plastic_work > 0


@pytest.mark.parametrize("p_y", [None, 3.04e9, 1e9, 0.5e9])
def test_energy_is_only_lost_and_plastic_work_grows_with_speed(p_y):
    law = law_of(p_y)
    x = adhesion.impact(law, m_star=M, speed=np.geomspace(1e-3, 100, 200))
    assert np.all((x.e_n >= 0) & (x.e_n < 1))
    assert np.all(np.diff(x.plastic_work) >= -1e-16 * x.work_in[1:])
    assert np.all(adhesive_work(law, x) > 0)
    pull_max = law.branch(x.radius_max)[0].pull_off_force * np.ones(200)
    for numbers in (x.force_max, x.overlap_max, x.radius_max, pull_max):
        assert np.all(np.diff(numbers) >= 0)


def test_without_adhesion_an_impact_is_that_of_hertz_and_thornton():
    speed = np.geomspace(1e-3, 100, 60)
    for p_y, old in ((None, Hertz(E_star=E, R_star=R)), (1e9, Thornton(E_star=E, R_star=R, p_y=1e9))):
        law = law_of(p_y, 0.0)
        x, y = adhesion.impact(law, m_star=M, speed=speed), restitution.impact(old, m_star=M, speed=speed)
        for name in vars(y):
            scale = np.maximum(np.abs(getattr(y, name)), 1e-7 * np.abs(getattr(y, name)).max())
            scale = y.work_in if name == "plastic_work" else y.overlap_max if name == "residual_overlap" else scale
            assert np.all(np.abs(getattr(x, name) - getattr(y, name)) <= 1e-11 * scale), name
        assert np.all(adhesive_work(law, x) == 0)


def test_arrays_of_contacts_are_their_scalars():
    """Every argument may be an array; a million e_n of `jkr` come at once."""
    E_, R_, G_, p_ = np.array([1e6, 1e11]), np.array([1e-3, 1e-6]), np.array([0.05, 0.5]), np.array([1e4, 1e9])
    speed = np.geomspace(0.1, 10, 5)[:, None]
    law = ThorntonNing(E_star=E_, R_star=R_, Gamma=G_, p_y=p_)
    both = adhesion.impact(law, m_star=1e-6, speed=speed)
    for k in range(2):
        one = ThorntonNing(E_star=E_[k], R_star=R_[k], Gamma=G_[k], p_y=p_[k])
        for i, v in enumerate(speed[:, 0]):
            single = adhesion.impact(one, m_star=1e-6, speed=v)
            for name in vars(single):
                a, b = float(getattr(both, name)[i, k]), float(getattr(single, name))
                assert a == pytest.approx(b, rel=1e-12, abs=1e-14 * float(single.work_in)), name
    many = adhesion.e_n(law_of(None), m_star=M, speed=np.linspace(0.5, 2, 1_000_000) * V_S)
    assert many.shape == (1_000_000,)
    assert many[-1] == pytest.approx(np.sqrt(3) / 2, rel=1e-8)  # sqrt(1 - 1/2^2)
