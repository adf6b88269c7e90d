# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls that moved before, and walls that a force drives: loads, power, normals, velocities and restarts."""

import math

import numpy as np
import pytest
from parts_cases import BED, FLOOR, bead, driven, flat, linear, mm, mps, parts, pipe, timed, vibrating, write_stl
from scene_runs import HOSTS, LAMMPS, LIGGGHTS, PRESSES, YADE, assert_goes_on, ran, run, write_case

from epdem.case.scene import parse
from epdem.scenes.judge.warnings import planned_warnings
from epdem.scenes.plan.plan import plan

ROOM = {"x": mm(-20, 20), "y": mm(-20, 20), "z": mm(-5, 40)}
PLATE = flat("plate", mm(0, 0, 0), mm(14, 15))
X, Y, RADIUS = 3e-3, -1e-3, 1e-3  # of the ball [m]
BALL = bead("ball", mm(3, -1, 0.9999), "1 mm", "glass")
WEIGHT = 9.81 * 2500 * 4 / 3 * np.pi * RADIUS**3  # [N]
ASIDE = linear("plate", 0.5, 0, 0)


def one_ball(*phases: dict, ball: dict = BALL, restitution: float = 0.3, step: str = "2e-6 s", **tables: dict) -> dict:
    """A sphere on a plate; phases: of 5 ms."""
    named = [timed(f"phase{n}", "5 ms") | phase for n, phase in enumerate(phases)]
    data = parts(room=ROOM, wall=[PLATE], fill=[], body=[ball], phase=named)
    return data | {"numerics": {"time_step": step}, "viscous": {"restitution": restitution}} | tables


@pytest.mark.parametrize("engine", HOSTS)
def test_the_torque_on_a_plate_is_about_a_place_at_rest(engine, tmp_path):
    """The weight of a smooth sphere that rests while the plate slides away below it: r x F about 0."""
    outcome = ran(one_ball({"move": [ASIDE]}, {}), tmp_path, engine)
    row = outcome.results.rows.iloc[-1]
    assert row["plate_force_z"] == pytest.approx(-WEIGHT, rel=1e-3)
    expected = [-WEIGHT * Y, WEIGHT * X, 0.0]
    assert [row[f"plate_torque_{x}"] for x in "xyz"] == pytest.approx(expected, abs=1e-3 * WEIGHT * X)


TUBE = pipe("tube", "-20 mm", "20 mm", "14 mm", axis="x")
NARROW = {"x": mm(-20, 20), "y": mm(-8, 8), "z": mm(-8, 8)}


@pytest.mark.parametrize("engine", HOSTS)
@pytest.mark.parametrize("wall", ["plate", "tube"])
def test_the_torque_on_a_wall_has_that_of_rolling_friction(wall, engine, tmp_path):
    """A sphere that rolls along x: r x F of its place and the row's force, and mu_r R W about y (cdt)."""
    low = {"plate": 0.0, "tube": -7e-3}[wall]
    ball = BALL | {"position": mm(-4, 0, 1e3 * low + 0.9999)}
    ball |= {"velocity": mps(0.1, 0, 0), "spin": ["0 rad/s", "100 rad/s", "0 rad/s"]}
    contact = {"friction": 0.8, "rolling": {"model": "cdt", "coefficient": 0.2}}
    data = one_ball({}, {}, ball=ball, contact=contact, output={"rows": 20, "particles": 20, "loads": True})
    if wall == "tube":
        data["scene"] |= {"wall": [TUBE], "room": NARROW}
    found = ran(data, tmp_path, engine).results
    row, x = found.rows.iloc[-1], found.particles.set_index("step")["x"].iloc[-2:].mean()
    force_x, force_z = row[f"{wall}_force_x"], row[f"{wall}_force_z"]
    assert force_z == pytest.approx(-WEIGHT, rel=1e-3)
    couple = row[f"{wall}_torque_y"] - (low * force_x - x * force_z)
    assert couple == pytest.approx(0.2 * RADIUS * WEIGHT, rel=0.01)


@pytest.mark.parametrize("engine", [LIGGGHTS, YADE])
def test_a_plate_that_tilts_after_a_way_gives_its_work(engine, tmp_path):
    """It lifts the sphere by its turn times the arm."""
    tilt = {"wall": "plate", "kind": "rotate", "axis": [0, 1, 0], "rate": "-4 rad/s"}
    data = one_ball({"move": [ASIDE]}, {"move": [tilt]}, restitution=0.999, contact={"friction": 0.3})
    outcome = ran(data, tmp_path, engine)
    balance = outcome.results.energy_balance
    lifted = WEIGHT * 4 * 5e-3 * X
    work = balance["work"].iloc[-1] - balance["work"][balance["step"] <= outcome.plan.phases[0].end].iloc[-1]
    assert work == pytest.approx(lifted, rel=0.2)  # it rolls, and has a speed at the end


