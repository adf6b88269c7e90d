# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of parts in LIGGGHTS: what is filled in, what walls bear, what single spheres do, which leave the room."""

import math
import re
import tomllib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from parts_cases import BED, CASES, FLOOR, bead, driven, mm, mps, own, parts, pipe, timed
from scene_runs import ran, run, write_case
from test_parts_motions import PLATE

from epdem.case.scene import parse
from epdem.errors import CaseError
from epdem.scenes.judge.measures import curves
from epdem.scenes.plan.plan import plan


@pytest.fixture(scope="module")
def sieved(shared):
    """The case of the sieve table, short: what is weighed is there from the first step."""
    data = own("sieve_cylinder")
    data["scene"]["fill"][0]["particles"][0]["radius"]["sieve"] = str(CASES / "parts/sieve.csv")
    data["numerics"] = {"time_step": "2e-5 s"}
    folder = shared("sieved", lambda folder: ran(data, folder))
    return run(folder / "case.toml", out=folder / "out")


@pytest.mark.liggghts
def test_the_spheres_have_the_masses_that_the_sieve_table_gives(sieved):
    spheres = sieved.results.particles
    last = spheres[spheres["step"] == spheres["step"].max()]
    mass = last.groupby(["type", "radius"])["mass"].sum()
    heaviest = 2500 * 4 / 3 * math.pi * 1.5875e-3**3
    assert mass.sum() == pytest.approx(8e-3, abs=heaviest)
    for diameter, share in ((3.175, 0.184), (2.52, 0.461), (2.02, 0.355)):
        here = mass[[(t, r) for t, r in mass.index if t == 1 and abs(r - diameter / 2000) < 1e-9]].sum()
        assert here == pytest.approx(0.7 * 8e-3 * share, abs=1.01 * 2500 * math.pi / 6 * (diameter * 1e-3) ** 3)


@pytest.mark.liggghts
def test_the_floor_of_a_smooth_cylinder_bears_the_weight_of_the_bed(sieved):
    spheres, last = sieved.results.particles, sieved.results.rows.iloc[-1]
    weight = 9.81 * spheres[spheres["step"] == spheres["step"].max()]["mass"].sum()
    assert -last["floor_force_z"] == pytest.approx(weight, rel=0.02)
    assert abs(last["cylinder_force_z"]) < 1e-9 * weight  # no friction
    checks = sieved.results.checks.set_index("key")
    assert checks["passed"].all() and "force_on_all_walls" in checks.index


@pytest.mark.liggghts
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


@pytest.mark.liggghts
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


STRAY = bead("stray", mm(0, 0, 20), "1 mm", "glass", velocity=mps(1.1, 0, 0))  # leaves at x = 10 mm after 9.1 ms
CALM = bead("calm", mm(-5, 0, 1), "1 mm", "glass")


def lost_outcome(folder, *, particles=10, **scene):
    data = parts(wall=[FLOOR], fill=[], gravity="0 m/s^2") | {"output": {"rows": 20, "particles": particles}}
    data["scene"] |= {"body": [CALM, STRAY], **scene}
    return ran(data, folder)


@pytest.mark.liggghts
def test_a_lost_sphere_is_named_with_its_last_place_and_time_also_of_a_stored_run(tmp_path):
    first, again = lost_outcome(tmp_path), lost_outcome(tmp_path)
    assert again.reused and again.warnings == first.warnings and not first.passed
    (said,) = [w for w in first.warnings if "left the room" in w]
    assert "1 spheres have left the room, the first between 0.009 s and 0.01 s, sphere 2 (last at (0.0088" in said
    assert said.endswith("close the walls, enlarge scene.room, or give scene.open_boundary = true")


@pytest.mark.liggghts
def test_without_frames_the_rows_tell_when(tmp_path):
    said = [w for w in lost_outcome(tmp_path, particles=0).warnings if "left the room" in w or "left the" in w]
    assert len(said) == 1 and "1 spheres have left the room, the first between 0.0" in said[0]


@pytest.mark.liggghts
def test_many_are_counted(tmp_path):
    row = [STRAY | {"name": f"s{y}", "position": mm(0, y, 20)} for y in (0, 3, 6, 9)]
    (said,) = [w for w in lost_outcome(tmp_path, body=[CALM, *row]).warnings if "left the room" in w]
    assert said.startswith("scene: 4 spheres have left the room, the first between ") and "sphere 4 (" in said
    assert said.count("sphere ") == 3


