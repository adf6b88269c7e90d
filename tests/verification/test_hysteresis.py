# SPDX-License-Identifier: GPL-2.0-or-later
"""The closed forms of luding and edinburgh against the equation of motion, integrated here from the force laws."""

import math

import numpy as np
import pytest

from epdem.verification.models import hysteresis

M, K_1, DELTA_P = 0.0329, 8.8e7, 1.25e-3


def luding_force(delta, top, *, k_1, k_p, delta_p):
    """The line through the end of loading at `top`; while loading goes on that is the point on k_1 delta itself."""
    anchor = min(top, delta_p)
    k_2 = k_1 + (k_p - k_1) * anchor / delta_p
    return max(0.0, k_1 * anchor + k_2 * (delta - anchor))


def edinburgh_force(delta, top, *, k_1, k_2, n):
    return max(0.0, min(k_1 * delta**n, k_2 * delta**n - (k_2 - k_1) * top**n))


def motion(force, m, v, dt):
    """(e_n, contact time, largest force, largest overlap, overlap at the end) of m x'' = -F by velocity Verlet."""
    x, top, t, f, peak = 0.0, 0.0, 0.0, 0.0, 0.0
    while True:
        v -= 0.5 * dt * f / m
        old, x = x, x + dt * v
        top = max(top, x)
        before, f = f, force(x, top)
        v -= 0.5 * dt * f / m
        t, peak = t + dt, max(peak, f)
        if f == 0.0 and v < 0.0:
            return -v, t, peak, top, x
        assert old >= 0.0 and before >= 0.0


def compare(found, theory, v, dt):
    e, t, peak, top, end = found
    # Verlet at a few thousand steps is second order: 1e-6; the end is known to one step
    assert e / v == pytest.approx(float(theory.e_n), rel=2e-6)
    assert t == pytest.approx(float(theory.contact_time), abs=1.5 * dt)
    assert peak == pytest.approx(float(theory.force_max), rel=2e-6)
    assert top == pytest.approx(float(theory.overlap_max), rel=2e-6)
    assert end == pytest.approx(float(theory.residual_overlap), abs=1.5 * dt * e)
    assert 0.5 * M * v**2 == pytest.approx(float(theory.work_in), rel=1e-14)
    assert 0.5 * M * e**2 == pytest.approx(float(theory.work_out), rel=4e-6)


@pytest.mark.parametrize("speed", [0.05, 3.0, 40.0, 64.0, 66.0, 150.0])
def test_luding_is_the_motion_of_its_force_law_below_and_beyond_the_plasticity_depth(speed):
    """delta_max passes delta_p at 64.65 m/s."""
    dt = 5e-4 * math.sqrt(M / (5 * K_1))
    numbers = {"k_1": K_1, "k_p": 5 * K_1}
    found = motion(lambda d, top: luding_force(d, top, delta_p=DELTA_P, **numbers), M, speed, dt)
    compare(found, hysteresis.luding(overlap_p=DELTA_P, m_star=M, speed=speed, **numbers), speed, dt)


@pytest.mark.parametrize("n", [1.0, 1.5, 2.0])
@pytest.mark.parametrize("ratio", [1.3, 5.0])
def test_edinburgh_is_the_motion_of_its_force_law_and_knows_no_speed(n, ratio):
    k_1 = K_1 if n == 1 else 1.5e10
    for v in (0.1, 10.0):
        theory = hysteresis.edinburgh(k_1=k_1, k_2=ratio * k_1, exponent=n, m_star=M, speed=v)
        dt = float(theory.contact_time) / 8000
        found = motion(lambda d, top: edinburgh_force(d, top, k_1=k_1, k_2=ratio * k_1, n=n), M, v, dt)
        compare(found, theory, v, dt)
        assert theory.e_n == pytest.approx(
            float(hysteresis.edinburgh(k_1=1.0, k_2=ratio, exponent=n, m_star=1.0, speed=1.0).e_n), rel=1e-13
        )


def test_luding_of_two_steel_spheres_at_10_m_per_s():
    """k_1 = 1e9 N/m, k_p/k_1 = 5, phi_f = 0.05, R = 10 mm, 7850 kg/m^3: by hand, e_n = 0.89105."""
    m = 0.5 * 7850 * 4 / 3 * math.pi * 0.01**3
    depth = hysteresis.plasticity_overlap(k_1=1e9, k_p=5e9, phi_f=0.05, R_star=0.005)
    assert depth == pytest.approx(6.25e-4, rel=1e-15)
    by_hand = 1 / math.sqrt(1 + 4 * 10 * math.sqrt(m / 1e9) / 6.25e-4)
    found = hysteresis.luding(k_1=1e9, k_p=5e9, overlap_p=depth, m_star=m, speed=10.0)
    assert found.e_n == pytest.approx(by_hand, rel=1e-14) and round(by_hand, 4) == 0.8910


def test_without_hysteresis_both_are_elastic():
    """k_p = k_1: a linear spring, t_c = pi sqrt(m/k); k_2 = k_1, n = 1.5: Hertz, t_c = 2.9432751843 delta_max/v."""
    v = np.geomspace(0.01, 300, 7)
    spring = hysteresis.luding(k_1=K_1, k_p=K_1, overlap_p=DELTA_P, m_star=M, speed=v)
    assert spring.e_n == pytest.approx(1.0, rel=1e-14)
    assert spring.contact_time == pytest.approx(math.pi * math.sqrt(M / K_1), rel=1e-13)
    hertz = hysteresis.edinburgh(k_1=1.5e10, k_2=1.5e10, exponent=1.5, m_star=M, speed=v)
    assert hertz.e_n == pytest.approx(1.0, rel=1e-14) and np.all(hertz.residual_overlap == 0)
    assert hertz.contact_time == pytest.approx(2.9432751843 * hertz.overlap_max / v, rel=1e-10)


def test_luding_goes_on_smoothly_at_the_plasticity_depth():
    v = DELTA_P * math.sqrt(K_1 / M)
    numbers = {"k_1": K_1, "k_p": 5 * K_1, "overlap_p": DELTA_P, "m_star": M}
    below, above = (hysteresis.luding(speed=v * (1 + s), **numbers) for s in (-1e-9, 1e-9))
    for name in ("e_n", "contact_time", "force_max", "overlap_max", "residual_overlap"):
        # continuous; arccos of nearly 1 makes a root of the step: sqrt(4e-9) of a part of the contact time
        tolerance = 1e-4 if name == "contact_time" else 1e-8
        assert getattr(below, name) == pytest.approx(getattr(above, name), rel=tolerance), name
    assert below.e_n == pytest.approx(math.sqrt(1 / 5), rel=1e-8)


@pytest.mark.parametrize("bad", [{"k_1": -1.0}, {"k_p": 0.5 * K_1}, {"overlap_p": 0.0}, {"speed": 0.0}])
def test_numbers_that_make_no_law_are_refused(bad):
    good = {"k_1": K_1, "k_p": 5 * K_1, "overlap_p": DELTA_P, "m_star": M, "speed": 1.0}
    with pytest.raises(ValueError, match=next(iter(bad))):
        hysteresis.luding(**(good | bad))
    with pytest.raises(ValueError, match="exponent"):
        hysteresis.edinburgh(k_1=1.0, k_2=2.0, exponent=0.5, m_star=1.0, speed=1.0)
