# SPDX-License-Identifier: GPL-2.0-or-later
"""The laws that travel with a YADE deck are those of the C++ library, digit for digit, and need no package."""

import ast
import math
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from epdem.errors import CaseError
from epdem.laws import library as claw
from epdem.laws.native import Law
from epdem.yade.deck_modules import cone
from epdem.yade.deck_modules import law as numbers

E_STAR, STRENGTH = 1.1428571428571429e11, 1.3e9


def both(name, E_star=E_STAR, strength=STRENGTH, **ratios):
    """The law of the deck and that of the library."""
    kind = numbers.LAWS[name]
    parameters = {kind.strength_name: strength} if kind.strength_name else {}
    return kind(E_star, *parameters.values(), **ratios), Law(name, E_star=E_star, **parameters, **ratios)


def test_both_know_the_same_laws_and_parameters():
    assert set(numbers.LAWS) == {name for name, info in claw.laws().items() if not info.adheres}
    for name, kind in numbers.LAWS.items():
        given = [p for p in claw.laws()[name].parameters if p.name != "finite_strain"]  # YADE refuses it
        known = [p.name for p in given]
        assert sorted(known) == sorted([*filter(None, [kind.strength_name]), *kind.ratios])
        for p in given:
            if p.unit == "1":  # the same number where the user gives none
                assert getattr(both(name)[0], {"first_yield_ratio": "c_Y", "plastic_ratio": "c_P"}[p.name]) == p.default


@pytest.mark.parametrize("name", numbers.LAWS)
@given(
    R_star=st.floats(1e-6, 10.0),
    share=st.floats(-2.0, 1.0),
    reached=st.floats(-3.0, 5.0),
    soft=st.floats(-5.0, -1.0),
    ratios=st.sampled_from([{}, {"first_yield_ratio": 1.5, "plastic_ratio": 3.0}]),
)
def test_force_radius_and_memory_agree_to_2e_15(name, R_star, share, reached, soft, ratios):
    """Overlaps from 1e-3 to 1e5 of yield_overlap, below and on the largest; share < 0 asks for none.

    Relative to the force and radius at the largest overlap: near the dent each is the difference of large numbers.
    """
    E_star = STRENGTH / 10.0**soft
    mine, library = both(name, E_star, **(ratios if name == "cavity" else {}))
    scale = mine.yield_ratio if math.isfinite(mine.yield_ratio) else 1e-3
    delta_max = 10.0**reached * scale * R_star
    recovered = delta_max
    if delta_max > mine.yield_ratio * R_star:
        recovered = numbers.recovered_overlap(E_star, mine.load(R_star, delta_max))
    for delta in (delta_max, delta_max - max(share, 0.0) * recovered, delta_max * (1 + max(share, 0.0)), share):
        force, radius, after = (float(x[0]) for x in library.step(R_star=R_star, delta_max=delta_max, delta=delta))
        found = numbers.step(mine, R_star, delta_max, delta)
        top = library.step(R_star=R_star, delta_max=after, delta=after)
        assert abs(found[0] - force) <= 2e-15 * top[0][0]
        # near the dent the radius goes as the square root of what is left, which is known to eps of the whole
        assert abs(found[1] ** 2 - radius**2) <= 2e-15 * top[1][0] ** 2
        assert found[2] == after


@pytest.mark.parametrize("name", ["thornton", "johnson", "cavity"])
def test_unloading_keeps_relative_accuracy_down_to_the_dent(name):
    """Down to a thousandth of the branch: 1e-12 of the force itself, not of the largest one."""
    mine, library = both(name)
    delta_max = 5.0 * mine.yield_ratio * 0.01
    peak = mine.load(0.01, delta_max)
    recovered = numbers.recovered_overlap(E_STAR, peak)
    for left in (0.5, 0.1, 1e-2, 1e-3):
        delta = delta_max - (1.0 - left) * recovered
        force = float(library.step(R_star=0.01, delta_max=delta_max, delta=delta)[0][0])
        assert abs(numbers.unload(E_STAR, peak, delta_max, delta)[0] / force - 1.0) <= 1e-12


@pytest.mark.parametrize("name", ["thornton", "johnson"])
def test_a_hertz_branch_of_yade_is_the_whole_elastic_branch(name):
    """What makes the engine exact: YADE's formula with (R, dent) is the law from the largest overlap to the dent."""
    law, R_star = both(name)[0], 0.01
    delta_max = 40.0 * law.yield_ratio * R_star
    peak = law.load(R_star, delta_max)
    R, dent = numbers.hertz_branch(E_STAR, peak[0], peak[1], delta_max)
    growth = 0.01
    for delta in np.linspace(dent * (1 + 1e-9), delta_max, 200):
        force = cone.force(E_STAR, R, R - dent / growth, growth, delta)
        assert abs(force - numbers.unload(E_STAR, peak, delta_max, delta)[0]) <= 1e-12 * peak[0]


def test_beyond_its_end_a_branch_rises_as_the_law_to_second_order():
    """The secant is that of the law: halving the step makes the miss within it four times smaller."""
    law, R_star = both("thornton")[0], 0.01
    delta_max = 3.0 * law.yield_ratio * R_star
    force, radius, _ = law.load(R_star, delta_max)
    R, dent = numbers.hertz_branch(E_STAR, force, radius, delta_max)
    h, _ = cone.damage_limit(E_STAR, R, dent, delta_max)
    misses = []
    for step in (1e-7, 5e-8):
        growth = cone.growth_by_secant(R, h, step, law.load(R_star, delta_max + step)[0] / force - 1.0)
        radius = R - dent / growth
        for share, kept in ((1.0, False), (0.5, True)):
            u = delta_max + share * step
            grown = (u + radius * growth) / (h + growth)
            miss = abs(cone.force(E_STAR, grown, radius, growth, u) / law.load(R_star, u)[0] - 1.0)
            if kept:
                misses.append(miss)
            else:
                assert miss <= 1e-12  # the secant ends on the law
    assert 3.5 < misses[0] / misses[1] < 4.5


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("thornton", {"strength": 0.0}),
        ("johnson", {"strength": -1.0}),
        ("cavity", {"strength": math.nan}),
        ("cavity", {"strength": 1e9, "plastic_ratio": 1.5}),
        ("cavity", {"strength": 1e9, "first_yield_ratio": 1.2}),
    ],
)
def test_what_the_library_refuses_the_deck_refuses_too(name, words):
    with pytest.raises(ValueError, match=f"law {name}"):
        numbers.LAWS[name](E_STAR, **words)
    strength = {numbers.LAWS[name].strength_name: words["strength"]}
    with pytest.raises(CaseError):
        Law(name, E_star=E_STAR, **strength, **{k: v for k, v in words.items() if k != "strength"}).step(
            R_star=0.01, delta_max=0.0, delta=1e-5
        )


def test_the_travelling_law_imports_nothing_but_the_standard_library():
    for module in (numbers, cone):
        for node in ast.walk(ast.parse(Path(module.__file__).read_text())):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            assert all(n.split(".")[0] in sys.stdlib_module_names for n in names), (module.__name__, names)
