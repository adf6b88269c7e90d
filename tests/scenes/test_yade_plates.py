# SPDX-License-Identifier: GPL-2.0-or-later
"""Flat walls in YADE: a sphere on the diagonal of a rectangle, which is two triangles elsewhere, has one contact."""

import math

import pytest
from parts_cases import bead, mm, mps, parts, timed
from scene_runs import ran
from test_parts_motions import PLATE

from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.scenes.plan.plan import plan

DIAGONAL = {"on": (2.0, 2.0), "beside": (4.0, -1.0)}  # x, y [mm] of a plate about 0, 0
YOUNG = 1 / ((1 - 0.25**2) / 10e6 + (1 - 0.3**2) / 100e6)


def ball(name: str, place: tuple[float, ...], radius: float = 1.0, **keys: object) -> dict:
    position = [f"{x!r} mm" for x in place]
    return bead(name, position, f"{radius} mm", "glass") | keys


def hertz(overlap: float, radius: float = 1e-3) -> float:
    return 4 / 3 * YOUNG * math.sqrt(radius) * overlap**1.5


@pytest.mark.yade("module")
@pytest.mark.parametrize("kind", ["plate", "box", "periodic"])
def test_a_frozen_sphere_on_the_diagonal_has_the_force_of_hertz(kind, tmp_path):
    """Of a plate, of the floor of a box, of a plate as wide as a periodic room across x."""
    overlap, size = 0.02, mm(20, 45) if kind == "periodic" else mm(18, 18)
    wall = {"name": "lid", "material": "steel"}
    if kind == "box":
        sides = {"x": mm(-9, 9), "y": mm(-9, 9), "z": mm(9, 20)}
        wall |= {"kind": "box", "open": ["+z"]} | sides
    else:
        axis, center = ("x", mm(9, 0, 17.5)) if kind == "periodic" else ("z", mm(0, 0, 9))
        wall |= {"kind": "plate", "axis": axis, "center": center, "size": size}
    at = 8 + overlap
    places = {
        name: (at, x, 17.5 + x * 45 / 20 if name == "on" else 17.5 + y) if kind == "periodic" else (x, y, at)
        for name, (x, y) in DIAGONAL.items()
    }
    data = parts(wall=[wall], fill=[], body=[ball(name, place, frozen=True) for name, place in places.items()])
    data["scene"] |= {"phase": [timed("hold", "0.2 ms")]}
    data["scene"] |= {"periodic": "y"} if kind == "periodic" else {}
    data |= {"law": {"name": "hertz"}, "output": {"rows": 2, "particles": 2, "contacts": 2, "loads": True}}
    results = ran(data, tmp_path, "yade").results
    contacts = results.contacts[results.contacts["step"] == results.contacts["step"].max()]
    assert contacts["force"].to_numpy() == pytest.approx([hertz(overlap * 1e-3)] * 2, rel=1e-9)
    axis = "x" if kind == "periodic" else "z"
    assert results.rows[f"lid_force_{axis}"].iloc[-1] == pytest.approx(2 * hertz(overlap * 1e-3), rel=1e-9)


@pytest.mark.yade("module")
def test_a_frictionless_sphere_slides_over_the_diagonal(tmp_path):
    """At rest along z under its weight, it keeps its speed along x."""
    weight = 2500 * 4 / 3 * math.pi * 1e-9 * 9.81
    z = 1.0 - 1e3 * (0.75 * weight / YOUNG / math.sqrt(1e-3)) ** (2 / 3)
    plate = PLATE | {"center": mm(0, 0, 0)}
    body = ball("slider", (-1.0, 0.0, z), velocity=mps(1, 0, 0))
    data = parts(wall=[plate], fill=[], body=[body], phase=[timed("slide", "2 ms")])
    data |= {"law": {"name": "hertz"}, "output": {"rows": 10, "particles": 10}}
    particles = ran(data, tmp_path, "yade").results.particles
    assert particles["x"].iloc[0] < 0 < particles["x"].iloc[-1]
    assert particles["vx"].to_numpy() == pytest.approx(1.0, abs=1e-9)
    assert particles["z"].to_numpy() == pytest.approx(z * 1e-3, rel=1e-6)


def test_walls_with_edges_between_triangles_are_named():
    cup = {"name": "cup", "kind": "cylinder", "diameter": "18 mm", "from": "0 mm", "to": "9 mm", "ends": ["from"]}
    text = " ".join(scene_engine("yade").notes(plan(parse(parts(wall=[cup | {"material": "steel"}, PLATE])))))
    assert "walls of triangles (cup): YADE counts a sphere that touches an edge once for each triangle" in text
