# SPDX-License-Identifier: GPL-2.0-or-later
import os

import pytest
from planting import faults, with_switches
from sub_models import add_models
from workshop import Runner, build_plugin, copy_of_project, with_one_instruction_set

from engines.yade_native import module_folder


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the project, with no compiled parts of its own."""
    return copy_of_project(tmp_path_factory.mktemp("copy"))


@pytest.fixture(scope="module")
def tests_of_copy(copy):
    """Runs tests of that copy."""
    tests = Runner(copy, {"EPDEM_YADE_MODULE": str(module_folder())} if "YADE_SOURCE" in os.environ else None)
    yield tests
    tests.close()


@pytest.fixture
def spoilt(tmp_path_factory):
    """A copy of the project for all faults of the library."""
    return copy_of_project(tmp_path_factory.mktemp("spoilt"))


@pytest.fixture(scope="session")
def plugin(shared):
    """A copy of the project whose plugin has the new sub-models, and all faults of the plugin behind switches."""

    def build(folder):
        with_one_instruction_set(copy_of_project(folder))
        add_models(folder)
        build_plugin(folder, with_switches(folder, faults("plugin")))

    return shared("plugin", build)
