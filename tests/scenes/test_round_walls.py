# SPDX-License-Identifier: GPL-2.0-or-later
"""Round walls at rest that are as long as the room: a formula in LIGGGHTS, so that no contact begins at an edge."""

import numpy as np
import pytest
from parts_cases import parts
from scene_runs import run, write_case

from engines.lammps_decks import needs_lammps
from epdem.case.scene import parse
from epdem.engines.liggghts.primitives import tubes
from epdem.scenes.plan.plan import plan
from epdem.scenes.plan.quantities import SPINS

ENGINES = [pytest.param("liggghts", marks=pytest.mark.liggghts), pytest.param("lammps", marks=needs_lammps)]
SIDES = {"x": 10, "y": 10, "z": 15}  # of the room about its middle [mm]
BALL = {"material": "glass", "radius": "1.5 mm"}
MIDDLE = {"x": 0, "y": 0, "z": 13}


def tube(axis, **more):
    across = [x for x in "xyz" if x != axis]
    center = {"x": 0.3, "y": -0.2, "z": 13.1}
    ends = [f"{MIDDLE[axis] + sign * SIDES[axis]} mm" for sign in (-1, 1)]
    wall = {"name": "tube", "kind": "cylinder", "material": "steel", "diameter": "18 mm", "axis": axis}
    return wall | {"from": ends[0], "to": ends[1], "center": [f"{center[x]} mm" for x in across]} | more


def scene(axis, *, body, **more):
    room = {x: [f"{MIDDLE[x] + sign * SIDES[x]} mm" for sign in (-1, 1)] for x in "xyz"}
    data = parts(wall=[tube(axis, **more)], room=room, fill=[], body=body, gravity="0 m/s^2")
    data["scene"]["phase"] = [{"name": "fly", "duration": "8 ms"}]
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


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("axis", "xyz")
def test_force_and_torque_on_a_tube_are_what_the_spheres_lose(engine, axis, tmp_path):
    """Momentum and angular momentum about the origin, of the first and the last frame, in which no sphere touches."""
    data = scene(axis, body=flying(axis))
    data["scene"]["phase"][0]["duration"] = "7 ms"
    results = run(write_case(data, tmp_path), engine, out=tmp_path / "out").results
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
        return [*tubes(plan(parse(scene("z", body=flying("z"), **more))))]

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
@needs_lammps
def test_contacts_with_a_tube_are_those_of_lammps(tmp_path):
    path = write_case(scene("y", body=flying("y")), tmp_path)
    tables = [run(path, engine, out=tmp_path / engine).results.tables["contacts"] for engine in ("liggghts", "lammps")]
    walls = [t[t["wall"] == "tube"].set_index(["step", "i"]).sort_index() for t in tables]
    assert len(walls[0]) > 2 and list(walls[0].index) == list(walls[1].index)
    for column in (
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
        one, two = (t[column].to_numpy() for t in walls)
        assert one == pytest.approx(two, rel=1e-5, abs=1e-5 * np.abs(two).max()), column
