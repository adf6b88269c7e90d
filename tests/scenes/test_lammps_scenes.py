# SPDX-License-Identifier: GPL-2.0-or-later
"""Bulk scenes in LAMMPS: the way of the spheres in LIGGGHTS, the energy that moving walls bring, what is refused."""

import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
from parts_cases import BED, CASES, FLOOR, linear, mm, mps, own, parts, timed, vibrating, write_stl
from scene_runs import LAMMPS, LIGGGHTS, assert_alike, in_hosts, ran, run, write_case
from test_parts_motions import PLATE, moved

from engines.lammps_decks import column, lammps, needs_lammps
from epdem.case.scene import load, parse
from epdem.engines import scene_engine
from epdem.engines.lammps import deck as lammps_scene
from epdem.engines.liggghts.primitives import tubes
from epdem.errors import EngineError
from epdem.scenes.plan.plan import plan
from epdem.scenes.plan.quantities import SPINS
from epdem.scenes.tables.columns import last_frame
from marks import thorough

ROOT = CASES.parent


def plane(name, axis, at):
    return {"name": name, "kind": "plane", "axis": axis, "at": at, "material": "steel"}


SIDES = [plane(f"{axis}{at[:2]}", axis, at) for axis in "xy" for at in ("-9 mm", "9 mm")]
SIDES = [side | {"name": name} for side, name in zip(SIDES, ("left", "right", "front", "back"), strict=True)]


