# SPDX-License-Identifier: GPL-2.0-or-later
"""The reference of friction with partial slip, against closed solutions and against integrals written anew here."""

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import trapezoid

import oblique
from epdem.theory import partial_slip, restitution
from epdem.theory.backbones import Cavity

E_STAR, G_STAR, MU, M, R = 1.142857e11, 2.3529e10, 0.3, 0.032882, 0.01  # steel sphere on steel
KAPPA = 4 * G_STAR / E_STAR


@pytest.mark.parametrize(("a", "tau"), [(1.0, 0.0), (0.6, 0.0), (1.0, 1.0), (0.6, 1.0), (0.9, 0.4), (1e-3, 0.7)])
def test_line_load_is_abels_transform_of_the_pressure(a, tau):
    """p = (1-tau) half-ellipse of the circle a + tau of 8.82, both by superposed rigid punches; 20 digits."""

    def p(rest):  # rest = a^2 - r^2, a_max = 1; each profile of unit force at a_max
        opened = mp.asin(mp.sqrt(rest / (1 - a * a + rest)))
        return (1 - tau) * 1.5 / mp.pi * mp.sqrt(rest) + tau * 2 / mp.pi**2 * opened

    with mp.workdps(20):
        a = mp.mpf(a)
        force = 2 * mp.pi * mp.quad(lambda u: a * a * u * p((a * u) ** 2), [0, 1])
        for share in (0.0, 0.5, 0.95):
            x = share * a  # r^2 = x^2 + h^2 u^2: r dr/sqrt(r^2 - x^2) = h du
            h = mp.sqrt(a * a - x * x)
            q = 2 * h * mp.quad(lambda u, h=h: p(h * h * (1 - u * u)), [0, 1])
            found = partial_slip.line_load(float(x), force=3.0, a=float(a), a_max=1.0, flatness=tau)
            # arcsin(a/a_max) and the segment: a few roundings
            assert float(found) == pytest.approx(float(3 * q / force), rel=1e-12, abs=0)
    assert partial_slip.line_load(1.01 * float(a), force=3.0, a=float(a), a_max=1.0, flatness=tau) == 0


def plain_springs(law, v_n, slips, steps, springs):
    """psi_2 of impacts at the slip velocities psi_1: springs written anew, their load by Abel's transform in numbers.
    The pressure is the definition's: half-ellipse and 8.82 by flatness; r^2 = x^2 + (a^2 - x^2) u^2, 24 Gauss nodes."""
    u, w = np.polynomial.legendre.leggauss(24)
    u, w = (u + 1) / 2, w / 2
    x_impact = restitution.impact(law, m_star=M, speed=v_n)
    dt, width = float(x_impact.contact_time) / steps, float(x_impact.radius_max) / springs
    x = (np.arange(springs) + 0.5) * width
    alpha, v, top, slip = 0.0, v_n, 0.0, MU / KAPPA * v_n * np.array(slips)
    force, friction, stretch = 0.0, 0.0 * slip, np.zeros((len(slips), springs))
    while True:
        v, slip = v - dt / 2 * force / M, slip - dt / 2 * 3.5 / M * friction
        alpha, top = alpha + dt * v, max(top, alpha + dt * v)
        force, a = map(float, (law.force(alpha), law.radius(alpha)) if alpha == top else law.unloading(alpha, top))
        if force <= 0:
            return KAPPA / MU * slip / v_n
        a_max, tau = float(law.radius(top)), float(law.flatness(top))
        inside = np.maximum(a * a - x * x, 0.0)
        rest = inside[:, None] * (1 - u * u)
        opened = np.arcsin(np.sqrt(rest / ((a_max - a) * (a_max + a) + rest + 1e-300)))
        p = (1 - tau) * 1.5 / np.pi * np.sqrt(rest) / a_max**3 + tau * 2 / np.pi**2 / a_max**2 * opened
        load = np.sqrt(inside) * (p @ w)
        limit = MU * force * load / load.sum() / 2 / (4 * G_STAR * width)
        stretch = np.clip(stretch + dt * slip[:, None], -limit, limit)
        friction = 8 * G_STAR * width * stretch.sum(axis=1)
        v, slip = v - dt / 2 * force / M, slip - dt / 2 * 3.5 / M * friction


@pytest.mark.parametrize("speed", [0.7, 7.0, 70.0])  # 5, 50 and 500 times that of first yield
def test_rebound_of_the_patch_takes_the_laws_own_pressure(speed):
    """3e-3 of psi: 60 springs and 300 steps here; with the load of a half-ellipse it would be off by up to 0.10."""
    law, psi_1 = Cavity(E_star=E_STAR, R_star=R, Y=1e9), np.array([0.5, 1.0, 1.5, 2.0, 3.0, 4.0])
    expected = plain_springs(law, speed, psi_1, steps=300, springs=60)
    theta = np.arctan(MU / KAPPA * psi_1)
    found = oblique.impact(law, mass=M, R=R, mu=MU, G_star=G_STAR, v_n=speed, theta=theta, steps=600)
    assert KAPPA / MU * found.patch == pytest.approx(expected, abs=3e-3)


