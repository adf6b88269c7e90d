# SPDX-License-Identifier: GPL-2.0-or-later
"""Adding a model of friction, rolling friction or cohesion takes one header and one line in its list."""

import re
import sys

import numpy as np
import pytest
from sub_models import HEADERS
from workshop import ROOT, program

sys.path.insert(0, str(ROOT / "tests" / "engines"))

from plugin_loop import SAID, SAID_OF_WALLS, Scene, outcome

pytestmark = [pytest.mark.liggghts, pytest.mark.slow]


@pytest.fixture
def launcher(plugin):
    """LIGGGHTS with a new model of each kind."""
    return str(program(plugin))


@pytest.mark.parametrize("kind", [{"tangential": "ep/toy"}, {"rolling": "ep/toy"}, {"cohesion": "ep/toy"}], ids=str)
def test_a_new_model_runs_in_both_loops_with_the_same_bits(launcher, tmp_path, kind):
    scene = Scene(**{"rolling": "epsd2", "types": 3, "loose": True, "walls": True} | kind)
    ours, said = outcome(tmp_path / "ours", scene, command=launcher)
    theirs, _ = outcome(tmp_path / "generic", scene, loop="generic", command=launcher)
    assert SAID not in said and SAID_OF_WALLS not in said
    assert np.array_equal(ours, theirs)
    without = Scene(**vars(scene) | {"settings": ()} | {name: "off" for name in kind})
    assert not np.array_equal(ours, outcome(tmp_path / "without", without, command=launcher)[0])


def test_the_manual_says_what_this_test_does():
    section = ROOT.joinpath("ARCHITECTURE.md").read_text().split("## Add a sub-model")[1].split("## ")[0]
    assert all(re.search(rf"`{kind}/`", section) for kind in HEADERS) and "`sub_models.hpp`" in section
