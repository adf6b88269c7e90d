# SPDX-License-Identifier: GPL-2.0-or-later
"""The map of equations is made from the code; here it is kept true and complete."""

from epdem import equations


def test_every_equation_of_the_chapter_has_a_function_with_a_test():
    rows = equations.entries()
    wanted = {f"8.{n}" for n in range(76, 90)}
    assert wanted <= {row[0] for row in rows}
    for number in wanted:
        assert any(row[4] for row in rows if row[0] == number), f"{number} has no test"


def test_the_stored_page_is_what_the_code_says():
    stored = (equations.ROOT / "docs/equations.md").read_text()
    assert stored == equations.page(), "run: python -m epdem.equations > docs/equations.md"
