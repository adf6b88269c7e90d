# SPDX-License-Identifier: GPL-2.0-or-later
"""A phase lasts its duration and ends with a row and a frame, in LIGGGHTS, YADE and LAMMPS; by which force it ended."""

import math
import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from parts_cases import BED, BOX, FLOOR, bead, flat, linear, mm, mps, own, parts, timed
from scene_runs import HOSTS, LAMMPS, LIGGGHTS, PRESSES, ran

from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.scenes.judge import checks
from epdem.scenes.judge.warnings import measured_warnings, planned_warnings
from epdem.scenes.plan.phases import NOT_REACHED, REACHED
from epdem.scenes.plan.plan import ScenePlan, plan
from epdem.scenes.plan.quantities import STRAINS
from epdem.scenes.plan.timestep import time_step

LID = flat("lid", mm(0, 0, 15), mm(17.9, 17.9))
DOWN = linear("lid", 0, 0, -0.1)
LOAD, UNLOAD = (3.2 - 1.15) * 1e-3, 0.05e-3 / 0.1  # [s] of cases/compaction_powder.toml: strokes over speeds


def durations(text: str) -> list[float]:
    """Seconds of each phase of a LIGGGHTS deck, by its own lines: `timestep`, and `run N upto`."""
    step, before, found = math.nan, 0, []
    for line in text.splitlines():
        if line.startswith("timestep"):
            step = float(line.split()[1])
        elif end := re.match(r"run (\d+) upto", line):
            found.append((int(end[1]) - before) * step)
            before = int(end[1])
    return found


@pytest.mark.parametrize("rows", [7, 20, 33, 100])
@pytest.mark.parametrize(("given", "tolerance"), [({}, 1e-9), ({"time_step": "7e-8 s"}, 3e-3)])
def test_the_plate_of_a_compaction_stops_at_its_height(rows, given, tolerance):
    """The strokes over the speeds of the case file."""
    data = own("compaction_powder")
    data["output"], data["numerics"] = {"rows": rows, "particles": 3}, given
    deck = scene_engine("liggghts").files(plan(parse(data)))
    load, unload = durations(deck["setup.in"] + deck["in.scene"])
    assert load == pytest.approx(LOAD, rel=tolerance) and unload == pytest.approx(UNLOAD, rel=tolerance)


def phases_of(numerics: dict, **own_steps: str) -> tuple[list[float], list[float], ScenePlan]:
    """(durations, time steps) of a deck of three phases whose durations are 20.1, 5.7 and 33.3 ms, and their plan."""
    wanted = {"a": "20.1 ms", "b": "5.7 ms", "c": "33.3 ms"}
    phases = [timed(name, t) for name, t in wanted.items()]
    phases = [phase | ({"time_step": own_steps[n]} if (n := phase["name"]) in own_steps else {}) for phase in phases]
    p = plan(parse(parts(phase=phases) | {"numerics": numerics}))
    deck = scene_engine("liggghts").files(p)
    text = deck["setup.in"] + deck["in.scene"]
    return durations(text), [float(line.split()[1]) for line in text.splitlines() if line.startswith("timestep")], p


def test_every_phase_lasts_its_duration():
    lasting, steps, p = phases_of({"error": 0.01})
    assert lasting == pytest.approx([0.0201, 0.0057, 0.0333], rel=1e-9)
    assert max(steps) <= time_step(p.case, 0.0) * (1 + 1e-9)


@pytest.mark.parametrize("step", [1e-5, 1.3e-5, 2e-5])
def test_a_given_time_step_is_kept_and_phases_end_nearest_their_durations(step):
    lasting, steps, _ = phases_of({"time_step": f"{step!r} s"})
    assert steps == [step]
    assert lasting == pytest.approx([0.0201, 0.0057, 0.0333], rel=4e-3)


def test_the_given_time_step_of_a_phase_is_kept():
    lasting, steps, _ = phases_of({"error": 0.01}, b="1e-5 s")
    assert steps[1] == 1e-5 and len(steps) == 3
    assert lasting == pytest.approx([0.0201, 0.0057, 0.0333], rel=1e-4)


@pytest.mark.parametrize(("last", "named"), [("3 ms", []), ("0.03 ms", ["phase b takes 5e-05 s, not 3e-05 s"])])
def test_a_phase_that_misses_its_duration_is_named(last, named):
    """A phase of three steps beside one of a thousand, and 20 rows."""
    phases = [timed("a", "10 ms"), timed("b", last)]
    case = parse(parts(phase=phases) | {"numerics": {"time_step": "1e-5 s"}, "output": {"rows": 20, "particles": 4}})
    assert [w.partition(":")[0] for w in planned_warnings(plan(case))] == named


