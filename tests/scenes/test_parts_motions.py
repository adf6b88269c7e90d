# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls of scenes of parts that move, and phases that end by a condition, in LIGGGHTS."""

import math

import numpy as np
import pytest
from parts_cases import BED, FLOOR, parts
from scene_runs import restart_steps, run, write_case, write_deck

from engines.lammps_decks import needs_lammps
from epdem.case.scene import parse
from epdem.engines import log
from epdem.engines.frames import Frames
from epdem.engines.liggghts import launcher, resume
from epdem.engines.liggghts import tables as tables
from epdem.scenes.judge.warnings import planned_warnings
from epdem.scenes.plan.plan import plan

BOX = {"name": "box", "kind": "box", "x": ["-9 mm", "9 mm"], "y": ["-9 mm", "9 mm"], "z": ["0 mm", "40 mm"]}
BOX |= {"material": "steel"}
PLATE = {
    "name": "lid",
    "kind": "plate",
    "axis": "z",
    "center": ["0 mm", "0 mm", "39 mm"],
    "size": ["17.9 mm", "17.9 mm"],
}
PLATE |= {"material": "steel"}
FALL = {"name": "fall", "duration": "60 ms"}
BEATER = PLATE | {"name": "beater", "axis": "x", "center": ["0 mm", "0 mm", "9 mm"], "size": ["17 mm", "16 mm"]}


def moved(kind: str) -> dict:
    """A frictionless bed whose walls do work."""
    if kind == "vibrate":  # and goes on after 1.8 periods
        move = {"wall": "lid", "kind": "vibrate", "amplitude": ["0 mm", "0 mm", "1 mm"], "frequency": "60 Hz"}
        floor = PLATE | {"center": ["0 mm", "0 mm", "2 mm"]}
        bed = BED | {"region": BED["region"] | {"z": ["4 mm", "38 mm"]}}
        shakes = [FALL | {"name": name, "duration": "30 ms", "move": [move]} for name in ("shake", "on")]
        data = parts(wall=[BOX, floor], fill=[bed], phase=[FALL, *shakes])
        return data | {"output": data["output"] | {"rows": 200, "particles": 200}}
    if kind == "rotate":
        move = {"wall": "beater", "kind": "rotate", "axis": [0.0, 1.0, 0.0], "origin": ["0 m", "0 m", "9 mm"]}
        phase = {"name": "beat", "duration": "60 ms", "move": [move | {"rate": "-20 rad/s"}]}
        bed = BED | {"region": BED["region"] | {"x": ["0.5 mm", "9 mm"]}}
        return parts(wall=[BOX, BEATER], fill=[bed], phase=[phase])
    if kind == "press":
        move = {"wall": "lid", "kind": "press", "direction": [0.0, 0.0, -1.0], "force": "0.2 N"}
        hold = {"name": "hold", "duration": "0.2 s", "move": [move | {"highest_speed": "0.1 m/s"}]}
        lid = PLATE | {"center": ["0 mm", "0 mm", "15 mm"]}
        bed = BED | {"region": BED["region"] | {"z": ["0 mm", "14 mm"]}}
        return parts(wall=[BOX, lid], fill=[bed], phase=[hold])
    move = {"wall": "lid", "kind": "linear", "velocity": ["0 m/s", "0 m/s", "-0.4 m/s"]}
    press = {"name": "press", "duration": "1 s", "until": {"wall": "lid", "travel": "30 mm"}, "move": [move]}
    return parts(wall=[BOX, PLATE], phase=[press | {"time_step": "1e-5 s"}])


def assert_the_lid_shakes_on(found) -> None:
    """Where spheres touch it, it is at 2 mm + 1 mm sin(2 pi 60 Hz t) since the begin of its first phase."""
    begin = found.phases.set_index("phase").loc["shake", "begin_time"]
    frames = found.particles.set_index(["step", "id"])
    touching = found.contacts[(found.contacts["wall"] == "lid") & (found.contacts["force"] > 0)]
    sphere = frames.loc[list(zip(touching["step"], touching["i"], strict=True))]
    place = sphere["z"].to_numpy() - sphere["radius"].to_numpy() + touching["overlap"].to_numpy()
    time = touching["step"].map(found.rows.set_index("step")["time"]).to_numpy() - begin
    late = time > 0.035
    assert late.any()
    assert place[late] == pytest.approx(2e-3 + 1e-3 * np.sin(2 * math.pi * 60 * time[late]), abs=2e-5)


HOSTS = [
    pytest.param(name, marks=mark) for name, mark in (("liggghts", pytest.mark.liggghts), ("lammps", needs_lammps))
]
IN_YADE = [pytest.param("yade", kind, marks=pytest.mark.yade("module")) for kind in ("vibrate", "rotate")]
MOVED = [pytest.param(*h.values, k, marks=h.marks) for h in HOSTS for k in ("vibrate", "rotate", "linear", "press")]


