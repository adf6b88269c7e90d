# SPDX-License-Identifier: GPL-2.0-or-later
"""Neighbour lists, lists of triangles, integration and gravity: ours and LIGGGHTS's own do not differ in one bit."""

import re

import numpy as np
import pytest
from plugin_decks import Bodies, contact, good, head, materials, per_pair
from test_plugin_mesh import COLUMNS, HALF, ROOM, box

pytestmark = pytest.mark.liggghts

ALL = "fix move all nve/sphere\nfix g all gravity 9810 vector 0.3 0.1 -1\n"
SCENES = {
    "all spheres": (ALL, 1),
    "two ranks, a moving mesh": (ALL + "fix turn all move/mesh mesh plate linear 1 0 2\n", 2),
    "some spheres": (
        "group some id <= 60\ngroup others subtract all some\nfix still others freeze\n"
        "fix move some nve/sphere\nfix g some gravity 9810 vector 0 0 -1\n",
        1,
    ),
    "gravity that varies": (
        "variable g equal 9810*(1+step/1000)\nfix g all gravity v_g vector 0 0 -1\nfix move all nve/sphere\n",
        1,
    ),
    "pairs left out": (ALL + "neigh_modify exclude type 1 2\n", 1),
    "lists of contacts at a distance": (ALL + "neigh_modify contact_distance_factor 1.1\n", 1),
    "shrink-wrapped, all on one side": (ALL, 1),
}


def bodies():
    """343 spheres of three types in a corner of the box, in contact with each other and with its walls."""
    rng = np.random.default_rng(3)
    grid = np.stack(np.meshgrid(*[np.arange(7)] * 3, indexing="ij"), -1).reshape(-1, 3)
    x = 1.95e-3 - HALF + 3.9e-3 * grid + rng.uniform(-1e-4, 1e-4, grid.shape)
    v, spin = rng.uniform(-10, 10, x.shape), rng.uniform(-500, 500, x.shape)
    return Bodies(rng.integers(1, 4, len(x)), rng.uniform(1.6e-3, 2.0e-3, len(x)), x, v, spin)


def deck(words, ranks, boundary):
    return (
        head(boundary=boundary, ranks=(ranks, 1, 1))
        + "read_data box.data\nneighbor 5e-4 bin\n"
        + materials("ep/any")
        + per_pair("coefficientRestitution", 0.7)
        + contact("ep/thornton", wall="mesh", tangential="history")
        + "timestep 2e-7\n"
        + words
        + "thermo_style custom step atoms ke f_g\nthermo 50\nthermo_modify lost error norm no format float %.17g\n"
        + f"dump d all custom 50 out.bin {COLUMNS}\nrun 1500\n"
    )


def outcome(folder, text, ranks, **env):
    """(frames, rows of thermo with the potential energy, lists made and pairs in them)."""
    done = good(folder, text, ranks=ranks, files={"box.data": bodies().data(ROOM), "plate.stl": box()}, env=env)
    rows = re.findall(r"^ *\d+ +343 +\S+ +\S+ *$", done.text, re.MULTILINE)
    lists = re.findall(r"Total # of neighbors = \d+|Neighbor list builds = \d+", done.text)
    return done.frames()[1], rows, lists


@pytest.mark.parametrize("scene", SCENES)
def test_lists_and_motion_of_both_loops_give_the_same_bits(tmp_path, scene):
    words, ranks = SCENES[scene]
    text = deck(words, ranks, "s s s" if scene.startswith("shrink") else "f f f")
    theirs, rows, lists = outcome(tmp_path / "generic", text, ranks, EPDEM_LOOP="generic")
    assert len(theirs) == len(rows) == 31 and len(set(rows)) == 31
    assert int(lists[-1].rpartition(" ")[2]) > 5 and int(lists[0].rpartition(" ")[2]) > 300
    assert np.abs(theirs[-1][:, 7:10]).max() > 0
    for simd in ("", "sse2"):
        ours, our_rows, our_lists = outcome(tmp_path / f"ours{simd}", text, ranks, EPDEM_SIMD=simd)
        assert np.array_equal(ours, theirs) and our_rows == rows and our_lists == lists
