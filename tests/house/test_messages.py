# SPDX-License-Identifier: GPL-2.0-or-later
"""Every sentence that a user can get for a mistake or a failure is named by a test: by three of its words in a row."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "python" / "epdem"
FILES = sorted(PACKAGE.rglob("*.py"))
ERRORS = {"CaseError", "EngineError", "ValueError", "BadParameter"}
ENOUGH = 3  # words

Words = set[tuple[str, ...]]


def texts(node: ast.AST) -> list[str]:
    """The texts within an expression, those of an f-string between its values."""
    return [n.value for n in ast.walk(node) if isinstance(n, ast.Constant) and isinstance(n.value, str)]


def runs(parts: list[str]) -> Words:
    """Every three words in a row."""
    found: Words = set()
    for part in parts:
        words = re.findall(r"\w+", part.lower())
        found |= {tuple(words[k : k + ENOUGH]) for k in range(len(words) - ENOUGH + 1)}
    return found


def named() -> Words:
    """What the tests name, but in the explanations of their own."""
    found: Words = set()
    for path in (ROOT / "tests").rglob("*.py"):
        tree = ast.parse(path.read_text())
        prose = {id(n.value) for n in ast.walk(tree) if isinstance(n, ast.Expr)}
        constants = [n for n in ast.walk(tree) if isinstance(n, ast.Constant) and id(n) not in prose]
        found |= runs([n.value.replace("\\", "") for n in constants if isinstance(n.value, str)])
    return found


NAMED = named()


def sentences(tree: ast.AST) -> Iterator[tuple[int, Words]]:
    """(line, three words in a row) of the messages of errors; those with fewer words of their own hand on another's."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            name = ast.unparse(node.exc.func).split(".")[-1]
            words = runs([t for a in node.exc.args for t in texts(a)]) if name in ERRORS else set()
            if words:
                yield node.lineno, words


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.relative_to(PACKAGE).as_posix())
def test_a_test_names_every_sentence(path):
    unnamed = [line for line, words in sentences(ast.parse(path.read_text())) if not words & NAMED]
    assert unnamed == [], f"lines of {path.name} whose message no test names"


def test_a_sentence_without_a_test_is_seen():
    sentence = " ".join(["zebras", "graze", "under", "water"])
    ((line, words),) = sentences(ast.parse(f'def f(x):\n    raise CaseError(f"{{x}}: {sentence}; give fewer")\n'))
    assert line == 2 and len(words) == 4 and not words & NAMED
