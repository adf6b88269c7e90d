# SPDX-License-Identifier: GPL-2.0-or-later
"""The highest speed of a hopper and of a poured bed is that of a fall from the top of the filling to the floor."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from parts_cases import CASE

from epdem.case.scene import parse
from epdem.errors import CaseError
from epdem.scenes.plan.timestep import highest_speed

COMMON = {"particles": [{"material": "glass", "radius": "1 mm"}], "count": 10, "walls": "steel", "duration": "1 s"}


def scene(keys):
    return parse(CASE | {"scene": COMMON | keys, "output": {}})


def hopper(**keys):
    lengths = {"bin_diameter": "100 mm", "bin_height": "80 mm", "outlet": "20 mm", "outlet_height": "30 mm"}
    return scene({"kind": "hopper", "half_angle": "30 deg", "fill_time": "0.1 s"} | lengths | keys)


@given(
    st.builds(
        lambda angle, height, drop, outlet: hopper(
            half_angle=f"{angle} deg",
            bin_height=f"{height} mm",
            outlet_height=f"{drop} mm",
            outlet=f"{outlet} mm",
        ),
        st.floats(5, 85),
        st.floats(20, 500),
        st.floats(10, 500),
        st.floats(5, 95),
    )
    | st.builds(lambda z: scene({"kind": "settle", "box": ["50 mm", "50 mm", f"{z} mm"]}), st.floats(20, 500))
)
def test_the_highest_speed_is_that_of_the_highest_fall(case):
    """v = sqrt(2 g h) with h between the planned top of the filling and the planned floor."""
    scene = case.parts
    top = scene.random_fills[0].region.limits[5]
    floor = next(plane.at for plane in scene.planes if plane.name == "floor")
    assert highest_speed(case) == pytest.approx(math.sqrt(2 * 9.81 * (top - floor)), rel=1e-9)


def test_a_hopper_narrows():
    with pytest.raises(CaseError, match=r"outlet \(0.1 m\) must be below bin_diameter \(0.1 m\)"):
        hopper(outlet="100 mm")


@given(st.floats(0, 20), st.floats(1, 60), st.integers(1, 5000))
def test_the_last_shot_of_a_stream_hits_with_the_energy_of_its_fall(gravity, speed, count):
    """v^2 = v_0^2 + 2 g h; the stream is as high as its shot goes in count/rate."""
    keys = {"kind": "peening", "width": "10 mm", "speed": f"{speed!r} m/s", "rate": "1 kHz", "count": count}
    case = scene(keys | {"gravity": f"{gravity!r} m/s^2"})
    height = case.parts.random_fills[0].region.limits[5]
    assert height >= speed * count / 1000
    assert highest_speed(case) == pytest.approx(math.sqrt(speed**2 + 2 * gravity * height), rel=1e-9)
