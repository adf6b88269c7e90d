# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls of scenes of parts that move, and phases that end by a condition, in LIGGGHTS."""

import math

import numpy as np
import pytest
from parts_cases import BED, BOX, FLOOR, bead, driven, flat, linear, mm, parts, timed, vibrating
from scene_runs import HOSTS, LAMMPS, LIGGGHTS, PRESSES, YADE, assert_goes_on, ran, run, write_case

from epdem.case.scene import parse
from epdem.engines.liggghts import deck
from epdem.engines.liggghts import tables as tables
from epdem.scenes.judge.warnings import planned_warnings
from epdem.scenes.plan.plan import plan

PLATE = flat("lid", mm(0, 0, 39), mm(17.9, 17.9))
FALL = timed("fall", "60 ms")
BEATER = PLATE | {"name": "beater", "axis": "x", "center": mm(0, 0, 9), "size": mm(17, 16)}


def moved(kind: str) -> dict:
    """A frictionless bed whose walls do work."""
    if kind == "vibrate":  # and goes on after 1.8 periods
        move = vibrating("lid", mm(0, 0, 1), "60 Hz")
        floor = PLATE | {"center": mm(0, 0, 2)}
        bed = BED | {"region": BED["region"] | {"z": mm(4, 38)}}
        shakes = [timed("shake", "30 ms", move=[move]), timed("on", "30 ms", move=[move], time_step="0.9e-5 s")]
        data = parts(wall=[BOX, floor], fill=[bed], phase=[FALL, *shakes])
        return data | {"output": data["output"] | {"rows": 200, "particles": 200}}
    if kind == "rotate":
        move = {"wall": "beater", "kind": "rotate", "axis": [0.0, 1.0, 0.0], "origin": ["0 m", "0 m", "9 mm"]}
        phase = timed("beat", "60 ms", move=[move | {"rate": "-20 rad/s"}])
        bed = BED | {"region": BED["region"] | {"x": mm(0.5, 9)}}
        return parts(wall=[BOX, BEATER], fill=[bed], phase=[phase])
    if kind == "press":
        move = {"wall": "lid", "kind": "press", "direction": [0.0, 0.0, -1.0], "force": "0.2 N"}
        hold = timed("hold", "0.2 s", move=[move | {"highest_speed": "0.1 m/s"}])
        lid = PLATE | {"center": mm(0, 0, 15)}
        bed = BED | {"region": BED["region"] | {"z": mm(0, 14)}}
        return parts(wall=[BOX, lid], fill=[bed], phase=[hold])
    move = linear("lid", 0, 0, -0.4)
    press = timed("press", "1 s", until={"wall": "lid", "travel": "30 mm"}, move=[move])
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


def assert_the_lid_has_stopped(found) -> None:
    """30 mm at 0.4 m/s, at a step of its own; the spheres are under the plate, but for overlaps."""
    last, rows = found.particles, found.rows
    assert rows["time"].iloc[-1] == pytest.approx(0.075, rel=1e-9)
    assert 0.9e-5 * rows["step"].iloc[-1] < rows["time"].iloc[-1] <= 1e-5 * rows["step"].iloc[-1]
    assert last[last["step"] == last["step"].max()].eval("z + radius").max() < 39e-3 - 30e-3 + 0.5e-3 * 3


IN_YADE = [pytest.param("yade", kind, marks=pytest.mark.yade("module")) for kind in ("vibrate", "rotate")]
KINDS = ("vibrate", "rotate", "linear", "press")
MOVED = [pytest.param(*host.values, kind, marks=host.marks) for host in (LIGGGHTS, LAMMPS) for kind in KINDS]


@pytest.mark.parametrize(("host", "kind"), MOVED + IN_YADE)
def test_energy_closes_with_the_work_of_walls_that_move(host, kind, tmp_path):
    outcome = ran(moved(kind), tmp_path, host)
    balance = outcome.results.energy_balance
    assert outcome.passed, outcome.results.checks
    if kind == "vibrate":
        assert_the_lid_shakes_on(outcome.results)
    if kind == "linear":
        assert_the_lid_has_stopped(outcome.results)
    assert abs(balance["work"]).max() > 0.1 * balance["kinetic"].max() > 0  # so that it counts
    if host == "yade":
        assert {"floor", "box", "beater", "lid"} >= {*outcome.results.contacts["wall"]} - {""}
        assert not any("once for each triangle" in text for text in outcome.warnings), "rectangles are one body"


def test_a_wall_that_moves_last_goes_no_farther_than_it_should():
    """2 mm at 0.1 m/s after 80 ms, also where a step of time is given."""
    up = linear("lid", 0, 0, 0.1)
    last = timed("lift", "1 s", move=[up], until={"wall": "lid", "travel": "2 mm"})
    data = parts(wall=[FLOOR, BOX, PLATE | {"center": mm(0, 0, 37)}], phase=[FALL, last])
    data["scene"]["fill"][0]["region"]["z"] = mm(0, 36)
    data["output"] = {"rows": 200, "particles": 20}
    given = plan(parse(data | {"numerics": {"time_step": "1.17e-5 s"}}))
    p = plan(parse(data | {"numerics": {"error": 0.02}}))
    lengths = [float(table.eval("end_time - begin_time").iloc[-1]) for table in (given.phase_table, p.phase_table)]
    assert lengths[0] == pytest.approx(0.02, rel=1e-3) and lengths[1] == pytest.approx(0.02, rel=1e-9)
    assert not planned_warnings(given) and not planned_warnings(p)


