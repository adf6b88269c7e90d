# SPDX-License-Identifier: GPL-2.0-or-later
"""Warnings of what a scene probably does not mean, and of the largest strain of its contacts."""

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from parts_cases import BED, CASES, FLOOR, GLASS, bead, linear, mm, mps, parts, timed
from scene_runs import LIGGGHTS, YADE, ran

from epdem.case.scene import load, parse
from epdem.case.toml import read_toml
from epdem.errors import CaseError
from epdem.impacts.prediction import predict
from epdem.report.pages import scene_sentences as sentences
from epdem.scenes.judge.warnings import measured_warnings, passed_walls, planned_warnings
from epdem.scenes.plan.plan import plan
from epdem.scenes.plan.quantities import STRAINS
from epdem.scenes.plan.timestep import impact
from epdem.scenes.tables.columns import rows

BALL = bead("ball", mm(0, 0, 20), "2 mm", "steel")
PLATE = {"name": "plate", "kind": "plate", "axis": "z", "center": mm(0, 0, 5), "size": mm(10, 10)}
TUBE = {"name": "tube", "kind": "cylinder", "axis": "z", "center": mm(0, 0), "from": "0 mm", "to": "40 mm"}
FALL, REST = timed("fall", "20 ms"), timed("rest", "20 ms")
LIFT = FALL | {"move": [linear("plate", 0, 0, 1)]}


def warnings_of(data: dict) -> list[str]:
    return planned_warnings(plan(parse(data)))


def place(*mm: float) -> list[str]:
    return [f"{x} mm" for x in mm]


SCENES = [p for p in sorted(CASES.rglob("*.toml")) if "[scene]" in p.read_text(encoding="utf-8")]


@pytest.mark.parametrize("path", SCENES, ids=lambda p: p.stem)
def test_scenes_of_the_project_give_no_warning(path: Path):
    """But for the press of a powder with adhesion, which `cavity` does not have, and frictions above 0.3."""
    found = planned_warnings(plan(load(path)))
    warnings = [text for text in found if "yields at its surface" not in text]
    assert len(found) - len(warnings) <= 1
    assert [text for text in warnings if "'thornton_ning'" not in text] == []
    assert len(warnings) == (path.stem == "adhesive_powder")


@pytest.mark.parametrize(("friction", "wall", "said"), [(0.3, 0.3, None), (0.5, 0.0, "0.5"), (0.1, 0.4, "0.4")])
def test_a_scene_with_a_friction_above_the_limit_says_once_at_which_pressure_and_speed_a_surface_yields(
    friction, wall, said
):
    """Von Mises at the trailing edge, where p = 0; a sphere of glass on another one, or on steel.

    v_y0 = (pi/(2 E*))^2 sqrt(8 pi R*^3 p^5/(15 m*)), Thornton 1997."""
    data = parts() | {"contact": {"friction": friction, "wall_friction": wall}}
    found = [text for text in warnings_of(data) if "at its surface" in text]
    assert len(found) == (said is not None)
    if not said:
        return
    mu, nu, E, R = float(said), 0.25, 10e6, 1.5e-3
    tension = (1 - 2 * nu) / 3 + math.pi * (4 + nu) / 8 * mu  # along the slip, at the trailing edge, where p = 0
    across = -(1 - 2 * nu) / 3 + 3 * math.pi * nu / 8 * mu
    pressure = 0.05e6 / math.sqrt(tension**2 - tension * across + across**2)
    mass, steel = 2500 * 4 / 3 * math.pi * R**3, (1 - 0.3**2) / 100e6
    E_star, R_star, m_star = (
        (E / 2 / (1 - nu**2), R / 2, mass / 2) if friction > wall else (1 / ((1 - nu**2) / E + steel), R, mass)
    )
    speed = (math.pi / 2 / E_star) ** 2 * math.sqrt(8 * math.pi * R_star**3 * pressure**5 / (15 * m_star))
    assert found[0].startswith(
        f"friction {said}: a sliding contact of glass yields at its surface from a peak pressure"
    )
    assert f"of {pressure / 1e3:.4g} kPa ({pressure / 0.05e6:.2f} Y)" in found[0] and f"at {speed:.3g} m/s" in found[0]


