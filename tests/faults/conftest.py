# SPDX-License-Identifier: GPL-2.0-or-later
import pytest
from workshop import Runner, copy_of_project


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the project, with no compiled parts of its own."""
    return copy_of_project(tmp_path_factory.mktemp("copy"))


@pytest.fixture(scope="module")
def tests_of_copy(copy):
    """Runs tests of that copy."""
    tests = Runner(copy)
    yield tests
    tests.close()


@pytest.fixture
def spoilt(tmp_path_factory):
    """A copy of the project for all faults of a compiled part."""
    return copy_of_project(tmp_path_factory.mktemp("spoilt"))
