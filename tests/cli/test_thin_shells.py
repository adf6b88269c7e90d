# SPDX-License-Identifier: GPL-2.0-or-later
"""Commands are thin: what each does is a function for programs, and none computes."""

import ast
import importlib
import inspect
from pathlib import Path

import pytest
from calls import COMMANDS

import epdem.cli

PACKAGE = Path(epdem.cli.__file__).parents[1]
FILES = [*sorted(PACKAGE.glob("cli/*.py")), *sorted(PACKAGE.glob("verification/cli/*.py"))]
PHYSICS = ("numpy", "epdem.theory", "epdem.laws", "scipy", "h5py")
# The function of each command.
FUNCTIONS = {
    "run": ("epdem.impacts.run", "run"),
    "deck": ("epdem.impacts.run", "write_deck"),
    "predict": ("epdem.impacts.prediction", "predict"),
    "doctor": ("epdem.engines.doctor", "examine"),
    "verify crosscheck": ("epdem.verification.engine_comparison", "crosscheck"),
    "verify motion": ("epdem.verification.motion.compare", "compare"),
    "theory": ("epdem.studies.one_impact", "one_impact"),
    "verify figures": ("epdem.verification.figures", "draw_all"),
    "timestep": ("epdem.impacts.timestep", "search"),
    "verify cost": ("epdem.verification.cost", "run"),
    "verify stability": ("epdem.verification.stability", "run"),
    "explain": ("epdem.liggghts.explain", "explain_case"),
    "soften": ("epdem.studies.soften", "soften"),
    "calibrate": ("epdem.studies.fit", "fit"),
    "sweep": ("epdem.studies.sweep.executors", "execute"),
    "status": ("epdem.studies.sweep.status", "status"),
    "tune": ("epdem.studies.tune", "tune"),
    "verify rerun": ("epdem.verification.rerun", "rerun"),
    "cite": ("epdem.engines.citations", "citations"),
    "header": ("epdem.liggghts.header", "write"),
    "view": ("epdem.scenes.pictures", "before"),
    "verify data": ("epdem.verification.measured_data", "validate"),
}


def test_the_table_has_every_command():
    assert set(FUNCTIONS) == set(COMMANDS)


def imports(path: Path) -> set[tuple[str, str]]:
    """(module, name) of what a file of the commands imports anywhere in it."""
    found, here = set(), ("epdem", *path.parent.relative_to(PACKAGE).parts)
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom):
            base = here[: len(here) - node.level + 1] if node.level else ()
            module = ".".join(filter(None, [*base, node.module]))
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


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.relative_to(PACKAGE).as_posix())
def test_no_command_computes(path):
    """Formulas are in the rooms below, whose names a view alone may print."""
    if path.name != "show.py":
        wrong = [module for module, name in imports(path) if f"{module}.{name}".startswith(PHYSICS)]
        assert not wrong