@pytest.mark.parametrize(("distance", "frozen", "said"), [(2.96, False, 0), (2.9, False, 1), (2.9, True, 0)])
def test_spheres_that_lie_in_each_other_at_the_start_are_named(distance, frozen, said):
    """Radii of 1 and 2 mm: an overlap of 4 or 10 % of the smaller one."""
    one = BALL | {"name": "one", "radius": "1 mm", "position": place(0, 0, 10), "frozen": frozen}
    two = BALL | {"name": "two", "position": place(0, 0, 10 + distance), "frozen": frozen}
    found = warnings_of(parts(body=[one, two]))
    assert len(found) == said
    assert all("1 pairs of spheres overlap at the start" in x and "spheres 1 and 2" in x for x in found)


@pytest.mark.parametrize(("at", "said"), [("0 mm", 0), ("0.05 mm", 0), ("5 mm", 1)])
def test_a_region_with_a_plane_in_it_is_named(at, said):
    found = warnings_of(parts(wall=[FLOOR | {"at": at}]))
    assert found == ["scene.fill.bed.region: wall floor runs through it; move one of them"] * said


@pytest.mark.parametrize(("diameter", "said"), [("13.8 mm", 0), ("14 mm", 0), ("14.6 mm", 1), ("19 mm", 1)])
def test_a_round_region_with_a_round_wall_in_it_is_named(diameter, said):
    """Spheres of 1.5 mm: less than 0.075 mm beyond a wall of 7 mm goes without a word."""
    region = {"diameter": diameter, "center": mm(0, 0), "z": mm(0, 38)}
    wall = TUBE | {"diameter": "14 mm", "ends": ["from"], "material": "steel"}
    found = warnings_of(parts(wall=[wall], fill=[BED | {"region": region}]))
    assert ["wall tube runs through it" in x for x in found] == [True] * said


@pytest.mark.parametrize(
    ("ball", "share"),
    [
        ({"position": place(0, 0, 1.95)}, None),
        ({"position": place(0, 0, 1.5)}, "floor by 25%"),
        ({"position": place(0, 0, 1.5), "frozen": True}, None),
        ({"position": place(6, 0, 6)}, "plate by 29%"),  # 1 - sqrt(1 + 1) / 2: beside its edge
        ({"position": place(6.5, 6.5, 5)}, None),  # sqrt(1.5^2 + 1.5^2) > 2: beside its corner
    ],
)
def test_a_sphere_in_a_wall_is_named(ball, share):
    walls = [FLOOR, PLATE | {"material": "steel"}]
    found = warnings_of(parts(wall=walls, fill=[], body=[BALL | ball], phase=[FALL, REST]))
    assert [share in x for x in found] == [True] * (share is not None)


def test_a_wall_that_has_moved_and_a_gate_of_another_phase_are_in_nobodys_way():
    gate = FLOOR | {"name": "gate", "at": "5 mm", "phases": ["rest"]}
    ball = BALL | {"position": place(0, 0, 5.1)}
    plate = PLATE | {"material": "steel"}
    for wall, phase, named in (
        ([FLOOR, gate], "fall", False),
        ([FLOOR, plate], "fall", True),
        ([FLOOR, plate], "rest", False),
    ):
        phases = [LIFT if plate in wall else FALL, REST]
        data = parts(wall=wall, fill=[], body=[ball | {"phase": phase}], phase=phases)
        if named and phase == "rest":  # a body of a later phase that comes into a wall is an error
            with pytest.raises(CaseError, match=r"the body overlaps wall gate by 0\.0019 m"):
                warnings_of(data)
        else:
            assert len(warnings_of(data)) == named, (wall, phase)


