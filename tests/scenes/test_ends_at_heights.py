# SPDX-License-Identifier: GPL-2.0-or-later
"""Presses that end at heights, densities, energies and numbers of spheres, or where the bed has no void."""

import math

import numpy as np
import pytest
from parts_cases import BED, BOX, FLOOR, flat, mm, mps, parts, timed
from scene_runs import PRESSES, assert_goes_on, ran, run, write_case
from test_press import COUNT, HEIGHT, RADIUS, SIDE, plate, press, without
from test_press_plans import evaluated

from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.scenes.judge import summary
from epdem.scenes.plan.plan import plan

SOLID = COUNT * 4 / 3 * math.pi * RADIUS**3 / SIDE**2  # height [m] of the spheres of the press without void


def to_bed(**scene):
    """The press to heights or densities of the bed."""
    return without(press(release_pressure="0.2 MPa", hold="5 us", **scene), "stages")


@pytest.mark.parametrize("engine", PRESSES)
def test_stages_end_at_the_step_at_which_the_bed_has_its_density(engine, tmp_path):
    """The plates of the frames, by the spheres that touch them: within the way of the punch in a step."""
    data = to_bed(densities=[0.6, 0.75])
    data["output"]["rows"] = 150  # far from a step
    outcome = ran(data, tmp_path, engine)
    found, phases = (outcome.results.tables[name].set_index("phase") for name in ("stages", "phases"))
    step = 3.0 * outcome.plan.time_step
    assert outcome.passed and (phases["until"].drop(["hold1", "hold2"]) == "reached").all()
    for name, density in (("stage1", 0.6), ("stage2", 0.75)):
        there = plate(outcome, "punch", phases["end"][name])
        assert SOLID / density - 1.01 * step < there <= SOLID / density * (1 + 1e-9)
        assert found["height"][name] == pytest.approx(there, rel=1e-6) and phases["held"][name] < phases["end"][name]
        assert phases["value"][name] == pytest.approx(SOLID / there, rel=1e-6)
        # the bed relaxes in the hold, up to which the pressure has risen
        assert found["peak"][name] == found["pressure"][name] > found["pressure"][f"hold{name[-1]}"]
        assert found["opposite_pressure"][name] == pytest.approx(found["pressure"][name], rel=0.15)
        assert found["pressure"][f"release{name[-1]}"] <= 1.01 * 0.2e6
    said = " ".join(summary.results(outcome.plan, outcome.results.tables))
    assert f"Relative density: 0.600 at {1e-6 * found['pressure']['stage1']:.4g} MPa, 0.750 at " in said
    assert found["asked"].isna().all() and found["springback"]["release2"] > 0.01


@pytest.mark.parametrize("engine", PRESSES)
def test_two_punches_stop_at_the_height_between_them(engine, tmp_path):
    """Between restart files, at which the run stops for a moment."""
    data = to_bed(heights=["0.4 mm"], double_action=True)
    data["output"] |= {"rows": 150, "restarts": 7}
    outcome = ran(data, tmp_path, engine)
    phases = outcome.results.phases.set_index("phase").loc["stage1"]
    high, low = (plate(outcome, name, phases["end"]) for name in ("punch", "floor"))
    assert 0.4e-3 - 1.01 * 3.0 * outcome.plan.time_step < high - low <= 0.4e-3 * (1 + 1e-9)
    assert phases["value"] == pytest.approx(high - low, rel=1e-6)


@pytest.mark.liggghts
def test_a_press_to_a_density_and_one_to_the_pressure_found_there_agree(tmp_path):
    """The plate slows near a pressure and not near a density."""
    data = to_bed(densities=[0.7], speed="1 m/s")
    found = run(write_case(data, tmp_path / "a"), out=tmp_path / "a/out").results.stages.iloc[0]
    again = without(press(stages=[f"{found['pressure']:.9g} Pa"], speed="1 m/s"), "hold")
    other = run(write_case(again, tmp_path / "b"), out=tmp_path / "b/out").results.stages.iloc[0]
    assert other["relative_density"] == pytest.approx(found["relative_density"], abs=0.004)


