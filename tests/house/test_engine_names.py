# SPDX-License-Identifier: GPL-2.0-or-later
"""An ability of an engine decides, never its name: names stand in the rooms of the engines alone."""

import ast
import re
from pathlib import Path

import pytest

from epdem.engines import ENGINES, FOREIGN, OTHERS

PACKAGE = Path(__file__).parents[2] / "python" / "epdem"
NAMES = {*ENGINES, *OTHERS, *FOREIGN}
ROOMS = ("liggghts", "yade", "lammps", "engines")
# a key of the user's configuration file and the default; the plugin's folder and that key; programs on the path
KNOWN = {"base/settings.py": 2, "base/paths.py": 3, "cli/printed.py": 2}
FILES = [path for path in sorted(PACKAGE.rglob("*.py")) if path.relative_to(PACKAGE).parts[0] not in ROOMS]
CLASSES = re.compile(r"isinstance\([^)]*\b(Liggghts|Yade|Embedded|LammpsMdr)\b")
PARTS = re.compile(r"\b(tool|engine|sampler)\.name(\.\w+\(| (not )?in | [!=]= )")


def names_in(text: str) -> list[str]:
    """The names of engines that a source has as texts of their own."""
    nodes = (node.value for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Constant))
    return [value for value in nodes if isinstance(value, str) and value in NAMES]


def where(path: Path) -> str:
    return path.relative_to(PACKAGE).as_posix()


@pytest.mark.parametrize("path", FILES, ids=where)
def test_no_module_asks_which_engine_it_has(path):
    text = path.read_text()
    assert len(names_in(text)) == KNOWN.get(where(path), 0), names_in(text)
    assert not CLASSES.search(text)
    assert not PARTS.search(text)


@pytest.mark.parametrize("line", ['x == "liggghts"', 'd = {"yade": 1}', 'f("embedded")', '"yade-luding" in known'])
def test_a_name_is_seen_wherever_it_stands(line):
    assert len(names_in(line)) == 1


def test_a_question_for_the_name_of_an_engine_is_seen():
    for line in ('if tool.name.startswith("lig")', "if tool.name in OTHERS", "x = sampler.name == y"):
        assert PARTS.search(line), line
    assert not PARTS.search("label = tool.name") and CLASSES.search("isinstance(x, (Yade, int))")