@pytest.mark.parametrize(("factor", "said"), [(0.95, 0), (1.05, 1)])
def test_a_time_step_that_no_contact_bears_is_named(factor, said):
    """Spheres that fall 45 mm on each other stay elastic, and stable up to 2 sqrt(m* / k) of their largest overlap."""
    E_star, R_star, m_star = 10e6 / (1 - 0.25**2) / 2, 0.75e-3, 2500 * 4 / 3 * math.pi * 1.5e-3**3 / 2
    overlap = (15 * m_star * 2 * 9.80665 * 0.045 / (16 * E_star * math.sqrt(R_star))) ** 0.4
    stable = 2 * math.sqrt(m_star / (2 * E_star * math.sqrt(R_star * overlap)))
    data = parts(wall=[FLOOR | {"material": "glass"}]) | {"numerics": {"time_step": f"{factor * stable} s"}}
    data["materials"] = {"glass": GLASS | {"yield_stress": "9 MPa"}}
    assert sum("impact at the scene's highest speed is stable" in x for x in warnings_of(data)) == said


@given(st.floats(0.0, 0.8), st.booleans())
def test_finite_strain_is_said_once_by_the_largest_contact_radius_of_the_rows(largest, yields):
    """Spheres of glass of 1 mm: two like spheres have a share of 1/2, one on a wall of steel, 20 times as strong, 1.

    The strain on the wall is half of that between the spheres: the share of the contacts above the limit.
    """
    p, R_star = plan(parse(parts())), np.array([0.5e-3, 1e-3])
    radius = np.array([2.0 * largest, 0.5 * largest]) * R_star
    contacts = {"step": [5, 5], "wall": ["", "floor"], "i": [1, 1], "j": [2, 0], "delta_max": radius**2 / R_star}
    tables = {
        "rows": pd.DataFrame({"largest_radius_ratio": [0.0, largest]}),
        "particles": pd.DataFrame(
            {"step": 5, "id": [1, 2], "radius": 1e-3, "mass": 1e-5, "type": 1, "x": 0.0, "y": 0.0, "z": 0.0}
        ),
        "contacts": pd.DataFrame(contacts | {"dent_radius": radius if yields else 0.0}),
    }
    found = measured_warnings(p, tables)
    limit = 0.3 if largest > 0.3 else 0.2 if largest > 0.2 else None
    if limit is None:
        assert found == []
        return
    (said,) = found
    assert f"1 beside a rigid one) reaches {largest:.2f}, above {limit}" in said
    if abs(0.5 * largest - limit) > 1e-9 and abs(largest - limit) > 1e-9:
        assert f"in up to {100 if 0.5 * largest > limit else 50} % of the contacts" in said


def test_the_largest_strain_of_rows_never_falls():
    """No sphere is there at first (LIGGGHTS: -1e20); the sphere that holds the largest value may leave the room."""
    p = plan(parse(parts()))
    values = {0: [0.0, 0.0, -1e20, -1e20], 10: [2.0, 0.0, 0.3, 0.09], 20: [1.0, 0.0, 0.1, 0.01]}
    found = rows(p, values, ["particles", "kinetic_energy", "largest_radius_ratio", "largest_overlap_ratio"])
    assert found["largest_radius_ratio"].to_list() == [0.0, 0.3, 0.3]
    assert found["largest_overlap_ratio"].to_list() == [0.0, 0.09, 0.09]


@pytest.mark.parametrize(("share", "said"), [(0.9, 0), (1.1, 1)])
def test_a_phase_in_which_a_bed_settles_says_if_the_bed_still_moves_at_its_end(share, said):
    """From 1 % of the energy of a fall by a radius on: v^2 = 0.02 g R."""
    p = plan(load(CASES / "settle_glass.toml"))
    R, mass, v = 1.5e-3, 2e-5, share * math.sqrt(0.02 * 9.81 * 1.5e-3)
    ends = [0.0, 7 * 0.5 * mass * v**2]
    spheres = {"step": p.phases[0].end, "id": range(1, 8), "radius": R, "mass": mass, "type": 1, "z": 0.0}
    tables = {
        "rows": pd.DataFrame(
            {"step": [0, p.phases[0].end], "particles": 7, "kinetic_energy": ends, "largest_radius_ratio": 0.0}
        ),
        "particles": pd.DataFrame(spheres),
    }
    found = [x for x in measured_warnings(p, tables) if "still move" in x]
    assert found == [f"phase settle ends while the spheres still move, at {v:.3g} m/s (rms); give more time"] * said


