# SPDX-License-Identifier: GPL-2.0-or-later
"""The blocks of docs/scenes.md do what the page says."""

import re
import shlex
import tomllib

import pytest
from parts_cases import CASES, parts
from scene_runs import run, write_case
from test_parts_motions import PLATE

from epdem.cli import main

PAGE = (CASES.parent / "docs/scenes.md").read_text()
COMMANDS = re.findall(r"^    (epdem [^#\n]+)", PAGE, re.M)


def block(language: str) -> str:
    (text,) = re.findall(rf"^```{language}\n(.*?)^```$", PAGE, re.M | re.S)
    return text


@pytest.mark.liggghts
def test_the_example_runs_and_the_tables_are_read_as_shown(tmp_path, monkeypatch):
    """Shortened in time, with a wall of triangles and measures, so that every table is there."""
    example = tomllib.loads(block("toml"))["scene"]
    for phase in example["phase"]:
        phase["duration"] = "4 ms"
    example["fill"][0]["mass"] = "0.5 g"
    example["wall"].append(PLATE | {"name": "lid", "stress": True})
    example["measure"] = [{"name": "top", "kind": "height"}, {"name": "work", "kind": "plastic_work"}]
    outcome = run(write_case(parts(**example), tmp_path), out=tmp_path / "runs/compaction_powder")
    assert outcome.passed, outcome.results.checks
    monkeypatch.chdir(tmp_path)
    lines = [line.split("#")[0] for line in block("python").splitlines()]
    shown = [part.strip() for line in lines if line.startswith("r.") for part in line.split(",")]
    space: dict = {}
    exec("\n".join(lines), space)
    tables = {part: eval(part, space) for part in shown}
    assert len(tables) == 9 and all(len(table) for table in tables.values())


@pytest.mark.parametrize("words", COMMANDS)
def test_the_commands_of_the_page_have_the_options_that_it_names(words):
    """Their cases exist; the commands themselves are called by their own tests."""
    name, *rest = shlex.split(words)[1:]
    command = {c.name: c for c in main.typer.main.get_command(main.app).commands.values()}[name]
    known = {flag for option in command.params for flag in option.opts}
    assert {word for word in rest if word.startswith("-")} <= known
    assert all((CASES.parent / word).is_file() for word in rest if word.startswith("cases/"))


def test_there_are_commands_on_the_page():
    assert len(COMMANDS) > 10
