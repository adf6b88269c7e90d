# SPDX-License-Identifier: GPL-2.0-or-later
"""Tests that could not fail: without a check, or comparing a thing with itself."""

import ast
import tomllib
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
TREES = {path: ast.parse(path.read_text()) for path in sorted(TESTS.rglob("*.py"))}


def functions(tree: ast.AST) -> list[ast.FunctionDef]:
    """All functions and methods of a file."""
    return [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]


def checks_itself(function: ast.FunctionDef) -> bool:
    """Whether a function asserts something, or expects an exception."""
    for node in ast.walk(function):
        if isinstance(node, ast.Assert) or (isinstance(node, ast.Attribute) and node.attr in ("raises", "fail")):
            return True
    return False


def called(function: ast.FunctionDef) -> set[str]:
    """Names of the functions that a function calls."""
    calls = (node.func for node in ast.walk(function) if isinstance(node, ast.Call))
    return {f.id if isinstance(f, ast.Name) else getattr(f, "attr", "") for f in calls}


def checking() -> set[str]:
    """Names of functions of the tests that check something, by themselves or by what they call."""
    everything = [f for tree in TREES.values() for f in functions(tree)]
    found = {f.name for f in everything if checks_itself(f)}
    while more := {f.name for f in everything if called(f) & found} - found:
        found |= more
    return found


CHECKING = checking()


@pytest.mark.parametrize("path", [p for p in TREES if p.name.startswith("test_")], ids=lambda p: p.stem)
def test_every_test_checks_something(path):
    tests = [f.name for f in functions(TREES[path]) if f.name.startswith("test_")]
    assert tests and set(tests) <= CHECKING


@pytest.mark.parametrize("path", TREES, ids=lambda p: p.stem)
def test_nothing_is_compared_with_itself(path):
    for node in ast.walk(TREES[path]):
        if isinstance(node, ast.Assert):
            assert not isinstance(node.test, ast.Constant | ast.GeneratorExp | ast.Lambda), node.lineno
        if isinstance(node, ast.Compare):
            sides = [ast.unparse(side) for side in (node.left, *node.comparators)]
            assert len(set(sides)) == len(sides), f"line {node.lineno}: {ast.unparse(node)}"


PLANTED = [tomllib.loads(path.read_text()) for path in TESTS.glob("faults/planted/*.toml")]
FAULTS = {name: fault for faults in PLANTED for name, fault in faults.items()}


@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS)
def test_a_planted_fault_names_a_text_and_a_test_that_exist(fault):
    assert fault["old"] in (TESTS.parent / fault["file"]).read_text(), "the text has changed; update the fault"
    file, _, name = fault["test"].partition("::")
    assert name.partition("[")[0] in {f.name for f in functions(TREES[TESTS / file])}
