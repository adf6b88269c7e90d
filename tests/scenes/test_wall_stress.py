# SPDX-License-Identifier: GPL-2.0-or-later
"""Pressure and wear of walls of triangles."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from parts_cases import BED, BOX, STEEL, bead, linear, mm, mps, parts, timed, write_stl
from scene_runs import ran, run, write_case

from epdem.case.scene import parse
from epdem.engines.liggghts import deck as scene_deck
from epdem.errors import CaseError
from epdem.scenes.plan.plan import plan

ENGINES = [pytest.param("liggghts", marks=pytest.mark.liggghts), pytest.param("lammps", marks=pytest.mark.lammps)]


def scene(*, wear=None, friction=0.0, **output):
    data = parts(
        wall=[BOX | {"stress": True} | ({"wear": wear} if wear else {})],
        fill=[BED | {"velocity": mps(0.2, 0, 0)}],
        phase=[timed("fall", "0.2 s")],
    )
    data["viscous"], data["contact"] = {"restitution": 0.4}, {"friction": friction}
    data["output"] = {"rows": 8, "particles": 4} | output
    return data


@pytest.mark.liggghts
def test_the_pressure_on_the_floor_bears_the_bed_and_nothing_wears(tmp_path):
    outcome = ran(scene(), tmp_path)
    walls = outcome.results.walls
    last = walls[walls["step"] == walls["step"].max()]
    weight = 40 * 2500 * 4 / 3 * math.pi * 1.5e-3**3 * 9.81
    floor = last[(last["area"] * last["normal_stress"]).abs() > 0.2 * weight]
    assert len(walls) == 12 * 5 and (floor["area"] * floor["normal_stress"]).sum() == pytest.approx(weight, rel=0.05)
    assert last["area"].sum() == pytest.approx((2 * 18 * 18 + 4 * 18 * 40) * 1e-6)
    assert not walls["wear"].any() and not walls["shear_stress"].any()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_continued_run_knows_the_wear(engine, tmp_path):
    path, out = write_case(scene(wear="1e-9 m^2/N", friction=0.3, restarts=4), tmp_path), tmp_path / "out"
    whole = run(path, engine, out=out)
    for frame in out.glob(f"particles.{whole.plan.steps}.*"):
        frame.unlink()
    again = run(path, engine, out=out, resume=True, force=True)
    assert again.resumed_from and again.results.walls.equals(whole.results.walls)
    wear = whole.results.walls.groupby("step")["wear"].sum()
    assert wear.iloc[-1] > wear.iloc[-2] > 0


def sliding_on_two_plates(wears=("1e-9 m^2/N", "3e-9 m^2/N"), walls=("steel", "iron"), spheres=("glass", "glass")):
    """A sphere slides on each of two plates."""
    wall, body = [], []
    for x, wear, of_wall, of_sphere, name in zip((-5, 5), wears, walls, spheres, ("left", "right"), strict=True):
        place = mm(x, 0, 0)
        plate = {"name": name, "kind": "plate", "axis": "z", "center": place, "size": mm(9, 18)}
        wall.append(plate | {"material": of_wall} | ({"wear": wear} if wear else {}))
        ball = bead(f"on_{name}", [*place[:2], "0.999 mm"], "1 mm", of_sphere)
        body.append(ball | {"velocity": mps(0, 0.1, 0)})
    data = parts(wall=wall, fill=[], body=body)
    data["materials"]["iron"] = STEEL
    data["output"] = {"rows": 8, "particles": 4}
    return data


def strikes(*wears):
    """Spheres strike a plate at rest steeply and a moving plate at a small angle, beside the edge of the triangles."""
    data = sliding_on_two_plates(wears)
    data["contact"] = {"friction": 0.3}
    for body, x, speed in zip(data["scene"]["body"], (-3, 7), (0.3, 0.02), strict=True):
        body |= {"position": mm(x, -4, 1), "velocity": ["0.05 m/s", "0.1 m/s", f"-{speed} m/s"]}
    slide = linear("right", 0, -0.2, 0)
    data["scene"]["phase"] = [timed("strike", "6 ms", move=[slide])]
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


@pytest.mark.lammps
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
        turn = {"wall": "right", "kind": "rotate", "axis": "-x", "origin": mm(5, 0, 0), "rate": "300 rpm"}
        (phase,) = data["scene"]["phase"]  # the second one begins while spheres touch both plates
        times = {"strike": "0.24 ms", "slide": "5.76 ms"}
        data["scene"]["phase"] = [phase | timed(n, t, move=[turn]) for n, t in times.items()]
    path = write_case(data, tmp_path)
    ours, theirs = (run(path, engine=tool, out=tmp_path / tool).results.walls for tool in ("lammps", "liggghts"))
    assert max(deviations(ours, theirs, "area", "normal_stress", "shear_stress", "wear")) <= 1e-9
    assert list(ours.columns) == list(theirs.columns)


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
