# SPDX-License-Identifier: GPL-2.0-or-later
"""Features of scenes of parts that meet in one scene, in LIGGGHTS: each pair runs, or is refused before the run."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from parts_cases import BED, FLOOR, driven, mm, parts, timed
from scene_runs import ran, run, write_case

from epdem.case.scene import parse
from epdem.errors import CaseError
from epdem.scenes.judge.measures import curves
from epdem.scenes.plan.plan import plan

TUBE = {"name": "tube", "kind": "cylinder", "from": "-1 mm", "to": "39 mm", "diameter": "16 mm", "material": "steel"}
PRESS = driven("tube", [0.0, 0.0, -1.0], "0.1 N", "0.1 m/s")
REGION = {"diameter": "12 mm", "z": mm(1, 30)}
FIRST, SECOND = timed("first", "2 ms"), timed("second", "2 ms")


def scene(*, wall, phase=(FIRST, SECOND), **more):
    bed = BED | {"region": REGION, "count": 8} | more.pop("bed", {})
    data = parts(wall=[FLOOR, TUBE | wall], fill=[bed], phase=list(phase), open_boundary=True, **more)
    data["output"] = {"rows": 4, "particles": 4}
    return data


@pytest.mark.liggghts
@settings(max_examples=12)
@given(
    wall=st.fixed_dictionaries(
        {},
        optional={
            "angular_velocity": st.just("60 rpm"),
            "wear": st.just("1e-9 m^2/N"),
            "stress": st.just(True),
            "center": st.just(mm(1, 0)),
        },
    ),
    pressed=st.booleans(),
    loads=st.booleans(),
)
def test_a_round_wall_turns_wears_bears_and_is_pressed(wall, pressed, loads, tmp_path_factory):
    first = FIRST | ({"move": [PRESS]} if pressed else {})
    data = scene(wall=wall, phase=[first])
    data["output"]["loads"] = loads
    if pressed and "angular_velocity" in wall:
        with pytest.raises(CaseError, match=r"scene.wall.tube: a wall that a force drives has no angular_velocity"):
            plan(parse(data))
        return
    folder = tmp_path_factory.mktemp("wall")
    assert ran(data, folder).results.rows["particles"].iloc[-1] == 8


@pytest.mark.liggghts
@pytest.mark.parametrize("bed", [{"phase": "second"}, {"phase": "second", "rate": "10 kHz"}, {}])
def test_spheres_may_come_with_a_later_phase_and_pass_a_plane_or_never_be_in_a_frame(bed, tmp_path):
    flow = {"name": "down", "kind": "flow", "direction": "-z", "at": "5 mm"}
    phases = [FIRST | {"record": False}, SECOND]
    results = run(
        write_case(scene(wall={}, phase=phases, bed=bed, measure=[flow]), tmp_path), out=tmp_path / "o"
    ).results
    assert results.rows["particles"].iloc[-1] == 8 and results.tables["measures"]["down"].notna().all()


@pytest.mark.liggghts
def test_a_flow_without_a_sphere_in_any_frame_is_zero(tmp_path):
    """As of a run whose spheres leave the room before the first frame."""
    flow = {"name": "down", "kind": "flow", "direction": "-z", "at": "5 mm"}
    outcome = ran(scene(wall={}, measure=[flow]), tmp_path)
    empty = outcome.results.tables | {"particles": outcome.results.particles.iloc[:0]}
    assert not curves(outcome.plan, empty)["down"].any()
