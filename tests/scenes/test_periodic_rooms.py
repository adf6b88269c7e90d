# SPDX-License-Identifier: GPL-2.0-or-later
"""Periodic rooms: spheres act through the faces, so that measures and refusals count their images."""

import itertools
import math

import numpy as np
import pandas as pd
import pytest
from parts_cases import BED, FLOOR, parts

from epdem.case.scene import parse
from epdem.errors import CaseError
from epdem.scenes import measures, placement
from epdem.scenes.plan import plan

BALL = {"material": "glass", "radius": "1.5 mm"}
SIZE = 20e-3  # of the room along x and y [m]


def ball(name: str, *place: float) -> dict:
    return BALL | {"name": name, "position": [f"{x} mm" for x in place]}


def periodic(**scene: object) -> dict:
    return parts(**({"periodic": True, "wall": [FLOOR]} | scene))


def test_porosity_counts_the_part_of_a_sphere_that_reaches_through_a_face():
    """A sphere on an upright edge of the room lies with a quarter at each of the four edges."""
    region = {"x": ["-10 mm", "10 mm"], "y": ["-10 mm", "10 mm"], "z": ["0 mm", "10 mm"]}
    p = plan(parse(periodic(measure=[{"name": "void", "kind": "porosity", "region": region}])))
    for place in ([-10e-3, -10e-3], [10e-3, 10e-3], [10.2e-3, 3e-3], [0.0, -9e-3], [0.0, 0.0]):
        columns = {"step": 0, "id": 1, "type": 1, "mass": 1.0, "radius": 4e-3, "x": place[0], "y": place[1], "z": 5e-3}
        (found,) = measures.curves(p, {"particles": pd.DataFrame([columns])})["void"]
        assert found == pytest.approx(1 - 4 / 3 * math.pi * 4e-3**3 / (SIZE**2 * 10e-3), abs=1e-4)


@pytest.mark.parametrize(
    ("one", "other"),
    [((-9.9, 0, 5), (9.9, 0, 5)), ((10, 0, 5), (-10, 0, 5)), ((9.5, -9.5, 5), (-9.7, 9.4, 5.1))],
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
    region = {"x": ["6 mm", "10 mm"], "y": ["-10 mm", "10 mm"], "z": ["0 mm", "12 mm"]}
    bodies = [ball(f"b{n}", -10 + 1e-3 * n, y, z) for n, (y, z) in enumerate(itertools.product((-5, 0, 5), (3, 7, 11)))]
    data = periodic(fill=[BED | {"region": region, "count": 6}], body=bodies)
    for seed in range(1, 6):
        x = placement.spheres(plan(parse(data | {"numerics": {"time_step": "2e-5 s", "seed": seed}})))
        way = x[:, None, :3] - x[None, :, :3]
        way[..., :2] -= SIZE * np.round(way[..., :2] / SIZE)
        gap = np.linalg.norm(way, axis=-1) - x[:, None, 3] - x[None, :, 3]
        assert gap[np.triu_indices(len(x), 1)].min() > 0