@pytest.mark.liggghts
@pytest.mark.parametrize("scene", [{"open_boundary": True}, {"periodic": True}])
def test_an_open_or_periodic_room_loses_nothing_that_is_said(scene, tmp_path):
    assert not [w for w in lost_outcome(tmp_path, **scene).warnings if "left the" in w]


TUBE = pipe("tube", "-1 mm", "39 mm", "16 mm")
PRESS = driven("tube", [0.0, 0.0, -1.0], "0.1 N", "0.1 m/s")
REGION = {"diameter": "12 mm", "z": mm(1, 30)}
FIRST, SECOND = timed("first", "2 ms"), timed("second", "2 ms")


def scene_of_tube(*, wall, phase=(FIRST, SECOND), **more):
    bed = BED | {"region": REGION, "count": 8} | more.pop("bed", {})
    data = parts(wall=[FLOOR, TUBE | wall], fill=[bed], phase=list(phase), open_boundary=True, **more)
    data["output"] = {"rows": 4, "particles": 4}
    return data


@pytest.mark.liggghts
@settings(max_examples=12)
@given(
    wall=st.fixed_dictionaries(
        {},
        optional={
            "angular_velocity": st.just("60 rpm"),
            "wear": st.just("1e-9 m^2/N"),
            "stress": st.just(True),
            "center": st.just(mm(1, 0)),
        },
    ),
    pressed=st.booleans(),
    loads=st.booleans(),
)
def test_a_round_wall_turns_wears_bears_and_is_pressed(wall, pressed, loads, tmp_path_factory):
    first = FIRST | ({"move": [PRESS]} if pressed else {})
    data = scene_of_tube(wall=wall, phase=[first])
    data["output"]["loads"] = loads
    if pressed and "angular_velocity" in wall:
        with pytest.raises(CaseError, match=r"scene.wall.tube: a wall that a force drives has no angular_velocity"):
            plan(parse(data))
        return
    folder = tmp_path_factory.mktemp("wall")
    assert ran(data, folder).results.rows["particles"].iloc[-1] == 8


@pytest.mark.liggghts
@pytest.mark.parametrize("bed", [{"phase": "second"}, {"phase": "second", "rate": "10 kHz"}, {}])
def test_spheres_may_come_with_a_later_phase_and_pass_a_plane_or_never_be_in_a_frame(bed, tmp_path):
    flow = {"name": "down", "kind": "flow", "direction": "-z", "at": "5 mm"}
    phases = [FIRST | {"record": False}, SECOND]
    results = run(
        write_case(scene_of_tube(wall={}, phase=phases, bed=bed, measure=[flow]), tmp_path), out=tmp_path / "o"
    ).results
    assert results.rows["particles"].iloc[-1] == 8 and results.tables["measures"]["down"].notna().all()


@pytest.mark.liggghts
def test_a_flow_without_a_sphere_in_any_frame_is_zero(tmp_path):
    """As of a run whose spheres leave the room before the first frame."""
    flow = {"name": "down", "kind": "flow", "direction": "-z", "at": "5 mm"}
    outcome = ran(scene_of_tube(wall={}, measure=[flow]), tmp_path)
    empty = outcome.results.tables | {"particles": outcome.results.particles.iloc[:0]}
    assert not curves(outcome.plan, empty)["down"].any()


DOCS = CASES.parent / "docs"


def block(page: str, language: str) -> str:
    """The first block of a language of a page."""
    return re.search(rf"^```{language}(?: in [^\n]*)?\n(.*?)^```$", (DOCS / page).read_text(), re.M | re.S)[1]


@pytest.mark.liggghts
def test_the_example_runs_and_the_tables_are_read_as_shown(tmp_path, monkeypatch):
    """Shortened in time, with a wall of triangles and measures, so that every table is there."""
    example = tomllib.loads(block("parts.md", "toml"))["scene"]
    for phase in example["phase"]:
        phase["duration"] = "4 ms"
    example["fill"][0]["mass"] = "0.5 g"
    example["wall"].append(PLATE | {"name": "lid", "stress": True})
    example["measure"] = [{"name": "top", "kind": "height"}, {"name": "work", "kind": "plastic_work"}]
    outcome = run(write_case(parts(**example), tmp_path), out=tmp_path / "runs/compaction_powder")
    assert outcome.passed, outcome.results.checks
    monkeypatch.chdir(tmp_path)
    lines = [line.split("#")[0] for line in block("scenes.md", "python").splitlines()]
    shown = [part.strip() for line in lines if line.startswith("r.") for part in line.split(",")]
    space: dict = {}
    exec("\n".join(lines), space)
    tables = {part: eval(part, space) for part in shown}
    assert len(tables) == 9 and all(len(table) for table in tables.values())
