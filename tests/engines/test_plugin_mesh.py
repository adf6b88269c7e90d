# SPDX-License-Identifier: GPL-2.0-or-later
"""Mesh walls of our models: our loops, which skip what cannot touch and compute contacts as lanes, and LIGGGHTS's own
do not differ in one bit. A sphere has one contact over a face, an edge or a corner."""

import re

import numpy as np
import pytest
from plugin_decks import Bodies, contact, good, head, materials, per_pair, run
from triangles import cube, plate

from epdem.scenes.plan.meshes import stl_text
from marks import thorough

pytestmark = pytest.mark.liggghts

HALF = 0.02  # of the edge of a box of triangles [m]
ROOM = ((-0.05, 0.05),) * 3
BOX = stl_text("plate", cube(HALF, 3))
COLUMNS = "id x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz"
LOCAL = " ".join(f"c_w[{k}]" for k in range(1, 7))
MOVES = {
    "at rest": "",
    "moving": "fix turn all move/mesh mesh plate rotate origin 0 0 0 axis 0 1 0 period 0.01\n",
    "shaken": "fix shake all move/mesh mesh plate wiggle amplitude 0.002 0 0.001 period 0.002\n",
    "pushed": "fix push all move/mesh mesh plate linear 30 0 0\n",
    "coarse": "",
    "growing": "variable d equal 3e-3*(1+step/2500)\nfix grow all adapt 1 atom diameter v_d\n",
}
STILL = {"pushed", "growing"}  # spheres begin at rest


def bodies(speed=30):
    """125 spheres of three types in the box, the outer ones next to its walls, thrown at random."""
    rng = np.random.default_rng(7)
    grid = np.stack(np.meshgrid(*[np.arange(5)] * 3, indexing="ij"), -1).reshape(-1, 3)
    radius = rng.uniform(1.5e-3, 2.5e-3, len(grid))
    x = (grid - 2) * 8e-3 + rng.uniform(-1e-3, 1e-3, grid.shape)
    x = np.clip(x, radius[:, None] - HALF, HALF - radius[:, None])
    v = rng.uniform(-speed, speed, x.shape)
    return Bodies(rng.integers(1, 4, len(x)), radius, x, v, rng.uniform(-500, 500, x.shape))


def deck(law, tangential, move, *, ranks=1, steps=3000, stress=False, restart=None, end=""):
    law, _, settings = law.partition(" ")
    text = (
        head(ranks=(ranks, 1, 1))
        + (f"read_restart {restart}\n" if restart else "read_data box.data\n")
        + "neighbor 5e-4 bin\n"
        + materials(f"ep/{law}")
        + per_pair("coefficientRestitution", 0.7)
        + contact(f"ep/{law}", wall="mesh", tangential=tangential, settings=settings)
        + f"fix floor all wall/gran model ep/{law} tangential off primitive type 1 zplane -0.045 {settings}\n"
        + MOVES[move]
        + "timestep 2e-7\nfix move all nve/sphere\nthermo_modify lost error norm no\nthermo 1000\n"
        + f"dump d all custom 50 out.bin {COLUMNS}\n"
        + f"compute w all wall/gran/local id force\ndump w all local 500 walls.txt {LOCAL}\n"
        + f"run {steps}\n{end}"
    )
    text = text.replace("plate.stl type 2", "plate.stl type 2 precision 5e-4") if move == "coarse" else text
    text = text.replace("fix move all nve/sphere\n", "") if move == "growing" else text  # growth alone makes contacts
    return text.replace("mesh/surface file", "mesh/surface/stress file") if stress else text


def outcome(folder, text, *, loop="", ranks=1, speed=30):
    """(all frames, the table of wall contacts) of a run, whose log names the steps of the table."""
    files = {"box.data": bodies(speed).data(ROOM), "plate.stl": BOX}
    done = good(folder, text, ranks=ranks, files=files, env={"EPDEM_LOOP": loop} if loop else None)
    reason = (
        "contacts with adhesion" if "ep/jkr" in text else "EPDEM_LOOP" if loop else "steps of compute wall/gran/local"
    )
    assert f"wall loop of LIGGGHTS for {reason}" in done.text and "for compaction" not in done.text
    return done.frames()[1], (folder / "walls.txt").read_text()


CASES = [
    ("thornton", "history", "moving", 1),
    ("thornton", "history", "shaken", 1),
    ("cavity", "off", "at rest", 1),
    ("hertz", "history", "at rest", 2),
    ("hertz", "no_history", "moving", 1),
    ("johnson", "history", "moving", 2),
    ("cavity", "ep/partial_slip", "moving", 1),
    ("cavity compaction on", "history", "moving", 2),
    ("cavity computePlasticWork on compaction on", "off", "shaken", 1),
    ("jkr", "history", "moving", 1),
    *(("thornton", "history", move, 1) for move in ("pushed", "coarse", "growing")),
]


@pytest.mark.parametrize(
    ("law", "tangential", "move", "ranks"),
    [thorough(*case, unless=case[0] in ("thornton", "jkr") or "compaction" in case[0]) for case in CASES],
    ids=lambda value: str(value).replace(" ", "_"),
)
def test_both_loops_over_triangles_give_the_same_bits(tmp_path, law, tangential, move, ranks):
    text = deck(law, tangential, move, ranks=ranks, stress=move == "at rest")
    speed = 0 if move in STILL else 30
    theirs, their_walls = outcome(tmp_path / "generic", text, loop="generic", ranks=ranks, speed=speed)
    ours, our_walls = outcome(tmp_path / "ours", text, ranks=ranks, speed=speed)
    assert len(ours) == 61 and np.array_equal(ours, theirs)
    assert our_walls == their_walls
    touching = [np.abs(frame[:, 7:10]).sum(axis=1) > 0 for frame in theirs]
    assert max(np.sum(b & ~a) for a, b in zip(touching, touching[1:], strict=False)) > 3  # contacts begin
    if move != "growing":
        assert max(np.sum(a & ~b) for a, b in zip(touching, touching[1:], strict=False)) > 3


