# SPDX-License-Identifier: GPL-2.0-or-later
"""Every number that README and docs claim has a row in docs/validation.md, and its command still gives it."""

import importlib.util
import re
from pathlib import Path

import pytest
import typer

from epdem.cli.main import app

ROOT = Path(__file__).parents[2]
spec = importlib.util.spec_from_file_location("validation", ROOT / "docs/validation.py")
validation = importlib.util.module_from_spec(spec)
spec.loader.exec_module(validation)
CLAIMS = validation.read()
VALUES, BLOCKS, PAGES = validation.values(CLAIMS), CLAIMS["by"], CLAIMS["pages"]
RECORDS = VALUES | BLOCKS | PAGES
ADVICE = "run .venv/bin/python docs/validation.py, with --marks if no value of the plugin has changed"


def test_the_page_and_every_marked_number_are_those_of_the_records():
    assert (ROOT / "docs/validation.md").read_text() == validation.page(CLAIMS), ADVICE
    used = set()
    for path in validation.pages():
        text = path.read_text()
        assert validation.filled(text, CLAIMS) == text, f"{path.name}: {ADVICE}"
        used |= {name.split(".")[0] for name, _ in validation.MARK.findall(text)}
    assert used >= {"e_n_liggghts_400", "thornton_ning_400", "million_thornton", "accuracy_400", "oblique_liggghts"}


def test_marked_blocks_have_records_of_just_these_numbers():
    numbers = validation.blocks()
    assert set(numbers) == set(BLOCKS) and len(BLOCKS) > 30
    for name, found in numbers.items():
        assert BLOCKS[name]["digest"] == validation.digest(found), f"{name} in {', '.join(found)}: {ADVICE}"
    one = {"a.md": ["1", "2"]}
    assert validation.digest(one) != validation.digest({"a.md": ["1", "3"]})


@pytest.mark.parametrize("path", validation.pages(), ids=lambda p: p.name)
def test_a_number_that_looks_measured_is_marked(path):
    if path.name not in PAGES:
        found = validation.unmarked(path.read_text(), CLAIMS["given"].get(path.name, []))
        assert not found, f"{path.name}: mark {found} by <!--by:RECORD-->, or name them under [given] of claims.toml"


def test_a_measured_number_is_seen_in_prose_and_tables_but_not_in_code_marks_and_equations():
    text = "an error of 3e-6, 20 ns, 5.5 %\n\n| a | 0.38 |\n\n`1e-9` $2.5\\,R$ by 8.83 <!--by:x-->4e-4<!--/by-->"
    assert validation.unmarked(text, []) == ["3e-6", "20 ns", "5.5 %", "0.38"]
    assert validation.unmarked(text, ["3e-6", "0.38"]) == ["20 ns", "5.5 %"]


@pytest.mark.parametrize("name", RECORDS)
def test_the_test_and_the_command_of_a_row_are_there(name):
    record = RECORDS[name]
    assert re.fullmatch(r"20\d\d-\d\d-\d\d", record["date"])
    if record["test"] == "by hand":
        assert "column" not in record and "columns" not in record
    else:
        file, _, function = record["test"].partition("::")
        text = (ROOT / "tests" / file).read_text()
        assert not function or f"def {function}(" in text
    program, *words = record["command"].split()
    top = typer.main.get_command(app).commands
    commands = top["verify"].commands if words[0] == "verify" else top
    name = words[words[0] == "verify"]
    known = {
        "epdem": lambda: name in commands and all((ROOT / w).exists() for w in words if w.endswith(".toml")),
        ".venv/bin/python": lambda: (ROOT / words[0]).exists(),
        "pytest": lambda: all((ROOT / w).exists() for w in words),
        "make": lambda: re.search(rf"^{words[0]}:", (ROOT / "Makefile").read_text(), re.M),
        "epdem-liggghts": lambda: words[0] == "-in",
    }
    assert known[program](), record["command"]


@pytest.mark.liggghts
def test_every_command_still_gives_the_value_of_its_row():
    found = validation.measure(CLAIMS)
    assert len(found) >= 21
    for name, value in found.items():
        claim, stored = CLAIMS[name], validation._leaves(CLAIMS[name]["value"])
        assert validation._leaves(value) == pytest.approx(stored, rel=0.02), name
        assert max(validation._leaves(value)) <= claim.get("tolerance", 1.0), name
