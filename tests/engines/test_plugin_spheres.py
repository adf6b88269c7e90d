# SPDX-License-Identifier: GPL-2.0-or-later
"""Neighbour lists, lists of triangles, integration and gravity: ours and LIGGGHTS's own do not differ in one bit."""

import re

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from plugin_decks import Bodies, contact, good, head, materials, per_pair
from test_plugin_mesh import BOX, COLUMNS, HALF, ROOM

pytestmark = pytest.mark.liggghts

PITCH, SIDE = 3.9e-3, 7  # of the grid on which spheres begin [m]; their number along an edge
PERIOD = ((-SIDE / 2 * PITCH, SIDE / 2 * PITCH),) * 3
FEATURES = {
    "boundary": ("f f f", "s s s", "p p p", "p f f"),
    "dimension": (3, 2),
    "moving": ("all", "some"),
    "gravity": ("constant", "varies"),
    "lists": ("", "exclude type 1 2", "contact_distance_factor 1.1 delay 200", "include some"),
    "then": ("", "neighbor 9e-4 bin", "neighbor 2e-4 bin", "delete_atoms group few", "set group few diameter 3.5e-3"),
    "mesh": ("at rest", "moves"),
}
PLAIN = {name: options[0] for name, options in FEATURES.items()} | {"ranks": 1}
SQUEEZED = {"boundary": "p p p", "then": "fix squeeze all deform 1 x erate -50 remap x"}  # moves spheres after forces
STREAMING = {"boundary": "p p p", "then": "fix squeeze all deform 1 x erate -50 remap v"}  # velocities of images differ
GROWING = {
    "boundary": "p p p",
    "then": "variable d equal 3.6e-3*(1+step/5e4)\nfix grow all adapt 1 atom diameter v_d",
}
SCENES = [
    {},
    {"mesh": "moves", "ranks": 2},
    SQUEEZED,
    STREAMING,
    GROWING,
    *({k: v} for k, options in FEATURES.items() for v in options[1:]),
]


def bodies(scene):
    """Spheres of three types in contact with each other: in a corner of the box of triangles, or, where the room is
    periodic, all around the box, which is smaller."""
    rng = np.random.default_rng(3)
    flat, periodic = scene["dimension"] == 2, scene["boundary"].startswith("p")
    sides = [range(SIDE), range(SIDE), [SIDE // 2] if flat else range(SIDE)]
    grid = np.stack(np.meshgrid(*sides, indexing="ij"), -1).reshape(-1, 3)
    x = (grid - SIDE // 2) * PITCH if periodic else 1.95e-3 - HALF + PITCH * grid
    x = x + rng.uniform(-1e-4, 1e-4, x.shape)
    v, spin = rng.uniform(-10, 10, x.shape), rng.uniform(-500, 500, x.shape)
    if flat:
        x[:, 2] = v[:, 2] = spin[:, 0] = spin[:, 1] = 0.0
    found = Bodies(rng.integers(1, 4, len(x)), rng.uniform(1.6e-3, 2.0e-3, len(x)), x, v, spin)
    far = np.abs(x).max(axis=1) > 0.9 * PITCH
    return Bodies(*(values[far] for values in (found.type, found.radius, x, v, spin))) if periodic else found


def deck(scene):
    f = PLAIN | scene
    flat = f["dimension"] == 2
    plate = contact("ep/thornton", wall="mesh", tangential="history")
    if f["boundary"].startswith("p"):
        plate = plate.replace("plate.stl type 2", "plate.stl type 2 scale 0.07")
    words = {
        "all": "fix move all nve/sphere\n",
        "some": "group others subtract all some\nfix still others freeze\nfix move some nve/sphere\n",
        "constant": "fix g all gravity 9810 vector 0.3 0.1 -1\n",
        "varies": "variable g equal 9810*(1+step/1000)\nfix g all gravity v_g vector 0.3 0.1 -1\n",
        "at rest": "",
        "moves": "fix turn all move/mesh mesh plate linear 1 0 2\n",
    }
    return (
        ("dimension 2\n" if flat else "")
        + head(boundary=f["boundary"][:-1] + ("p" if flat else f["boundary"][-1]), ranks=(f["ranks"], 1, 1))
        + "read_data box.data\nneighbor 5e-4 bin\ngroup some id <= 60\ngroup few id 3:30\n"
        + ("atom_modify first some\n" if "include" in f["lists"] else "")
        + materials("ep/any")
        + per_pair("coefficientRestitution", 0.7)
        + plate
        + "timestep 2e-7\n"
        + "".join(words[f[name]] for name in ("moving", "gravity", "mesh"))
        + ("fix flat all enforce2d\n" if flat else "")
        + (f"neigh_modify {f['lists']}\n" if f["lists"] else "")
        + "thermo_style custom step atoms ke f_g\nthermo 50\nthermo_modify lost ignore norm no format float %.17g\n"
        + f"dump d all custom 50 out.bin {COLUMNS}\nrun 500\n{f['then']}\nrun 500\n"
    )


def outcome(folder, text, scene, **env):
    """(frames, rows of thermo with the potential energy, lists made and pairs in them)."""
    f = PLAIN | scene
    room = [PERIOD[k] if side == "p" else ROOM[k] for k, side in enumerate(f["boundary"].split())]
    files = {"box.data": bodies(f).data(room), "plate.stl": BOX}
    done = good(folder, text, ranks=f["ranks"], files=files, env=env)
    rows = re.findall(r"^ *\d+ +\d+ +\S+ +\S+ *$", done.text, re.MULTILINE)
    lists = re.findall(r"Total # of neighbors = \d+|Neighbor list builds = \d+|Dangerous builds = \d+", done.text)
    return done.frames()[1], rows, lists


def compare(folder, scene, *instructions):
    """Runs with LIGGGHTS's own loops and with ours, for each instruction set; the former's frames, rows and lists."""
    text = deck(scene)
    theirs, rows, lists = outcome(folder / "generic", text, scene, EPDEM_LOOP="generic")
    for simd in instructions:
        ours, our_rows, our_lists = outcome(folder / f"ours{simd}", text, scene, EPDEM_SIMD=simd)
        assert our_rows == rows and our_lists == lists
        assert len(ours) == len(theirs) and all(map(np.array_equal, ours, theirs))
    return theirs, rows, lists


def name_of(scene):
    """Its features, of a feature of two lines the last."""
    return ", ".join(str(value).rpartition("\n")[2] for value in scene.values()) or "plain"


@pytest.mark.parametrize("scene", SCENES, ids=name_of)
def test_lists_and_motion_of_both_loops_give_the_same_bits(tmp_path, scene):
    frames, rows, lists = compare(tmp_path, scene, "", *([] if scene else ["sse2"]))
    assert len(frames) == 21 and len(rows) == 22 and len(set(rows)) >= 21
    assert int(lists[-2].rpartition(" ")[2]) > 1 and int(lists[0].rpartition(" ")[2]) > 20
    assert np.abs(frames[-1][:, 7:10]).max() > 0


@settings(max_examples=10, phases=[Phase.explicit, Phase.generate])
@given(scene=st.fixed_dictionaries({name: st.sampled_from(options) for name, options in FEATURES.items()}))
def test_any_features_together_give_the_same_bits(tmp_path_factory, scene):
    compare(tmp_path_factory.mktemp("scene"), scene, "")
