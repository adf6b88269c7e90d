# SPDX-License-Identifier: GPL-2.0-or-later
"""The map of equations is made from the code; here it is kept true and complete."""

import re

from epdem import equations
from epdem.theory.sources import SOURCES


def test_every_equation_of_the_chapter_has_a_formula_a_function_and_a_test():
    rows = equations.entries()
    wanted = [f"8.{n}" for n in range(76, 90)]
    assert [n for n in wanted if not any(row.number == n and row.formula and row.source for row in rows)] == []
    assert [row.function for row in rows if not row.tests] == []


def test_the_lines_of_cpp_are_declarations_below_a_comment_that_names_the_equation():
    places = {(row.number, place) for row in equations.entries() for place in row.cpp}
    assert {number for number, _ in places} >= {"8.78", "8.80", "8.81", "8.82", "8.83", "8.84", "8.85"}
    for number, place in places:
        name, line = place.split(":")
        lines = (equations.ROOT / equations.HEADERS / name).read_text().splitlines()
        assert re.match(r"\s*(template|struct|inline|real)\b", lines[int(line) - 1]), place
        assert any(number in text for text in lines[: int(line)]), place


def test_every_source_is_used_by_a_docstring_of_the_theory():
    text = "".join(p.read_text() for p in (equations.ROOT / equations.THEORY).glob("*.py") if p.stem != "sources")
    unused = [key for key in SOURCES if not re.search(r"\s+".join(map(re.escape, key.split())), text)]
    assert unused == []


def test_the_stored_page_is_what_the_code_says():
    stored = (equations.ROOT / "docs/equations.md").read_text()
    assert stored == equations.page(), "run: python -m epdem.equations > docs/equations.md"
