# SPDX-License-Identifier: GPL-2.0-or-later
"""Periodic rooms: spheres act through the faces, so that measures and refusals count their images."""

import itertools
import math

import numpy as np
import pandas as pd
import pytest
from parts_cases import BED, FLOOR, flat, mm, parts, timed
from scene_runs import HOSTS, ran, run, write_case

from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.errors import CaseError, EngineError
from epdem.jobs.engine import Unsupported, check
from epdem.scenes.judge import measures
from epdem.scenes.plan import placement
from epdem.scenes.plan.plan import plan

BALL = {"material": "glass", "radius": "1.5 mm"}
SIZE = 20e-3  # of the room along x and y [m]


def ball(name: str, *place: float) -> dict:
    return BALL | {"name": name, "position": [f"{x} mm" for x in place]}


def periodic(**scene: object) -> dict:
    return parts(**({"periodic": True, "wall": [FLOOR]} | scene))


def test_porosity_counts_the_part_of_a_sphere_that_reaches_through_a_face():
    """A sphere on an upright edge of the room lies with a quarter at each of the four edges."""
    region = {"x": mm(-10, 10), "y": mm(-10, 10), "z": mm(0, 10)}
    p = plan(parse(periodic(measure=[{"name": "void", "kind": "porosity", "region": region}])))
    rows = pd.DataFrame({"step": [0], "particles": [1]})
    for place in ([-10e-3, -10e-3], [10e-3, 10e-3], [10.2e-3, 3e-3], [0.0, -9e-3], [0.0, 0.0]):
        columns = {"step": 0, "id": 1, "type": 1, "mass": 1.0, "radius": 4e-3, "x": place[0], "y": place[1], "z": 5e-3}
        (found,) = measures.curves(p, {"particles": pd.DataFrame([columns]), "rows": rows})["void"]
        assert found == pytest.approx(1 - 4 / 3 * math.pi * 4e-3**3 / (SIZE**2 * 10e-3), abs=1e-4)


@pytest.mark.parametrize(
    ("one", "other"), [((-9.9, 0, 5), (9.9, 0, 5)), ((10, 0, 5), (-10, 0, 5)), ((9.5, -9.5, 5), (-9.7, 9.4, 5.1))]
)
def test_spheres_that_lie_in_each_other_through_a_face_are_refused(one, other):
    bodies = [ball("a", *one), ball("b", *other)]
    with pytest.raises(
        CaseError, match=r"scene.body.b.position: overlaps scene.body.a.position by \d+% of the smaller"
    ):
        plan(parse(periodic(fill=[], body=bodies)))
    if 10 not in one:
        plan(parse(parts(fill=[], body=bodies)))
    plan(parse(periodic(fill=[], body=[bodies[0], ball("b", 0, 0, 5)])))


def test_a_fill_leaves_the_place_of_a_body_beyond_a_face():
    region = {"x": mm(6, 10), "y": mm(-10, 10), "z": mm(0, 12)}
    bodies = [ball(f"b{n}", -10 + 1e-3 * n, y, z) for n, (y, z) in enumerate(itertools.product((-5, 0, 5), (3, 7, 11)))]
    data = periodic(fill=[BED | {"region": region, "count": 6}], body=bodies)
    for seed in range(1, 6):
        x = placement.spheres(plan(parse(data | {"numerics": {"time_step": "2e-5 s", "seed": seed}})))
        way = x[:, None, :3] - x[None, :, :3]
        way[..., :2] -= SIZE * np.round(way[..., :2] / SIZE)
        gap = np.linalg.norm(way, axis=-1) - x[:, None, 3] - x[None, :, 3]
        assert gap[np.triu_indices(len(x), 1)].min() > 0


def plate(name: str, axis: str, at: str) -> dict:
    center = mm(0, 0, 12)
    center["xyz".index(axis)] = at
    return flat(name, center, mm(8, 8), axis=axis)


BOX = {"name": "box", "kind": "box", "x": mm(-9, 5), "y": mm(-5, 5), "z": mm(1, 9), "material": "steel"}
PLANE = {"name": "side", "kind": "plane", "axis": "x", "at": "0 mm", "material": "steel"}


@pytest.mark.parametrize(
    ("wall", "repeats", "other"),
    [
        (PLANE, "x", "y"),
        (PLANE, True, "y"),
        (PLANE | {"phases": ["fall"]}, "x", "y"),
        (PLANE | {"axis": "y"}, "y", "x"),
        (PLANE, "y", None),
        (plate("side", "x", "9 mm"), True, "y"),
        (plate("side", "x", "-10 mm"), "x", "y"),
        (plate("side", "x", "8 mm"), True, None),  # farther from the face than a radius
        (plate("side", "y", "9 mm"), "x", None),
        (BOX | {"name": "side"}, "x", "y"),
        (BOX | {"name": "side"}, "y", None),
        (BOX | {"name": "side", "open": ["-x"]}, "x", None),
    ],
)
def test_walls_that_spheres_would_touch_through_a_face_are_refused(wall, repeats, other):
    data = periodic(wall=[FLOOR, wall], periodic=repeats, fill=[], body=[ball("a", 7, 7, 30)])
    if other is None:
        plan(parse(data))
        return
    words = f"scene.wall.side: a wall across .*, along which the room repeats.*scene.periodic = '{other}'"
    with pytest.raises(CaseError, match=words):
        plan(parse(data))


