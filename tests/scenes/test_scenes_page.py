# SPDX-License-Identifier: GPL-2.0-or-later
"""The example of docs/parts.md and the tables of docs/scenes.md are what they say; test_guide runs their commands."""

import re
import tomllib

import pytest
from parts_cases import CASES, parts
from scene_runs import run, write_case
from test_parts_motions import PLATE

DOCS = CASES.parent / "docs"


def block(page: str, language: str) -> str:
    """The first block of a language of a page."""
    return re.search(rf"^```{language}(?: in [^\n]*)?\n(.*?)^```$", (DOCS / page).read_text(), re.M | re.S)[1]


@pytest.mark.liggghts
def test_the_example_runs_and_the_tables_are_read_as_shown(tmp_path, monkeypatch):
    """Shortened in time, with a wall of triangles and measures, so that every table is there."""
    example = tomllib.loads(block("parts.md", "toml"))["scene"]
    for phase in example["phase"]:
        phase["duration"] = "4 ms"
    example["fill"][0]["mass"] = "0.5 g"
    example["wall"].append(PLATE | {"name": "lid", "stress": True})
    example["measure"] = [{"name": "top", "kind": "height"}, {"name": "work", "kind": "plastic_work"}]
    outcome = run(write_case(parts(**example), tmp_path), out=tmp_path / "runs/compaction_powder")
    assert outcome.passed, outcome.results.checks
    monkeypatch.chdir(tmp_path)
    lines = [line.split("#")[0] for line in block("scenes.md", "python").splitlines()]
    shown = [part.strip() for line in lines if line.startswith("r.") for part in line.split(",")]
    space: dict = {}
    exec("\n".join(lines), space)
    tables = {part: eval(part, space) for part in shown}
    assert len(tables) == 9 and all(len(table) for table in tables.values())
