# SPDX-License-Identifier: GPL-2.0-or-later
"""Theory and C++ are two routes to one number: they agree for every law, on every branch."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from laws import NAMES, YIELDING, contacts, symbols

from epdem.base.declarations import declarations
from epdem.theory import backbones
from epdem.theory.sources import SOURCES

ROUND_OFF = 1e-12  # of the largest value: exp, log and powers of numbers near 1, once on each route


def theory(c):
    """The theory's law with the same numbers."""
    return backbones.LAWS[c.name](E_star=c.E_star, R_star=c.R_star, **symbols(c.name, c.strength))


def test_both_know_the_same_laws():
    assert set(backbones.LAWS) == set(NAMES)
    assert {*backbones.LAWS, *backbones.ADHESIVE} == set(declarations())


def test_declarations_are_those_of_the_literature():
    """The memory is delta_max; cavity and meyer keep the peak beside it; an adhesive law keeps its opening curve."""
    tabor = {"thornton": ("yield_pressure", 2.8), "johnson": ("yield_pressure", 3.0), "cavity": ("yield_stress", 1.0)}
    tabor |= {"hertz": (None, 1.0), "jkr": (None, 1.0), "thornton_ning": ("yield_pressure", 2.8)}
    tabor |= {"meyer": tabor["thornton"], "cavity_adhesive": tabor["cavity"]}
    memory = {"hertz": 0, "thornton": 1, "johnson": 1, "cavity": 4, "jkr": 2, "thornton_ning": 5, "meyer": 2}
    memory["cavity_adhesive"] = 8
    for name, law in declarations().items():
        if name in tabor:
            assert (law.strength, law.default_ratio) == tabor[name] and law.memory == memory[name]
        assert set(law.sources) <= set(SOURCES) and law.title and len(set(law.symbols.values())) == len(law.parameters)
    defaults = {p.symbol: p.default for p in declarations()["cavity"].parameters}
    assert defaults == {"Y": None, "c_Y": 1.6, "c_P": 2.8, "c_strain": 1e6}
    assert {n: law.without_adhesion for n, law in declarations().items() if law.adheres} == {
        "jkr": "hertz",
        "thornton_ning": "thornton",
        "cavity_adhesive": "cavity",
    }


@pytest.mark.parametrize("name", NAMES)
def test_a_law_flattens_where_its_theory_has_a_flatness(name):
    cls = backbones.LAWS[name]
    assert declarations()[name].flattens == (cls.flatness is not backbones.Backbone.flatness)


def test_ids_are_those_that_restart_files_keep():
    stored = {"hertz": 40, "thornton": 41, "johnson": 42, "cavity": 43, "jkr": 44, "thornton_ning": 45, "meyer": 46}
    stored["cavity_adhesive"] = 47
    ids = {name: info.id for name, info in declarations().items()}
    assert stored.items() <= ids.items() and len(set(ids.values())) == len(ids)


@given(contacts(), st.lists(st.floats(1e-3, 5e3), min_size=1, max_size=20))
def test_backbones_agree(c, s):
    delta = np.array(s) * c.delta_y
    delta = delta[np.abs(delta / c.delta_y - 1) > 1e-9]  # johnson's radius jumps there
    if not delta.size:
        return
    force, radius, work, plastic = c.backbone(delta)
    law = theory(c)
    assert force == pytest.approx(law.force(delta), rel=ROUND_OFF)
    assert radius == pytest.approx(law.radius(delta), rel=ROUND_OFF)
    assert work == pytest.approx(law.work(delta), rel=ROUND_OFF)
    lost = np.where(delta > c.delta_y, law.work(delta) - law.recovered_work(delta), 0.0)
    assert np.all(np.abs(plastic - lost) <= ROUND_OFF * work)


@given(contacts(YIELDING), st.floats(1.001, 5e3), st.lists(st.floats(0, 1), min_size=1, max_size=20))
def test_unloading_branches_agree(c, s, shares):
    """Absolute in the peak force: near the dent the theory's acos y - y sqrt(1-y^2) keeps absolute accuracy only."""
    law, peak = theory(c), s * c.delta_y
    delta = np.array(shares) * peak
    force = c.step(peak, delta)[0]
    assert np.all(np.abs(force - law.unloading_force(delta, peak)) <= 4 * ROUND_OFF * law.force(peak))


@given(contacts(("cavity",)), st.floats(1.01, 5e3), st.floats(1e-8, 1.0))
def test_the_last_of_the_unloading_force_keeps_its_relative_accuracy(c, s, share):
    """Just above the dent F = F_max [(1-tau)(1-y^2)^1.5 + tau (2/pi)(acos y - y sqrt(1-y^2))] with 50 digits."""
    import mpmath

    law, peak = theory(c), s * c.delta_y
    tau, F, a = (float(f(peak)) for f in (law.flatness, law.force, law.radius))
    with mpmath.workdps(50):
        E, A, B = mpmath.mpf(c.E_star), mpmath.mpf(0.75) * (1 - mpmath.mpf(tau)), 2 * mpmath.mpf(tau) / mpmath.pi
        delta = peak - float((A + B) * F / (E * a)) * (1 - share)
        w = (mpmath.mpf(peak) - mpmath.mpf(delta)) * E * a / F
        y = 2 * w / (B + mpmath.sqrt(B * B + 4 * A * w))
        if delta <= 0 or y >= 1:
            return
        segment = mpmath.acos(y) - y * mpmath.sqrt(1 - y * y)
        exact = F * ((1 - mpmath.mpf(tau)) * (1 - y * y) ** mpmath.mpf(1.5) + B * segment)
        slope = float(1.5 / (1 - y) * 2)  # how much a rounding of w is amplified in (1-y)^1.5
        force = float(c.step(peak, delta)[0][0])
    scale = peak * c.E_star * a / F  # w is a difference of overlaps: its rounding is eps alpha E* a/F
    assert force == pytest.approx(float(exact), rel=1e-13 + 2e-15 * slope * max(scale, 1.0))
