# SPDX-License-Identifier: GPL-2.0-or-later
"""The laws that a YADE deck asks of its copy of the C library: the numbers of the theory, one contact at a time."""

import ast
import math
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from epdem.base.declarations import declarations
from epdem.engines.yade.launcher import write_deck_modules
from epdem.theory import backbones
from epdem.yade.deck_modules import cone
from epdem.yade.deck_modules import law as numbers

E_STAR, STRENGTH = 1.1428571428571429e11, 1.3e9


def law_of(name, E_star=E_STAR, strength=STRENGTH, **ratios):
    """The law of the deck."""
    return numbers.Law(name, E_star, strength, **ratios)


def theory(law, R_star):
    """The theory of the same contact."""
    cls = backbones.LAWS[law.name]
    given = dict(zip((p.symbol for p in cls.declaration().parameters), law._parameters, strict=False))
    return cls(E_star=law.E_star, R_star=R_star, **(given if law.declared["parameters"] else {}))


def test_a_deck_has_every_law_without_adhesion():
    assert list(numbers.declarations()) == [name for name, law in declarations().items() if not law.adheres]
    for name, law in numbers.declarations().items():
        assert (law["index"], law["strength"]) == (declarations()[name].index, declarations()[name].strength)


@pytest.mark.parametrize("name", numbers.declarations())
@given(
    R_star=st.floats(1e-6, 10.0),
    share=st.floats(0.0, 1.0),
    reached=st.floats(-3.0, 4.0),
    soft=st.floats(-5.0, -1.0),
    ratios=st.sampled_from([{}, {"first_yield_ratio": 1.5, "plastic_ratio": 3.0}, {"finite_strain": 0.82}]),
    exponent=st.floats(0.0, 0.99),
)
def test_force_radius_memory_and_dent_are_those_of_the_theory(name, R_star, share, reached, soft, ratios, exponent):
    """Overlaps from 1e-3 to 1e4 of first yield, on the backbone and below; relative to the largest force and radius."""
    own = {"cavity": ratios, "meyer": {"hardening_exponent": exponent}}.get(name, {})
    law = law_of(name, STRENGTH / 10.0**soft, **own)
    route, scale = theory(law, R_star), law.yield_ratio if math.isfinite(law.yield_ratio) else 1e-3
    delta_max = 10.0**reached * scale * R_star
    if abs(delta_max / (scale * R_star) - 1.0) < 1e-9:
        return  # johnson's radius jumps there
    force, radius = float(route.force(delta_max)), float(route.radius(delta_max))
    assert law.load(R_star, delta_max) == pytest.approx((force, radius), rel=1e-12)
    dent = float(route.residual_overlap(delta_max))
    assert abs(law.dent(R_star, delta_max) - dent) <= 1e-12 * delta_max
    delta = delta_max - share * (delta_max - dent)
    found = law.step(R_star, delta_max, delta)
    if delta_max > scale * R_star:
        below, narrow = (float(x) for x in route.unloading(delta, delta_max))
        assert abs(found[0] - below) <= 1e-11 * force and abs(found[1] ** 2 - narrow**2) <= 1e-11 * radius**2
    assert found[2] == delta_max
    assert law.step(R_star, delta_max, -delta)[:2] == (0.0, 0.0)


@pytest.mark.parametrize("name", ["thornton", "johnson"])
def test_a_hertz_branch_of_yade_is_the_whole_elastic_branch(name):
    """What makes the engine exact: YADE's formula with (R, dent) is the law from the largest overlap to the dent."""
    law, R_star = law_of(name), 0.01
    delta_max = 40.0 * law.yield_ratio * R_star
    peak = law.load(R_star, delta_max)
    R, dent = cone.hertz_branch(E_STAR, *peak, delta_max)
    growth = 0.01
    for delta in np.linspace(dent * (1 + 1e-9), delta_max, 200):
        force = cone.force(E_STAR, R, R - dent / growth, growth, delta)
        assert abs(force - law.unload(R_star, delta_max, delta)[0]) <= 1e-12 * peak[0]


def test_beyond_its_end_a_branch_rises_as_the_law_to_second_order():
    """The secant is that of the law: halving the step makes the miss within it four times smaller."""
    law, R_star = law_of("thornton"), 0.01
    delta_max = 3.0 * law.yield_ratio * R_star
    force, radius = law.load(R_star, delta_max)
    R, dent = cone.hertz_branch(E_STAR, force, radius, delta_max)
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
        ("meyer", {"strength": 1e9, "hardening_exponent": 1.0}),
        ("meyer", {"strength": 1e9, "hardening_exponent": -0.1}),
        ("cavity", {"strength": math.nan}),
        ("cavity", {"strength": 1e9, "plastic_ratio": 1.5}),
        ("cavity", {"strength": 1e9, "first_yield_ratio": 1.2}),
        ("cavity", {"strength": 1e9, "first_yield_ratio": 0.5, "plastic_ratio": 0.55}),
    ],
)
def test_numbers_out_of_range_are_refused_with_law_and_numbers(name, words):
    with pytest.raises(ValueError, match=rf"law {name}: E_star = .*(yield_pressure|yield_stress) = .* must be finite"):
        numbers.Law(name, E_STAR, **words)


@pytest.mark.parametrize(("name", "ratios"), [("toffee", {}), ("thornton", {"finite_strain": 1.0})])
def test_a_law_or_parameter_that_is_not_there_is_named(name, ratios):
    with pytest.raises(ValueError, match=r"there are hertz|has no parameter 'finite_strain'; it has none"):
        numbers.Law(name, E_STAR, STRENGTH, **ratios)


def test_the_modules_of_a_deck_import_nothing_but_the_standard_library():
    for module in (numbers, cone):
        for node in ast.walk(ast.parse(Path(module.__file__).read_text())):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            assert all(n.split(".")[0] in sys.stdlib_module_names for n in names), (module.__name__, names)


def test_the_copy_of_a_deck_stands_alone(tmp_path):
    """Another Python, without epdem, without any package, in a folder that was moved."""
    write_deck_modules(tmp_path / "deck", classes=False)
    shutil.move(tmp_path / "deck", tmp_path / "elsewhere")
    script = "from epdem.yade.deck_modules import law as n; "
    script += "print(n.library_path(), n.Law('thornton', 1e11, 1e9).step(0.01, 0.0, 1e-5)[0])"
    words = [sys.executable, "-S", "-s", "-c", script]
    done = subprocess.run(words, cwd=tmp_path / "elsewhere", capture_output=True, text=True, env={})
    path, force = done.stdout.split()
    assert Path(path).is_relative_to(tmp_path / "elsewhere"), done.stderr
    assert float(force) == pytest.approx(float(backbones.Thornton(E_star=1e11, R_star=0.01, p_y=1e9).force(1e-5)))


def test_without_the_library_the_place_is_named(tmp_path):
    write_deck_modules(tmp_path, classes=False)
    (tmp_path / "epdem/yade/deck_modules" / numbers.LIBRARY).unlink()
    words = [sys.executable, "-S", "-s", "-c", "from epdem.yade.deck_modules import law; law.library_path()"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, env={})
    assert "libepdem.so: not there; copy the folder epdem of a YADE deck" in done.stderr
