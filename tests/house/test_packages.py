# SPDX-License-Identifier: GPL-2.0-or-later
"""Rooms of the package stand in an order, and no module needs itself on the way round."""

import ast
import graphlib
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "python" / "epdem"
# A room uses rooms of the lines above it; rooms of one line do not use each other.
ORDER = """
__init__ errors
base
report
theory
laws
case
impacts
scenes
lammps
liggghts yade
engines
studies
api
cli
"""
LEVEL = {room: level for level, line in enumerate(ORDER.split("\n")) for room in line.split()}
FILES = sorted(PACKAGE.rglob("*.py"))


def module_of(path: Path) -> str:
    """The dotted name of a file of the package."""
    return ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__")


MODULES = {module_of(path) for path in FILES}


def imports(path: Path) -> set[str]:
    """Modules of the package that a file imports anywhere in it, in functions too."""
    parts, found = path.relative_to(PACKAGE.parent).with_suffix("").parts, set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = ".".join([*parts[: len(parts) - node.level], *filter(None, [node.module])])
            base = base if node.level else str(node.module)
            # a name of a package is a module, or else something that the package's own file holds
            found |= {f"{base}.{a.name}" if f"{base}.{a.name}" in MODULES else base for a in node.names}
    return found & MODULES


def room(module: str) -> str:
    """The first name below the package."""
    return module.split(".")[1] if "." in module else "__init__"


@pytest.mark.parametrize("path", FILES, ids=module_of)
def test_a_room_uses_lower_rooms_alone(path):
    here = room(module_of(path))
    level, wrong = LEVEL.get(here, -1), set()
    for there in map(room, imports(path)):
        if there != here and LEVEL.get(there, 99) >= level:
            wrong.add(there)
    assert not wrong


def test_no_module_needs_itself():
    graph = {module_of(path): imports(path) - {module_of(path)} for path in FILES}
    order = list(graphlib.TopologicalSorter(graph).static_order())  # CycleError names the way round
    assert len(order) == len(graph) > 50
