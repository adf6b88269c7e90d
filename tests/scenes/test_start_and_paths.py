# SPDX-License-Identifier: GPL-2.0-or-later
"""Spheres that no engine can begin with or that come into others, walls that leave the room: place and value."""

import math
import re
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from parts_cases import BED, FLOOR, bead, driven, flat, linear, mm, mps, parts, pipe, timed
from scene_runs import HOSTS, PRESSES, ran, run, write_case

from epdem.case.motions import LinearMove, RotateMove, VibrateMove
from epdem.case.parts import Sphere
from epdem.case.scene import parse
from epdem.errors import CaseError, EngineError
from epdem.scenes.judge.warnings import planned_warnings
from epdem.scenes.plan.limits import overlaps
from epdem.scenes.plan.meshes import at_end
from epdem.scenes.plan.plan import plan
from epdem.scenes.tables.columns import place

PLATE = flat("plate", mm(0, 0, 5), mm(6, 6))
FALL = timed("fall", "20 ms")
SECOND = timed("second", "20 ms")


def body(name, *mm, **more):
    return bead(name, [f"{x} mm" for x in mm], "1 mm", "glass") | more


def moved(**phases):
    """The plate above a floor, with its motion in each phase."""
    motions = [{"wall": "plate"} | motion for motion in phases.values()]
    made = [timed(n, "20 ms", move=[m]) for n, m in zip(phases, motions, strict=True)]
    return parts(wall=[FLOOR, PLATE], fill=[], body=[body("a", 0, 0, 20)], phase=made)


OPEN = parse(parts()).scene

spheres = st.builds(
    lambda x, y, radius, frozen: Sphere((x, y, 0.0), radius, "glass", frozen=frozen),
    st.sampled_from([0.0, 1.0, 2.0, 2.5]),
    st.sampled_from([0.0, 1.0]),
    st.sampled_from([0.25, 1.0, 1.5]),
    st.booleans(),
)


@given(st.lists(spheres, max_size=5))
def test_overlaps_are_those_of_all_pairs_or_name_one_that_is_whole(table):
    expected = {}
    for (i, a), (j, b) in combinations(enumerate(table), 2):
        share = (a.radius + b.radius - math.dist(a.place, b.place)) / min(a.radius, b.radius)
        if share > 0 and not (a.frozen and b.frozen):
            expected[i, j] = share
    i, j, share = overlaps(table, OPEN)
    found = {(min(a, b), max(a, b)): s for a, b, s in zip(i.tolist(), j.tolist(), share.tolist(), strict=True)}
    assert found.items() <= {key: pytest.approx(s) for key, s in expected.items()}.items() or not found
    assert max(found.values(), default=0) >= 1 or len(found) == len(expected)
    assert (max(found.values(), default=0) >= 1) == (max(expected.values(), default=0) >= 1)


@given(
    apart=st.sampled_from([0.0, 0.4, 0.99, 1.01, 1.9]),
    phases=st.tuples(*[st.sampled_from(["fall", "second", None])] * 2),
    frozen=st.tuples(st.booleans(), st.booleans()),
)
def test_spheres_that_come_together_with_a_centre_in_each_other_are_refused(apart, phases, frozen):
    """Radii of 1 mm: the centres are nearer than 1 mm. A frozen one is there from the start."""
    comes = [None if still else phase for phase, still in zip(phases, frozen, strict=True)]
    more = [{"frozen": still} | ({"phase": p} if p else {}) for p, still in zip(comes, frozen, strict=True)]
    data = parts(
        fill=[], body=[body("a", 0, 0, 20, **more[0]), body("b", 0, 0, 20 + apart, **more[1])], phase=[FALL, SECOND]
    )
    together = (comes[0] or "fall") == (comes[1] or "fall")
    least = 1.0 if comes[0] in (None, "fall") else 2.0  # spheres of a later phase do not overlap at all
    if together and apart <= least and not all(frozen):
        with pytest.raises(CaseError, match=r"scene.body.b.position: overlaps scene.body.a.position by \d+% of the"):
            plan(parse(data))
    else:
        plan(parse(data))


