# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of parts in LIGGGHTS: what is filled in, what walls bear, what single spheres do, which leave the room."""

import math

import numpy as np
import pytest
from parts_cases import BED, CASES, FLOOR, bead, mm, mps, own, parts, timed
from scene_runs import ran, run

pytestmark = pytest.mark.liggghts


@pytest.fixture(scope="module")
def sieved(shared):
    """The case of the sieve table, short: what is weighed is there from the first step."""
    data = own("sieve_cylinder")
    data["scene"]["fill"][0]["particles"][0]["radius"]["sieve"] = str(CASES / "parts/sieve.csv")
    data["numerics"] = {"time_step": "2e-5 s"}
    folder = shared("sieved", lambda folder: ran(data, folder))
    return run(folder / "case.toml", out=folder / "out")


def test_the_spheres_have_the_masses_that_the_sieve_table_gives(sieved):
    spheres = sieved.results.particles
    last = spheres[spheres["step"] == spheres["step"].max()]
    mass = last.groupby(["type", "radius"])["mass"].sum()
    heaviest = 2500 * 4 / 3 * math.pi * 1.5875e-3**3
    assert mass.sum() == pytest.approx(8e-3, abs=heaviest)
    for diameter, share in ((3.175, 0.184), (2.52, 0.461), (2.02, 0.355)):
        here = mass[[(t, r) for t, r in mass.index if t == 1 and abs(r - diameter / 2000) < 1e-9]].sum()
        assert here == pytest.approx(0.7 * 8e-3 * share, abs=1.01 * 2500 * math.pi / 6 * (diameter * 1e-3) ** 3)


def test_the_floor_of_a_smooth_cylinder_bears_the_weight_of_the_bed(sieved):
    spheres, last = sieved.results.particles, sieved.results.rows.iloc[-1]
    weight = 9.81 * spheres[spheres["step"] == spheres["step"].max()]["mass"].sum()
    assert -last["floor_force_z"] == pytest.approx(weight, rel=0.02)
    assert abs(last["cylinder_force_z"]) < 1e-9 * weight  # no friction
    checks = sieved.results.checks.set_index("key")
    assert checks["passed"].all() and "force_on_all_walls" in checks.index


def test_the_energy_of_a_scene_with_an_stl_wall_and_an_impactor_closes(tmp_path):
    data = own("impactor_bowl")
    del data["contact"]
    data["scene"]["wall"][0]["file"] = str(CASES / "parts/bowl.stl")
    for phase, duration in zip(data["scene"]["phase"], ("40 ms", "30 ms"), strict=True):
        phase["duration"] = duration
    outcome = ran(data, tmp_path)
    balance, spheres = outcome.results.energy_balance, outcome.results.particles
    assert outcome.passed, outcome.results.checks
    came = spheres[spheres["radius"] > 3e-3]
    start = outcome.plan.phases[0].end
    assert came["step"].min() >= start and (came["z"].diff().iloc[1:3] < 0).all()
    assert balance["step"].iloc[0] >= start and balance["plastic"].iloc[-1] > 0.1 * balance["kinetic"].iloc[0]


