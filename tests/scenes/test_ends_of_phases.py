# SPDX-License-Identifier: GPL-2.0-or-later
"""A phase lasts its duration and ends with a row and a frame, in LIGGGHTS, YADE and LAMMPS."""

import math
import re

import numpy as np
import pytest
from parts_cases import BED, FLOOR, own, parts
from scene_runs import run, write_case

from engines.lammps_decks import needs_lammps
from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.scenes.judge.warnings import planned_warnings
from epdem.scenes.plan.plan import ScenePlan, plan
from epdem.scenes.plan.timestep import time_step

LID = {"name": "lid", "kind": "plate", "axis": "z", "material": "steel", "size": ["17.9 mm", "17.9 mm"]}
LID |= {"center": ["0 mm", "0 mm", "15 mm"]}
BOX = {"name": "box", "kind": "box", "x": ["-9 mm", "9 mm"], "y": ["-9 mm", "9 mm"], "z": ["0 mm", "40 mm"]}
BOX |= {"material": "steel"}
DOWN = {"wall": "lid", "kind": "linear", "velocity": ["0 m/s", "0 m/s", "-0.1 m/s"]}
LOAD, UNLOAD = (3.2 - 1.15) * 1e-3, 0.05e-3 / 0.1  # [s] of cases/compaction_powder.toml: strokes over speeds
ENGINES = [
    pytest.param("liggghts", marks=pytest.mark.liggghts),
    pytest.param("yade", marks=pytest.mark.yade("module")),
    pytest.param("lammps", marks=needs_lammps),
]


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
    phases = [{"name": name, "duration": t} for name, t in wanted.items()]
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
    phases = [{"name": "a", "duration": "10 ms"}, {"name": "b", "duration": last}]
    case = parse(parts(phase=phases) | {"numerics": {"time_step": "1e-5 s"}, "output": {"rows": 20, "particles": 4}})
    assert [w.partition(":")[0] for w in planned_warnings(plan(case))] == named


def pressed() -> dict:
    """A bed that a lid presses until a force; no end of a phase is a multiple of the steps between two frames."""
    bed = BED | {"region": BED["region"] | {"z": ["0 mm", "14 mm"]}}
    press = {"name": "press", "duration": "0.3 s", "until": {"wall": "lid", "force": "0.3 N"}, "move": [DOWN]}
    phases = [{"name": "fall", "duration": "31 ms"}, press, {"name": "rest", "duration": "7 ms"}]
    data = parts(wall=[FLOOR, BOX | {"open": ["+z", "-z"]}, LID], fill=[bed], phase=phases)
    data["scene"]["measure"] = [{"name": "top", "kind": "height", "share": 1.0}]
    return data | {"output": {"rows": 200, "particles": 3, "energy": True, "loads": True}}


@pytest.mark.parametrize("engine", ENGINES)
def test_every_phase_ends_with_a_row_and_a_frame(engine, tmp_path):
    """The press ends for the force at a step; the lid rests until the row ends, and its contacts still bear a load."""
    found = run(write_case(pressed(), tmp_path), engine, out=tmp_path / "out").results
    ends = found.phases["end"].to_list()
    assert {*ends} <= {*found.rows["step"]} and {*ends} <= {*found.particles["step"]}
    assert {*ends} <= {*found.contacts["step"]} and {*ends} <= {*found.energy_balance["step"]}
    assert {*ends} <= {*found.measures["step"]} and found.rows["step"].max() == ends[-1]
    press = found.phases.set_index("phase").loc["press"]
    assert press["value"] >= 0.998 * 0.3 and press["begin"] < press["held"] <= press["end"]
    lid = found.contacts[(found.contacts["step"] == press["end"]) & (found.contacts["wall"] == "lid")]
    assert lid["force"].sum() > 0


@pytest.mark.parametrize("engine", [engine for engine in ENGINES if "yade" not in str(engine)])
def test_a_phase_that_is_not_recorded_has_no_pictures(engine, tmp_path):
    phases = [{"name": "a", "duration": "10 ms", "record": False}, {"name": "b", "duration": "10 ms"}]
    data = parts(phase=phases) | {"output": {"rows": 20, "particles": 10, "pictures": 10}}
    p = run(write_case(data, tmp_path), engine, out=tmp_path / "out").plan
    steps = sorted(int(path.name.split(".")[1]) for path in (tmp_path / "out").glob("picture.*.ppm"))
    assert steps == sorted(int(path.name.split(".")[1]) for path in (tmp_path / "out").glob("particles.*.*"))
    assert not [n for n in steps if 0 < n < p.phases[0].end] and max(steps) == p.steps


@pytest.mark.liggghts
def test_the_work_of_a_vibration_that_goes_on_with_another_step(tmp_path):
    """A lid that throws spheres up: the sum of all energies is the work of the lid."""
    shake = {"wall": "lid", "kind": "vibrate", "amplitude": ["0 mm", "0 mm", "1 mm"], "frequency": "60 Hz"}
    phases = [{"name": "fall", "duration": "60 ms"}]
    phases += [{"name": "shake", "duration": "30 ms", "move": [shake]}]
    phases += [{"name": "on", "duration": "30 ms", "move": [shake], "time_step": "0.9e-5 s"}]
    phases += [{"name": "more", "duration": "20 ms", "move": [shake]}]
    bed = BED | {"region": BED["region"] | {"z": ["4 mm", "38 mm"]}}
    data = parts(wall=[BOX, LID | {"center": ["0 mm", "0 mm", "2 mm"]}], fill=[bed], phase=phases)
    data["output"] |= {"rows": 200, "particles": 200}
    outcome = run(write_case(data, tmp_path), out=tmp_path / "out")
    balance = outcome.results.energy_balance
    assert outcome.passed, outcome.results.checks
    assert np.abs(balance["work"]).max() > 0.1 * balance["kinetic"].max() > 0