@pytest.mark.parametrize("engine", ["liggghts", "lammps"])
def test_the_force_is_looked_at_from_a_density_on_that_can_bear_it(engine):
    """The steps at 3 m/s to a relative density of 0.4; spheres that attract each other may bear a plate before."""
    data = without(press(stages=["40 MPa"]), "hold")
    p = plan(parse(data))
    text = "\n".join(scene_engine(engine).files(p).values())
    (line,) = [x for x in text.splitlines() if x.startswith("variable loose equal ")]
    formula = line.partition(" equal ")[2].partition("  #")[0].removeprefix("floor")
    way = 3.0 * p.time_step * evaluated(formula, {"punch": -0.2e-3})
    assert HEIGHT - 0.2e-3 - way == pytest.approx(SOLID / 0.4, rel=1e-9)
    data |= {"contact": {"cohesion": "1e3 J/m^3"}, "law": {"name": "cavity"}}
    assert "variable loose" not in "\n".join(scene_engine(engine).files(plan(parse(data))).values())


@pytest.mark.parametrize("engine", PRESSES)
def test_a_press_that_stops_on_its_way_to_a_density_goes_on_to_the_same_tables(engine, tmp_path):
    """Between two looks the run is one, and a restart file stands at none of the rows that end a phase."""
    data = to_bed(densities=[0.75])
    data["output"] |= {"rows": 400, "restarts": 130, "loads": True}
    whole, steps = assert_goes_on(plan(parse(data)), tmp_path, engine, of=slice(1, 6, 4))
    assert sum(step < whole["phases"]["held"][0] for step in steps) > 1


def falls(rows, until):
    """A bed that comes to rest, or that leaves the room through its open floor."""
    data = parts(wall=[BOX | {"open": ["+z", "-z"]}, *([] if "count" in until else [FLOOR])])
    data["scene"]["phase"] = [timed("fall", "0.4 s", until=until | {"after": "0 s"})]
    return data | {"output": {"rows": rows, "particles": 1}, "numerics": {"time_step": "1e-5 s"}}


