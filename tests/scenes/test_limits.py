# SPDX-License-Identifier: GPL-2.0-or-later
"""What an engine could not run, or would run otherwise than it is meant, is said before; how fast a scene gets."""

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from parts_cases import BED, CASE, FLOOR, flat, linear, mm, parts, pipe, timed
from stored_runs import CASES

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.errors import CaseError
from epdem.scenes.judge.warnings import planned_warnings
from epdem.scenes.plan.plan import plan
from epdem.scenes.plan.timestep import highest_speed


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
    down = linear("lid", 0, 0, -0.1)
    size = {"room": mm(20, 20), "tube": mm(16.4, 16.4), "plates": mm(17, 17), "small": mm(18, 18)}[kind]
    lid = flat("lid", mm(0, 0, 39), size)
    tube = pipe("tube", "-1 mm", "39 mm", "16 mm")
    region = {"diameter": "16 mm", "z": mm(0, 38)}
    phase = timed("press", "1 s", move=[down], until={"wall": "lid", "travel": f"{39 - height} mm"})
    floor = lid | {"name": "floor", "center": mm(0, 0, 0)} if kind == "plates" else FLOOR
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


COMMON = {"particles": [{"material": "glass", "radius": "1 mm"}], "count": 10, "walls": "steel", "duration": "1 s"}


def scene_of(keys):
    return parse(CASE | {"scene": COMMON | keys, "output": {}})


def hopper(**keys):
    lengths = {"bin_diameter": "100 mm", "bin_height": "80 mm", "outlet": "20 mm", "outlet_height": "30 mm"}
    return scene_of({"kind": "hopper", "half_angle": "30 deg", "fill_time": "0.1 s"} | lengths | keys)


@given(
    st.builds(
        lambda angle, height, drop, outlet: hopper(
            half_angle=f"{angle} deg", bin_height=f"{height} mm", outlet_height=f"{drop} mm", outlet=f"{outlet} mm"
        ),
        st.floats(5, 85),
        st.floats(20, 500),
        st.floats(10, 500),
        st.floats(5, 95),
    )
    | st.builds(lambda z: scene_of({"kind": "settle", "box": mm(50, 50, z)}), st.floats(20, 500))
)
def test_the_highest_speed_is_that_of_the_highest_fall(case):
    """v = sqrt(2 g h) with h between the planned top of the filling and the planned floor."""
    scene = case.parts
    top = scene.random_fills[0].region.limits[5]
    floor = next(plane.at for plane in scene.planes if plane.name == "floor")
    assert highest_speed(case) == pytest.approx(math.sqrt(2 * 9.81 * (top - floor)), rel=1e-9)


@given(st.floats(0, 20), st.floats(1, 60), st.integers(1, 5000))
def test_the_last_shot_of_a_stream_hits_with_the_energy_of_its_fall(gravity, speed, count):
    """v^2 = v_0^2 + 2 g h; the stream is as high as its shot goes in count/rate."""
    keys = {"kind": "peening", "width": "10 mm", "speed": f"{speed!r} m/s", "rate": "1 kHz", "count": count}
    case = scene_of(keys | {"gravity": f"{gravity!r} m/s^2"})
    height = case.parts.random_fills[0].region.limits[5]
    assert height >= speed * count / 1000
    assert highest_speed(case) == pytest.approx(math.sqrt(speed**2 + 2 * gravity * height), rel=1e-9)
