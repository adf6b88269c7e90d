# SPDX-License-Identifier: GPL-2.0-or-later
"""Spheres that leave a closed room are named with time and place."""

import pytest
from parts_cases import FLOOR, parts
from scene_runs import run, write_case

pytestmark = pytest.mark.liggghts

STRAY = {"name": "stray", "material": "glass", "radius": "1 mm", "position": ["0 mm", "0 mm", "20 mm"]}
STRAY |= {"velocity": ["1.1 m/s", "0 m/s", "0 m/s"]}  # leaves at x = 10 mm after 9.1 ms
CALM = {"name": "calm", "material": "glass", "radius": "1 mm", "position": ["-5 mm", "0 mm", "1 mm"]}


def outcome(folder, *, particles=10, **scene):
    data = parts(wall=[FLOOR], fill=[], gravity="0 m/s^2") | {"output": {"rows": 20, "particles": particles}}
    data["scene"] |= {"body": [CALM, STRAY], **scene}
    return run(write_case(data, folder), out=folder / "out")


def test_a_lost_sphere_is_named_with_its_last_place_and_time_also_of_a_stored_run(tmp_path):
    first, again = outcome(tmp_path), outcome(tmp_path)
    assert again.reused and again.warnings == first.warnings and not first.passed
    (said,) = [w for w in first.warnings if "left the room" in w]
    assert "1 spheres have left the room, the first between 0.009 s and 0.01 s, sphere 2 (last at (0.0088" in said
    assert said.endswith("close the walls, enlarge scene.room, or give scene.open_boundary = true")


def test_without_frames_the_rows_tell_when(tmp_path):
    said = [w for w in outcome(tmp_path, particles=0).warnings if "left the room" in w or "left the" in w]
    assert len(said) == 1 and "1 spheres have left the room, the first between 0.0" in said[0]


def test_many_are_counted(tmp_path):
    row = [STRAY | {"name": f"s{y}", "position": ["0 mm", f"{y} mm", "20 mm"]} for y in (0, 3, 6, 9)]
    (said,) = [w for w in outcome(tmp_path, body=[CALM, *row]).warnings if "left the room" in w]
    assert said.startswith("scene: 4 spheres have left the room, the first between ") and "sphere 4 (" in said
    assert said.count("sphere ") == 3


@pytest.mark.parametrize("scene", [{"open_boundary": True}, {"periodic": True}])
def test_an_open_or_periodic_room_loses_nothing_that_is_said(scene, tmp_path):
    assert not [w for w in outcome(tmp_path, **scene).warnings if "left the" in w]