@pytest.mark.parametrize("until", [{"kinetic_energy": "20 nJ"}, {"count": 30}], ids=["energy", "count"])
@pytest.mark.parametrize("engine", PRESSES)
def test_an_energy_and_a_number_of_spheres_are_looked_at_between_rows(engine, until, tmp_path):
    """The same step for long rows of two lengths, and the first in rows of 100 steps at which the condition holds."""
    held = []
    for steps in (1000, 700, 100):
        outcome = run(
            write_case(falls(40000 // steps, until), tmp_path / f"{steps}"), engine, out=tmp_path / f"{steps}/out"
        )
        found = outcome.results.phases.set_index("phase").loc["fall"]
        assert found["until"] == "reached" and found["end"] - found["held"] < outcome.plan.every
        held.append((found["held"], found["value"]))
    assert outcome.plan.every == 100
    rows = outcome.results.rows[outcome.results.rows["step"] > 0]
    energy = rows["kinetic_energy"] / rows["particles"]
    holds = energy < 20e-9 if "kinetic_energy" in until else rows["particles"] <= 30
    assert held[0] == held[1] == held[2] and held[0][0] == rows[holds.to_numpy()]["step"].iloc[0]
    last = rows.set_index("step").loc[held[0][0]]
    expected = last["kinetic_energy"] / last["particles"] if "kinetic_energy" in until else last["particles"]
    assert held[0][1] == pytest.approx(expected, rel=1e-6)


SIDES = {"name": "sides", "kind": "box", "x": mm(-10, 10), "y": mm(-10, 10), "z": mm(0, 20)}
SIDES |= {"open": ["+z", "-z"], "material": "steel"}
COVER = flat("lid", mm(0, 0, 12), mm(20, 20))
NO_VOID = 40 * 4 / 3 * np.pi * 1.5e-3**3 / 0.02**2  # height without void [m]
MOVES = {
    "linear": {"kind": "linear", "velocity": mps(0, 0, -2)},
    "press": {"kind": "press", "direction": [0.0, 0.0, -1.0], "force": "1 GN", "highest_speed": "2 m/s"},
}
HOLD = timed("hold", "1 ms")


def under_a_lid(kind, until=None, **output):
    """Forty spheres under a lid that moves at 2 m/s, which it does under a force that no bed reaches, too."""
    press = timed("press", "10 ms", move=[{"wall": "lid"} | MOVES[kind]])
    if until:
        press["until"] = until
    bed = BED | {"region": BED["region"] | {"z": mm(0, 11)}}
    data = parts(wall=[FLOOR, SIDES, COVER], fill=[bed], phase=[press, HOLD])
    return data | {"output": {"rows": 50, "particles": 4, "loads": True} | output}


FORCE = {"wall": "lid", "force": "0.9 GN", "after": "1 ms"}


def expected_end(p, looks=1):
    """The first row in which the lid, whose way is known, is as low as the spheres without void; looks: steps between
    two looks where the lid slows near a force, after which it rests until the row ends."""
    steps = np.arange(p.every, p.steps, max(p.every, looks))
    steps = steps if looks == 1 else steps // looks * looks
    return p.every * math.ceil(steps[0.012 - 2.0 * p.time_step * steps <= NO_VOID][0] / p.every)


@pytest.mark.parametrize("engine", PRESSES)
@pytest.mark.parametrize(("kind", "until"), [("linear", FORCE), ("press", FORCE), ("press", None)])
def test_a_run_ends_with_a_frame_where_a_pressed_bed_has_no_void(tmp_path, engine, kind, until):
    path = write_case(under_a_lid(kind, until, contacts=2), tmp_path)
    for _ in range(2):  # and as it is read again
        outcome = run(path, engine=engine, out=tmp_path / "out")
        looks = 100 if kind == "linear" else 1
        r, end = outcome.results, expected_end(plan(parse(under_a_lid(kind, until))), looks)
        assert r.phases["until"].to_list() == ["no void", "no void"] and r.phases["end"].to_list() == [end, end]
        assert r.rows["step"].iloc[-1] == r.particles["step"].iloc[-1] == r.contacts["step"].iloc[-1] == end
        checks = r.tables["checks"].set_index("key")
        assert not outcome.passed and not checks.loc["void", "passed"]
        (said,) = [x for x in outcome.warnings if "no void" in x]
        assert said.startswith(
            f"scene.phase.press: the run ended after step {end}, because the pressed bed has no void"
        )
    assert outcome.reused


@pytest.mark.liggghts
def test_a_continued_press_ends_in_the_same_row(tmp_path):
    p = plan(parse(under_a_lid("linear", FORCE, restarts=50, particles=50)))
    whole, _ = assert_goes_on(p, tmp_path, of=slice(-3, None))
    assert whole["phases"]["end"].iloc[0] == expected_end(p)


def test_a_bed_is_looked_at_only_where_the_run_tells_its_height():
    """Not where the way of the lid is known, as with `travel`, and not where spheres pass beside the lid."""
    travel = {"wall": "lid", "travel": "1 mm"}
    for kind, until, looked in (("linear", None, 0), ("linear", travel, 0), ("linear", FORCE, 1), ("press", None, 1)):
        data = under_a_lid(kind, until)
        data["scene"]["phase"][0]["duration"] = "1 ms" if kind == "linear" else "10 ms"
        if until:
            data["scene"]["phase"][0]["until"] = until | ({"after": "0.1 ms"} if "force" in until else {})
        assert len(plan(parse(data)).pressed) == looked, (kind, until)
    small = under_a_lid("press")
    small["scene"]["wall"] = [FLOOR, SIDES, COVER | {"size": mm(18, 18)}]
    assert not plan(parse(small)).pressed
