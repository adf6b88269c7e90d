# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/laws.md gives every law, property, parameter and default as the laws declare them."""

import re
from pathlib import Path

import pytest

from epdem.base.declarations import declarations

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/laws.md").read_text()


@pytest.mark.parametrize("name", declarations())
def test_the_page_states_the_properties_and_defaults_of_every_law(name):
    row = next(
        line
        for line in PAGE.splitlines()
        if line.startswith(f"| `{name}` |") and line.count("|") == 5 and not re.search(r"\| [\d.]+ \|", line)
    )
    for p in declarations()[name].parameters:
        assert f"`{p.property}`" in row
        assert f"`{p.name}`" in PAGE
        if p.default is not None:
            assert f"`{p.property}` ({p.default:g})" in row
        elif p.name == "yield_pressure":
            assert f"{declarations()[name].default_ratio:.1f} Y" in row