def beds(axis: str) -> dict:
    """Spheres in a room that repeats along x or y, between walls across the other one; a mirror turns one into the
    other."""
    order, random = (0, 1, 2) if axis == "x" else (1, 0, 2), np.random.default_rng(1)
    bodies = []
    for n, (along, across, z) in enumerate(itertools.product((-10, -6.6, -3.2, 0.5, 4, 7), (-7, -3, 1, 5), (2, 5.5))):
        place, v = np.array([along, across, z])[[*order]], random.normal(0, 0.5, 3)[[*order]]
        bodies.append(ball(f"b{n}", *place) | {"velocity": [f"{x} m/s" for x in v]})
    walls = [
        PLANE | {"name": f"w{n}", "axis": "xy".replace(axis, ""), "at": at} for n, at in enumerate(("-9 mm", "9 mm"))
    ]
    data = periodic(periodic=axis, wall=[FLOOR, *walls], fill=[], body=bodies, phase=[timed("fall", "6 ms")])
    return data | {"contact": {"friction": 0.3}, "output": {"rows": 20, "particles": 5, "contacts": 5}}


@pytest.mark.parametrize("engine", HOSTS)
def test_a_room_repeats_along_one_axis_where_walls_close_the_other(engine, tmp_path):
    found = {axis: run(write_case(beds(axis), tmp_path), engine, out=tmp_path / axis).results for axis in "xy"}
    one, other = (results.particles.set_index(["step", "id"]).sort_index() for results in found.values())
    names = ["x", "y", "z", "vx", "vy", "vz"]
    mirrored = other[["y", "x", "z", "vy", "vx", "vz"]]
    assert one[names].to_numpy() == pytest.approx(mirrored.to_numpy(), rel=1e-6, abs=1e-6 if engine == "yade" else 1e-9)
    contacts = found["x"].contacts
    assert {*contacts["wall"]} == {"", "floor", "w0", "w1"}
    x = one["x"].reindex(pd.MultiIndex.from_frame(contacts[["step", "i"]])).to_numpy()
    y = one["x"].reindex(pd.MultiIndex.from_frame(contacts[["step", "j"]])).to_numpy()
    assert np.abs(x - y)[contacts["wall"] == ""].max() > 0.5 * SIZE, "some contact goes through a face"


def narrow(copies: int) -> dict:
    """Two spheres that touch each other on both sides in a room that repeats after 2 diameters, `copies` times."""
    bodies = []
    for n in range(copies):
        spin = {"spin": ["0 rad/s", "0 rad/s", "300 rad/s"]}
        bodies += [ball(f"a{n}", 0.8 + 5.9 * n, 0, 5) | spin, ball(f"b{n}", 3.75 + 5.9 * n, 0.3, 5)]
    room = {"x": mm(0, 5.9 * copies), "y": mm(-10, 10), "z": mm(0, 10)}
    data = periodic(periodic="x", room=room, wall=[], fill=[], body=bodies, phase=[timed("fall", "1 ms")])
    data["scene"]["gravity"] = "0 m/s^2"
    data["numerics"] |= {"time_step": "2e-6 s", "highest_speed": "1 m/s"}
    return data | {"contact": {"friction": 0.3}, "output": {"rows": 10, "particles": 5}}


@pytest.mark.lammps
def test_a_narrow_periodic_room_is_refused_where_a_host_mixes_images_and_runs_in_lammps(tmp_path):
    for engine, least in (("liggghts", 0.0075), ("yade", 0.00752)):  # 2.5 diameters; skins have two digits
        with pytest.raises(Unsupported, match=rf"scene.room.x: .* after 0.0059 m, at least {least:g} m "):
            scene_engine(engine).scene_deck.deck(plan(parse(narrow(1))))
        scene_engine(engine).scene_deck.deck(plan(parse(narrow(2))))
    with pytest.raises(CaseError, match="--engine lammps"):
        check(scene_engine("liggghts"), plan(parse(narrow(1))))
    frames = []
    for copies in (1, 2):
        outcome = run(write_case(narrow(copies), tmp_path), "lammps", out=tmp_path / str(copies))
        frames.append(outcome.results.particles.query("id < 3").set_index(["step", "id"]).sort_index())
    names = ["y", "vx", "vy", "omega_z"]
    assert frames[0][names].to_numpy() == pytest.approx(frames[1][names].to_numpy(), rel=1e-9, abs=1e-12)
    turned = frames[0]["omega_z"].to_numpy().reshape(-1, 2)
    assert abs(turned[-1] - turned[0]).min() > 10, "friction acts"


@pytest.mark.liggghts
def test_a_wall_too_long_for_a_narrow_periodic_room_says_what_to_change(tmp_path):
    """LIGGGHTS's search for the corners of meshes fails at 11 periods; its own words are those of an assertion."""
    room = {"x": mm(-60, 60), "y": mm(-5, 5), "z": mm(-20, 90)}
    belt = {"name": "belt", "kind": "plate", "axis": "z", "center": mm(0, 0, -10), "material": "steel"}
    bed = BED | {"region": {"x": mm(-9, 9), "y": mm(-4, 4), "z": mm(0, 30)}, "count": 5}
    scene = parts(room=room, periodic="y", wall=[belt | {"size": mm(110, 10)}], fill=[bed])
    with pytest.raises(EngineError, match="a triangle of a wall is many times longer than a period of the room"):
        ran(scene, tmp_path)