def test_spheres_of_a_table_begin_where_it_says_and_frozen_ones_stay(tmp_path):
    (tmp_path / "s.csv").write_text("x,y,z,radius,material,vz\n0,0,0.03,0.001,glass,-1\n0.004,0,0.01,0.002,steel,0.5\n")
    held = bead("held", mm(0, 0, 20), "2 mm", "steel", frozen=True)
    late = bead("late", mm(-5, 5, 20), "1 mm", "glass", velocity=mps(0.2, 0, 0), phase="second")
    gate = FLOOR | {"name": "gate", "at": "5 mm", "phases": ["first"]}
    scene = {
        "wall": [FLOOR, gate],
        "fill": [{"name": "table", "file": "s.csv"}],
        "body": [held, late],
        "phase": [timed("first", "20 ms"), timed("second", "20 ms")],
    }
    results = ran(parts(**scene), tmp_path).results
    frames = dict(tuple(results.particles.groupby("step")))
    start, end = frames[0].set_index("id"), frames[max(frames)].set_index("id")
    columns = ["x", "y", "z", "vx", "vy", "vz", "radius"]
    assert start.loc[1, columns].to_numpy() == pytest.approx([0, 0, 0.03, 0, 0, -1, 0.001])
    assert start.loc[2, columns].to_numpy() == pytest.approx([0.004, 0, 0.01, 0, 0, 0.5, 0.002])
    assert start.loc[2, "mass"] == pytest.approx(7800 * 4 / 3 * math.pi * 0.002**3)
    assert end.loc[3, columns].to_numpy() == pytest.approx([0, 0, 0.02, 0, 0, 0, 0.002], abs=1e-15)
    t = 0.02
    assert end.loc[4, "x"] == pytest.approx(-0.005 + 0.2 * t, rel=1e-6)
    assert end.loc[4, "z"] == pytest.approx(0.02 - 9.81 / 2 * t**2, rel=1e-3)
    assert np.isin([0, max(frames)], [*frames]).all() and len(end) == 4


def test_a_gate_holds_what_falls_until_its_phase_ends(tmp_path):
    gate = FLOOR | {"name": "gate", "at": "5 mm", "phases": ["first"]}
    phases = [timed("first", "0.1 s"), timed("second", "30 ms")]
    region = BED["region"] | {"z": mm(6, 30)}
    data = parts(wall=[gate, FLOOR], fill=[BED | {"region": region}], phase=phases, open_boundary=True)
    outcome = ran(data, tmp_path)
    lowest = outcome.results.particles.groupby("step").apply(lambda x: (x["z"] - x["radius"]).min())
    opened = outcome.plan.phases[0].end
    assert lowest[lowest.index <= opened].min() > 4.9e-3
    assert lowest.iloc[-1] < 3e-3


STRAY = bead("stray", mm(0, 0, 20), "1 mm", "glass", velocity=mps(1.1, 0, 0))  # leaves at x = 10 mm after 9.1 ms
CALM = bead("calm", mm(-5, 0, 1), "1 mm", "glass")


def lost_outcome(folder, *, particles=10, **scene):
    data = parts(wall=[FLOOR], fill=[], gravity="0 m/s^2") | {"output": {"rows": 20, "particles": particles}}
    data["scene"] |= {"body": [CALM, STRAY], **scene}
    return ran(data, folder)


def test_a_lost_sphere_is_named_with_its_last_place_and_time_also_of_a_stored_run(tmp_path):
    first, again = lost_outcome(tmp_path), lost_outcome(tmp_path)
    assert again.reused and again.warnings == first.warnings and not first.passed
    (said,) = [w for w in first.warnings if "left the room" in w]
    assert "1 spheres have left the room, the first between 0.009 s and 0.01 s, sphere 2 (last at (0.0088" in said
    assert said.endswith("close the walls, enlarge scene.room, or give scene.open_boundary = true")


def test_without_frames_the_rows_tell_when(tmp_path):
    said = [w for w in lost_outcome(tmp_path, particles=0).warnings if "left the room" in w or "left the" in w]
    assert len(said) == 1 and "1 spheres have left the room, the first between 0.0" in said[0]


def test_many_are_counted(tmp_path):
    row = [STRAY | {"name": f"s{y}", "position": mm(0, y, 20)} for y in (0, 3, 6, 9)]
    (said,) = [w for w in lost_outcome(tmp_path, body=[CALM, *row]).warnings if "left the room" in w]
    assert said.startswith("scene: 4 spheres have left the room, the first between ") and "sphere 4 (" in said
    assert said.count("sphere ") == 3


@pytest.mark.parametrize("scene", [{"open_boundary": True}, {"periodic": True}])
def test_an_open_or_periodic_room_loses_nothing_that_is_said(scene, tmp_path):
    assert not [w for w in lost_outcome(tmp_path, **scene).warnings if "left the" in w]
