# SPDX-License-Identifier: GPL-2.0-or-later
"""What an engine could not run, or would run otherwise than it is meant, is said before anything is written."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from parts_cases import BED, FLOOR, parts
from scene_runs import run, write_case
from stored_runs import CASES

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.errors import CaseError
from epdem.scenes.judge.warnings import planned_warnings
from epdem.scenes.plan.plan import plan


def test_a_scene_beyond_a_limit_names_its_file_and_writes_nothing(tmp_path):
    data = read_toml(CASES / "settle_glass.toml")
    path = write_case(data | {"scene": data["scene"] | {"duration": "1e9 s"}}, tmp_path)
    with pytest.raises(CaseError, match=r"case.toml: .*1e\+14 steps of 1e-05 s, at most 2e\+09") as refused:
        run(path, out=tmp_path / "out")
    assert "\n" not in str(refused.value) and not (tmp_path / "out").exists()


def test_a_rate_is_taken_up_to_the_layer_s_filling():
    """A layer 12.8 mm deep on 30 mm x 30 mm falls out of itself in sqrt(2 h/g) = 51.1 ms; 0.26 of it are spheres."""
    data = read_toml(CASES / "settle_glass.toml")
    radii = [1.4e-3, 1.45e-3, 1.5e-3, 1.55e-3, 1.6e-3]
    volume = 4.18879 * sum(r**3 for r in radii) / len(radii)
    most = 0.26 * 30e-3 * 30e-3 * 12.8e-3 / volume / (2 * 12.8e-3 / 9.81) ** 0.5
    for rate in (0.999 * most, 1.001 * most):
        case = parse(data | {"scene": data["scene"] | {"rate": f"{rate:.9g} Hz"}})
        if rate < most:
            assert plan(case).insertions[0].rate == pytest.approx(rate)
        else:
            with pytest.raises(CaseError, match="rate"):
                plan(case)


def pressed(height: float, kind: str):
    """1500 spheres of 50 um on 1 mm^2 (0.785 mm without void), or 40 of 1.5 mm under a plate ("plates": on another)."""
    if kind == "compaction":
        data = read_toml(CASES / "compaction_powder.toml")
        return data | {"scene": data["scene"] | {"height": f"{height} mm"}}
    down = {"wall": "lid", "kind": "linear", "velocity": ["0 m/s", "0 m/s", "-0.1 m/s"]}
    size = {
        "room": ["20 mm", "20 mm"],
        "tube": ["16.4 mm", "16.4 mm"],
        "plates": ["17 mm", "17 mm"],
        "small": ["18 mm", "18 mm"],
    }[kind]
    lid = {
        "name": "lid",
        "kind": "plate",
        "axis": "z",
        "center": ["0 mm", "0 mm", "39 mm"],
        "size": size,
        "material": "steel",
    }
    tube = {
        "name": "tube",
        "kind": "cylinder",
        "diameter": "16 mm",
        "from": "-1 mm",
        "to": "39 mm",
        "material": "steel",
    }
    region = {"diameter": "16 mm", "z": ["0 mm", "38 mm"]}
    phase = {
        "name": "press",
        "duration": "1 s",
        "move": [down],
        "until": {"wall": "lid", "travel": f"{39 - height} mm"},
    }
    floor = lid | {"name": "floor", "center": ["0 mm", "0 mm", "0 mm"]} if kind == "plates" else FLOOR
    if kind in ("tube", "plates"):
        return parts(wall=[floor, lid, tube], fill=[BED | {"region": region}], phase=[phase])
    return parts(wall=[FLOOR, lid], phase=[phase])


SOLID = {  # height without void [mm]: sum of volumes over the area
    "compaction": 1500 * 4 / 3 * np.pi * 0.05**3,
    "room": 40 * 4 / 3 * np.pi * 1.5**3 / 400,
    "tube": 40 * 4 / 3 * np.pi * 1.5**3 / (np.pi * 8**2),
    "plates": 40 * 4 / 3 * np.pi * 1.5**3 / (np.pi * 8**2),
}


@settings(max_examples=30, deadline=None)
@given(st.sampled_from(sorted(SOLID)), st.floats(0.3, 3.0).filter(lambda x: abs(x - 1) > 1e-3))
def test_a_plate_is_not_pressed_below_the_height_without_void(kind, share):
    case = parse(pressed(share * SOLID[kind], kind))
    if share > 1:
        plan(case)
    else:
        with pytest.raises(CaseError) as caught:
            plan(case)
        (height,) = re.findall(r"are (\S+) m high .* give a larger height", str(caught.value))
        assert float(height) == pytest.approx(1e-3 * SOLID[kind], rel=1e-3)


@pytest.mark.parametrize("kind", SOLID)
def test_a_bed_pressed_beyond_a_relative_density_of_nine_tenths_is_warned_of(kind):
    for density, said in ((0.89, []), (0.92, ["the relative density reaches 0.92"])):
        warnings = planned_warnings(plan(parse(pressed(SOLID[kind] / density, kind))))
        found = [text for text in warnings if "relative density" in text]
        assert len(found) == len(said) and all(part in text for part, text in zip(said, found, strict=True))


def test_spheres_may_pass_beside_a_plate_that_does_not_cover_the_room():
    plan(parse(pressed(0.5 * SOLID["room"], "small")))