def line(shape=(1,), springs=400):
    """Springs of a contact with a = 1 mm."""
    return partial_slip.Springs(G_star=G_STAR, mu=MU, a_max=1e-3, shape=shape, springs=springs)


LOADED = {"force": 1000.0, "a": 1e-3, "a_peak": 1e-3, "flatness": 0.0}
LIMIT = 3 * MU * 1000.0 / (16 * G_STAR * 1e-3)  # [m] of slip, where all of a Hertz contact slides


def test_constant_load_gives_cattaneos_curve_and_mindlins_way_back():
    """T = mu F [1 - (1 - u/u_s)^1.5], u_s = 3 mu F/(16 G* a); back by twice the half curve (Masing). 400 springs."""
    one, u = line(), np.linspace(0, 0.7, 8)[1:] * LIMIT
    there = [float(one.move([step], **LOADED)[0]) for step in np.diff(u, prepend=0.0)]

    def forward(u):
        return MU * 1000.0 * (1 - (1 - u / LIMIT) ** 1.5)

    assert there == pytest.approx(forward(u), abs=1e-4 * MU * 1000)
    back = [float(one.move([-0.2 * LIMIT], **LOADED)[0]) for _ in range(7)]
    turned = 0.2 * LIMIT * np.arange(1, 8)
    assert back == pytest.approx(there[-1] - 2 * forward(turned / 2), abs=1e-4 * MU * 1000)


def test_a_closed_cycle_loses_the_area_of_mindlins_loop():
    """T between +-T_m: the loop of Masing's rule by quadrature of Cattaneo's curve; 2000 steps: 1e-3 of it."""
    top = 0.6
    with mp.workdps(20):
        forward = lambda u: 1 - (1 - u) ** mp.mpf(1.5)  # noqa: E731  in mu F and u_s
        area = 2 * mp.quad(lambda d: 2 * forward(d / 2) - forward(top) * d / top, [0, 2 * top])
    one = line()
    u = LIMIT * top * np.sin(np.linspace(0, 2.5 * np.pi, 2501))
    force = np.array([float(one.move([step], **LOADED)[0]) for step in np.diff(u, prepend=0.0)])
    loop = slice(500, 2501)
    assert trapezoid(force[loop], u[loop]) == pytest.approx(float(area) * MU * 1000 * LIMIT, rel=1e-3)


def test_shear_in_a_plane_knows_no_axis_and_nothing_stays_without_force():
    """The same path turned by 37 degrees gives the same force turned; a parted contact forgets."""
    rng = np.random.default_rng(1)
    path = rng.normal(scale=0.1 * LIMIT, size=(40, 2))
    c, s = np.cos(0.65), np.sin(0.65)
    turn = np.array([[c, -s], [s, c]])
    one, other = line((2,)), line((2,))
    for step in path:
        assert other.move(turn @ step, **LOADED) == pytest.approx(turn @ one.move(step, **LOADED), rel=1e-12)
    assert np.hypot(*one.move([LIMIT, 0.0], **LOADED)) > 0 and np.any(one.stretch != 0)
    assert np.all(one.move([LIMIT, 0.0], force=0.0, a=0.0, a_peak=1e-3, flatness=0.0) == 0) and np.all(one.stretch == 0)


def test_nearly_normal_impacts_stick_and_rebound_as_without_slip():
    """As psi_1 goes to 0 nothing slides but a vanishing rim, and what leaves the circle takes its stretch along. Then T
    = 8 G* [a u - integral of u(at the touch of x) dx], linear in the slip u: integrated here with alpha in units of
    alpha_max and t in alpha_max/v by 4000 steps of velocity Verlet."""
    kappa, n = 14 / 17, 4000
    dt = 2.9432751843 / n
    # per mass: alpha'' = -1.25 alpha^1.5, so k_n = 1.875 a, a = sqrt(alpha), and u'' = -3.5 kappa 1.875 a u if a stays
    alpha, v, u, w = 0.0, 1.0, 0.0, 1.0
    rim_a, rim_u = [0.0], [0.0]  # slip at which the line was touched at distance a, while loading

    def touched(a):  # integral of u at touch from 0 to a
        A, U = np.array(rim_a), np.array(rim_u)
        k = np.searchsorted(A, a)
        if k == len(A):
            return float(trapezoid(U, A) + (a - A[-1]) * U[-1])
        end = float(np.interp(a, A, U))
        return float(trapezoid(np.append(U[:k], end), np.append(A[:k], a)))

    pull = 0.0
    for _ in range(n):
        v_half, w_half = v - dt / 2 * 1.25 * max(alpha, 0) ** 1.5, w - dt / 2 * pull
        alpha, u = alpha + dt * v_half, u + dt * w_half
        a = max(alpha, 0.0) ** 0.5
        if v_half > 0:
            rim_a.append(a)
            rim_u.append(u)
        pull = 3.5 * kappa * 1.875 * (a * u - touched(a))
        v, w = v_half - dt / 2 * 1.25 * max(alpha, 0) ** 1.5, w_half - dt / 2 * pull
    found = oblique.maw_barber_fawcett(np.array([0.003]), kappa=kappa, steps=4000) / 0.003
    assert found == pytest.approx(w, abs=5e-3)