def test_many_spheres_at_one_position_are_refused_at_once(tmp_path):
    (tmp_path / "t.csv").write_text("x,y,z,radius\n" + "0,0,0.02,0.001\n" * 50_000)
    data = parts(fill=[{"name": "bed", "file": "t.csv", "material": "glass"}])
    with pytest.raises(CaseError, match=r"scene.fill.bed, sphere \d+: overlaps scene.fill.bed, sphere \d+ by 200%"):
        plan(parse(data, tmp_path / "case.toml"))


@pytest.mark.parametrize("phase", ["fall", "second"])
@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("position", [(10, 0, 20), (-10, 0, 20), (0, 0, 40), (0, 0, -5), (0, 10.001, 20)])
def test_a_sphere_on_the_limit_of_the_room_is_refused_where_it_is_one(position, periodic, phase):
    ball = body("ball", *position, phase=phase)
    data = parts(periodic=periodic, fill=[], body=[body("a", 0, 0, 20), ball], phase=[FALL, SECOND])
    if periodic and abs(position[0]) == 10:
        plan(parse(data))
    else:
        with pytest.raises(CaseError, match=r"scene.body.ball.position: \(.*\) m lies beyond scene.room or on its"):
            plan(parse(data))


@pytest.mark.parametrize(("wall", "z"), [(FLOOR, 0), (PLATE, 5)])
def test_a_sphere_with_its_centre_in_a_wall_is_refused(wall, z):
    p = plan(parse(parts(wall=[wall], fill=[], body=[body("a", 0, 0, z)])))
    with pytest.raises(CaseError, match=f"its centre lies in wall {wall['name']}; move it"):
        planned_warnings(p)


vectors = st.tuples(*[st.sampled_from([-1.0, 0.0, 0.5])] * 3)
motions = st.one_of(
    st.builds(LinearMove.model_construct, velocity=vectors),
    st.builds(VibrateMove.model_construct, amplitude=vectors, frequency=st.sampled_from([0.05, 0.3, 0.8])),
    st.builds(
        RotateMove.model_construct,
        origin=vectors,
        axis=st.sampled_from([[0.0, 0.0, 1.0], [0.6, 0.0, -0.8]]),
        rate=st.sampled_from([-2.0, 0.7, 9.0]),
    ),
)


@given(motions, st.sampled_from([0.4, 1.0, 3.0]))
def test_the_path_of_a_wall_is_that_of_its_points_at_many_times(move, seconds):
    points = np.array([[0.3, -0.2, 0.1], [1.0, 1.0, -1.0]])
    way = []
    for t in np.linspace(0.0, seconds, 2001):
        if isinstance(move, LinearMove):
            way.append(points + t * np.array(move.velocity))
        elif isinstance(move, VibrateMove):
            way.append(points + np.sin(move.omega * t) * np.array(move.amplitude))
        else:  # Rodrigues' matrix
            x, y, z = np.array(move.axis) / np.linalg.norm(move.axis)
            cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            angle = move.rate * t
            matrix = np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
            way.append((points - np.array(move.origin)) @ matrix.T + np.array(move.origin))
    for one, of_one in zip(points, np.swapaxes(way, 0, 1), strict=True):
        low, high = move.extent(seconds, one[None])
        assert low == pytest.approx(of_one.min(axis=0), abs=1e-3)
        assert high == pytest.approx(of_one.max(axis=0), abs=1e-3)
    assert move.point_at(seconds, points) == pytest.approx(way[-1], abs=1e-9)
    speed = np.linalg.norm(np.diff(way, axis=0), axis=2).max() / (seconds / 2000)
    assert speed <= move.top_speed(math.sqrt(12)) * (1 + 1e-6)  # no point is farther from an axis


VIBRATE = {"kind": "vibrate", "frequency": "100 Hz"}
SPIN = {"kind": "rotate", "axis": [0.0, 0.0, 1.0]}
PUSH = {"kind": "linear", "velocity": mps(0.4, 0, 0)}  # 8 mm in a phase


