# SPDX-License-Identifier: GPL-2.0-or-later
"""Adhesive contacts at rest: pressures integrated numerically, energies minimised, curves searched for extremes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from epdem.theory import adhesion
from epdem.theory.backbones import Hertz, Thornton
from epdem.theory.jkr import JKR
from epdem.theory.thornton_ning import ThorntonNing

E, R, GAMMA = 215e9 / (2 * (1 - 0.3**2)), 1e-5, 0.2
STEEL = {"E_star": E, "R_star": R, "Gamma": GAMMA}
SOFT = {"E_star": 4e6, "R_star": 2e-3, "Gamma": 0.05}
elastic = pytest.mark.parametrize("numbers", [STEEL, SOFT], ids=["steel", "rubber"])
_X, _W = np.polynomial.legendre.leggauss(200)
_X, _W = 0.5 * (_X + 1), 0.5 * _W


def pressures(a, *, E_star, R_star, Gamma):
    """Hertz's peak pressure and that of a flat punch in tension whose rim has the stress intensity of Gamma. K = p_1
    sqrt(pi a) for p = -p_1/sqrt(1 - r^2/a^2), and K^2/(2 E*) = Gamma (Griffith, Irwin)."""
    return 2 * E_star * a / (np.pi * R_star), np.sqrt(2 * E_star * Gamma / (np.pi * a))


@elastic
def test_elastic_contact_is_a_hertz_contact_and_a_flat_punch_in_tension(numbers):
    """Force and approach by quadrature of the pressure: F = 2 pi int p r dr, u(0) = (2/E*) int p dr, r = a sin t."""
    law = JKR(**numbers)
    t = np.pi / 2 * _X
    for a in np.array([0.5, 1.0, 2.0, 10.0]) * law.touch_radius:
        hertz, punch = pressures(a, **numbers)
        stress = (hertz * np.cos(t) - punch / np.cos(t)) * np.pi / 2 * a * np.cos(t)  # p dr/dx
        F, u = 2 * np.pi * a * np.sum(_W * stress * np.sin(t)), 2 / law.E_star * np.sum(_W * stress)
        # the sums cancel where the contact hardly pulls or pushes: relative to their parts
        assert law.force(a) == pytest.approx(F, abs=1e-12 * (law.adhesive_load(a) + abs(F)))
        assert law.overlap(a) == pytest.approx(u, abs=1e-12 * a * a / law.R_star)


@elastic
def test_elastic_contact_minimises_elastic_energy_less_surface_energy(numbers):
    """At a given approach, U = E* a (al^2 - 2/3 al a^2/R* + a^4/(5 R*^2)) - pi Gamma a^2 is smallest at radius(al). F
    is its slope by al."""
    law, g = JKR(**numbers), (np.sqrt(5) - 1) / 2

    def U(a, al):
        x = a * a / law.R_star
        return law.E_star * a * (al * al - 2 / 3 * al * x + x * x / 5) - np.pi * law.Gamma * a * a

    for al in np.array([-0.5, 0.0, 1.0, 20.0]) * -law.fold_overlap:
        low, high = max(law.fold_radius, np.sqrt(law.R_star * max(al, 0.0))), 30 * law.touch_radius
        for _ in range(60):  # golden section
            x, y = high - g * (high - low), low + g * (high - low)
            low, high = (low, y) if U(x, al) < U(y, al) else (x, high)
        a = 0.5 * (low + high)
        # a minimum is found to the root of eps, an energy there to eps
        assert law.radius(al) == pytest.approx(a, rel=1e-6)
        assert law.energy(law.radius(al)) == pytest.approx(U(a, al), rel=1e-12)
        h = 1e-4 * -law.fold_overlap
        slope = (U(law.radius(al), al + h) - U(law.radius(al), al - h)) / (2 * h)
        assert law.force(law.radius(al)) == pytest.approx(slope, rel=1e-7)


@elastic
def test_extremes_of_the_curve_are_the_touch_the_pull_off_and_the_fold(numbers):
    law = JKR(**numbers)
    a = law.touch_radius * np.linspace(0.2, 1.2, 2_000_001)
    F, al = law.force(a), law.overlap(a)
    fold, pull = np.argmin(al), np.argmin(F)
    assert al[fold] == pytest.approx(law.fold_overlap, rel=1e-11)  # of the square of the spacing
    assert a[fold] == pytest.approx(law.fold_radius, rel=2e-6)
    assert F[fold] == pytest.approx(-5 / 9 * law.pull_off_force, rel=2e-6)
    assert F[pull] == pytest.approx(-law.pull_off_force, rel=1e-11)
    assert law.pull_off_force == pytest.approx(1.5 * np.pi * law.Gamma * law.R_star, rel=1e-15)
    assert law.overlap(law.touch_radius) == pytest.approx(0, abs=1e-15 * law.touch_radius)
    assert law.force(law.touch_radius) == pytest.approx(-8 / 9 * law.pull_off_force, rel=1e-14)
    assert law.fold_overlap == pytest.approx(-1.6087720 * np.cbrt(law.Gamma**2 * law.R_star / law.E_star**2), rel=1e-7)


@given(st.floats(3, 12), st.floats(-7, 0), st.floats(-9, 2), st.floats(0, 1))
def test_radius_inverts_the_overlap(log_E, log_R, log_Gamma, share):
    """From the fold, where the root is double, to 1e6 times the radius at touch."""
    law = JKR(E_star=10**log_E, R_star=10**log_R, Gamma=10**log_Gamma)
    a = law.fold_radius * 10 ** (6.5 * share)
    al = law.overlap(a)
    # rounding of the overlap (180 eps) over the slope; at the fold the root of it
    part = a * a / law.R_star
    bend = np.sqrt(4e-14 * part * law.R_star)
    slope = abs(law.slope(np.sqrt(a))) / (2 * np.sqrt(a))
    allowed = np.minimum(4e-14 * part / max(slope, 1e-300), 4 * bend) + 1e-14 * a
    assert abs(law.radius(al) - a) <= allowed or al < law.fold_overlap
    assert law.radius(1.001 * law.fold_overlap) == 0


@pytest.mark.parametrize("p_y", [3.04e9, 1e9, 0.5e9, 0.05e9])
@pytest.mark.parametrize("ratio", [1.0001, 1.5, 8.0, 100.0])
def test_plastic_force_is_the_integral_of_the_pressure_cut_at_p_y(p_y, ratio):
    """F = 2 pi a^2 int min(A s - B/s, p_y) s ds over s = sqrt(1 - r^2/a^2), in two pieces that meet at the cut."""
    law = ThorntonNing(**STEEL, p_y=p_y)
    a = ratio * law.yield_radius
    A, B = pressures(a, **STEEL)
    low, high = 0.0, 1.0
    for _ in range(60):  # where the pressure reaches p_y
        cut = 0.5 * (low + high)
        low, high = (cut, high) if A * cut - B / cut < p_y else (low, cut)
    rim = cut * np.sum(_W * (A * (cut * _X) ** 2 - B))
    F = 2 * np.pi * a * a * (rim + p_y * (1 - cut * cut) / 2)
    assert law.force(a) == pytest.approx(F, abs=1e-12 * np.pi * a * a * (p_y + A + B))


@pytest.mark.parametrize("p_y", [3.04e9, 1e9, 0.5e9, 0.05e9])
def test_yield_begins_where_the_pressure_at_the_centre_reaches_p_y(p_y):
    law = ThorntonNing(**STEEL, p_y=p_y)
    hertz, punch = pressures(law.yield_radius, **STEEL)
    assert hertz - punch == pytest.approx(p_y, rel=1e-13)
    a = law.yield_radius * (1 + np.array([-1e-9, 1e-9]))
    assert law.force(a[1]) == pytest.approx(law.force(a[0]), rel=1e-7)  # continuous there
    slope = [(law.force(y) - law.force(x)) / (y - x) for x, y in (a - 1e-4 * a, a + 1e-4 * a)]
    assert slope[1] == pytest.approx(slope[0], rel=1e-3)


@pytest.mark.parametrize("p_y", [3.04e9, 1e9, 0.05e9])
def test_opening_starts_from_the_force_overlap_and_radius_of_the_peak(p_y):
    law = ThorntonNing(**STEEL, p_y=p_y)
    top = law.yield_radius * np.geomspace(1.01, 300, 20)
    opened, dent = law.branch(top)
    assert np.all(opened.R_star > R)
    assert opened.force(top) == pytest.approx(law.force(top), rel=1e-12)
    assert dent + opened.overlap(top) == pytest.approx(law.overlap(top), rel=1e-12)
    same, none = law.branch(0.99 * law.yield_radius)
    assert same.R_star == R
    assert none == 0


def test_without_adhesion_the_laws_are_those_of_hertz_and_thornton():
    numbers = {"E_star": E, "R_star": R}
    al = R * np.geomspace(1e-7, 1e-1, 200)
    for law, old in (
        (JKR(**numbers, Gamma=0.0), Hertz(**numbers)),
        (ThorntonNing(**numbers, Gamma=0.0, p_y=1e9), Thornton(**numbers, p_y=1e9)),
    ):
        a = law.radius(al)
        assert a == pytest.approx(old.radius(al), rel=1e-14)
        assert law.force(a) == pytest.approx(old.force(al), rel=1e-13)
        assert law.work(a) == pytest.approx(old.work(al), rel=1e-13)
        assert law.branch(a)[1] == pytest.approx(old.residual_overlap(al), rel=1e-6, abs=1e-15 * R)
        assert law.touch_radius == law.fold_overlap == law.pull_off_force == 0
    assert law.yield_radius == pytest.approx(np.pi * R * 1e9 / (2 * E), rel=1e-15)


def test_a_very_strong_contact_does_not_yield_and_weak_adhesion_changes_little():
    strong, jkr = ThorntonNing(**STEEL, p_y=1e13), JKR(**STEEL)
    a = jkr.touch_radius * np.geomspace(0.7, 100, 50)
    assert np.array_equal(strong.force(a), jkr.force(a))
    weak = ThorntonNing(E_star=E, R_star=R, Gamma=1e-12, p_y=1e9)
    none = Thornton(E_star=E, R_star=R, p_y=1e9)
    al = none.yield_overlap * np.geomspace(0.1, 100, 50)
    assert weak.force(weak.radius(al)) == pytest.approx(none.force(al), rel=2e-5)  # as P_t/F ~ sqrt(Gamma)


def test_tabor_number_of_steel_and_rubber_and_its_warning():
    """By hand: (1e-5 (0.2/1.1813e11)^2)^(1/3)/0.2e-9 = 1.530, rubber (2e-3 (0.05/4e6)^2)^(1/3)/0.2e-9 = 3393."""
    assert adhesion.tabor_number(JKR(**STEEL)) == pytest.approx(1.530, abs=5e-4)
    assert adhesion.tabor_number(JKR(**SOFT)) == pytest.approx(3393, abs=0.5)
    assert "1.5 (< 3)" in adhesion.warning(JKR(**STEEL))
    assert adhesion.warning(JKR(**SOFT)) is None
    assert adhesion.warning(JKR(E_star=E, R_star=R, Gamma=0.0)) is None
