# SPDX-License-Identifier: GPL-2.0-or-later
"""A test that cannot fail is a defect: each fault planted here must turn the named test red.

The faults are in `planted/*.toml`. Each is an exact replacement of text in a copy of the project, which is then built
and tested. Text that is not there any more fails the test. Nothing in the product knows of faults.
"""

import shutil
import tomllib
from dataclasses import dataclass
from pathlib import Path

import pytest
from workshop import PYTHON, Runner, build_library, build_plugin


@dataclass(frozen=True)
class Fault:
    """In `file`, `old` becomes `new`; `test`, a pytest node below tests/, must then fail."""

    name: str
    file: str
    old: str
    new: str
    test: str


def faults(*names: str) -> list[Fault]:
    """The faults of files in `planted`."""
    found = []
    for name in names:
        tables = tomllib.loads((Path(__file__).parent / "planted" / f"{name}.toml").read_text())
        found += [Fault(title, **table) for title, table in tables.items()]
    return found


ROOMS = [path.stem for path in sorted((Path(__file__).parent / "planted").glob("*.toml")) if path.stem != "plugin"]
FAULTS, OF_PLUGIN = faults(*ROOMS), faults("plugin")
HALVES = [sorted({fault.test for fault in FAULTS})[half::2] for half in (0, 1)]


def planted(fault: Fault, good: str, new: str | None = None) -> str:
    """The text of a file with the fault in it."""
    assert fault.old in good, f"{fault.file} does not contain {fault.old!r} any more; update the fault {fault.name!r}"
    return good.replace(fault.old, fault.new if new is None else new)


def needs_an_engine(test: str) -> bool:
    """Whether the engine that a test names in its parameters is missing."""
    return any(name in test.partition("[")[2] and not shutil.which(name) for name in ("liggghts", "yade"))


def test_there_are_faults_in_every_room():
    assert len(FAULTS) + len(OF_PLUGIN) >= 40
    assert len({fault.name for fault in FAULTS + OF_PLUGIN}) == len(FAULTS + OF_PLUGIN)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda f: f.name)
def test_a_planted_fault_turns_its_test_red(fault, copy, tests_of_copy):
    if needs_an_engine(fault.test):
        pytest.skip("the engine is not installed")
    path = copy / fault.file
    good = path.read_text()
    path.write_text(planted(fault, good))
    try:
        if fault.file.startswith("cpp_contact"):
            build_library(copy)
        done = tests_of_copy.run(f"tests/{fault.test}")
    finally:
        path.write_text(good)
        shutil.rmtree(copy / PYTHON / "native", ignore_errors=True)  # the next fault starts from sound parts
    assert done.returncode == 1, f"the test did not fail:\n{done.stdout[-2000:]}"


@pytest.mark.parametrize("tests", HALVES, ids=["first half", "second half"])
def test_every_named_test_is_green_without_a_fault(tests, tests_of_copy):
    """In two processes, one for each core."""
    done = tests_of_copy.run(*(f"tests/{test}" for test in tests if not needs_an_engine(test)))
    assert done.returncode == 0, done.stdout[-3000:]


# One build of the plugin has all its faults, each of which an environment variable switches on.
SWITCH = """#pragma once
#include <cstdlib>
template <int n>
inline bool planted() {
  static const bool on = [] {
    const char* chosen = std::getenv("PLANTED");
    return chosen && std::atoi(chosen) == n;
  }();
  return on;
}
"""


@pytest.mark.liggghts
def test_planted_faults_of_the_plugin_turn_their_tests_red(copy_of_plugin):
    """`old` and `new` are expressions."""
    for n, fault in enumerate(OF_PLUGIN, 1):
        path = copy_of_plugin / fault.file
        path.write_text(planted(fault, path.read_text(), f"(planted<{n}>() ? ({fault.new}) : ({fault.old}))"))
    (copy_of_plugin / "planted.hpp").write_text(SWITCH)
    launcher = build_plugin(copy_of_plugin, f"-O0 -include {copy_of_plugin}/planted.hpp")
    tests = Runner(copy_of_plugin, {"EPDEM_LIGGGHTS": str(launcher)})
    done = tests.run(*sorted({f"tests/{fault.test}" for fault in OF_PLUGIN}))
    assert done.returncode == 0, done.stdout[-3000:]
    reds = {
        fault.name: tests.run(f"tests/{fault.test}", env={"PLANTED": str(n)}).returncode
        for n, fault in enumerate(OF_PLUGIN, 1)
    }
    tests.close()
    assert reds == dict.fromkeys(reds, 1), "a test did not fail"
