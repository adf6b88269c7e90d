# SPDX-License-Identifier: GPL-2.0-or-later
"""The map of equations is made from the code; here it is kept true and complete."""

import importlib.util
import re
from pathlib import Path

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


def test_the_stored_page_is_what_the_code_says():
    stored = (equations.ROOT / "docs/equations.md").read_text()
    assert stored == equations.page(), "run: python docs/equations.py"