@pytest.mark.parametrize(
    ("phases", "says"),
    [  # the centres of the two triangles lie at 1 mm on both sides of the plate's own
        ({"one": VIBRATE | {"amplitude": mm(8, 0, 0)}}, None),
        ({"one": VIBRATE | {"amplitude": mm(9.5, 0, 0)}}, r"one.move: wall plate .* x = 0.0105 m"),
        ({"one": VIBRATE | {"amplitude": mm(0, 0, 11)}}, r"reaches z = -0.006 m and the room is from -0.0"),
        ({"one": SPIN | {"rate": "600 rpm", "origin": mm(4, 0, 0)}}, None),
        ({"one": SPIN | {"rate": "3000 rpm", "origin": mm(6, 0, 0)}}, r"leaves scene.room.* x = 0.013"),
        ({"one": SPIN | {"rate": "10 rpm", "origin": mm(6, 0, 0)}}, None),  # 1.2 degrees
        ({"one": PUSH, "two": VIBRATE | {"amplitude": mm(0.5, 0, 0)}}, None),
        ({"one": PUSH, "two": VIBRATE | {"amplitude": mm(1.5, 0, 0)}}, r"two.move.* x = 0.0105 m"),
        ({"one": PUSH, "two": SPIN | {"rate": "600 rpm"}}, None),
        ({"one": PUSH, "two": PUSH}, r"two.move.* x = 0.017 m"),
    ],
)
def test_a_wall_that_turns_or_vibrates_out_of_the_room_is_refused(phases, says):
    if says is None:
        plan(parse(moved(**phases)))
    else:
        with pytest.raises(CaseError, match=rf"scene.phase.{says}" if says.startswith(("one", "two")) else says):
            plan(parse(moved(**phases)))


@pytest.mark.liggghts
def test_spheres_from_a_nanometre_to_a_millimetre_are_filled_in(tmp_path):
    sizes = {"from": "1 nm", "to": "1.6 mm"}
    data = parts(fill=[BED | {"count": 20, "particles": [{"material": "glass", "radius": sizes}]}])
    del data["output"]["energy"]
    spheres = ran(data, tmp_path).results.particles
    radii = spheres[spheres["step"] == spheres["step"].min()]["radius"]
    assert len(radii) == 20 and radii.min() == pytest.approx(1e-9) and radii.max() == pytest.approx(1.6e-3)


@pytest.mark.liggghts
def test_a_wall_that_its_force_drives_out_of_the_room_is_named(tmp_path):
    press = driven("plate", [0.0, 0.0, 1.0], "1 N", "9 m/s")
    data = parts(wall=[FLOOR, PLATE], fill=[], body=[body("a", 5, 0, 1)], phase=[FALL | {"move": [press]}])
    with pytest.raises(EngineError, match=r"scene.wall.plate: the wall has left scene.room after step \d+; enlarge"):
        ran(data, tmp_path)


TUBE = pipe("tube", "10 mm", "20 mm", "10 mm")
UP = {"kind": "linear", "velocity": mps(0, 0, 0.1)}
TURN = {"kind": "rotate", "axis": [1, 0, 0], "origin": mm(0, 0, 15), "rate": "12.5 turn/s"}
PRESS = {"kind": "press", "direction": [0, 0, -1], "force": "1 N", "highest_speed": "0.1 m/s"}


