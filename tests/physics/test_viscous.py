# SPDX-License-Identifier: GPL-2.0-or-later
"""A dashpot on the elastic branches: what its equation of motion must fulfil, whatever solves it."""

import mpmath
import numpy as np
import pytest
from scipy.integrate import trapezoid

from epdem.theory import restitution, viscous
from epdem.theory.backbones import LAWS, Hertz, Thornton

STEEL = {"E_star": 1.1428571428571429e11, "R_star": 0.01}
M = 0.032882003107573169
STRENGTH = {"hertz": {}, "thornton": {"p_y": 2.8e9}, "johnson": {"p_m": 3e9}, "cavity": {"Y": 1e9}}
V_Y = 0.559430455498519  # of thornton, p_y = 2.8 GPa
ODE = 1e-9  # what the integration promises
every_law = pytest.mark.parametrize("law", [LAWS[n](**STEEL, **k) for n, k in STRENGTH.items()], ids=list(STRENGTH))


def test_damping_ratio_inverts_the_restitution_formula():
    e = np.linspace(0.14, 0.999, 50)
    phi = np.arcsin(viscous.damping_ratio(e))
    # sin phi is known to eps; near phi = pi/2 (e = 0.14: 1.36) that is 5 eps of phi and 30 of tan phi
    assert np.exp(-(np.pi - 2 * phi) * np.tan(phi)) == pytest.approx(e, rel=1e-13, abs=0)
    assert viscous.damping_ratio(1.0) == 0
    with pytest.raises(ValueError, match="restitution"):
        viscous.damping_ratio(0.13)


@every_law
@pytest.mark.parametrize("e", [0.14, 0.5, 0.9, 0.999])
def test_an_impact_that_does_not_yield_has_the_given_restitution_at_any_speed(law, e):
    """The formula of zeta is exact: Hertz's contact with this dashpot is a damped oscillator in alpha^(5/4)."""
    speed = np.geomspace(1e-6, 0.95, 8) * V_Y  # thornton reaches p_y at V_Y without dashpot
    speed = speed if law.name != "cavity" else speed / 4.2  # cavity yields at 1.60 Y: v_y/4.05
    assert viscous.impact(law, m_star=M, speed=speed, restitution=e).e_n == pytest.approx(e, abs=ODE)


@every_law
def test_no_dashpot_is_the_law_itself(law):
    speed = np.geomspace(0.1, 100, 9)
    plain = restitution.impact(law, m_star=M, speed=speed)
    weak = viscous.impact(law, m_star=M, speed=speed, restitution=1 - 1e-7)
    for name in ("e_n", "contact_time", "force_max", "overlap_max", "residual_overlap", "plastic_work"):
        scale = plain.overlap_max if name == "residual_overlap" else getattr(plain, name)
        scale = plain.work_in if name == "plastic_work" else scale
        # the change is of the order of 1 - e, but for the cut-off: x^(5/4) ~ 1 - e, so x is 1e-5 of overlap_max
        tolerance = 2e-5 if name in ("residual_overlap", "contact_time") else 1e-6
        assert np.abs(getattr(weak, name) - getattr(plain, name)).max() <= tolerance * np.abs(scale).max(), name
    assert np.array_equal(viscous.impact(law, m_star=M, speed=speed, restitution=1.0).e_n, plain.e_n)


@pytest.mark.parametrize("e", [0.14, 0.5, 0.9])
def test_far_above_yield_the_dashpot_takes_half_of_what_it_takes_of_an_elastic_impact(e):
    """Rebound is the second half of a damped elastic impact, and the halves are equal: e_n/e_plastic tends to sqrt(e).

    The loss before yield goes as (v_y/v)^0.5 of the energy of the elastic start: below 1e-4 at 1e6 v_y.
    """
    law, speed = Thornton(**STEEL, p_y=2.8e9), 1e6 * V_Y
    damped = viscous.impact(law, m_star=M, speed=speed, restitution=e)
    plain = restitution.impact(law, m_star=M, speed=speed)
    assert damped.e_n / plain.e_n == pytest.approx(e**0.5, abs=1e-4)


def test_at_268_times_the_yield_speed_a_dashpot_of_0_9_leaves_0_9485_of_the_plastic_restitution():
    law, speed = Thornton(**STEEL, p_y=2.8e9), 150.0
    damped = viscous.impact(law, m_star=M, speed=speed, restitution=0.9)
    plain = restitution.impact(law, m_star=M, speed=speed)
    assert damped.e_n / plain.e_n == pytest.approx(0.9485, abs=5e-5)