@pytest.mark.parametrize("engine", HOSTS)
def test_the_normal_of_a_plate_is_geometry(engine, tmp_path):
    """Of a sphere that a plate pulls up by adhesion, beside one that a dashpot slows: also where forces change sign."""
    up = linear("plate", 0, 0, 0.02)
    ball = BALL | {"position": mm(3, -1, -0.9999)}
    law = {"name": "jkr", "work_of_adhesion": "0.5 J/m^2"}
    data = one_ball({"move": [up]}, ball=ball, law=law, output={"rows": 40, "particles": 40, "contacts": 40})
    contacts = ran(data, tmp_path, engine).results.contacts
    assert contacts["step"].min() == 0 and len(contacts) > 40
    assert (contacts["force"] < 0).any() and (contacts["force"] > 0).any()
    normals = contacts[["normal_x", "normal_y", "normal_z"]].to_numpy()
    assert normals == pytest.approx(np.tile([0.0, 0.0, -1.0], (len(contacts), 1)), abs=1e-9)


@pytest.mark.liggghts
@pytest.mark.lammps
def test_vibrating_walls_are_the_same_in_liggghts_and_lammps(tmp_path):
    """Through phases of two time steps, one of which the motion begins in; rounding alone is left."""
    shake = vibrating("plate", mm(0, 0.1, 0.5), "300 Hz")
    ball = BALL | {"position": mm(3, -1, 1.05)}
    phases = ({"move": [shake]}, {"move": [shake], "time_step": "1.4e-6 s"})
    data = one_ball(*phases, ball=ball, contact={"friction": 0.3})
    path = write_case(data, tmp_path)
    places = [
        run(path, engine, out=tmp_path / engine).results.particles[["z", "vx", "vy", "vz"]].to_numpy()
        for engine in ("liggghts", "lammps")
    ]
    assert abs(places[0][:, 3]).max() > 0.5
    assert places[0] == pytest.approx(places[1], abs=1e-9)


def pressed(*moves: dict, height: str) -> dict:
    """A bed under or on a lid with friction and both dashpots, a phase for each motion and one of rest."""
    lid = PLATE | {"name": "lid", "center": ["0 mm", "0 mm", height], "size": mm(17.9, 17.9)}
    box = {"name": "box", "kind": "box", "x": mm(-9, 9), "y": mm(-9, 9), "z": mm(0, 39)}
    bed = BED | {"count": 60, "region": BED["region"] | {"z": mm(0.6, 11.4)}}
    every = [[{"wall": "lid"} | move] for move in moves] + [[]]
    phases = [timed(f"phase{n}", "10 ms", move=move) for n, move in enumerate(every)]
    data = parts(wall=[box | {"material": "steel"}, lid], fill=[bed], phase=phases) | {"viscous": {"restitution": 0.5}}
    data |= {"contact": {"friction": 0.3, "tangential_restitution": 0.5}, "numerics": {"time_step": "1e-5 s"}}
    return data | {"output": {"rows": 16, "particles": 8, "restarts": 8, "contacts": 8}}


DOWN = {"kind": "linear", "velocity": mps(0.05, 0, -0.3)}
SLOWER = DOWN | {"velocity": mps(0, 0, -0.2)}
HELD = {"kind": "press", "direction": [0, 0, 1], "force": "50 mN", "highest_speed": "0.3 m/s"}


@pytest.mark.parametrize(
    ("engine", "moves"),
    [
        pytest.param("liggghts", (DOWN, SLOWER, SLOWER), marks=pytest.mark.liggghts),
        pytest.param("lammps", (DOWN, SLOWER, SLOWER), marks=[pytest.mark.lammps, pytest.mark.thorough]),
        pytest.param("lammps", (HELD, HELD), marks=pytest.mark.lammps, id="lammps-press"),
    ],
)
def test_a_run_under_a_moving_wall_goes_on_bitwise_with_dashpots(engine, moves, tmp_path):
    """From every restart file: every table, the frame in which the run goes on included."""
    p = plan(parse(pressed(*moves, height="0.5 mm" if HELD in moves else "12 mm")))
    whole, steps = assert_goes_on(p, tmp_path, engine)
    assert (whole["contacts"]["wall"] == "lid").any() and len(steps) > 5


@pytest.mark.parametrize("engine", HOSTS)
def test_a_wall_that_never_yields_is_that_of_a_strength_which_no_pressure_reaches(engine, tmp_path):
    ends = []
    for strength in ("inf Pa", "1e5 GPa"):
        data = one_ball({}, ball=BALL | {"velocity": mps(0, 0, -1)})
        data["materials"] = data["materials"] | {"steel": data["materials"]["steel"] | {"yield_stress": strength}}
        del data["viscous"]
        folder = tmp_path / strength.replace(" ", "")
        ends.append(ran(data, folder, engine).results.particles.iloc[-1])
    assert ends[0]["vz"] == pytest.approx(ends[1]["vz"], rel=1e-9) and 0.1 < ends[0]["vz"] < 0.95


