# SPDX-License-Identifier: GPL-2.0-or-later
"""Pressure and wear of walls of triangles."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from parts_cases import BED, STEEL, parts, write_stl
from scene_runs import run, write_case

from engines.lammps_decks import needs_lammps
from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.engines.liggghts import deck as scene_deck
from epdem.errors import CaseError
from epdem.jobs.engine import check
from epdem.scenes.plan.plan import plan

BOX = {"name": "box", "kind": "box", "x": ["-9 mm", "9 mm"], "y": ["-9 mm", "9 mm"], "z": ["0 mm", "40 mm"]}
BOX |= {"material": "steel"}


def scene(*, wear=None, friction=0.0, **output):
    data = parts(
        wall=[BOX | {"stress": True} | ({"wear": wear} if wear else {})],
        fill=[BED | {"velocity": ["0.2 m/s", "0 m/s", "0 m/s"]}],
        phase=[{"name": "fall", "duration": "0.2 s"}],
    )
    data["viscous"], data["contact"] = {"restitution": 0.4}, {"friction": friction}
    data["output"] = {"rows": 8, "particles": 4} | output
    return data


@pytest.mark.liggghts
def test_the_pressure_on_the_floor_bears_the_bed_and_nothing_wears(tmp_path):
    outcome = run(write_case(scene(), tmp_path), out=tmp_path / "out")
    walls = outcome.results.walls
    last = walls[walls["step"] == walls["step"].max()]
    weight = 40 * 2500 * 4 / 3 * math.pi * 1.5e-3**3 * 9.81
    floor = last[(last["area"] * last["normal_stress"]).abs() > 0.2 * weight]
    assert len(walls) == 12 * 5 and (floor["area"] * floor["normal_stress"]).sum() == pytest.approx(weight, rel=0.05)
    assert last["area"].sum() == pytest.approx((2 * 18 * 18 + 4 * 18 * 40) * 1e-6)
    assert not walls["wear"].any() and not walls["shear_stress"].any()


@pytest.mark.liggghts
def test_wear_grows_and_is_proportional_to_its_constant(tmp_path):
    wear = {}
    for constant in ("1e-9 m^2/N", "2e-9 m^2/N"):
        place = tmp_path / constant[0]
        place.mkdir()
        outcome = run(write_case(scene(wear=constant, friction=0.3), place), out=place / "out")
        wear[constant] = outcome.results.walls.pivot(index="step", columns="triangle", values="wear")
    one, two = wear.values()
    assert (one.diff().iloc[1:] >= 0).all(axis=None) and one.iloc[-1].max() > 0 and not one.iloc[0].any()
    assert two.to_numpy() == pytest.approx(2 * one.to_numpy(), rel=1e-9)


def test_two_walls_of_a_material_wear_alike_and_frames_are_needed():
    other = BOX | {"name": "other", "x": ["-8 mm", "8 mm"], "wear": "2e-9 m^2/N"}
    data = scene(wear="1e-9 m^2/N")
    data["scene"]["wall"].append(other)
    with pytest.raises(CaseError, match=r"scene.wall.other.wear = 2e-09 m\^2/N: wall box has 1e-09 m\^2/N, and"):
        scene_deck.files(plan(parse(data)))
    with pytest.raises(CaseError, match=r"scene.wall.box: stress and wear are written with the frames"):
        plan(parse(scene(particles=0)))
    with pytest.raises(CaseError, match=r"LIGGGHTS's restart files lack the wear of wall box.* lammps"):
        check(scene_engine("liggghts"), plan(parse(scene(wear="1e-9 m^2/N", restarts=1))))


def sliding_on_two_plates(wears=("1e-9 m^2/N", "3e-9 m^2/N"), walls=("steel", "iron"), spheres=("glass", "glass")):
    """A sphere slides on each of two plates."""
    wall, body = [], []
    for x, wear, of_wall, of_sphere, name in zip((-5, 5), wears, walls, spheres, ("left", "right"), strict=True):
        place = [f"{x} mm", "0 mm", "0 mm"]
        plate = {"name": name, "kind": "plate", "axis": "z", "center": place, "size": ["9 mm", "18 mm"]}
        wall.append(plate | {"material": of_wall} | ({"wear": wear} if wear else {}))
        ball = {"name": f"on_{name}", "material": of_sphere, "radius": "1 mm", "position": [*place[:2], "0.999 mm"]}
        body.append(ball | {"velocity": ["0 m/s", "0.1 m/s", "0 m/s"]})
    data = parts(wall=wall, fill=[], body=body)
    data["materials"]["iron"] = STEEL
    data["output"] = {"rows": 8, "particles": 4}
    return data


@pytest.mark.liggghts
def test_walls_of_two_materials_wear_by_their_own_constants(tmp_path):
    walls = run(write_case(sliding_on_two_plates(), tmp_path), out=tmp_path / "out").results.walls
    wear = walls.groupby("wall")["wear"].max()
    assert wear["right"] == pytest.approx(3 * wear["left"], rel=1e-6) and wear["left"] > 0


def strikes(*wears):
    """Spheres strike a plate at rest steeply and a moving plate at a small angle, beside the edge of the triangles."""
    data = sliding_on_two_plates(wears)
    data["contact"] = {"friction": 0.3}
    for body, x, speed in zip(data["scene"]["body"], (-3, 7), (0.3, 0.02), strict=True):
        body |= {"position": [f"{x} mm", "-4 mm", "1 mm"], "velocity": ["0.05 m/s", "0.1 m/s", f"-{speed} m/s"]}
    slide = {"wall": "right", "kind": "linear", "velocity": ["0 m/s", "-0.2 m/s", "0 m/s"]}
    data["scene"]["phase"] = [{"name": "strike", "duration": "6 ms", "move": [slide]}]
    data["output"] = {"rows": 75, "particles": 75}
    data["numerics"] = {"time_step": "4e-6 s"}
    return data


def deviations(ours, theirs, *names):
    """Largest difference of each column and wall over the largest value."""
    assert ours[["step", "wall", "triangle"]].equals(theirs[["step", "wall", "triangle"]])
    for column, wall in itertools.product(names, ("left", "right")):
        one, two = (x.loc[x["wall"] == wall, column].to_numpy() for x in (ours, theirs))
        assert two.max() > 0, (column, wall)
        yield np.abs(one - two).max() / two.max()


@pytest.mark.yade("module")
@pytest.mark.liggghts
def test_stress_and_wear_in_yade_are_those_in_liggghts(tmp_path):
    path = write_case(strikes("1e-9 m^2/N", "3e-9 m^2/N"), tmp_path)
    ours, theirs = (run(path, engine=tool, out=tmp_path / tool).results.walls for tool in ("yade", "liggghts"))
    assert max(deviations(ours, theirs, "area", "normal_stress", "shear_stress", "wear")) <= 0.01


@needs_lammps
@pytest.mark.liggghts
@pytest.mark.parametrize("kind", ["plate", "stl", "turn"])
def test_stress_and_wear_in_lammps_are_those_in_liggghts(kind, tmp_path):
    """turn: one plate turns by ten degrees."""
    data = strikes("1e-9 m^2/N", "3e-9 m^2/N")
    if kind == "stl":
        corners = 1e-3 * np.array([(-4.5, -9, 0), (4.5, -9, 0), (4.5, 9, 0), (-4.5, 9, 0)])
        write_stl(tmp_path / "plate.stl", corners[[[0, 1, 2], [0, 2, 3]]])
        for k, wall in enumerate(data["scene"]["wall"]):
            stl = {"kind": "stl", "file": "plate.stl", "position": wall["center"]}
            data["scene"]["wall"][k] = {key: wall[key] for key in ("name", "material", "wear")} | stl
    elif kind == "turn":
        turn = {"wall": "right", "kind": "rotate", "axis": "-x", "origin": ["5 mm", "0 mm", "0 mm"], "rate": "300 rpm"}
        (phase,) = data["scene"]["phase"]  # the second one begins while spheres touch both plates
        times = {"strike": "0.24 ms", "slide": "5.76 ms"}
        data["scene"]["phase"] = [phase | {"name": n, "duration": t, "move": [turn]} for n, t in times.items()]
    path = write_case(data, tmp_path)
    ours, theirs = (run(path, engine=tool, out=tmp_path / tool).results.walls for tool in ("lammps", "liggghts"))
    assert max(deviations(ours, theirs, "area", "normal_stress", "shear_stress", "wear")) <= 1e-9
    assert list(ours.columns) == list(theirs.columns)


@pytest.mark.yade("module")
def test_spheres_at_rest_press_a_periodic_plate_in_yade_with_their_weight(tmp_path):
    """At the overlap at which Hertz's force is the weight; YADE has the plate as one triangle."""
    plate = {"name": "plate", "kind": "plate", "axis": "z", "center": ["0 mm"] * 3, "size": ["20 mm", "20 mm"]}
    weight, young = 2500 * 4 / 3 * math.pi * 1.5e-3**3 * 9.81, 1 / ((1 - 0.25**2) / 10e6 + (1 - 0.3**2) / 100e6)
    z = 1e3 * (1.5e-3 - (0.75 * weight / young / math.sqrt(1.5e-3)) ** (2 / 3))
    spheres = [
        {"name": f"ball{n}", "material": "glass", "radius": "1.5 mm", "position": [f"{x} mm", "1 mm", f"{z!r} mm"]}
        for n, x in enumerate((-9, 0, 4))
    ]
    data = parts(wall=[plate | {"material": "steel", "stress": True}], fill=[], body=spheres, periodic=True)
    data |= {"law": {"name": "hertz"}, "output": {"rows": 4, "particles": 4}}
    data["scene"]["phase"] = [{"name": "rest", "duration": "1 ms"}]
    walls = run(write_case(data, tmp_path), engine="yade", out=tmp_path / "out").results.walls
    assert walls["area"].to_numpy() == pytest.approx(2e-4) and len(walls) == 2 * 6  # 50 steps are five rows
    assert walls["normal_stress"].to_numpy() == pytest.approx(3 * weight / 4e-4, rel=1e-6)
    assert not walls["shear_stress"].any() and not walls["wear"].any()


