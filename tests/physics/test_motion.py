# SPDX-License-Identifier: GPL-2.0-or-later
"""Oblique impact, printed equations and reference times."""

import mpmath as mp
import numpy as np
import pytest

import oblique
from epdem.theory import pair, printed, restitution, yielding
from epdem.theory.backbones import Hertz, Thornton

E, NU = 208e9, 0.3
E_STAR, G_STAR = pair.E_star(E, NU, E, NU), pair.G_star(E, NU, E, NU)
M = pair.sphere_mass(radius=0.01, density=7850)
STEEL = {"E_star": E_STAR, "R_star": 0.01, "m_star": M}


def test_printed_equations_give_nan_outside_their_domain_and_say_why():
    assert np.isnan(printed.wu_restitution(99.0, v_y0=1.0)) and printed.wu_restitution(
        100.0, v_y0=1.0
    ) == pytest.approx(2.08 * 100**-0.25)
    v_y0 = yielding.yield_speed(p_y=1.6e9, **STEEL)
    assert np.isnan(printed.johnson_restitution(26.8 * v_y0, p_m=3e9, **STEEL))
    assert float(printed.johnson_restitution(26.9 * v_y0, p_m=3e9, **STEEL)) == pytest.approx(1, abs=2e-3)  # 26.85 v_y0
    assert np.isnan(printed.bridges_restitution(0.06)) and printed.bridges_restitution(0.01) == pytest.approx(0.32)


def test_equation_8_87_is_8_86_for_a_sphere_on_a_plane():
    """Its printed constant 1.718 has four digits."""
    v = np.array([10.0, 100.0])
    plane = printed.johnson_plane_restitution(v, p_m=3e9, E_star=E_STAR, density=7850)
    assert plane == pytest.approx(printed.johnson_restitution(v, p_m=3e9, **STEEL), rel=5e-4, abs=0)


def test_equation_8_86_is_the_work_of_a_uniform_pressure_against_hertz_recovery():
    """Work in: p_m on the volume pi a^4/(4 R*) of the dent; work out: 3 F^2/(10 a E*). Round-off only."""
    v, p_m, R = np.array([20.0, 200.0]), 3e9, STEEL["R_star"]
    work = M * v**2 / 2
    a = (4 * R * work / (np.pi * p_m)) ** 0.25
    out = 0.3 * (np.pi * a**2 * p_m) ** 2 / (a * E_STAR)
    assert printed.johnson_restitution(v, p_m=p_m, **STEEL) == pytest.approx(np.sqrt(out / work), rel=1e-14, abs=0)


def test_fits_to_elements_and_ice_at_points_worked_out_by_hand():
    """8.88: 2.08/100^(1/4) and 2.08/10; 8.89: 0.32 at 1 cm/s, and a tenth of the speed raises e_n by 10^0.234."""
    assert printed.wu_restitution(np.array([13.0, 1300.0]), v_y0=0.13) == pytest.approx([0.65775, 0.208], abs=1e-5)
    assert printed.bridges_restitution(np.array([0.01, 0.001])) == pytest.approx([0.32, 0.32 * 1.71396], abs=1e-5)


@pytest.mark.parametrize(
    ("call", "name"),
    [
        (lambda: pair.E_star(-1, 0.3, 1e9, 0.3), "E1"),
        (lambda: pair.E_star(1e9, 0.51, 1e9, 0.3), "nu1"),
        (lambda: pair.R_star(0.0, 1.0), "R1"),
        (lambda: pair.sphere_mass(radius=1.0, density=np.nan), "density"),
        (lambda: Thornton(E_star=1e11, R_star=0.01, p_y=-1), "p_y"),
        (lambda: Hertz(E_star=np.inf, R_star=1), "E_star"),
        (lambda: restitution.e_n(Hertz(E_star=1e9, R_star=1), m_star=1, speed=np.array([1.0, -2.0])), "speed = -2"),
        (lambda: oblique.sliding_angle(-0.1, e_n=1, nu=0.3), "mu"),
        (lambda: oblique.tangential_restitution(0.3, e_n=-5, theta=0.5), "e_n = -5"),
        (lambda: oblique.spin(0.3, e_n=-0.1, v_n=1.0, R=0.01), "e_n"),
        (lambda: oblique.sliding_angle(0.3, e_n=np.nan, nu=0.3), "e_n = nan"),
        (lambda: oblique.patch_rebound(0.3, e_n=1.0, theta=np.pi), "theta"),
        (lambda: oblique.patch_rebound(0.3, e_n=-1.0, theta=1.0), "e_n"),
        (lambda: printed.unloading_pressure(0.0, a=2.0, a_max=1.0, p=1.0), "a = 2"),
    ],
)
def test_bad_input_is_named_with_its_range(call, name):
    with pytest.raises(ValueError, match="must lie in") as caught:
        call()
    assert name in str(caught.value)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: pair.E_star(np.inf, 0.3, np.inf, 0.3), "both bodies are rigid"),
        (lambda: pair.G_star(np.array([1e9, np.inf]), 0.3, np.inf, 0.3), "both bodies are rigid"),
        (lambda: pair.R_star(np.inf, np.inf), "both bodies are planes"),
        (lambda: pair.m_star(np.inf, np.inf), "both bodies are fixed"),
    ],
)
def test_a_pair_without_a_finite_quantity_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_effective_quantities_are_exact_for_any_poisson_ratio():
    """30 digits over E 1 kPa to 1 TPa, nu 0 to 0.5, radii 1 um to 10 m."""
    rng = np.random.default_rng(3)
    for _ in range(200):
        E1, E2 = 10 ** rng.uniform(3, 12, 2)
        n1, n2 = rng.uniform(0, 0.5, 2)
        R1, R2 = 10 ** rng.uniform(-6, 1, 2)
        with mp.workdps(30):
            a, b, c, d = map(mp.mpf, (E1, n1, E2, n2))
            e_star = 1 / ((1 - b**2) / a + (1 - d**2) / c)
            g_star = 1 / (2 * (2 - b) * (1 + b) / a + 2 * (2 - d) * (1 + d) / c)
            r_star = 1 / (1 / mp.mpf(R1) + 1 / mp.mpf(R2))
        assert pair.E_star(E1, n1, E2, n2) == pytest.approx(float(e_star), rel=1e-14, abs=0)
        assert pair.G_star(E1, n1, E2, n2) == pytest.approx(float(g_star), rel=1e-14, abs=0)
        assert pair.R_star(R1, R2) == pytest.approx(float(r_star), rel=1e-14, abs=0)