def test_a_way_that_a_phase_is_too_short_for_is_named():
    until = {"wall": "plate", "travel": "30 mm"}
    for duration, said in (("29 ms", ["until was not reached"]), ("31 ms", [])):
        phase = LIFT | {"duration": duration, "until": until}
        p = plan(parse(parts(wall=[FLOOR, PLATE | {"material": "steel"}], phase=[phase, REST], fill=[], body=[BALL])))
        found = measured_warnings(p, {"rows": pd.DataFrame({"largest_radius_ratio": [0.0]}), "phases": p.phase_table})
        assert ["until was not reached" in x for x in found] == [True] * len(said)


@pytest.mark.parametrize(
    ("law", "warned"),
    [
        ({"name": "cavity", "finite_strain": True, "compaction": True}, False),
        ({"name": "thornton"}, True),
        ({"name": "cavity"}, True),
        ({"name": "cavity", "finite_strain": True}, True),
        ({"name": "hertz"}, True),
    ],
)
def test_a_press_with_another_law_says_first_that_its_pressures_deviate(law, warned):
    data = read_toml(CASES / "compaction_powder.toml")
    found = planned_warnings(plan(parse(data | {"law": law})))
    assert ("are not those of finite elements" in "".join(found[:1])) == warned
    loose = data | {"law": law, "scene": data["scene"] | {"height": "1.3 mm"}}  # relative density 0.60
    assert not any("law.name" in text for text in planned_warnings(plan(parse(loose))))


UPWARDS = mps(0, 0, 1)
UP = timed("lift", "20 ms", move=[{"wall": "floor", "kind": "linear", "velocity": [*UPWARDS]}])
SHEET = PLATE | {"name": "floor", "center": mm(0, 0, 0), "material": "steel"}
BOX = {"name": "floor", "kind": "box", "x": mm(-5, 5), "y": mm(-5, 5), "z": mm(0, 20)}
BOX |= {"open": ["+z"], "material": "steel"}


@pytest.mark.parametrize("floor", [FLOOR, SHEET, BOX, "lifted", "aside"])
@pytest.mark.parametrize(("speed", "passed"), [(-50.0, 3), (50.0, 2), (0.0, 3)])
def test_spheres_that_are_pressed_through_a_wall_are_counted_with_the_overlap(floor, speed, passed):
    """Of five spheres on a floor two are below it at the end; one is gone, downwards at 50 m/s or upwards, or from rest
    in contact with the floor, by a load between the frames. A plate that moves upwards takes all with it; spheres
    beside a plate, 6 mm from its middle, pass nothing."""
    data = parts(
        wall=[SHEET if isinstance(floor, str) else floor], fill=[BED], phase=[UP if floor == "lifted" else FALL]
    )
    data["scene"]["open_boundary"] = floor == SHEET
    p = plan(parse(data | {"output": {"rows": 4, "particles": 2, "contacts": 2}}))
    begin, middle, end = p.frame_steps(p.frames)
    at = 1e-3 * np.array([2.1, 1.0, 1.0, 1.0, 1.0])
    frames = []
    for step, z, there in ((begin, at, 5), (middle, at, 5), (end, at - [0, 0, 0, 2e-3, 2e-3], 4)):
        table = pd.DataFrame({"step": step, "id": [2, 3, 4, 5, 1], "type": 1, "radius": 2e-3, "mass": 1e-5, "z": z})
        table["z"] += p.time_at(np.array([step]))[0] * (floor == "lifted")
        table = table.assign(x=6e-3 * (floor == "aside"), y=0.0, vx=0.0, vy=0.0, vz=0.0)
        frames.append(table[:: 1 if there == 5 else -1].head(there))
    frames[1].loc[frames[1]["id"] == 2, "vz"] = speed
    contacts = pd.DataFrame({"step": [middle], "wall": "floor", "i": 3, "j": 0, "delta_max": 1.8e-3})
    found = passed_walls(p, {"particles": pd.concat(frames, ignore_index=True), "contacts": contacts})
    if floor == "aside":
        assert not found
        return
    (said,) = found
    assert said.startswith(
        f"{passed} of 5 spheres have passed through wall floor, whose contacts overlap by up to 0.9 "
    )