@given(
    wears=st.tuples(*[st.sampled_from([None, "1e-9 m^2/N", "3e-9 m^2/N"])] * 2),
    walls=st.tuples(*[st.sampled_from(["steel", "iron"])] * 2),
    spheres=st.tuples(*[st.sampled_from(["steel", "iron", "glass"])] * 2),
)
def test_each_sphere_wears_each_wall_by_the_constant_of_the_wall_or_the_case_is_refused(wears, walls, spheres):
    p = plan(parse(sliding_on_two_plates(wears, walls, spheres)))
    worn = {name: float(w.split()[0]) for name, w in zip(("left", "right"), wears, strict=True) if w}
    pairs = [({walls[name == "right"], sphere}, value) for name, value in worn.items() for sphere in spheres]
    try:
        found = [x.values for x in scene_deck.deck(p).contact.properties if x.name == "k_finnie"]
    except CaseError:
        assert any(a == b and x != y for a, x in pairs for b, y in pairs)
        return
    assert bool(found) == bool(worn)
    for types, *values in found:
        matrix = np.reshape(values, (types, types))
        assert (matrix == matrix.T).all()
        for name, value in worn.items():
            for sphere in spheres:
                assert matrix[p.wall_types[name] - 1, p.model.type_of(sphere) - 1] == value
