# SPDX-License-Identifier: GPL-2.0-or-later
"""The map of equations is made from the code; here it is kept true and complete.

The C++ column is checked by numbers: each equation worked out here against what the C interface gives.
"""

import importlib.util
import math
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import trapezoid

from epdem.base.declarations import declarations
from epdem.laws.library import Law

PAGE = Path(__file__).parents[2] / "docs/equations.md"
spec = importlib.util.spec_from_file_location("equations", PAGE.with_suffix(".py"))
equations = importlib.util.module_from_spec(spec)
spec.loader.exec_module(equations)


def test_every_equation_of_the_chapter_has_a_formula_a_function_and_a_test():
    rows = equations.entries()
    wanted = [f"8.{n}" for n in range(76, 90)]
    assert [n for n in wanted if not any(row.number == n and row.formula and row.source for row in rows)] == []
    assert [row.function for row in rows if not row.tests] == []


def test_the_page_of_theory_sets_every_equation_of_the_chapter():
    text = (PAGE.parent / "theory.md").read_text()
    for n in range(76, 90):
        near = [text[m.start() : m.start() + 700] for m in re.finditer(rf"8\.{n}\b", text)]
        assert any("$" in part for part in near), f"8.{n}"
    assert text.count("$$") >= 44 and "ISBN 978-0-08-098337-0" in text


R, E, Y = 0.01, 1.1e11, 1e9
CAVITY = Law("cavity", E_star=E, yield_stress=Y, first_yield_ratio=1.6, plastic_ratio=2.8)
JOHNSON, THORNTON = Law("johnson", E_star=E, yield_pressure=3 * Y), Law("thornton", E_star=E, yield_pressure=2.8 * Y)
FIRST, LAST = (np.pi * 1.6 * Y / (2 * E)) ** 2 * R, 0.3 * R  # overlaps [m]: at first yield, and fully plastic


def pressure(law, delta):
    """Mean pressure [Pa] and radius [m] that C++ gives on the backbone."""
    force, radius, _, _ = law.backbone(R_star=R, delta=np.atleast_1d(delta))
    return force / (np.pi * radius**2), radius


def default(law, name):
    return next(p.default for p in declarations()[law].parameters if p.name == name)


def uniform_pressure_below_its_radius(delta_max, share):
    """Eq. 8.82 integrated over the circle: force and overlap of a flat contact that has shrunk to `share` of a_max."""
    p, a_max = 2.8 * Y, math.sqrt(2 * R * delta_max)
    r = share * a_max * np.sin(np.linspace(0, np.pi / 2, 4001))
    p_r = 2 * p / np.pi * np.arcsin(np.sqrt((r[-1] ** 2 - r**2) / (a_max**2 - r**2)))
    force = trapezoid(2 * np.pi * r * p_r, r)
    # the rigid punches that open between the two radii lift the surface by this together
    return force, delta_max - 2 * p * a_max / E * math.sqrt(1 - share**2)


def of_8_82():
    """C++ gives the same force at the same overlap on the way back."""
    for share in (0.9, 0.6, 0.3):
        force, delta = uniform_pressure_below_its_radius(LAST, share)
        found, radius, _ = CAVITY.step(R_star=R, delta_max=LAST, delta=delta)
        assert radius[0] == pytest.approx(share * math.sqrt(2 * R * LAST), rel=1e-12)
        assert found[0] == pytest.approx(force, rel=1e-5)  # 4000 intervals of the integral


def of_8_81():
    """p_m/Y grows by 2/3 for each e-fold of a."""
    p_m, a = pressure(CAVITY, FIRST * np.array([2.0, 4.0]))
    assert np.diff(p_m / Y) == pytest.approx(2 / 3 * np.diff(np.log(a)), rel=1e-12)


def of_8_85(law, p_m):
    """F = 2 pi R* p_m alpha, a^2 = 2 R* alpha."""
    force, radius, _, _ = law.backbone(R_star=R, delta=np.array([LAST]))
    assert force[0] == pytest.approx(2 * math.pi * R * p_m * LAST, rel=1e-12)
    assert radius[0] == pytest.approx(math.sqrt(2 * R * LAST), rel=1e-12)


CHECKS = {
    ("8.78", "cavity.hpp"): lambda: (
        default("cavity", "first_yield_ratio") == 1.60
        and pressure(CAVITY, 0.999999 * FIRST)[0] == pytest.approx(2 / 3 * 1.60 * Y, rel=1e-5)
    ),
    ("8.80", "cavity.hpp"): lambda: (
        2.8 <= default("cavity", "plastic_ratio") <= 3.0 and pressure(CAVITY, LAST)[0] == pytest.approx(2.8 * Y)
    ),
    ("8.80", "johnson.hpp"): lambda: declarations()["johnson"].default_ratio == 3.0,
    ("8.80", "thornton.hpp"): lambda: declarations()["thornton"].default_ratio == 2.8,
    ("8.81", "cavity.hpp"): of_8_81,
    ("8.82", "unloading.hpp"): of_8_82,
    ("8.85", "cavity.hpp"): lambda: of_8_85(CAVITY, 2.8 * Y),
    ("8.85", "johnson.hpp"): lambda: of_8_85(JOHNSON, 3 * Y),
}


def stated_in_cpp():
    """(number, header) of every entry in the C++ column of the page."""
    rows = [line.replace("\\|", "").split("|") for line in PAGE.read_text().splitlines() if line.startswith("| 8.")]
    return {(row[1].strip(), header) for row in rows for header in re.findall(r"`(\w+\.hpp): [\w:]+`", row[5])}


def test_the_page_names_the_cpp_that_computes_with_an_equation_and_no_other():
    assert stated_in_cpp() == set(CHECKS)


@pytest.mark.parametrize("place", CHECKS, ids=" ".join)
def test_cpp_computes_with_the_equation_that_the_page_says(place):
    assert CHECKS[place]() in (None, True)


def test_the_stored_page_is_what_the_code_says():
    stored = (equations.ROOT / "docs/equations.md").read_text()
    assert stored == equations.page(), "run: python docs/equations.py"
