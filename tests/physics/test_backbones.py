# SPDX-License-Identifier: GPL-2.0-or-later
"""Force, radius, dent and plastic work of the laws against 30 digits, as close to yield as floating point comes."""

import mpmath as mp
import numpy as np
import pytest
from test_restitution import STEEL, Exact, M, steel

from epdem.theory import restitution, yielding

STRENGTH = {"hertz": 1e9, "thornton": 2.8e9, "johnson": 3e9, "cavity": 1e9}
BEYOND = np.array([1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 0.3, 3.0, 1e3, 1e6])  # alpha/alpha_y - 1


def exact(name, alpha):
    """Columns force, radius, dent, plastic work of the law at overlaps alpha [m], by its definition."""
    rows = []
    with mp.workdps(30):
        law = Exact(name, *STEEL.values(), STRENGTH[name])
        for top in map(mp.mpf, map(float, alpha)):
            F, a, tau = law.point(top)
            dent = top - (mp.mpf(3) / 4 * (1 - tau) + 2 / mp.pi * tau) * F / (law.E * a)
            rows.append([float(q) for q in (F, a, dent, law.work(top) - law.given_back(top))])
    return np.array(rows).T


@pytest.mark.parametrize("name", ["thornton", "johnson", "cavity"])
def test_force_radius_dent_and_plastic_work_are_those_of_the_definition(name):
    """Force and radius: 1e-13, a few roundings of powers. The dent and the work that stays vanish at yield, as x^2 for
    thornton and x/5 for cavity, x = alpha/alpha_y - 1: ten roundings change them by 4e-14/x at most."""
    law = steel(name)
    alpha = law.yield_overlap * (1 + BEYOND)
    force, radius, dent, plastic = exact(name, alpha)
    assert law.force(alpha) == pytest.approx(force, rel=1e-13, abs=0)
    assert law.radius(alpha) == pytest.approx(radius, rel=1e-13, abs=0)
    for found, expected in ((law.residual_overlap(alpha), dent), (law.plastic_work(alpha), plastic)):
        assert np.all(np.abs(found / expected - 1) < 1e-12 + 4e-14 / BEYOND)


@pytest.mark.parametrize("name", ["hertz", "thornton", "johnson", "cavity"])
def test_below_yield_the_laws_are_hertz_and_nothing_stays(name):
    """1e-13: a few roundings of powers."""
    law, alpha = steel(name), steel("cavity").yield_overlap * np.array([1e-12, 1e-3, 0.9])
    force, radius = exact("hertz", alpha)[:2]
    assert law.force(alpha) == pytest.approx(force, rel=1e-13, abs=0)
    assert law.radius(alpha) == pytest.approx(radius, rel=1e-13, abs=0)
    assert not np.any(law.residual_overlap(alpha)) and not np.any(law.plastic_work(alpha))


@pytest.mark.parametrize("name", ["thornton", "johnson", "cavity"])
def test_an_impact_right_above_yield_creates_neither_energy_nor_a_bump(name):
    law = steel(name)
    v_y = np.sqrt(2 * law.work(law.yield_overlap) / M)
    speed = v_y * (1 + np.concatenate([[0.0], np.geomspace(1e-16, 1e-3, 300)]))
    x = restitution.impact(law, m_star=M, speed=speed)
    assert np.all(x.e_n <= 1) and np.all(restitution.e_n(law, m_star=M, speed=speed) <= 1)
    assert np.all(x.residual_overlap >= 0) and np.all(x.plastic_work >= 0) and np.all(x.work_out <= x.work_in)


def test_in_the_cavity_phase_a_harder_body_yields_where_the_pressure_of_the_definition_reaches_its_own():
    """Half-ellipse and uniform pressure by flatness, 30 digits; 1e-12: the inverse of a logarithm's slow growth."""
    hard = np.array([1.05e9, 1.3e9, 1.7e9])  # the softer body has 1 GPa; all between its 1.60 and 2.8 Y
    found = yielding.first_yield_speed(steel("cavity"), hard, m_star=M)
    with mp.workdps(30):
        law = Exact("cavity", *STEEL.values(), STRENGTH["cavity"])

        def peak(alpha):
            F, a, tau = law.point(alpha)
            return (mp.mpf(3) / 2 * (1 - tau) + tau) * F / (mp.pi * a**2)

        for Y, speed in zip(hard, found, strict=True):
            s = mp.findroot(lambda s, Y=Y: peak(law.y * s) / (mp.mpf(1.6) * float(Y)) - 1, (1, 80), solver="anderson")
            assert speed == pytest.approx(float(mp.sqrt(2 * law.work(law.y * s) / M)), rel=1e-12, abs=0)
