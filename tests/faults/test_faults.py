# SPDX-License-Identifier: GPL-2.0-or-later
"""A test that cannot fail is a defect: each fault planted here must turn the named test red.

The faults are in `planted/*.toml`. Each is an exact replacement of text in a copy of the project, which is then built
and tested. Text that is not there any more fails the test. Nothing in the product knows of faults.
"""

import os
import shutil
from pathlib import Path

import pytest
from planting import Fault, faults, planted, with_switches
from workshop import PYTHON, ROOT, Runner, build_lammps, build_library, build_yade, program, with_one_instruction_set

SWITCHED = ("library", "plugin", "lammps", "yade")  # all faults of one in one build
ROOMS = [path.stem for path in sorted((Path(__file__).parent / "planted").glob("*.toml")) if path.stem not in SWITCHED]
FAULTS, OF_LIBRARY, OF_PLUGIN, OF_LAMMPS, OF_YADE = faults(*ROOMS), *(faults(name) for name in SWITCHED)
EVERY = -(-len(FAULTS) // 10)
HALVES = [sorted({fault.test for fault in FAULTS})[half::2] for half in (0, 1)]


def needs_an_engine(test: str) -> bool:
    """Whether the engine that a test names in its parameters, or YADE's module, is missing."""
    if ("test_yade_phases" in test or "test_yade_plates" in test) and not {"YADE_SOURCE", "EPDEM_YADE_MODULE"} & {
        *os.environ
    }:
        return True
    return any(name in test.partition("[")[2] and not shutil.which(name) for name in ("liggghts", "yade"))


def test_every_planted_fault_has_its_own_name_and_a_text_and_a_test_that_exist():
    everything = FAULTS + OF_LIBRARY + OF_PLUGIN + OF_LAMMPS + OF_YADE
    assert len(everything) >= 40 and len({fault.name for fault in everything}) == len(everything)
    for fault in everything:
        planted(fault, (ROOT / fault.file).read_text())
        file, _, name = fault.test.partition("[")[0].partition("::")
        assert f"def {name}(" in (ROOT / "tests" / file).read_text(), fault.test
        for text in (fault.old, fault.new) if fault not in FAULTS else ():  # of expressions, all in one build
            assert all(text.count(a) == text.count(b) for a, b in ("()", "[]", "{}")), f"{fault.name}: {text}"
            assert not text.startswith(("const ", "if ", "return ")), f"{fault.name}: {text}"


def later(n: int, fault: Fault) -> list[pytest.MarkDecorator]:
    """The suite plants one of EVERY faults, but none that needs a build."""
    return [pytest.mark.faults] * (n % EVERY > 0 or fault.file.startswith("cpp_contact"))


@pytest.mark.parametrize("fault", [pytest.param(f, marks=later(n, f), id=f.name) for n, f in enumerate(FAULTS)])
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


@pytest.mark.faults
@pytest.mark.parametrize("tests", HALVES, ids=["first half", "second half"])
def test_every_named_test_is_green_without_a_fault(tests, tests_of_copy):
    """In two processes, one for each core."""
    done = tests_of_copy.run(*(f"tests/{test}" for test in tests if not needs_an_engine(test)))
    assert done.returncode == 0, done.stdout[-3000:]


def all_turn_red(folder: Path, found: list[Fault], env: dict[str, str] | None = None) -> None:
    """Every named test is green while no fault is switched on, and red with its own."""
    tests = Runner(folder, env, "epdem.engines", "epdem.scenes.run", "epdem.impacts.run")
    done = tests.run(*sorted({f"tests/{fault.test}" for fault in found}))
    assert done.returncode == 0, done.stdout[-3000:]
    codes = [tests.run(f"tests/{fault.test}", env={"PLANTED": str(n)}).returncode for n, fault in enumerate(found, 1)]
    reds = dict(zip((fault.name for fault in found), codes, strict=True))
    tests.close()
    assert reds == dict.fromkeys(reds, 1), "a test did not fail"


@pytest.mark.faults
def test_planted_faults_of_the_library_turn_their_tests_red(spoilt):
    build_library(spoilt, with_switches(spoilt, OF_LIBRARY))
    all_turn_red(spoilt, OF_LIBRARY)


@pytest.mark.liggghts
@pytest.mark.faults
def test_planted_faults_of_the_plugin_turn_their_tests_red(plugin):
    all_turn_red(plugin, OF_PLUGIN, {"EPDEM_LIGGGHTS": str(program(plugin))})


@pytest.mark.lammps
@pytest.mark.faults
def test_planted_faults_of_the_plugin_for_lammps_turn_their_tests_red(spoilt):
    build_lammps(with_one_instruction_set(spoilt), with_switches(spoilt, OF_LAMMPS))
    all_turn_red(spoilt, OF_LAMMPS)


@pytest.mark.yade("module")
@pytest.mark.skipif("YADE_SOURCE" not in os.environ, reason="YADE_SOURCE names no source of YADE")
@pytest.mark.faults
def test_planted_faults_of_the_module_for_yade_turn_their_tests_red(spoilt):
    module = build_yade(spoilt, with_switches(spoilt, OF_YADE))
    all_turn_red(spoilt, OF_YADE, {"EPDEM_YADE_MODULE": str(module)})