@pytest.mark.parametrize("e", [0.3, 0.8])
def test_elastic_motion_agrees_with_a_taylor_solution_of_30_digits(e):
    """z = x^(5/4), x'' = -(5/4) x^1.5 - d x^(1/4) x': by the time s with ds = x^(1/4) dt, z' = (5/4) u, u' = -z - d u
    is linear, so that x, u and t follow in closed form and by quadrature. Force ends where z + d u... in x: F = 0."""
    d = float(2 * np.sqrt(5 / 6) * viscous.damping_ratio(e) * np.sqrt(15 / 8))
    law, v = Hertz(**STEEL), 0.3
    found = viscous.impact(law, m_star=M, speed=v, restitution=e)
    with mpmath.workdps(30):
        # z'' + d z' + (25/16) z = 0 in s, z(0) = 0, z'(0) = 5/4 (u = 1)
        g, w = mpmath.mpf(d) / 2, mpmath.sqrt(mpmath.mpf(25) / 16 - mpmath.mpf(d) ** 2 / 4)
        z = lambda s: mpmath.mpf(5) / 4 / w * mpmath.exp(-g * s) * mpmath.sin(w * s)  # noqa: E731
        u = lambda s: mpmath.exp(-g * s) * (mpmath.cos(w * s) - g / w * mpmath.sin(w * s))  # noqa: E731
        top = mpmath.atan(w / g) / w
        end = mpmath.findroot(lambda s: mpmath.mpf(5) / 4 * z(s) + d * u(s), (mpmath.pi - mpmath.atan(g / w)) / w)
        time = mpmath.quad(lambda s: z(s) ** (-mpmath.mpf(1) / 5), [0, top / 8, top, end])
        largest = max((mpmath.mpf(5) / 4 * z(s) + d * u(s)) * z(s) ** 0.2 for s in mpmath.linspace(0, end, 4000)[1:])
    L = (15 * M * v * v / (16 * law.E_star * np.sqrt(law.R_star))) ** 0.4
    assert found.e_n == pytest.approx(float(-u(end)), rel=ODE)
    assert found.e_n == pytest.approx(e, abs=ODE)
    assert found.overlap_max == pytest.approx(L * float(z(top)) ** 0.8, rel=ODE)
    assert found.residual_overlap == pytest.approx(L * float(z(end)) ** 0.8, rel=ODE)
    assert found.contact_time == pytest.approx(
        L / v * float(time), rel=1e-7, abs=0
    )  # z^(-1/5) at s = 0 limits the quadrature
    assert found.force_max == pytest.approx(
        M * v * v / L * float(largest), rel=1e-6, abs=0
    )  # 4000 samples of a flat summit


@every_law
def test_a_dashpot_takes_energy_and_gives_none(law):
    speed = np.geomspace(0.05, 150, 24)
    plain = restitution.impact(law, m_star=M, speed=speed)
    for e in (0.14, 0.6, 0.95):
        p = viscous.impact(law, m_star=M, speed=speed, restitution=e)
        assert np.all(p.viscous_work > 0)
        assert np.all(p.plastic_work <= plain.plastic_work * (1 + 1e-12))
        assert np.all(p.e_n <= plain.e_n)
        assert np.all(p.residual_overlap >= 0)


@pytest.mark.parametrize(
    ("name", "e", "v", "e_n"),  # e_n above e: the dashpot does not act while the contact yields; the numbers of laws.md
    [
        ("thornton", 0.7, 6.0, None),
        ("cavity", 0.7, 6.0, None),
        ("thornton", 0.3, 4.5 * V_Y, 0.357),
        ("cavity", 0.3, 2.4 * V_Y, 0.416),
    ],
)
def test_equation_of_motion_of_a_yielding_impact_by_plain_time_steps(name, e, v, e_n):
    """Runge-Kutta of fourth order on alpha(t), written down anew from the law's branches; 4,000 steps.

    The kinks at yield and at the peak leave it near 1e-5 in restitution, 3e-5 for e = 0.3, more in the overlap.
    """
    law = LAWS[name](**STEEL, **STRENGTH[name])
    found = viscous.impact(law, m_star=M, speed=v, restitution=e)
    number = 2 * np.sqrt(5 / 6) * float(viscous.damping_ratio(e))
    alpha, speed, top, t, dt = 0.0, v, 0.0, 0.0, float(found.contact_time) / 4_000

    def forces(alpha, speed, top):
        """Force of the law and of the dashpot [N]."""
        if alpha > law.yield_overlap and alpha >= top:
            return float(law.force(alpha)), 0.0
        if top > law.yield_overlap:
            F, a = law.unloading(alpha, top)
        else:
            F, a = law.force(alpha), law.radius(alpha)
        return float(F), number * np.sqrt(2 * law.E_star * float(a) * M) * speed

    def rate(alpha, speed, top):
        contact, dashpot = forces(max(alpha, 0.0), speed, top)
        return speed, -(contact + dashpot) / M, dashpot * speed

    lost = 0.0
    while t == 0 or sum(forces(alpha, speed, top)) > 0:
        k1 = rate(alpha, speed, top)
        k2 = rate(alpha + dt / 2 * k1[0], speed + dt / 2 * k1[1], top)
        k3 = rate(alpha + dt / 2 * k2[0], speed + dt / 2 * k2[1], top)
        k4 = rate(alpha + dt * k3[0], speed + dt * k3[1], top)
        alpha += dt / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
        speed += dt / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
        lost += dt / 6 * (k1[2] + 2 * k2[2] + 2 * k3[2] + k4[2])
        top, t = max(top, alpha), t + dt
    way = np.linspace(law.residual_overlap(top), alpha, 2001)  # what the contact still stores when the bodies part
    stored = trapezoid(law.unloading_force(way, top), way)
    assert -speed / v == pytest.approx(float(found.e_n), abs=4e-5)
    assert e_n is None or -speed / v == pytest.approx(e_n, abs=5e-4)
    assert t == pytest.approx(float(found.contact_time), abs=1.1 * dt)  # seen at the step after
    assert top == pytest.approx(float(found.overlap_max), rel=1e-4, abs=0)  # the force jumps inside a step
    assert lost + stored == pytest.approx(float(found.viscous_work), abs=1e-4 * 0.5 * M * v * v)