@pytest.mark.parametrize(("host", "kind"), MOVED + IN_YADE)
def test_energy_closes_with_the_work_of_walls_that_move(host, kind, tmp_path):
    outcome = run(write_case(moved(kind), tmp_path), engine=host, out=tmp_path / "out")
    balance = outcome.results.energy_balance
    assert outcome.passed, outcome.results.checks
    if kind == "vibrate":
        assert_the_lid_shakes_on(outcome.results)
    assert abs(balance["work"]).max() > 0.1 * balance["kinetic"].max() > 0  # so that it counts
    if host == "yade":
        assert {"floor", "box", "beater", "lid"} >= {*outcome.results.contacts["wall"]} - {""}
        assert not any("once for each triangle" in text for text in outcome.warnings), "rectangles are one body"


@pytest.mark.liggghts
def test_a_plate_stops_where_it_was_to_and_its_step_of_time_is_its_own(tmp_path):
    data = moved("linear")
    data["output"] = {"rows": 10, "particles": 2}
    outcome = run(write_case(data, tmp_path), out=tmp_path / "out")
    last, rows = outcome.results.particles, outcome.results.rows
    top = last[last["step"] == last["step"].max()].eval("z + radius").max()
    assert rows["time"].iloc[-1] == pytest.approx(0.075, rel=1e-9)  # 30 mm at 0.4 m/s
    assert 0.9e-5 * rows["step"].iloc[-1] < rows["time"].iloc[-1] <= 1e-5 * rows["step"].iloc[-1]
    assert top < 39e-3 - 30e-3 + 0.5e-3 * 3  # under the plate, but for overlaps


def test_a_wall_that_moves_last_goes_no_farther_than_it_should():
    """2 mm at 0.1 m/s after 80 ms, also where a step of time is given."""
    up = {"wall": "lid", "kind": "linear", "velocity": ["0 m/s", "0 m/s", "0.1 m/s"]}
    last = {"name": "lift", "duration": "1 s", "move": [up], "until": {"wall": "lid", "travel": "2 mm"}}
    data = parts(wall=[FLOOR, BOX, PLATE | {"center": ["0 mm", "0 mm", "37 mm"]}], phase=[FALL, last])
    data["scene"]["fill"][0]["region"]["z"] = ["0 mm", "36 mm"]
    data["output"] = {"rows": 200, "particles": 20}
    given = plan(parse(data | {"numerics": {"time_step": "1.17e-5 s"}}))
    p = plan(parse(data | {"numerics": {"error": 0.02}}))
    lengths = [float(table.eval("end_time - begin_time").iloc[-1]) for table in (given.phase_table, p.phase_table)]
    assert lengths[0] == pytest.approx(0.02, rel=1e-3) and lengths[1] == pytest.approx(0.02, rel=1e-9)
    assert not planned_warnings(given) and not planned_warnings(p)


@pytest.mark.parametrize("engine", HOSTS)
def test_phases_end_by_force_and_by_energy_and_a_servo_holds_its_force(engine, tmp_path):
    hold = {
        "wall": "lid",
        "kind": "press",
        "direction": [0.0, 0.0, -1.0],
        "force": "0.2 N",
        "highest_speed": "0.03 m/s",
    }
    lid = PLATE | {"center": ["0 mm", "0 mm", "15 mm"]}
    bed = BED | {"region": BED["region"] | {"z": ["0 mm", "14 mm"]}}
    phases = [
        {"name": "settle", "duration": "1 s", "until": {"kinetic_energy": "5 nJ", "after": "40 ms"}},
        {
            "name": "press",
            "duration": "1 s",
            "until": {"wall": "lid", "force": "0.1 N", "after": "0 s"},
            "move": [hold],
        },
        {"name": "hold", "duration": "0.3 s", "move": [hold]},
    ]
    data = parts(wall=[BOX, lid], fill=[bed], phase=phases) | {"viscous": {"restitution": 0.4}}
    data["output"] = {"rows": 800, "particles": 2, "loads": True, "restarts": 0}
    outcome = run(write_case(data, tmp_path), engine=engine, out=tmp_path / "out")
    rows, phase = outcome.results.rows, outcome.results.phases.set_index("phase")
    force = np.linalg.norm(rows[["lid_force_x", "lid_force_y", "lid_force_z"]], axis=1)
    at = {name: int(np.flatnonzero(rows["step"] == phase.loc[name, "end"])[0]) for name in phase.index}
    mean = rows["kinetic_energy"] / rows["particles"]
    begin = int(np.flatnonzero(rows["time"] >= 0.04)[0])
    assert phase.loc["settle", "value"] < 5e-9 <= mean[begin : at["settle"] - 1].min()
    assert force[at["press"]] >= 0.1 > force[at["settle"] : at["press"]].max()
    assert phase.loc["press", "end_time"] < 1.5 and phase.loc["hold", "end"] == rows["step"].iloc[-1]
    assert force[-50:].mean() == pytest.approx(0.2, rel=0.02)
    assert outcome.plan.steps == rows["step"].iloc[-1]