def one_impact(law: str, speed: float) -> dict:
    """A sphere of glass that hits the floor after 1 ms; the contact lasts less than the only row after it."""
    ball = bead("ball", mm(0, 0, 2 + speed), "2 mm", "glass", velocity=["0 m/s", "0 m/s", f"-{speed} m/s"])
    data = parts(wall=[FLOOR], fill=[], body=[ball], gravity="0 m/s^2", phase=[timed("hit", "8 ms")])
    return data | {"law": {"name": law}, "output": {"rows": 1, "particles": 1}, "numerics": {"time_step": "1e-6 s"}}


@pytest.mark.parametrize("engine", [LIGGGHTS, YADE])
@pytest.mark.parametrize(("law", "speed"), [("hertz", 2), ("thornton", 2), ("johnson", 0.5), ("cavity", 2)])
def test_an_impact_between_two_rows_has_the_largest_strain_of_theory(tmp_path, engine, law, speed):
    data = one_impact(law, speed)
    outcome = ran(data, tmp_path, engine)
    hit = predict(impact(parse(data), "glass", 2e-3, "steel", float(speed)))
    rows, share = outcome.results.rows, 0.5 if law == "hertz" else 1.0  # the floor is 20 times as strong
    assert rows[STRAINS[0]].to_list() == pytest.approx([0.0, hit.strain[-1]], rel=2e-3)
    assert rows[STRAINS[1]].to_list() == pytest.approx([0.0, share * hit.overlap_max[-1] / 2e-3], rel=4e-3)
    said = [warning for warning in outcome.warnings if "the strain w a/R*" in warning]
    assert len(said) == (hit.strain[-1] > 0.2)
    assert f"a strain w a/R* of {rows[STRAINS[0]].iloc[-1]:.3g}" in " ".join(sentences(outcome))


@pytest.mark.liggghts
def test_a_press_that_goes_beyond_small_strain_says_so_however_slow_it_is(tmp_path):
    data = read_toml(CASES / "compaction_powder.toml")
    data["scene"] |= {"box": mm(0.5, 0.5, 0.8), "count": 80, "height": "0.21 mm", "speed": "1 m/s"}
    data["output"] |= {"rows": 20, "particles": 10}
    outcome = ran(data, tmp_path)
    (said,) = [warning for warning in outcome.warnings if "the strain w a/R*" in warning]
    largest = outcome.results.rows[STRAINS[0]].iloc[-1]
    assert largest > 0.3 and f" reaches {largest:.2f}, above 0.3 in up to " in said
    assert said.endswith("pressures and springback deviate from finite elements (docs/press.md)")
    contacts, spheres = outcome.results.contacts, outcome.results.particles
    R_star = spheres["radius"].iloc[0] / (1.0 + (contacts["wall"] == ""))
    digits = 1 + 1e-4  # while a contact unloads, its spheres grow by their other contacts
    assert (0.5 * contacts["dent_radius"] / R_star).max() <= largest * digits  # one material: w = 1/2
    assert (0.5 * contacts["delta_max"] / R_star).max() <= outcome.results.rows[STRAINS[1]].iloc[-1] * digits