@needs_lammps
@pytest.mark.liggghts
@pytest.mark.parametrize("kind", ["drum", "hopper"])
def test_round_walls_hold_and_drive_a_bed_as_in_liggghts(kind, tmp_path):
    """Drum: torque of the bed, which is that of its weight. Hopper: spheres that flow out in 0.15 s."""
    data = own(f"{kind}_beads")
    keys = {"drum": {"duration": "0.4 s"}, "hopper": {"duration": "0.15 s", "fill_time": "0.12 s"}}[kind]
    data["scene"] |= keys | {"count": {"drum": 300, "hopper": 500}[kind]}
    if kind == "drum":
        del data["contact"]["rolling"]
        data["output"] |= {"rows": 100, "particles": 25}
    ours, theirs = in_hosts(data, tmp_path, "lammps", "liggghts")
    if kind == "drum":
        a, b = (found.rows["torque"][len(found.rows) // 2 :].mean() for found in (ours, theirs))
        assert all(found.checks.set_index("key")["passed"]["torque_of_the_bed"] for found in (ours, theirs))
    else:
        a, b = ((last_frame(found.particles)["z"] < -0.01).sum() for found in (ours, theirs))
    assert a == pytest.approx(b, rel=0.1) and abs(b) > 0
    assert (ours.rows["particles"] == theirs.rows["particles"].max()).all()


@needs_lammps
@pytest.mark.liggghts
@pytest.mark.parametrize("ranks", [1, 2])
def test_a_sphere_takes_the_way_of_liggghts_in_a_bowl_of_triangles_that_shakes(ranks, tmp_path):
    """From the same lines, of a sphere that hits the middle of a facet: rows and places."""
    row = "5e-3,1e-3,9e-3,1.5e-3,glass,0.33,0.1,-0.9"
    (tmp_path / "spheres.csv").write_text(f"x,y,z,radius,material,vx,vy,vz\n{row}\n")
    bowl = next(wall for wall in own("impactor_bowl")["scene"]["wall"] if wall["kind"] == "stl")
    wall = bowl | {"file": str(CASES / "parts/bowl.stl"), "material": "steel"}
    shake = vibrating(wall["name"], mm(0.1, 0, 0.2), "60 Hz")
    data = parts(
        wall=[wall],
        room={axis: mm(-40, 40) for axis in "xyz"},
        fill=[{"name": "table", "file": "spheres.csv"}],
        phase=[timed("shake", "30 ms", move=[shake])],
    )
    data["numerics"] = {"time_step": "2e-6 s"}
    data["contact"] = {"friction": 0.3}
    path = write_case(data, tmp_path)
    ours = run(path, engine="lammps", out=tmp_path / "lammps", ranks=ranks).results
    theirs = run(path, engine="liggghts", out=tmp_path / "liggghts").results
    assert np.abs(theirs.rows["bowl_force_z"]).max() > 0
    assert_alike(ours.rows, theirs.rows, theirs.rows, 1e-6)
    assert_alike(ours.particles, theirs.particles, ("x", "z", "vy", "omega_x"), 1e-6)


@needs_lammps
@pytest.mark.liggghts
@pytest.mark.parametrize("kind", ["fold", "plate"])
def test_a_sphere_crosses_edges_with_friction_as_in_liggghts(kind, tmp_path):
    """A convex fold of 10 degrees; the diagonal of a plate that moves."""
    slope = 0.04 * np.tan(np.radians(10)) if kind == "fold" else 0.0
    x, z = (-0.02, 0.0, 0.02), (0.0, 0.0, -slope / 2)
    a, b = ([(x[k], y, z[k]) for k in range(3)] for y in (-0.02, 0.02))
    triangles = [t for k in (0, 1) for t in ((a[k], a[k + 1], b[k + 1]), (a[k], b[k + 1], b[k]))]
    write_stl(tmp_path / "floor.stl", np.array(triangles))
    starts = [(-1e-4 * k, 4e-3 * k - 0.014) for k in range(8)] + [(-0.01 - 1e-5 * k, 4e-3 * k - 0.014) for k in (1, 2)]
    lines = [f"{x!r},{y!r},1.5003e-3,1.5e-3,glass,2,0.3,-0.5" for x, y in starts]
    (tmp_path / "spheres.csv").write_text("\n".join(["x,y,z,radius,material,vx,vy,vz", *lines, ""]))
    move = linear("floor", 0.1, 0, 0.2)
    data = parts(
        wall=[{"name": "floor", "kind": "stl", "file": "floor.stl", "material": "steel"}],
        room={axis: mm(-40, 40) for axis in "xyz"},
        fill=[{"name": "table", "file": "spheres.csv"}],
        phase=[timed("hit", "2 ms") | ({"move": [move]} if kind == "plate" else {})],
    )
    data["numerics"] = {"time_step": "1e-7 s"}
    data["contact"] = {"friction": 0.3}
    ours, theirs = (last_frame(found.particles) for found in in_hosts(data, tmp_path, "lammps", "liggghts"))
    names = ["vx", "vy", "vz", "omega_x", "omega_y"]
    assert_alike(ours, theirs, names, 1e-9)
    assert (np.abs(theirs[names]).max() > 0).all()


@needs_lammps
@pytest.mark.liggghts
@pytest.mark.parametrize("name", [thorough("screw"), thorough("hopper"), thorough("drum")])
def test_scenes_with_an_stl_wall_agree_in_both_hosts_and_with_their_table(name, monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(str(ROOT / "bench"))
    import stl_scenes

    stored = pd.read_csv(stl_scenes.TABLE)
    for host in stl_scenes.HOSTS:
        found = stl_scenes.measure(name, 9, host, tmp_path)
        rows = stored[stored["scene"] == name].set_index("quantity")
        assert {*rows.index} == {*found}
        for quantity, value in found.items():
            off = value - rows.loc[quantity, host]
            assert abs(off) <= max(4 * rows.loc[quantity, f"{host}_scatter"], 0.02 * abs(value)), (host, quantity)


def test_the_page_has_the_table_of_scenes_with_an_stl_wall():
    """The means of both hosts differ by at most 2.5 of their standard errors."""
    stored = pd.read_csv(ROOT / "docs/data/stl_scenes.csv", dtype=str)
    assert {*stored["scene"]} == {"screw", "hopper", "drum"} and (stored["packings"].astype(int) >= 4).all()
    assert (stored["sigmas"].astype(float).abs() <= 2.5).all()
    page = (ROOT / "docs/lammps.md").read_text()
    for _, x in stored.iterrows():
        cells = [f"{x[host]} +- {x[f'{host}_scatter']}" for host in ("liggghts", "lammps")]
        assert f"| {x['scene']} | {x['quantity']} [{x['unit']}] | {cells[0]} | {cells[1]} | {x['ratio']} |" in page


def test_the_meshes_of_the_cases_are_those_of_their_script(tmp_path):
    subprocess.run([sys.executable, CASES / "parts/meshes.py", tmp_path], check=True)
    for name in ("hopper.stl", "screw.stl"):
        assert (tmp_path / name).read_bytes() == (CASES / "parts" / name).read_bytes()


def test_a_wall_that_was_shifted_along_an_axis_turns_about_the_axis():
    turn = {"wall": "lid", "kind": "rotate", "axis": [1.0, 0.0, 0.0], "rate": "1 rad/s"}
    phases = [timed("shift", "1 ms", move=[linear("lid", 1, 0, 0)]), timed("turn", "1 ms", move=[turn])]
    scene_engine("lammps").check(plan(parse(parts(wall=[FLOOR, PLATE], phase=phases))))


BALL = {"material": "glass", "radius": "1.5 mm"}
HELD = BALL | {"name": "held", "position": mm(0, 0, 1), "frozen": True}
LOST = BALL | {"name": "lost", "position": mm(8, 0, 9), "velocity": mps(5, 0, 0)}
LATE = BALL | {"name": "late", "position": mm(0, 5, 9), "phase": "spheres"}
GATE = plane("gate", "z", "0 mm") | {"phases": ["spheres"]}


def late(**scene):
    """A frozen sphere that a gate overlaps, one that leaves the room, and one that comes in the second phase."""
    phases = [timed(name, "4 ms") for name in ("first", "spheres")]
    return parts(wall=[GATE, PLATE], fill=[], body=[HELD, LOST, LATE], phase=phases, **scene)


def test_spheres_of_a_phase_have_a_file_of_their_own():
    files = lammps_scene.files(plan(parse(late())))
    assert [files[name].splitlines()[2] for name in ("spheres.data", "phase_spheres.data")] == ["2 atoms", "1 atoms"]


@needs_lammps
def test_gates_leave_frozen_spheres_where_they_are_and_ids_are_not_given_twice(tmp_path):
    table = ran(late(), tmp_path, "lammps").results.particles
    held = table[table["id"] == 1]
    assert held["step"].nunique() > 2 and (held["z"] == 1e-3).all() and (held["vz"] == 0).all()
    assert {*last_frame(table)["id"]} == {1, 3}


def layers(low):
    """Two layers of spheres; the second falls on the first from a region that begins at `low`."""
    regions = [BED["region"] | {"z": z} for z in (mm(0, 14), [low, "38 mm"])]
    fills = [BED | {"name": name, "region": z} for name, z in zip(("one", "two"), regions, strict=True)]
    fills[1]["phase"] = "second"
    drop = BALL | {"name": "drop", "position": mm(0, 0, 30), "phase": "second"}
    phases = [timed(name, "60 ms") for name in ("first", "second")]
    return parts(wall=[FLOOR, *SIDES], fill=fills, body=[drop], phase=phases)


@needs_lammps
def test_a_later_phase_fills_a_region_without_spheres(tmp_path):
    outcome = ran(layers("20 mm"), tmp_path, "lammps")
    assert outcome.passed, outcome.results.checks
    table, rows = outcome.results.particles, outcome.results.rows
    second = outcome.results.phases.set_index("phase").loc["first", "end"]
    assert (rows["particles"] == np.where(rows["step"] <= second, 40, 81)).all()
    assert sorted(last_frame(table)["id"]) == [*range(1, 82)]
    assert outcome.results.contacts["overlap"].max() < 0.2e-3  # none came inside of another
    with pytest.raises(EngineError, match=r"phase second has \d+ spheres in the region, and LAMMPS fills an empty"):
        run(write_case(layers("3 mm"), tmp_path), engine="lammps", out=tmp_path / "full")


def test_regions_of_a_profile_are_not_named_as_a_wall():
    """A wall `a` of two cones, and a wall `a_1`."""
    profile = [mm(5, 0), mm(8, 10), mm(9, 20)]
    cup = {"name": "a", "kind": "revolved", "profile": profile, "material": "steel"}
    deck = lammps_scene.files(plan(parse(parts(wall=[FLOOR, cup, PLATE | {"name": "a_1"}]))))["in.scene"]
    regions = [line.split()[1] for line in deck.splitlines() if line.startswith("region ")]
    assert len(regions) == len({*regions}) == 4


def test_borders_of_ranks_that_move_change_nothing_but_the_time(tmp_path):
    """A bed in the lower half of its room, on two ranks above one another, and on one."""
    data = moved("linear") | {"numerics": {"time_step": "2e-5 s", "processors": "z", "balance": 100}}
    data["scene"]["phase"] = [timed("fall", "30 ms")]
    data["scene"]["fill"][0]["region"]["z"] = mm(0, 14)
    data["output"] = {"rows": 30, "particles": 3, "energy": True}
    path = write_case(data, tmp_path)
    two = run(path, engine="lammps", out=tmp_path / "two", ranks=2).results
    one = run(path, engine="lammps", out=tmp_path / "one").results
    a, b = (found.particles.set_index(["step", "id"]).sort_index() for found in (two, one))
    assert np.abs(a[["x", "y", "z"]] - b[["x", "y", "z"]]).max().max() < 1e-9
    assert two.rows["kinetic_energy"].to_numpy() == pytest.approx(one.rows["kinetic_energy"].to_numpy(), rel=1e-6)
    deck = (tmp_path / "two/in.scene").read_text()
    code, out = lammps(deck.replace("custom step", "custom step f_balance"), tmp_path / "two", ranks=2)
    assert code == 0 and column(out, "f_balance")[-1] < 1.2
    low, high = plan(load(path)).box[4:]
    upper = (last_frame(two.particles)["z"] > 0.5 * (low + high)).mean()
    assert upper < 0.2  # so that borders at rest would give one rank most of the spheres


@pytest.mark.parametrize("key", ["processors", "balance", "sort_interval"])
def test_every_host_says_which_numbers_it_leaves_out(key):
    lacks = {"liggghts": ["balance"], "lammps": ["sort_interval"], "yade": ["processors", "balance", "sort_interval"]}
    data = parts() | {"numerics": {"time_step": "2e-5 s", key: "x" if key == "processors" else 200}}
    for name, keys in lacks.items():
        notes = [note for note in scene_engine(name).notes(plan(parse(data))) if "left out" in note]
        assert [note.partition(":")[0] for note in notes] == [f"numerics.{key}"] * (key in keys), name


HALF = {"x": 10, "y": 10, "z": 15}  # of the room about its middle [mm]
MIDDLE = {"x": 0, "y": 0, "z": 13}


def round_wall(axis, **more):
    across = [x for x in "xyz" if x != axis]
    center = {"x": 0.3, "y": -0.2, "z": 13.1}
    ends = [f"{MIDDLE[axis] + sign * HALF[axis]} mm" for sign in (-1, 1)]
    wall = {"name": "tube", "kind": "cylinder", "material": "steel", "diameter": "18 mm", "axis": axis}
    return wall | {"from": ends[0], "to": ends[1], "center": [f"{center[x]} mm" for x in across]} | more


def in_tube(axis, *, body, **more):
    room = {x: [f"{MIDDLE[x] + sign * HALF[x]} mm" for sign in (-1, 1)] for x in "xyz"}
    data = parts(wall=[round_wall(axis, **more)], room=room, fill=[], body=body, gravity="0 m/s^2")
    data["scene"]["phase"] = [timed("fly", "8 ms")]
    data |= {"contact": {"friction": 0.3}}
    data["output"] = {"rows": 100, "particles": 40, "contacts": 40, "loads": True}
    return data


def flying(axis):
    """Six spheres that meet the tube and each other."""
    rng = np.random.default_rng(5)
    k, body = "xyz".index(axis), []
    for n in range(6):
        place, velocity = np.array([MIDDLE[x] for x in "xyz"], float), rng.normal(size=3)
        angle = 0.1 + n * np.pi / 3
        place[[(k + 1) % 3, (k + 2) % 3]] += 6.0 * np.array([np.cos(angle), np.sin(angle)])
        velocity[k] *= 0.2
        body.append(
            BALL
            | {
                "name": f"b{n}",
                "position": [f"{x:.6g} mm" for x in place],
                "velocity": [f"{v:.6g} m/s" for v in velocity],
            }
        )
    return body


@pytest.mark.parametrize("engine", [LIGGGHTS, LAMMPS])
@pytest.mark.parametrize("axis", "xyz")
def test_force_and_torque_on_a_tube_are_what_the_spheres_lose(engine, axis, tmp_path):
    """Momentum and angular momentum about the origin, of the first and the last frame, in which no sphere touches."""
    data = in_tube(axis, body=flying(axis))
    data["scene"]["phase"][0]["duration"] = "7 ms"
    results = ran(data, tmp_path, engine).results
    first, last = (
        f for _, f in results.particles.groupby("step") if f["step"].iloc[0] in (0, results.rows["step"].max())
    )
    lost = []
    for frame in (first, last):
        m, r = frame["mass"].to_numpy()[:, None], frame["radius"].to_numpy()[:, None]
        x, v, w = (frame[[*names]].to_numpy() for names in (("x", "y", "z"), ("vx", "vy", "vz"), SPINS))
        lost.append([(m * v).sum(axis=0), (m * np.cross(x, v) + 0.4 * m * r**2 * w).sum(axis=0)])
    seconds = np.diff(results.rows["time"], prepend=0.0)
    for kind, (before, after) in zip(("force", "torque"), zip(*lost, strict=True), strict=True):
        got = np.array([(results.rows[f"tube_{kind}_{x}"] * seconds).sum() for x in "xyz"])
        assert got == pytest.approx(before - after, abs=1e-6 * np.abs(before - after).max())


@pytest.mark.liggghts
def test_only_a_tube_as_long_as_the_room_that_rests_is_a_formula():
    def found(**more):
        return [*tubes(plan(parse(in_tube("z", body=flying("z"), **more))))]

    assert found() == ["tube"]
    for other in (
        {"to": "20 mm"},
        {"angular_velocity": "60 rpm"},
        {"stress": True},
        {"ends": ["to"]},
        {"diameter": "5 mm"},
    ):
        assert found(**other) == []


@pytest.mark.liggghts
@pytest.mark.lammps
def test_contacts_with_a_tube_are_those_of_lammps(tmp_path):
    path = write_case(in_tube("y", body=flying("y")), tmp_path)
    tables = [run(path, engine, out=tmp_path / engine).results.tables["contacts"] for engine in ("liggghts", "lammps")]
    walls = [t[t["wall"] == "tube"].set_index(["step", "i"]).sort_index() for t in tables]
    assert len(walls[0]) > 2 and list(walls[0].index) == list(walls[1].index)
    for name in (
        "overlap",
        "delta_max",
        "force",
        "contact_radius",
        "normal_x",
        "normal_y",
        "normal_z",
        "force_x",
        "force_z",
    ):
        one, two = (t[name].to_numpy() for t in walls)
        assert one == pytest.approx(two, rel=1e-5, abs=1e-5 * np.abs(two).max()), name