def pressed() -> dict:
    """A bed that a lid presses until a force; no end of a phase is a multiple of the steps between two frames."""
    bed = BED | {"region": BED["region"] | {"z": mm(0, 14)}}
    press = timed("press", "0.3 s", until={"wall": "lid", "force": "0.3 N"}, move=[DOWN])
    phases = [timed("fall", "31 ms"), press, timed("rest", "7 ms")]
    data = parts(wall=[FLOOR, BOX | {"open": ["+z", "-z"]}, LID], fill=[bed], phase=phases)
    data["scene"]["measure"] = [{"name": "top", "kind": "height", "share": 1.0}]
    return data | {"output": {"rows": 200, "particles": 3, "energy": True, "loads": True}}


@pytest.mark.parametrize("engine", PRESSES)
def test_every_phase_ends_with_a_row_and_a_frame(engine, tmp_path):
    """The press ends for the force at a step; the lid rests until the row ends, and its contacts still bear a load."""
    found = ran(pressed(), tmp_path, engine).results
    ends = found.phases["end"].to_list()
    assert {*ends} <= {*found.rows["step"]} and {*ends} <= {*found.particles["step"]}
    assert {*ends} <= {*found.contacts["step"]} and {*ends} <= {*found.energy_balance["step"]}
    assert {*ends} <= {*found.measures["step"]} and found.rows["step"].max() == ends[-1]
    press = found.phases.set_index("phase").loc["press"]
    assert press["value"] >= 0.998 * 0.3 and press["begin"] < press["held"] <= press["end"]
    lid = found.contacts[(found.contacts["step"] == press["end"]) & (found.contacts["wall"] == "lid")]
    assert lid["force"].sum() > 0


@pytest.mark.parametrize("engine", [LIGGGHTS, LAMMPS])
def test_a_phase_that_is_not_recorded_has_no_pictures(engine, tmp_path):
    phases = [timed("a", "10 ms", record=False), timed("b", "10 ms")]
    data = parts(phase=phases) | {"output": {"rows": 20, "particles": 10, "pictures": 10}}
    p = ran(data, tmp_path, engine).plan
    steps = sorted(int(path.name.split(".")[1]) for path in (tmp_path / "out").glob("picture.*.ppm"))
    assert steps == sorted(int(path.name.split(".")[1]) for path in (tmp_path / "out").glob("particles.*.*"))
    assert not [n for n in steps if 0 < n < p.phases[0].end] and max(steps) == p.steps


@pytest.mark.parametrize(("own_step", "count"), [("4e-6 s", 2), ("7e-6 s", 3), ("2e-5 s", 2), ("5e-6 s", 8)])
def test_contacts_are_listed_in_frames(own_step, count):
    """A phase whose own time step changes the number of rows."""
    phases = [timed("a", "6 ms", time_step=own_step), timed("b", "4 ms")]
    output = {"rows": 20, "particles": 4, "contacts": count}
    p = plan(parse(parts(phase=phases) | {"numerics": {"time_step": "5e-6 s"}, "output": output}))
    assert {*p.frame_steps(p.contacts)} <= {*p.frame_steps(p.frames)} and 0 < p.contacts < p.steps


def falling(*phases: dict) -> dict:
    """Spheres that come one in each phase, 10 ms each, above a floor, the first of them on a gate."""
    gate = FLOOR | {"name": "gate", "at": "10 mm", "phases": ["a"]}
    places = {"a": (0, 10.99, "0 m/s"), "b": (5, 30, "-0.1 m/s"), "c": (-5, 30, "0.2 m/s")}
    bodies = [
        bead(f"ball_{name}", mm(x, 0, z), "1 mm", "glass")
        | {"velocity": ["0 m/s", "0 m/s", v]}
        | ({"phase": name} if name > "a" else {})
        for name, (x, z, v) in places.items()
    ]
    named = [timed(name, "10 ms") | phase for name, phase in zip("abc", phases, strict=True)]
    data = parts(wall=[FLOOR, gate], fill=[], body=bodies, phase=named) | {"law": {"name": "hertz"}}
    return data | {"numerics": {"time_step": "1e-5 s"}, "output": {"rows": 60, "particles": 6, "contacts": 6}}