@given(
    both=st.sampled_from([(None, None), (UP, None), (None, UP), (UP, UP), (None, PRESS)]),
    turns=st.sampled_from([(), (0,), (1,), (0, 1)]),
)
def test_walls_at_the_end_are_where_their_motions_take_them(both, turns):
    """By hand: 2 mm up in each phase of 20 ms; a quarter turn in each, so z - 15 mm becomes -y or y."""
    moves = [[] if m is None else [m | {"wall": "plate"}] for m in both]
    for n in turns:
        moves[n].append(TURN | {"wall": "tube"})
    phases = [timed(name, "20 ms", move=m) for name, m in zip(("a", "b"), moves, strict=True)]
    p = plan(parse(parts(wall=[FLOOR, PLATE, TUBE], fill=[BED | {"count": 3}], phase=phases)))
    found = at_end([(phase.moves, 0.02) for phase in p.phases], p.triangles)
    assert ("plate" in found) == (PRESS not in both)
    if PRESS not in both:
        way = 2e-3 * both.count(UP)
        assert found["plate"] == pytest.approx(p.triangles["plate"] + np.array([0, 0, way]), abs=1e-12)
    x, y, z = np.moveaxis(p.triangles["tube"], -1, 0) - np.array([0, 0, 0.015]).reshape(3, 1, 1)
    for _ in turns:
        y, z = -z, y
    assert np.moveaxis(found["tube"], -1, 0) == pytest.approx(np.stack([x, y, z + 0.015]), abs=1e-12)


@pytest.mark.parametrize("name", ["vibrate", "turn"])
def test_a_row_has_the_place_of_a_wall_that_vibrates_or_turns_through_two_phases(name):
    move = VIBRATE | {"amplitude": mm(0.5, 0, 0)} if name == "vibrate" else SPIN | {"rate": "600 rpm"}
    p = plan(parse(moved(one=move, two=move)))
    times = np.linspace(0.0, p.phase_table["end_time"].iloc[-1], 40)
    x, y, _ = p.triangles["plate"][0, 0]
    turn = 2 * math.pi * (100 if name == "vibrate" else 10) * times
    expected = x + 0.5e-3 * np.sin(turn) if name == "vibrate" else x * np.cos(turn) - y * np.sin(turn)
    assert np.ptp(expected) > 9e-4
    assert place(p, "plate", 0, times) == pytest.approx(expected, abs=1e-9)


PHASES = [timed("first", "2 ms"), timed("second", "2 ms")]


def late_body(name, place, **keys):
    position = [f"{x} mm" for x in place]
    return bead(name, position, "1.5 mm", "glass") | keys


def free(late, first=(0, 0, 20), **scene):
    """A body in a room without gravity, and one that comes later."""
    data = parts(gravity="0 m/s^2", fill=[], body=[late_body("first", first), late], phase=PHASES, **scene)
    own = {"numerics": {"time_step": "2e-5 s", "highest_speed": "4 m/s"}}
    return data | own | {"contact": {"friction": 0.3}, "output": {"rows": 20, "particles": 10}}


@pytest.mark.parametrize("engine", HOSTS)
def test_a_late_body_has_every_key_in_its_first_frame(engine, tmp_path):
    motion = {"velocity": mps(1, -2, 3), "spin": ["-50 rad/s", "500 rad/s", "7 rad/s"]}
    late = late_body("late", (5, 0, 15), phase="second", **motion) | {"material": "steel", "radius": "0.7 mm"}
    outcome = ran(free(late), tmp_path, engine)
    frames = outcome.results.particles.query("id == 2")
    row = frames.iloc[0]
    flown = outcome.plan.time_at(np.array([row["step"]]))[0] - 2e-3
    assert 0 <= flown < 1e-3
    assert row[["x", "y", "z"]].to_list() == pytest.approx([5e-3 + flown, -2 * flown, 15e-3 + 3 * flown], rel=1e-9)
    assert row[["vx", "vy", "vz"]].to_list() == [1, -2, 3]
    assert row[["omega_x", "omega_y", "omega_z"]].to_list() == [-50, 500, 7]
    assert row["radius"] == pytest.approx(0.7e-3) and row["mass"] == pytest.approx(7800 * 4 / 3 * np.pi * 0.7e-3**3)


@pytest.mark.parametrize("engine", HOSTS)
@pytest.mark.parametrize("periodic", [False, True])
def test_a_late_body_in_a_sphere_ends_the_run(engine, periodic, tmp_path):
    """The first body moves into the place; in a periodic room the place is beyond a face."""
    place = (-9.7, 0, 20) if periodic else (6, 0, 20)
    data = free(late_body("late", place, phase="second"), (7, 0, 20), periodic=periodic)
    data["scene"]["body"][0]["velocity"] = mps(0.1, 0, 0)
    data["scene"]["wall"] = [FLOOR | {"at": "-4 mm"}]
    words = "scene.body.late.position: at the begin of phase second another sphere is there"
    if periodic:  # the first body is at 7.2 mm, and with 1 m/s at 9 mm
        assert run(write_case(data, tmp_path), engine, out=tmp_path / "apart").passed
        data["scene"]["body"][0]["velocity"] = mps(1, 0, 0)
    with pytest.raises(EngineError, match=words):
        ran(data, tmp_path, engine)


