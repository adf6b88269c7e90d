# SPDX-License-Identifier: GPL-2.0-or-later
"""A dashpot on the elastic branches: what its equation of motion must fulfil, whatever solves it."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from epdem.theory import restitution, viscous
from epdem.theory.backbones import LAWS, Thornton

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
    The loss before yield goes as (v_y/v)^0.5 of the energy of the elastic start: below 1e-4 at 1e6 v_y."""
    law, speed = Thornton(**STEEL, p_y=2.8e9), 1e6 * V_Y
    damped = viscous.impact(law, m_star=M, speed=speed, restitution=e)
    plain = restitution.impact(law, m_star=M, speed=speed)
    assert damped.e_n / plain.e_n == pytest.approx(e**0.5, abs=1e-4)


def test_at_268_times_the_yield_speed_a_dashpot_of_0_9_leaves_0_9485_of_the_plastic_restitution():
    law, speed = Thornton(**STEEL, p_y=2.8e9), 150.0
    damped = viscous.impact(law, m_star=M, speed=speed, restitution=0.9)
    plain = restitution.impact(law, m_star=M, speed=speed)
    assert damped.e_n / plain.e_n == pytest.approx(0.9485, abs=5e-5)


@pytest.mark.parametrize("e", [0.14, 0.3, 0.8, 0.99])
@pytest.mark.parametrize(("name", "v"), [("hertz", 0.3), ("thornton", 6.0), ("thornton", 1.2 * V_Y), ("cavity", 6.0)])
def test_motion_agrees_with_an_integrator_of_scipy(name, v, e):
    """x = L q^4 above the dent and dt = 4 (L/V) q^3 ds make the motion smooth at both of its ends: q' = speed/V."""
    law = LAWS[name](**STEEL, **STRENGTH[name])
    found = viscous.impact(law, m_star=M, speed=v, restitution=e)
    number = 2 * np.sqrt(5 / 6) * float(viscous.damping_ratio(e))

    def force(branch, q, u, L, V):
        F, a = branch(L * q**4)
        return F + number * np.sqrt(2 * law.E_star * a * M) * u * V

    def move(branch, L, V, start, *, yields=np.inf):
        """Overlap at rest, largest force; overlap, speed and time where it yields or the force ends."""

        def rate(s, y):
            q, u, _ = y
            return [u, -4 * q**3 * force(branch, q, u, L, V) * L / (M * V * V), 4 * q**3 * L / V]

        ends = [lambda s, y: L * y[0] ** 4 - yields if yields < np.inf else -1.0]
        ends.append(lambda s, y: force(branch, max(y[0], 0.0), y[1], L, V) if y[1] < 0 else 1.0)
        for end in ends:
            end.terminal = True
        ends.append(lambda s, y: y[1])  # rest
        way = solve_ivp(rate, (0, 100), start, "DOP853", events=ends, rtol=1e-12, atol=1e-14, dense_output=True)
        assert way.status == 1
        q, u, _ = way.sol(np.linspace(0, way.t[-1], 4001))
        largest = max(force(branch, a, b, L, V) for a, b in zip(q, u, strict=True))
        rest = way.y_events[2]
        return L * rest[0, 0] ** 4 if len(rest) else 0.0, largest, L * way.y[0, -1] ** 4, way.y[1, -1] * V, way.y[2, -1]

    L = (15 * M * v * v / (16 * law.E_star * np.sqrt(law.R_star))) ** 0.4
    touch = lambda x: (4 / 3 * law.E_star * np.sqrt(law.R_star * x) * x, np.sqrt(law.R_star * x))  # noqa: E731
    top, largest, parting, speed, time = move(touch, L, v, [0.0, 1.0, 0.0], yields=float(law.yield_overlap))
    if speed > 0:
        y = float(law.yield_overlap)
        energy = float(law.work(y)) + 0.5 * M * speed**2
        top = float(law.overlap_of_work(energy))
        pause = lambda c: 2 * (top - y) * c / np.sqrt(2 / M * (energy - law.work(top - (top - y) * c * c)))  # noqa: E731
        recovered, dent = float(law.recovered_overlap(top)), float(law.residual_overlap(top))
        V = float(np.sqrt(2 * law.recovered_work(top) / M))
        branch = lambda x: tuple(map(float, law.unloading(min(dent + x, top), top)))  # noqa: E731
        _, _, left, speed, after = move(branch, recovered, V, [1.0, 0.0, 0.0])
        time, parting = time + quad(pause, 0, 1, epsrel=1e-9)[0] + after, dent + left
        largest = max(largest, float(law.force(top)))
    assert -speed / v == pytest.approx(found.e_n, rel=ODE)
    assert top == pytest.approx(found.overlap_max, rel=ODE, abs=0)
    assert parting == pytest.approx(found.residual_overlap, abs=ODE * top)
    assert time == pytest.approx(found.contact_time, rel=1e-8, abs=0)
    assert largest == pytest.approx(found.force_max, rel=1e-6, abs=0)  # of 4001 samples
    assert found.plastic_work == pytest.approx(law.plastic_work(top), rel=1e-8, abs=1e-12 * M * v * v)


@pytest.mark.parametrize(("name", "v", "e_n"), [("thornton", 4.5 * V_Y, 0.357), ("cavity", 2.4 * V_Y, 0.416)])
def test_restitution_lies_above_that_of_the_dashpot_which_does_not_act_while_the_contact_yields(name, v, e_n):
    """The numbers of docs/laws.md for e = 0.3."""
    law = LAWS[name](**STEEL, **STRENGTH[name])
    assert float(viscous.impact(law, m_star=M, speed=v, restitution=0.3).e_n) == pytest.approx(e_n, abs=5e-4)


@every_law
def test_a_dashpot_takes_energy_and_gives_none(law):
    speed = np.geomspace(0.05, 150, 24)
    plain = restitution.impact(law, m_star=M, speed=speed)
    for e in (0.14, 0.6, 0.95):
        p = viscous.impact(law, m_star=M, speed=speed, restitution=e)
        assert np.all(p.work_in - p.work_out - p.plastic_work > 0)
        assert np.all(p.plastic_work <= plain.plastic_work * (1 + 1e-12))
        assert np.all(p.e_n <= plain.e_n)
        assert np.all(p.residual_overlap >= 0)
