# SPDX-License-Identifier: GPL-2.0-or-later
"""Rooms of the package stand in an order, and no module needs itself on the way round."""

import graphlib

import pytest
from modules import FILES, MODULES, imports, module_of

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


def room(module: str) -> str:
    """The first name below the package."""
    return module.split(".")[1] if "." in module else "__init__"


@pytest.mark.parametrize("path", FILES, ids=module_of)
def test_a_room_uses_lower_rooms_alone(path):
    here = room(module_of(path))
    level, wrong = LEVEL.get(here, -1), set()
    for there in map(room, imports(path) & MODULES):
        if there != here and LEVEL.get(there, 99) >= level:
            wrong.add(there)
    assert not wrong


def test_no_module_needs_itself():
    graph = {module_of(path): imports(path) & MODULES - {module_of(path)} for path in FILES}
    order = list(graphlib.TopologicalSorter(graph).static_order())  # CycleError names the way round
    assert len(order) == len(graph) > 50