LID = flat("lid", mm(0, 0, 30), mm(18, 18))
GATE = FLOOR | {"name": "gate", "at": "10 mm"}


@pytest.mark.parametrize(
    ("place", "walls", "move", "met"),
    [
        ((0, 0, 1.4), [], [], "wall floor by 0.0001 m"),
        ((0, 0, 1.5), [], [], None),
        ((0, 0, 10), [GATE | {"phases": ["second"]}], [], "wall gate by 0.0015 m"),
        ((0, 0, 10), [GATE | {"phases": ["first"]}], [], None),
        ((0, 0, 29), [LID], [], "wall lid by 0.0005 m"),
        ((0, 0, 29), [LID], [mps(0, 0, -1)], "wall lid by 0.0005 m"),  # 28 mm, below the centre
        ((0, 0, 29), [LID], [mps(0, 0, 1)], None),  # 32 mm
        ((0, 0, 26), [LID], [mps(0, 0, -1)], None),  # 28 mm
        ((0, 0, 27), [LID], [mps(0, 0, -1)], "wall lid by 0.0005 m"),
    ],
)
def test_a_late_body_in_a_wall_is_refused(place, walls, move, met):
    data = free(late_body("late", place, phase="second"), (0, 0, 20), wall=[FLOOR, *walls])
    data["scene"]["phase"][0]["move"] = [{"wall": "lid", "kind": "linear", "velocity": v} for v in move]
    if met is None:
        assert plan(parse(data)).count == 2
        return
    words = rf"scene\.body\.late\.position: at the begin of phase second the body overlaps {met}"
    with pytest.raises(CaseError, match=words):
        plan(parse(data))


DRIVEN = driven("lid", "-z", "50 mN", "1 m/s")
LINEAR = linear("lid", 0, 0, -1)
UNTIL = {"kinetic_energy": "1 J", "after": "1 ms"}  # holds at the first row after 1 ms


SOME_TIME = {"move": [LINEAR], "until": UNTIL}
MOVED = [
    pytest.param(*host.values, {"move": [DRIVEN]}, 2e-3, marks=host.marks, id=f"driven-{host.values[0]}")
    for host in PRESSES
]
MOVED += [
    pytest.param(*host.values, SOME_TIME, 1.2e-3, marks=host.marks, id=f"until-{host.values[0]}") for host in HOSTS
]


@pytest.mark.parametrize(("engine", "phase", "way"), MOVED)
def test_a_late_body_in_a_wall_whose_place_the_run_alone_knows_ends_the_run(engine, phase, way, tmp_path):
    """A plate moves by 1 m/s from 30 mm on; without the motion the body of 1.5 mm is free in both cases."""
    for off, met in ((2.1e-3, False), (1.0e-3, True)):
        late = late_body("late", (0, 0, round(1e3 * (30e-3 - way - off), 6)), phase="second")
        data = free(late, (0, 8, 5), wall=[FLOOR, LID])
        data["scene"]["phase"] = [PHASES[0] | phase, PHASES[1]]
        path = write_case(data, tmp_path)
        if not met:
            assert run(path, engine, out=tmp_path / "free").passed
            continue
        words = r"scene\.body\.late\.position: at the begin of phase second the body overlaps wall lid by (\S+) m"
        with pytest.raises(EngineError, match=words) as error:
            run(path, engine, out=tmp_path / "met")
        depth = float(re.search(words, str(error.value))[1])
        assert depth == pytest.approx(0.5e-3, abs=3e-5)  # the plate begins to move within a step of 2e-5 s