def test_a_simulation_after_another_in_one_program_has_the_bits_of_one_alone(tmp_path):
    text = deck("thornton", "history", "moving", steps=1000)
    before = deck("cavity", "off", "shaken", steps=700)
    before = before.replace("out.bin", "before.bin").replace("walls.txt", "before.txt")
    alone, walls = outcome(tmp_path / "alone", text)
    after, walls_after = outcome(tmp_path / "after", before + "clear\n" + text)
    assert len(after) == 21 and np.array_equal(after, alone) and walls_after == walls


def test_a_restart_goes_on_with_the_other_loop_over_triangles(tmp_path):
    ends = []
    for first in ("", "generic"):
        folder = tmp_path / f"first{first}"
        text = deck("thornton", "history", "at rest", steps=1000, end="write_restart x.restart\n")
        outcome(folder, text, loop=first)
        for second in ("", "generic"):
            text = deck("thornton", "history", "at rest", steps=1000, restart=folder / "x.restart")
            ends.append(outcome(tmp_path / f"{first}-{second}", text, loop=second)[0][-1])
    assert len(ends) == 4 and all(np.array_equal(ends[0], e) for e in ends[1:])


def of_meshes(folder, loop, *meshes):
    """Motion of two spheres that roll on a plate each, and forces and torques on those of the plates that are meshes of
    the wall; the right one turns."""
    words = "model ep/hertz tangential history rolling_friction cdt"
    text = head() + "read_data box.data\nneighbor 5e-4 bin\n" + materials("ep/hertz")
    text += per_pair("coefficientRollingFriction", 0.1) + f"pair_style gran {words}\npair_coeff * *\n"
    for name in meshes:
        text += f"fix {name} all mesh/surface/stress file {name}.stl type {2 if name == 'left' else 3}\n"
    text += f"fix wall all wall/gran {words} mesh n_meshes {len(meshes)} meshes {' '.join(meshes)}\n"
    turn = "fix turn all move/mesh mesh right rotate origin 0.006 0 0 axis 0 1 0 period 0.01\n"
    text += turn * ("right" in meshes) + "timestep 1e-7\nfix move all nve/sphere\nthermo 20\n"
    text += f"thermo_style custom step {' '.join(f'f_{m}[{k}]' for m in meshes for k in range(1, 7))}\n"
    text += f"thermo_modify lost error norm no format float %.17g\ndump d all custom 20 out.bin {COLUMNS}\nrun 100\n"
    x, v = [[-6e-3, 0, 1.99e-3], [6e-3, 0, 1.99e-3]], [[3.0, 0, -1], [3.0, 0, -1]]
    spheres = Bodies(np.array([1, 1]), np.full(2, 2e-3), np.array(x), np.array(v), np.full((2, 3), 200.0))
    files = {"box.data": spheres.data(ROOM), "left.stl": plate((-0.03, -1e-3)), "right.stl": plate((1e-3, 0.03))}
    done = good(folder, text, files=files, env={"EPDEM_LOOP": loop} if loop else None)
    rows = re.findall(rf"^ *\d+((?: +[\d.e+-]+){{{6 * len(meshes)}}}) *$", done.text, re.MULTILINE)
    return done.frames()[1], np.array([row.split() for row in rows], float).reshape(6, len(meshes), 6)


@pytest.mark.parametrize("loop", ["", "generic"], ids=["ours", "generic"])
def test_each_mesh_of_a_wall_has_its_material_motion_and_sums(loop, tmp_path):
    """As where it is the only one."""
    both, on_both = of_meshes(tmp_path / "both", loop, "left", "right")
    for k, mesh in enumerate(("left", "right")):
        alone, on_mesh = of_meshes(tmp_path / mesh, loop, mesh)
        assert np.array_equal(both[:, k], alone[:, k]) and np.array_equal(on_both[:, k], on_mesh[:, 0])
        assert np.abs(on_mesh[1:3, 0, [0, 2, 4]]).min() > 0  # until the sphere rebounds


LATER = {
    "same ids": ([], False, ""),
    "another wall": ([("fix floor", "fix ground")], False, "id ground: the restart file holds contacts of walls"),
    "another mesh": ([("plate all", "sheet all"), ("meshes plate", "meshes sheet")], False, "with the ids plate, and"),
    "a run before": ([], True, "id floor: its contacts of the restart file ended with the first run"),
    "a new wall after a run": ([("fix floor", "fix ground")], True, ""),
}


@pytest.mark.parametrize("what", LATER)
def test_a_wall_that_would_lose_its_dents_after_a_restart_is_refused(what, tmp_path):
    """The mesh and the floor are each a wall; `run 0` before the floor: it comes after the first run."""
    changes, late, wrong = LATER[what]
    first = deck("thornton", "history", "at rest", steps=20, end="write_restart x.restart\n")
    again = deck("thornton", "history", "at rest", steps=20, restart="x.restart").replace("out.bin", "again.bin")
    if late:
        again = re.sub("compute w .*\n|dump w .*\n", "", again)  # LIGGGHTS refuses them after a run
        again = again.replace("fix floor", "timestep 2e-7\nrun 0\nfix floor")
    for old, new in changes:
        assert again.count(old) == 1
        again = again.replace(old, new)
    done = run(tmp_path, first + "clear\n" + again, files={"box.data": bodies().data(ROOM), "plate.stl": BOX})
    assert (done.code != 0) == bool(wrong) and wrong in done.error, done.error or done.text[-1000:]
