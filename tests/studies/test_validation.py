# SPDX-License-Identifier: GPL-2.0-or-later
"""Every number that README claims has a row in docs/validation.md, and the command of the row still gives it."""

import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
spec = importlib.util.spec_from_file_location("validation", ROOT / "docs/validation.py")
validation = importlib.util.module_from_spec(spec)
spec.loader.exec_module(validation)
CLAIMS = validation.read()
ERROR = re.compile(r"\b\d(?:\.\d+)?e-\d+\b|\b\d+(?:\.\d+)? ns\b|\b\d+\.\d+ s per step|\b\d+(?:\.\d+)? %")
TOLERANCES = {"1e-4"}  # what cases ask for, not what was measured


def test_the_page_and_every_marked_number_are_those_of_the_records():
    assert (ROOT / "docs/validation.md").read_text() == validation.page(CLAIMS)
    used = set()
    for path in validation.pages():
        text = path.read_text()
        assert validation.filled(text, CLAIMS) == text, f"run docs/validation.py: {path.name}"
        used |= {name for name, _ in validation.MARK.findall(text)}
    assert used >= {"e_n_liggghts_400", "thornton_ning_400", "million_thornton"}


def test_a_number_of_the_readme_without_a_record_is_seen():
    bare = validation.MARK.sub("", (ROOT / "README.md").read_text())
    assert set(ERROR.findall(bare)) <= TOLERANCES
    assert ERROR.findall("an error of 3e-6, 20 ns, 5.5 %") == ["3e-6", "20 ns", "5.5 %"]


@pytest.mark.parametrize("name", CLAIMS)
def test_the_test_that_a_row_names_is_there(name):
    named = CLAIMS[name]["test"]
    if named == "by hand":
        assert "column" not in CLAIMS[name] and CLAIMS[name]["date"]
        return
    file, _, function = named.partition("::")
    text = (ROOT / "tests" / file).read_text()
    assert not function or f"def {function}(" in text


@pytest.mark.liggghts
def test_every_command_still_gives_the_value_of_its_row():
    found = validation.measure(CLAIMS)
    assert len(found) >= 13
    for name, value in found.items():
        claim = CLAIMS[name]
        assert value == pytest.approx(claim["value"], rel=0.02), name
        assert value <= claim.get("tolerance", 1.0), name