@pytest.mark.liggghts
def test_a_condition_that_is_not_reached_is_named(tmp_path):
    """The first is met, the second is not: the phase, the place and the time of its end, and its row in the results."""
    phases = [
        {"name": "settle", "duration": "40 ms", "until": {"kinetic_energy": "1 J", "after": "1 ms"}},
        {"name": "calm", "duration": "40 ms", "until": {"kinetic_energy": "1e-30 J"}},
        {"name": "rest", "duration": "10 ms"},
    ]
    data = parts(wall=[FLOOR, BOX], phase=phases) | {"output": {"rows": 30, "particles": 2}}
    path = write_case(data, tmp_path)
    for _ in range(2):  # and as it is read again
        outcome = run(path, out=tmp_path / "out")
        table = outcome.results.phases.set_index("phase")
        assert table["until"].to_list() == ["reached", "not reached", ""]
        (said,) = [x for x in outcome.warnings if "until" in x]
        assert said.startswith(
            f"scene.phase.calm.until was not reached: the phase ended by its duration, at "
            f"{table.loc['calm', 'end_time']:.4g} s"
        )
    assert outcome.reused


@pytest.mark.liggghts
def test_a_run_that_ends_by_a_condition_goes_on_bitwise(tmp_path):
    """From every row, those at which a phase ends and other spheres come included."""
    gate = FLOOR | {"name": "gate", "at": "2 mm", "phases": ["settle", "more"]}
    bed = BED | {"region": BED["region"] | {"z": ["4 mm", "38 mm"]}}
    phases = [
        {"name": "settle", "duration": "1 s", "until": {"kinetic_energy": "5 nJ", "after": "40 ms"}},
        {"name": "more", "duration": "20 ms"},
        {"name": "fall", "duration": "20 ms"},
    ]
    more = BED | {"name": "more", "count": 5, "phase": "more"}
    ball = {
        "name": "ball",
        "material": "steel",
        "radius": "1.5 mm",
        "position": ["0 mm", "0 mm", "36 mm"],
        "phase": "fall",
    }
    walls = [FLOOR, BOX | {"open": ["-z"]}, gate]
    data = parts(wall=walls, fill=[bed, more], body=[ball], phase=phases, open_boundary=True)
    data |= {"viscous": {"restitution": 0.4}, "output": {"rows": 100, "particles": 100, "restarts": 100}}
    p = write_deck(parse(data), tmp_path)
    launcher.run("in.scene", tmp_path)
    ends = log.ends(tmp_path / launcher.OUT)
    done = p.with_ends(ends)
    whole = tables.particles(Frames(done, tmp_path, tables.kinds(done)))
    files = restart_steps(tmp_path)
    for step in files:
        resume.write_resume(p, tmp_path, step)
        launcher.run("in.resume", tmp_path, append=True)
        assert log.ends(tmp_path / launcher.OUT) == ends
        assert tables.particles(Frames(done, tmp_path, tables.kinds(done))).equals(whole)
    assert ends["more"] in files  # the phase before ends between two of them


def test_a_motion_counts_for_the_highest_speed():
    move = {"wall": "lid", "kind": "vibrate", "amplitude": ["0 mm", "3 mm", "4 mm"], "frequency": "100 Hz"}
    scene = parse(parts(wall=[PLATE], phase=[FALL | {"move": [move]}])).scene
    assert scene.drive == pytest.approx(2 * math.pi * 100 * 5e-3)


@pytest.mark.liggghts
def test_a_phase_that_is_not_recorded_has_rows_and_no_frames(tmp_path):
    """The others have the same ones, at their begin and end too; a run that goes on in it writes none."""
    phases = [FALL | {"duration": "20 ms", "name": name} for name in ("first", "second", "third", "last")]
    for kept in (True, False):
        place = tmp_path / str(kept)
        data = parts(phase=[phases[0], phases[1] | {"record": kept}, phases[2] | {"record": kept}, phases[3]])
        data["output"] = {"rows": 8, "particles": 8, "contacts": 8, "restarts": 8}
        outcome = run(write_case(data, place), out=place / "out")
        if kept:
            whole, every = outcome.results, outcome.plan.every
            continue
        found = outcome.results
        assert [*found.particles["step"].unique()] == [k * every for k in (1, 2, 6, 7, 8)]  # before 1 nothing is there
        there = whole.particles[whole.particles["step"].isin(found.particles["step"])].reset_index(drop=True)
        assert found.particles.equals(there) and found.rows.equals(whole.rows)
        assert {*found.contacts["step"]} <= {*found.particles["step"]}
        assert not {f"particles.{k * every}.bin" for k in (3, 4, 5)} & {p.name for p in (place / "out").iterdir()}
        resume.write_resume(outcome.plan, place / "out", 4 * every)
        assert "dump_modify particles every 1000000000" in (place / "out/in.resume").read_text()