@pytest.mark.parametrize(("own_step", "count"), [("4e-6 s", 2), ("7e-6 s", 3), ("2e-5 s", 2), ("5e-6 s", 8)])
def test_contacts_are_listed_in_frames(own_step, count):
    """A phase whose own time step changes the number of rows."""
    phases = [{"name": "a", "duration": "6 ms", "time_step": own_step}, {"name": "b", "duration": "4 ms"}]
    output = {"rows": 20, "particles": 4, "contacts": count}
    p = plan(parse(parts(phase=phases) | {"numerics": {"time_step": "5e-6 s"}, "output": output}))
    assert {*p.frame_steps(p.contacts)} <= {*p.frame_steps(p.frames)} and 0 < p.contacts < p.steps


def falling(*phases: dict) -> dict:
    """Spheres that come one in each phase, 10 ms each, above a floor, the first of them on a gate."""
    gate = FLOOR | {"name": "gate", "at": "10 mm", "phases": ["a"]}
    places = {"a": (0, 10.99, "0 m/s"), "b": (5, 30, "-0.1 m/s"), "c": (-5, 30, "0.2 m/s")}
    bodies = [
        {"name": f"ball_{name}", "material": "glass", "radius": "1 mm", "position": [f"{x} mm", "0 mm", f"{z} mm"]}
        | {"velocity": ["0 m/s", "0 m/s", v]}
        | ({"phase": name} if name > "a" else {})
        for name, (x, z, v) in places.items()
    ]
    named = [{"name": name, "duration": "10 ms"} | phase for name, phase in zip("abc", phases, strict=True)]
    data = parts(wall=[FLOOR, gate], fill=[], body=bodies, phase=named) | {"law": {"name": "hertz"}}
    return data | {"numerics": {"time_step": "1e-5 s"}, "output": {"rows": 60, "particles": 6, "contacts": 6}}


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    "phases",
    [({}, {}, {}), ({"duration": "8.05 ms"}, {}, {}), ({"until": {"count": 1, "after": "1 ms"}}, {}, {})],
    ids=["between frames", "odd", "until"],
)
def test_a_frame_at_the_end_of_a_phase_shows_the_spheres_of_this_phase(engine, phases, tmp_path):
    results = run(write_case(falling(*phases), tmp_path), engine, out=tmp_path / "out").results
    spheres = results.particles.groupby("step").size()
    assert spheres[results.phases["end"]].to_list() == [1, 2, 3]
    rows = results.rows.set_index("step")["particles"]
    assert rows[results.phases["end"]].to_list() == [1, 2, 3]


@pytest.mark.parametrize("engine", ENGINES)
def test_a_sphere_falls_from_its_place_with_its_velocity(engine, tmp_path):
    """z + v t - g t^2 / 2 and v - g t, which leapfrog has without an error; YADE's velocities are half a step old."""
    results = run(write_case(falling({}, {}, {}), tmp_path), engine, out=tmp_path / "out").results
    time = results.rows.set_index("step")["time"]
    for number, z, v, begin in ((2, 0.03, -0.1, 0.01), (3, 0.03, 0.2, 0.02)):
        sphere = results.particles.query(f"id == {number}")
        t = sphere["step"].map(time) - begin
        assert len(t) > 1
        assert sphere["vz"].to_numpy() == pytest.approx((v - 9.81 * t).to_numpy(), abs=1e-9)
        assert sphere["z"].to_numpy() == pytest.approx((z + v * t - 9.81 / 2 * t**2).to_numpy(), abs=1e-9)


@pytest.mark.parametrize("engine", ENGINES)
def test_the_largest_overlap_of_a_law_without_yield_is_that_of_now(engine, tmp_path):
    data = falling({}, {}, {}) | {"viscous": {"restitution": 0.4}}
    data["scene"]["wall"] = [LID | {"center": ["0 mm", "0 mm", "0 mm"]}]
    data["scene"]["body"][0]["position"][2] = "0.999 mm"
    data["output"] = {"rows": 60, "particles": 60, "contacts": 60}
    contacts = run(write_case(data, tmp_path), engine, out=tmp_path / "out").results.contacts
    assert contacts["overlap"].nunique() > 2
    assert contacts["delta_max"].equals(contacts["overlap"])


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("first", [{}, {"duration": "8.05 ms"}, {"until": {"count": 1, "after": "1 ms"}}], ids=str)
def test_walls_that_come_and_go_bear_spheres_in_each_frame_of_their_phases(engine, first, tmp_path):
    """Two spheres, one at rest from the start, whose force is the weight, and one that comes with phase b."""
    weight, young = 2500 * 4 / 3 * math.pi * 1e-9 * 9.81, 1 / ((1 - 0.25**2) / 10e6 + (1 - 0.3**2) / 100e6)
    sunk = 1e3 * (0.75 * weight / young / math.sqrt(1e-3)) ** (2 / 3)
    data = falling(first, {}, {})
    gate, bodies = data["scene"]["wall"][1], data["scene"]["body"][:2]
    for body, z in zip(bodies, (11.0 - sunk, 21.0), strict=True):
        body |= {"position": [*body["position"][:2], f"{z!r} mm"], "velocity": ["0 m/s"] * 3}
    data["scene"]["wall"].append(gate | {"name": "trap", "at": "20 mm", "phases": ["b"]})
    data["scene"]["body"] = bodies
    results = run(write_case(data, tmp_path), engine, out=tmp_path / "out").results
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
