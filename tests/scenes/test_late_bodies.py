# SPDX-License-Identifier: GPL-2.0-or-later
"""Single spheres that come with a later phase: every key of them arrives in each host, and their places are free."""

import re

import numpy as np
import pytest
from parts_cases import FLOOR, bead, driven, flat, linear, mm, mps, parts, timed
from scene_runs import HOSTS, ran, run, write_case

from epdem.case.scene import parse
from epdem.errors import CaseError, EngineError
from epdem.scenes.plan.plan import plan

PHASES = [timed("first", "2 ms"), timed("second", "2 ms")]


def body(name, place, **keys):
    position = [f"{x} mm" for x in place]
    return bead(name, position, "1.5 mm", "glass") | keys


def free(late, first=(0, 0, 20), **scene):
    """A body in a room without gravity, and one that comes later."""
    data = parts(gravity="0 m/s^2", fill=[], body=[body("first", first), late], phase=PHASES, **scene)
    own = {"numerics": {"time_step": "2e-5 s", "highest_speed": "4 m/s"}}
    return data | own | {"contact": {"friction": 0.3}, "output": {"rows": 20, "particles": 10}}


@pytest.mark.parametrize("engine", HOSTS)
def test_a_late_body_has_every_key_in_its_first_frame(engine, tmp_path):
    motion = {"velocity": mps(1, -2, 3), "spin": ["-50 rad/s", "500 rad/s", "7 rad/s"]}
    late = body("late", (5, 0, 15), phase="second", **motion) | {"material": "steel", "radius": "0.7 mm"}
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
    data = free(body("late", place, phase="second"), (7, 0, 20), periodic=periodic)
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
    data = free(body("late", place, phase="second"), (0, 0, 20), wall=[FLOOR, *walls])
    data["scene"]["phase"][0]["move"] = [{"wall": "lid", "kind": "linear", "velocity": v} for v in move]
    if met is None:
        assert plan(parse(data)).count == 2
        return
    words = rf"scene\.body\.late\.position: at the begin of phase second the body overlaps {met}"
    with pytest.raises(CaseError, match=words):
        plan(parse(data))


PRESS = driven("lid", "-z", "50 mN", "1 m/s")
LINEAR = linear("lid", 0, 0, -1)
UNTIL = {"kinetic_energy": "1 J", "after": "1 ms"}  # holds at the first row after 1 ms


@pytest.mark.parametrize("engine", HOSTS)
@pytest.mark.parametrize(
    ("phase", "way"), [({"move": [PRESS]}, 2e-3), ({"move": [LINEAR], "until": UNTIL}, 1.2e-3)], ids=["driven", "until"]
)
def test_a_late_body_in_a_wall_whose_place_the_run_alone_knows_ends_the_run(engine, phase, way, tmp_path):
    """A plate moves by 1 m/s from 30 mm on; without the motion the body of 1.5 mm is free in both cases."""
    for off, met in ((2.1e-3, False), (1.0e-3, True)):
        late = body("late", (0, 0, round(1e3 * (30e-3 - way - off), 6)), phase="second")
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
