# SPDX-License-Identifier: GPL-2.0-or-later
"""The package explains itself: every public name says what it is."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "python" / "epdem"
FILES = sorted(PACKAGE.rglob("*.py"))
DEFINITIONS = ast.FunctionDef | ast.ClassDef


def public(body: list[ast.stmt]) -> list[DEFINITIONS]:
    """Definitions without a leading underscore."""
    return [node for node in body if isinstance(node, DEFINITIONS) and not node.name.startswith("_")]


def said_elsewhere() -> set[str]:
    """Names of methods that some class explains: another class that has them fills the same place."""
    classes = (n for path in FILES for n in ast.walk(ast.parse(path.read_text())) if isinstance(n, ast.ClassDef))
    return {method.name for c in classes for method in public(c.body) if ast.get_docstring(method)}


KNOWN = said_elsewhere()


def unexplained(path: Path) -> list[str]:
    """Public names of a file without a docstring, but for those whose body is one statement, and so says it itself."""
    tree = ast.parse(path.read_text())
    missing = [] if ast.get_docstring(tree) or path.name == "__init__.py" else ["the module"]
    for node in public(tree.body):
        methods = public(node.body) if isinstance(node, ast.ClassDef) else []
        for one in [node, *(m for m in methods if m.name not in KNOWN)]:
            if not ast.get_docstring(one) and len(one.body) > 1:
                missing.append(one.name)
    return missing


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_public_names_have_docstrings(path):
    assert unexplained(path) == []
