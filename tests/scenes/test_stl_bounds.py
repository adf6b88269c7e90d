# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls of an STL file beside planes, in LIGGGHTS and LAMMPS: a box, a floor of tiles, a step."""

import numpy as np
import pytest
from parts_cases import mm, parts, timed, write_stl
from scene_runs import ran

from engines.lammps_decks import needs_lammps
from engines.triangles import tiles
from epdem.scenes.plan.meshes import box
from epdem.scenes.tables.columns import last_frame

R = 1.5e-3  # [m]
HOSTS = [pytest.param("liggghts", marks=pytest.mark.liggghts), pytest.param("lammps", marks=needs_lammps)]
MOTION = ["x", "y", "z", "vx", "vy", "vz", "omega_x", "omega_y", "omega_z"]


def divided(triangle, n):
    """n^2 triangles of one orientation in place of one."""
    a, one, other = triangle[0], (triangle[1] - triangle[0]) / n, (triangle[2] - triangle[0]) / n
    at = [[a + i * one + j * other for j in range(n + 1 - i)] for i in range(n + 1)]
    found = [(at[i][j], at[i + 1][j], at[i][j + 1]) for i in range(n) for j in range(n - i)]
    return found + [(at[i + 1][j], at[i + 1][j + 1], at[i][j + 1]) for i in range(n) for j in range(n - i - 1)]


def plane(axis, at):
    return {"name": f"p{axis}{'m' if at < 0 else 'p'}", "kind": "plane", "axis": axis, "at": f"{at!r} m"}


def thrown(engine, folder, walls, start, velocity, duration, **scene):
    """All frames of a sphere; walls: planes, or the triangles of an STL file."""
    folder.mkdir()
    wall = [w | {"material": "steel"} for w in walls] if isinstance(walls, list) else []
    if not wall:
        write_stl(folder / "wall.stl", walls)
        wall = [{"name": "wall", "kind": "stl", "file": "wall.stl", "material": "steel"}]
    numbers = ",".join(map(repr, (*start, R))) + ",glass," + ",".join(map(repr, velocity))
    (folder / "one.csv").write_text(f"x,y,z,radius,material,vx,vy,vz\n{numbers}\n")
    data = parts(
        wall=wall,
        room={axis: mm(-40, 40) for axis in "xyz"},
        fill=[{"name": "one", "file": "one.csv"}],
        phase=[timed("fly", f"{duration} s")],
        **scene,
    )
    data |= {"contact": {"friction": 0.3}, "numerics": {"time_step": "1e-6 s"}}
    data["output"] = {"rows": 100, "particles": 100, "loads": True}
    return ran(data, folder, engine).results


def assert_same_motion(mesh, planes):
    ours, theirs = last_frame(mesh.particles), last_frame(planes.particles)
    for columns in (MOTION[:3], MOTION[3:6], MOTION[6:]):
        one, two = ours[columns].to_numpy(), theirs[columns].to_numpy()
        assert np.abs(one - two).max() <= 1e-6 * np.abs(two).max(), columns


@pytest.mark.parametrize("engine", HOSTS)
def test_a_box_of_1200_triangles_gives_the_rebounds_of_six_planes(engine, tmp_path):
    """Three rebounds, with friction: position, velocity and spin."""
    limits = (-0.01, 0.011, -0.012, 0.009, -0.01, 0.01)
    outwards = [t if np.dot(np.cross(t[1] - t[0], t[2] - t[0]), t[0]) > 0 else t[::-1] for t in box(limits)]
    faces = [t for triangle in outwards for t in divided(triangle, 10)]
    assert len(faces) == 1200
    walls = [plane(axis, at) for k, axis in enumerate("xyz") for at in limits[2 * k : 2 * k + 2]]
    words = ((0.0, 0.0, 0.0), (1.3, -0.9, -0.7), 0.02)
    planes = thrown(engine, tmp_path / "planes", walls, *words)
    mesh = thrown(engine, tmp_path / "mesh", np.array(faces), *words)
    velocity = planes.particles[["vx", "vy", "vz"]].to_numpy()
    assert (np.diff(np.sign(velocity), axis=0) != 0).sum() >= 3
    assert_same_motion(mesh, planes)


@pytest.mark.parametrize("engine", HOSTS)
def test_a_sphere_rolls_over_tiles_as_over_a_plane(engine, tmp_path):
    """It slides first, then rolls over edges and corners."""
    words = ((-0.02, 0.0, 0.9999 * R), (0.4, 0.01, 0.0), 0.1)
    planes = thrown(engine, tmp_path / "plane", [plane("z", 0.0)], *words)
    mesh = thrown(engine, tmp_path / "mesh", tiles((-0.03, 0.03), (-0.01, 0.01), 60, 20), *words)
    end = last_frame(planes.particles)
    assert end["x"].iloc[0] > 0 and end["omega_y"].iloc[0] * R == pytest.approx(end["vx"].iloc[0], rel=0.05)
    assert_same_motion(mesh, planes)


@pytest.mark.parametrize("engine", HOSTS)
def test_no_force_acts_past_a_ledge(engine, tmp_path):
    """A sphere beside a step falls from the height of the upper floor to the lower one."""
    low = -0.005
    riser = [[(0, -0.01, 0), (0, 0.01, 0), (0, 0.01, low)], [(0, -0.01, 0), (0, 0.01, low), (0, -0.01, low)]]
    step = [*tiles((-0.01, 0), (-0.01, 0.01), 3, 3), *riser, *tiles((0, 0.01), (-0.01, 0.01), 3, 3, low)]
    x = 1.001 * R
    found = thrown(engine, tmp_path / "step", np.array(step), (x, 0.0, 0.9 * R), (0.0, 0.0, -1.0), 0.01)
    rows, spheres = found.rows, found.particles
    assert not rows[["wall_force_x", "wall_force_y"]].to_numpy().any() and (spheres["x"] == spheres["x"].iloc[0]).all()
    until = (0.9 * R - low - R) - 1e-4  # way to the lower floor, but 0.1 mm, at 1 m/s
    assert not rows["wall_force_z"][rows["time"] < until].any() and rows["wall_force_z"].any()