@pytest.mark.parametrize("engine", PRESSES)
def test_phases_end_by_force_and_by_energy_and_a_servo_holds_its_force(engine, tmp_path):
    hold = driven("lid", [0.0, 0.0, -1.0], "0.2 N", "0.03 m/s")
    lid = PLATE | {"center": mm(0, 0, 15)}
    bed = BED | {"region": BED["region"] | {"z": mm(0, 14)}}
    phases = [
        timed("settle", "1 s", until={"kinetic_energy": "5 nJ", "after": "40 ms"}),
        timed("press", "1 s", until={"wall": "lid", "force": "0.1 N", "after": "0 s"}, move=[hold]),
        timed("hold", "0.3 s", move=[hold]),
    ]
    data = parts(wall=[BOX, lid], fill=[bed], phase=phases) | {"viscous": {"restitution": 0.4}}
    data["output"] = {"rows": 800, "particles": 2, "loads": True, "restarts": 0}
    outcome = ran(data, tmp_path, engine)
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


@pytest.mark.parametrize("engine", HOSTS)
def test_a_condition_that_is_not_reached_is_named(engine, tmp_path):
    """The first is met, the second is not: the phase, the place and the time of its end, and its row in the results."""
    ends = [timed(n, "10 ms", until={"kinetic_energy": x}) for n, x in (("settle", "1 J"), ("calm", "1e-30 J"))]
    data = parts(phase=[*ends, timed("rest", "5 ms")]) | {"output": {"rows": 30, "particles": 2}}
    path = write_case(data, tmp_path)
    for _ in range(2):  # and as it is read again
        outcome = run(path, engine, out=tmp_path / "out")
        table = outcome.results.phases.set_index("phase")
        assert table["until"].to_list() == ["reached", "not reached", ""]
        assert 1e-3 < table["end_time"]["settle"] < 3e-3, "looked at from a tenth of the duration"
        assert outcome.results.rows["step"].iloc[-1] == outcome.plan.steps == table["end"].iloc[-1]
        (said,) = [x for x in outcome.warnings if "until" in x]
        ended = f"{table.loc['calm', 'end_time']:.4g} s"
        assert said.startswith(f"scene.phase.calm.until was not reached: the phase ended by its duration, at {ended}")
    assert outcome.reused


@pytest.mark.liggghts
def test_a_run_that_ends_by_a_condition_goes_on_bitwise(tmp_path):
    """From every third row, and those at which a phase ends and other spheres come."""
    gate = FLOOR | {"name": "gate", "at": "2 mm", "phases": ["settle", "more"]}
    bed = BED | {"region": BED["region"] | {"z": mm(4, 38)}}
    phases = [
        timed("settle", "1 s", until={"kinetic_energy": "5 nJ", "after": "40 ms"}),
        timed("more", "20 ms"),
        timed("fall", "20 ms"),
    ]
    more = BED | {"name": "more", "count": 5, "phase": "more"}
    ball = bead("ball", mm(0, 0, 36), "1.5 mm", "steel", phase="fall")
    walls = [FLOOR, BOX | {"open": ["-z"]}, gate]
    data = parts(wall=walls, fill=[bed, more], body=[ball], phase=phases, open_boundary=True)
    data |= {"viscous": {"restitution": 0.4}, "output": {"rows": 100, "particles": 100, "restarts": 100}}
    whole, steps = assert_goes_on(plan(parse(data)), tmp_path, of=slice(None, None, 3))
    ends = whole["phases"].set_index("phase")["end"]
    assert ends["more"] in steps  # the phase before ends between two of them


def test_a_motion_counts_for_the_highest_speed():
    move = vibrating("lid", mm(0, 3, 4), "100 Hz")
    scene = parse(parts(wall=[PLATE], phase=[FALL | {"move": [move]}])).scene
    assert scene.drive == pytest.approx(2 * math.pi * 100 * 5e-3)


@pytest.mark.parametrize("engine", [LIGGGHTS, YADE])
def test_a_phase_that_is_not_recorded_has_rows_and_no_frames(engine, tmp_path):
    """The others have the same ones, at their begin and end too; a run that goes on in it writes none."""
    found, output = [], {"rows": 8, "particles": 8, "contacts": 8} | ({"restarts": 8} if engine == "liggghts" else {})
    for kept in (True, False):
        phases = [timed(name, "20 ms", record=kept or name in "ad") for name in "abcd"]
        data = parts(phase=phases) | {"output": output, "numerics": {"time_step": "2e-5 s"}}
        outcome = ran(data, tmp_path / str(kept), engine)
        found.append(outcome.results)
    (whole, less), every = found, outcome.plan.every
    steps = [step for step in whole.particles["step"].unique() if step // every not in (3, 4, 5)]
    assert [*less.particles["step"].unique()] == steps and len(steps) >= 5
    there = whole.particles[whole.particles["step"].isin(steps)].reset_index(drop=True)
    assert less.particles.equals(there) and less.rows.equals(whole.rows)
    assert {*less.contacts["step"]} <= {*steps}
    if engine == "liggghts":
        out = tmp_path / "False/out"
        assert not {f"particles.{k * every}.bin" for k in (3, 4, 5)} & {p.name for p in out.iterdir()}
        deck.write_resume(outcome.plan, out, 4 * every)
        assert "dump_modify particles every 1000000000" in (out / "in.resume").read_text()
