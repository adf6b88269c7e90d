# SPDX-License-Identifier: GPL-2.0-or-later
"""A wall that a force drives reaches its force beside dashpots, and a phase in which it does not says so."""

import math

import numpy as np
import pytest
from parts_cases import FLOOR, driven, mm, parts, timed, vibrating, write_stl
from scene_runs import HOSTS, LAMMPS, LIGGGHTS, ran, run, write_case

from epdem.case.scene import parse
from epdem.scenes.judge.warnings import planned_warnings
from epdem.scenes.plan.plan import plan

LID = {"name": "lid", "kind": "plate", "axis": "z", "center": mm(0, 0, 3.05), "size": mm(18, 18)}
NINE = [(x, y) for x in (-4, 0, 4) for y in (-4, 0, 4)]


def pressed(*, duration="20 ms", restitution=0.6, speed="0.2 m/s"):
    """Nine spheres under a plate, 50 mN."""
    press = driven("lid", "-z", "50 mN", speed)
    ball = {"material": "glass", "radius": "1.5 mm"}
    data = parts(
        gravity="0 m/s^2",
        wall=[FLOOR, LID | {"material": "steel"}],
        fill=[],
        body=[ball | {"name": f"b{n}", "position": mm(x, y, 1.5)} for n, (x, y) in enumerate(NINE)],
        phase=[timed("press", duration, move=[press])],
    )
    data |= {"law": {"name": "hertz"}, "numerics": {"time_step": "5e-6 s", "highest_speed": "0.1 m/s"}}
    return data | ({"viscous": {"restitution": restitution}} if restitution else {})


@pytest.mark.parametrize("engine", HOSTS)
def test_a_servo_beside_dashpots_reaches_its_force(engine, tmp_path):
    """At 0.2 m/s n c v/F is 6: the speed alternated between both limits, at 65 to 72 mN and powers of both signs."""
    data = pressed() | {"output": {"rows": 40, "particles": 4, "energy": True}}
    outcome = ran(data, tmp_path, engine)
    rows, table = outcome.results.rows, outcome.results.energy_balance
    assert rows["lid_force_z"].tail(8).to_numpy() == pytest.approx(0.05, rel=1e-3)
    assert rows["lid_force_z"].iloc[1] > 0  # 0.05 mm at 0.2 m/s are half of the row, at the stable speed six rows
    # E* and Hertz's overlap of a ninth of the force: the plate puts in what spheres hold, dashpots take the rest
    E_star = 1 / ((1 - 0.25**2) / 10e6 + (1 - 0.3**2) / 100e6)
    overlap = (0.75 * 0.05 / 9 / (E_star * math.sqrt(1.5e-3))) ** (2 / 3)
    assert table["elastic"].iloc[-1] == pytest.approx(2 * 0.4 * 0.05 * overlap, rel=0.1)  # of both ends of nine
    assert 1 < table["work"].iloc[-1] / table["elastic"].iloc[-1] < 1.6
    assert not [said for said in outcome.warnings if "the force of wall lid" in said]
    (said,) = [said for said in planned_warnings(outcome.plan) if "oscillate" in said]
    assert "scene.phase.press.move: " in said and "highest_speed = 0.2 m/s; where spheres touch it, it has at" in said


@pytest.mark.parametrize("engine", [LIGGGHTS, LAMMPS])
def test_a_force_drives_an_stl_wall_as_it_drives_a_plate(engine, tmp_path):
    """The gap is no whole number of steps: whether the first touch comes a step later would hang on rounding."""
    corners = 0.009 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    square = np.column_stack([corners, np.full(4, 3.0504e-3)])
    stl = {"name": "lid", "kind": "stl", "file": "lid.stl", "material": "steel"}
    forces = []
    for lid in (LID | {"material": "steel", "center": mm(0, 0, 3.0504)}, stl):
        data = pressed() | {"output": {"rows": 40, "energy": True}}
        data["scene"]["wall"] = [FLOOR, lid]
        path = write_case(data, tmp_path / lid["kind"])
        write_stl(tmp_path / lid["kind"] / "lid.stl", square[[[0, 1, 2], [0, 2, 3]]])
        rows = run(path, engine, out=tmp_path / lid["kind"] / "out").results.rows
        forces.append(rows["lid_force_z"].to_numpy())
    assert forces[0][-1] == pytest.approx(0.05, rel=1e-3)
    assert np.abs(forces[1] - forces[0]).max() <= 1e-6 * 0.05


@pytest.mark.parametrize("engine", HOSTS)
@pytest.mark.parametrize("kind", ["press", "vibrate"])
def test_the_work_of_a_wall_that_changes_its_speed_is_all_in_elastic_spheres(engine, kind, tmp_path):
    """Where the wall is at rest: at the end of a press, at the turning points of a vibration. With the speeds of the
    last or of the next step the work is off by 1e-2."""
    data = pressed(restitution=None, speed="0.02 m/s", duration="5 ms")
    data["scene"]["wall"] = [FLOOR, LID | {"material": "steel", "center": mm(0, 0, 3)}]
    data |= {"output": {"rows": 50, "particles": 50, "energy": True}}
    data["numerics"]["time_step"] = "1e-5 s"
    if kind == "vibrate":
        shake = vibrating("lid", mm(0, 0, -0.01), "250 Hz")
        data["scene"]["phase"][0]["move"] = [shake]
    table = ran(data, tmp_path, engine).results.energy_balance
    table = table.iloc[[10, 30, 50] if kind == "vibrate" else [50]]
    held = table["elastic"] + table["kinetic"]
    assert held.max() > 1e-8
    assert table["work"].to_numpy() == pytest.approx(held.to_numpy(), abs=1e-3 * held.max())


@pytest.mark.parametrize("engine", HOSTS)
def test_a_second_phase_presses_with_another_force(engine, tmp_path):
    data = pressed() | {"output": {"rows": 80, "particles": 2}}
    (first,) = data["scene"]["phase"]
    second = first | {"name": "less", "move": [first["move"][0] | {"force": "30 mN"}]}
    data["scene"]["phase"] = [first, second]
    force = ran(data, tmp_path, engine).results.rows["lid_force_z"]
    assert force.iloc[[38, 78]].to_numpy() == pytest.approx([0.05, 0.03], rel=2e-3)


@pytest.mark.lammps
def test_a_servo_that_does_not_reach_its_force_says_so(tmp_path):
    data = pressed(duration="0.4 ms", restitution=None) | {"output": {"rows": 10, "particles": 0}}
    outcome = ran(data, tmp_path, "lammps")
    found = outcome.results.rows["lid_force_z"].tail(2).mean()
    (said,) = [said for said in outcome.warnings if "the force of wall lid" in said]
    assert f"the force of wall lid is {found:.4g} N in the last rows, requested are 0.05 N" in said


def test_without_dashpots_and_below_the_stable_speed_a_wall_has_the_speed_of_the_case():
    for data in (pressed(restitution=None), pressed(speed="0.001 m/s")):
        p = plan(parse(data))
        move = p.phases[0].moves["lid"]
        assert move.speed_in_contact == move.highest_speed == p.scene.phase[0].moves["lid"].highest_speed
        assert not [said for said in planned_warnings(p) if "oscillate" in said]
