# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls that moved before: loads, power, normals, velocities and restarts, of one sphere or some on a plate."""

import numpy as np
import pytest
from parts_cases import BED, bead, flat, linear, mm, mps, parts, timed, vibrating
from scene_runs import HOSTS, LIGGGHTS, YADE, assert_goes_on, ran, run, write_case

from epdem.case.scene import parse
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


TUBE = {"name": "tube", "kind": "cylinder", "axis": "x", "diameter": "14 mm", "material": "steel"}
TUBE |= {"from": "-20 mm", "to": "20 mm"}
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
