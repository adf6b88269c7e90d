# SPDX-License-Identifier: GPL-2.0-or-later
"""Commands are thin: what each does is a function for programs, and none computes."""

import ast
import importlib
import inspect
from pathlib import Path

import pytest
from calls import COMMANDS

import epdem.cli

FILES = sorted(Path(epdem.cli.__file__).parent.glob("*.py"))
PHYSICS = ("numpy", "epdem.theory", "epdem.laws", "scipy", "h5py")
# The function of each command.
FUNCTIONS = {
    "run": ("epdem.impacts.run", "run"),
    "deck": ("epdem.impacts.run", "write_deck"),
    "predict": ("epdem.impacts.prediction", "predict"),
    "doctor": ("epdem.engines.doctor", "examine"),
    "crosscheck": ("epdem.studies.crosscheck", "crosscheck"),
    "motion": ("epdem.studies.motions", "compare"),
    "theory": ("epdem.studies.one_impact", "one_impact"),
    "figures": ("epdem.studies.figures", "draw_all"),
    "timestep": ("epdem.impacts.timestep", "search"),
    "cost": ("epdem.studies.cost", "run"),
    "stability": ("epdem.studies.stability", "run"),
    "explain": ("epdem.liggghts.explain", "explain_case"),
    "soften": ("epdem.studies.soften", "soften"),
    "calibrate": ("epdem.studies.fit", "fit"),
    "sweep": ("epdem.studies.sweep.executors", "execute"),
    "status": ("epdem.studies.sweep.status", "status"),
    "tune": ("epdem.studies.tune", "tune"),
    "rerun": ("epdem.studies.rerun", "rerun"),
    "cite": ("epdem.engines.citations", "citations"),
    "header": ("epdem.liggghts.header", "write"),
    "view": ("epdem.scenes.pictures", "before"),
    "validate": ("epdem.studies.validate", "validate"),
}


def test_the_table_has_every_command():
    assert set(FUNCTIONS) == set(COMMANDS) - {"stress"}  # the old name of stability


def imports(path: Path) -> set[tuple[str, str]]:
    """(module, name) of what a file of the commands imports anywhere in it."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom):
            base = ".".join(["epdem.cli".rsplit(".", node.level - 1)[0]] if node.level else [])
            module = ".".join(filter(None, [base, node.module]))
            found |= {(module, alias.name) for alias in node.names}
        elif isinstance(node, ast.Import):
            found |= {(alias.name, "") for alias in node.names}
    return found


@pytest.mark.parametrize("command", FUNCTIONS)
def test_what_a_command_does_is_a_function_for_programs(command):
    module, name = FUNCTIONS[command]
    function = getattr(importlib.import_module(module), name)
    assert (inspect.signature(function).parameters and function.__doc__) or command == "doctor"
    package, _, last = module.rpartition(".")
    all_imports = set().union(*map(imports, FILES))
    assert {(module, name), (package, last)} & all_imports
    assert command in COMMANDS


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_no_command_computes(path):
    """Formulas are in the rooms below, whose names a view alone may print."""
    if path.name != "show.py":
        wrong = [module for module, name in imports(path) if f"{module}.{name}".startswith(PHYSICS)]
        assert not wrong