@pytest.mark.parametrize("engine", HOSTS)
@pytest.mark.parametrize(
    "phases",
    [({}, {}, {}), ({"duration": "8.05 ms"}, {}, {}), ({"until": {"count": 1, "after": "1 ms"}}, {}, {})],
    ids=["between frames", "odd", "until"],
)
def test_a_frame_at_the_end_of_a_phase_shows_the_spheres_of_this_phase(engine, phases, tmp_path):
    """They fall: z + v t - g t^2 / 2, v - g t without an error of leapfrog; velocities of YADE are half a step late."""
    results = ran(falling(*phases), tmp_path, engine).results
    ends, rows = results.phases["end"], results.rows.set_index("step")
    assert results.particles.groupby("step").size()[ends].to_list() == rows["particles"][ends].to_list() == [1, 2, 3]
    if engine == "yade" and "until" in phases[0]:
        return  # a sphere comes one step after the begin of a phase that follows an early end
    for number, z, v in ((2, 0.03, -0.1), (3, 0.03, 0.2)):
        sphere = results.particles.query(f"id == {number}")
        t = sphere["step"].map(rows["time"]) - results.phases["begin_time"][number - 1]
        assert len(t) > 1
        assert sphere["vz"].to_numpy() == pytest.approx((v - 9.81 * t).to_numpy(), abs=1e-9)
        assert sphere["z"].to_numpy() == pytest.approx((z + v * t - 9.81 / 2 * t**2).to_numpy(), abs=1e-9)


@pytest.mark.parametrize("engine", HOSTS)
def test_the_largest_overlap_of_a_law_without_yield_is_that_of_now(engine, tmp_path):
    data = falling({}, {}, {}) | {"viscous": {"restitution": 0.4}}
    data["scene"]["wall"] = [LID | {"center": mm(0, 0, 0)}]
    data["scene"]["body"][0]["position"][2] = "0.999 mm"
    data["output"] = {"rows": 60, "particles": 60, "contacts": 60}
    contacts = ran(data, tmp_path, engine).results.contacts
    assert contacts["overlap"].nunique() > 2
    assert contacts["delta_max"].equals(contacts["overlap"])


@pytest.mark.parametrize("engine", HOSTS)
@pytest.mark.parametrize("first", [{}, {"duration": "8.05 ms"}, {"until": {"count": 1, "after": "1 ms"}}], ids=str)
def test_walls_that_come_and_go_bear_spheres_in_each_frame_of_their_phases(engine, first, tmp_path):
    """Two spheres, one at rest from the start, whose force is the weight, and one that comes with phase b."""
    weight, young = 2500 * 4 / 3 * math.pi * 1e-9 * 9.81, 1 / ((1 - 0.25**2) / 10e6 + (1 - 0.3**2) / 100e6)
    sunk = 1e3 * (0.75 * weight / young / math.sqrt(1e-3)) ** (2 / 3)
    data = falling(first, {}, {})
    gate, bodies = data["scene"]["wall"][1], data["scene"]["body"][:2]
    for body, z in zip(bodies, (11.0 - sunk, 21.0), strict=True):
        body |= {"position": [*body["position"][:2], f"{z!r} mm"], "velocity": mps(0, 0, 0)}
    data["scene"]["wall"].append(gate | {"name": "trap", "at": "20 mm", "phases": ["b"]})
    data["scene"]["body"] = bodies
    results = ran(data, tmp_path, engine).results
    begins, ends = results.phases["begin"], results.phases["end"]
    frames = np.array(sorted({*results.particles["step"]}))
    for wall, there in (
        ("gate", frames <= ends[0]),
        ("trap", (frames > begins[1]) & (frames <= ends[1])),
        ("floor", frames < 0),
    ):
        contacts = results.contacts[results.contacts["wall"] == wall]
        assert contacts["step"].to_list() == frames[there].tolist()
        if wall == "gate":
            assert contacts["force"].to_numpy() == pytest.approx(weight, rel=1e-6)


@pytest.mark.parametrize(
    ("value", "told", "passed"),
    [(0.3, False, True), (0.3014, False, True), (0.3017, True, True), (0.2945, True, True), (0.3063, True, False)],
)
def test_a_force_that_ends_a_phase_is_told_above_half_a_percent_and_fails_above_two(value, told, passed):
    p = plan(parse(pressed()))
    ended = replace(p.phases[1], reached=REACHED, value=value)
    p = replace(p, phases=(p.phases[0], ended, p.phases[2]))
    rows = pd.DataFrame({"particles": [p.count], STRAINS[0]: [0.0], "step": [0]})
    found = checks.checks(p, {"rows": rows}).set_index("key").loc["reached_force"]
    assert (found["value"], found["expected"], bool(found["passed"])) == (value, 0.3, passed)
    said = [w for w in measured_warnings(p, {"rows": rows}) if "asked for" in w]
    assert len(said) == told and all(f"{value} N, {value / 0.3 - 1:+.2%} beside the 0.3 N" in w for w in said)


def test_what_did_not_end_by_a_force_has_no_such_check():
    """A phase that ended by its duration has a warning; a stage of a press has its own check."""
    p = plan(parse(pressed()))
    p = replace(p, phases=(p.phases[0], replace(p.phases[1], reached=NOT_REACHED, value=0.1), p.phases[2]))
    assert checks.reached_forces(p) == {} == checks.reached_forces(plan(parse(parts())))