@pytest.mark.parametrize("engine", HOSTS)
def test_the_torque_on_a_plate_is_taken_in_the_middle_of_the_overlap(engine, tmp_path):
    """A plate slides below a frozen sphere: half of the overlap times the friction."""
    overlap = 0.1e-3
    ball = BALL | {"position": mm(0, 0, 0.9), "frozen": True}
    data = one_ball({"move": [ASIDE]}, ball=ball, contact={"friction": 0.3}, law={"name": "hertz"})
    data["scene"]["phase"][0]["duration"] = "1 ms"
    row = ran(data, tmp_path, engine).results.rows.iloc[-1]
    assert row["plate_force_x"] == pytest.approx(0.3 * row["plate_force_z"], rel=1e-6) and row["plate_force_z"] < 0
    assert row["plate_torque_y"] == pytest.approx(-0.5 * overlap * row["plate_force_x"], rel=1e-6)


PLATE_ABOVE = {"name": "lid", "kind": "plate", "axis": "z", "center": mm(0, 0, 3.05), "size": mm(18, 18)}
NINE = [(x, y) for x in (-4, 0, 4) for y in (-4, 0, 4)]


def under_plate(*, duration="20 ms", restitution=0.6, speed="0.2 m/s"):
    """Nine spheres under a plate, 50 mN."""
    press = driven("lid", "-z", "50 mN", speed)
    ball = {"material": "glass", "radius": "1.5 mm"}
    data = parts(
        gravity="0 m/s^2",
        wall=[FLOOR, PLATE_ABOVE | {"material": "steel"}],
        fill=[],
        body=[ball | {"name": f"b{n}", "position": mm(x, y, 1.5)} for n, (x, y) in enumerate(NINE)],
        phase=[timed("press", duration, move=[press])],
    )
    data |= {"law": {"name": "hertz"}, "numerics": {"time_step": "5e-6 s", "highest_speed": "0.1 m/s"}}
    return data | ({"viscous": {"restitution": restitution}} if restitution else {})


@pytest.mark.parametrize("engine", PRESSES)
def test_a_servo_beside_dashpots_reaches_its_force(engine, tmp_path):
    """At 0.2 m/s n c v/F is 6: the speed alternated between both limits, at 65 to 72 mN and powers of both signs."""
    data = under_plate() | {"output": {"rows": 40, "particles": 4, "energy": True}}
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
    for lid in (PLATE_ABOVE | {"material": "steel", "center": mm(0, 0, 3.0504)}, stl):
        data = under_plate() | {"output": {"rows": 40, "energy": True}}
        data["scene"]["wall"] = [FLOOR, lid]
        path = write_case(data, tmp_path / lid["kind"])
        write_stl(tmp_path / lid["kind"] / "lid.stl", square[[[0, 1, 2], [0, 2, 3]]])
        rows = run(path, engine, out=tmp_path / lid["kind"] / "out").results.rows
        forces.append(rows["lid_force_z"].to_numpy())
    assert forces[0][-1] == pytest.approx(0.05, rel=1e-3)
    assert np.abs(forces[1] - forces[0]).max() <= 1e-6 * 0.05


PUSHED = [pytest.param(*host.values, kind, marks=host.marks) for kind in ("press", "vibrate") for host in PRESSES]


@pytest.mark.parametrize(("engine", "kind"), [*PUSHED, pytest.param(*YADE.values, "vibrate", marks=YADE.marks)])
def test_the_work_of_a_wall_that_changes_its_speed_is_all_in_elastic_spheres(engine, kind, tmp_path):
    """Where the wall is at rest: at the end of a press, at the turning points of a vibration. With the speeds of the
    last or of the next step the work is off by 1e-2."""
    data = under_plate(restitution=None, speed="0.02 m/s", duration="5 ms")
    data["scene"]["wall"] = [FLOOR, PLATE_ABOVE | {"material": "steel", "center": mm(0, 0, 3)}]
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


@pytest.mark.parametrize("engine", PRESSES)
def test_a_second_phase_presses_with_another_force(engine, tmp_path):
    data = under_plate() | {"output": {"rows": 80, "particles": 2}}
    (first,) = data["scene"]["phase"]
    second = first | {"name": "less", "move": [first["move"][0] | {"force": "30 mN"}]}
    data["scene"]["phase"] = [first, second]
    force = ran(data, tmp_path, engine).results.rows["lid_force_z"]
    assert force.iloc[[38, 78]].to_numpy() == pytest.approx([0.05, 0.03], rel=2e-3)


@pytest.mark.lammps
def test_a_servo_that_does_not_reach_its_force_says_so(tmp_path):
    data = under_plate(duration="0.4 ms", restitution=None) | {"output": {"rows": 10, "particles": 0}}
    outcome = ran(data, tmp_path, "lammps")
    found = outcome.results.rows["lid_force_z"].tail(2).mean()
    (said,) = [said for said in outcome.warnings if "the force of wall lid" in said]
    assert f"the force of wall lid is {found:.4g} N in the last rows, requested are 0.05 N" in said


def test_without_dashpots_and_below_the_stable_speed_a_wall_has_the_speed_of_the_case():
    for data in (under_plate(restitution=None), under_plate(speed="0.001 m/s")):
        p = plan(parse(data))
        move = p.phases[0].moves["lid"]
        assert move.speed_in_contact == move.highest_speed == p.scene.phase[0].moves["lid"].highest_speed
        assert not [said for said in planned_warnings(p) if "oscillate" in said]
