# SPDX-License-Identifier: GPL-2.0-or-later
"""Measures of scenes: each one against what its definition gives on a bed whose places are known."""

import math
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from parts_cases import BED, FLOOR, bead, mm, mps, parts, timed
from scene_runs import ran, run, write_case

from epdem.case.scene import parse
from epdem.cli.options import answer
from epdem.errors import CaseError
from epdem.laws.strengths import LawSpec
from epdem.report.pages import write_page
from epdem.report.scenes import charts
from epdem.report.scenes import measures as curves_of
from epdem.scenes.judge import measures, summary
from epdem.scenes.plan.plan import plan
from epdem.scenes.tables.columns import units
from epdem.scenes.tables.results import read
from epdem.studies.fit import fit
from epdem.studies.sweep import run as study
from epdem.studies.sweep.table import numbers_of

ROOM = {"x": mm(-2, 2), "y": mm(-2, 2), "z": mm(0, 8)}


def planned(*wanted: dict, **output: object):
    """The plan of a scene with these measures."""
    data = parts(measure=list(wanted))
    data["output"] |= output
    return plan(parse(data))


def spheres(step: int, places: np.ndarray, radius: float = 1e-3, kind: int = 1) -> pd.DataFrame:
    """A frame of spheres of 2 mg."""
    table = pd.DataFrame(places, columns=["x", "y", "z"])
    still = dict.fromkeys(("vx", "vy", "vz"), 0.0)
    return table.assign(step=step, id=np.arange(1, len(places) + 1), type=kind, radius=radius, mass=2e-6, **still)


def curve(m: dict, *frames: pd.DataFrame, rows: pd.DataFrame | None = None) -> list[float]:
    """The values of a measure over frames."""
    p = planned(m | {"name": "value"})
    table = pd.concat(frames, ignore_index=True)
    rows = pd.DataFrame({"step": table["step"].unique(), "particles": 1}) if rows is None else rows
    return measures.curves(p, {"particles": table, "rows": rows})["value"].to_list()


def test_spheres_are_counted_and_weighed_where_their_centres_are():
    places = np.array([[0, 0, 1e-3], [1e-3, 0, 7e-3], [3e-3, 0, 1e-3], [0, 0, 9e-3]])
    assert curve({"kind": "count", "region": ROOM}, spheres(0, places)) == [2.0]
    assert curve({"kind": "mass", "region": ROOM}, spheres(0, places)) == [pytest.approx(4e-6)]
    assert curve({"kind": "count", "material": "glass"}, spheres(0, places, kind=2)) == [0.0]
    upright = {"diameter": "7 mm", "z": mm(0, 8)}
    assert curve({"kind": "count", "region": upright}, spheres(0, places)) == [3.0]


def test_mass_flows_through_a_plane_in_its_direction():
    heights = [[3e-3, 3e-3, 5e-3], [1e-3, 3e-3, 5e-3], [1e-3, 1e-3, 5e-3]]
    frames = [spheres(100 * n, np.array([[0, 0, z] for z in row])) for n, row in enumerate(heights)]
    frames[2].loc[2, "vz"] = -2.0  # m/s: 4 mm to the next frame, and the third has left the room there
    frames.append(spheres(300, np.array([[0, 0, 1e-3], [0, 0, 1e-3]])))
    late = spheres(300, np.array([[0, 0, 1e-3]])).assign(id=9)  # and one has come beyond the plane
    rate = 2e-6 / (100 * 2e-5)
    down = curve({"kind": "flow", "direction": "-z", "at": "2 mm"}, *frames, late)
    assert down == pytest.approx([0.0, rate, rate, rate])
    up = curve({"kind": "flow", "direction": "+z", "at": "2 mm"}, *frames[:3])
    assert up == pytest.approx([0.0, -rate, -rate])


@pytest.mark.parametrize(
    ("direction", "speed", "flows"), [("-z", -2.0, 1), ("-z", 2.0, 0), ("-x", -2.0, 0), ("+z", 2.0, 0)]
)
def test_a_sphere_that_leaves_has_passed_a_plane_only_if_its_motion_carries_it_through(direction, speed, flows):
    here, gone = spheres(0, np.array([[5e-3, 0, 5e-3]])).assign(vz=speed), spheres(100, np.zeros((0, 3)))
    rows = pd.DataFrame({"step": [0, 100], "particles": [1, 0]})
    p = planned({"kind": "flow", "direction": direction, "at": "2 mm", "name": "value"})
    at = next(n for n in p.frame_steps(p.frames) if n > 0)
    rows["step"] = [0, at]
    found = measures.curves(p, {"particles": pd.concat([here, gone]), "rows": rows})
    seconds = float(p.time_at(np.array([at]))[0])
    fast = abs(speed) * seconds > 3e-3 or speed > 0  # the frame after
    assert found["step"].to_list() == [0, at]
    assert found["value"].iloc[-1] == pytest.approx(2e-6 / seconds * flows * fast)


@pytest.mark.parametrize(("share", "flows"), [(0.5, 1), (2.0, 0)])
def test_a_sphere_that_leaves_by_a_side_above_a_plane_has_not_passed_it(share, flows):
    """It moves sideways so fast that it is at the plane after this share of its way to the side."""
    p = planned({"kind": "flow", "direction": "-z", "at": "2 mm", "name": "value"})
    at = next(n for n in p.frame_steps(p.frames) if n > 0)
    seconds, side = float(p.time_at(np.array([at]))[0]), p.scene.room.limits[1]
    down = 3e-3 / (0.25 * seconds) - 0.5 * 9.81 * 0.25 * seconds  # through the plane after a quarter of the interval
    here = spheres(0, np.array([[0, 0, 5e-3]])).assign(vz=-down, vx=share * side / (0.25 * seconds))
    rows = pd.DataFrame({"step": [0, at], "particles": [1, 0]})
    found = measures.curves(p, {"particles": here, "rows": rows})["value"]
    assert found.iloc[-1] == pytest.approx(2e-6 / seconds * flows)


@pytest.mark.parametrize("share", [0.4, 0.9, 1.7, -0.9])
def test_a_sphere_passes_a_plane_of_a_periodic_room_in_each_image(share):
    """One that goes by this share of the period from each of ten frames to the next, at constant velocity."""
    data = parts(measure=[{"kind": "flow", "direction": "+x", "at": "0 mm", "name": "value"}])
    data["scene"] |= {"periodic": "x", "wall": [w for w in data["scene"]["wall"] if w.get("axis") != "x"]}
    p = plan(parse(data))
    period = p.scene.periods[0]
    low = p.scene.room.limits[0]
    frames = [spheres(100 * n, np.array([[low + (0.05 + share * n) % 1.0 * period, 0, 1e-3]])) for n in range(11)]
    frames = [frame.assign(vx=share * period / float(p.time_at(np.array([100]))[0])) for frame in frames]
    rows = pd.DataFrame({"step": np.arange(11) * 100, "particles": 1})
    found = measures.curves(p, {"particles": pd.concat(frames), "rows": rows})
    mass = float((found["value"].to_numpy()[1:] * np.diff(p.time_at(found["step"].to_numpy()))).sum())
    first, last = (0.05 + share * n - (0.0 - low) / period for n in (0, 10))  # periods beyond the plane
    assert mass == pytest.approx((math.floor(last) - math.floor(first)) * 2e-6)


def test_an_emptied_room_has_no_mass_no_flow_and_no_centre():
    wanted = [{"kind": "mass", "name": "held"}, {"kind": "center_of_mass", "name": "middle"}]
    p = planned(*wanted)
    steps = p.frame_steps(p.frames)
    frames = [spheres(n, np.array([[0, 0, 1e-3]])) for n in steps[:-2]]
    rows = pd.DataFrame({"step": steps, "particles": [1] * (len(steps) - 2) + [0, 0]})
    found = measures.curves(p, {"particles": pd.concat(frames), "rows": rows})
    assert found["step"].to_list() == steps
    assert found["held"].to_list()[-3:] == [2e-6, 0.0, 0.0]
    assert found["middle"].iloc[-3] == 1e-3 and found["middle"].tail(2).isna().all()


@pytest.mark.parametrize("strays", [0, 6, 200])
def test_spheres_that_have_rolled_away_do_not_change_the_angle_of_repose(strays):
    """A cone of 25 degrees, filled evenly, and strays on the floor up to ten radii of its foot away."""
    rng, slope, height = np.random.default_rng(2), math.tan(math.radians(25.0)), 0.1
    z = height * (1 - rng.uniform(size=20_000) ** (1 / 3))
    r = (height - z) / slope * np.sqrt(rng.uniform(size=z.size))
    phi = rng.uniform(0, 2 * math.pi, z.size)
    far, turn = rng.uniform(0.3, 2.0, strays), rng.uniform(0, 2 * math.pi, strays)
    x, y = (np.append(r * f(phi), far * f(turn)) for f in (np.cos, np.sin))
    places = np.stack([x, y, np.append(z, np.zeros(strays))], axis=1)
    (found,) = curve({"kind": "repose"}, spheres(0, places, 1e-6))
    assert math.degrees(found) == pytest.approx(25.0, abs=0.7)


def test_an_angle_of_repose_comes_with_its_rings_and_in_degrees_for_readers():
    """A cone of 25 degrees of spheres on a line, of which 10 of 12 rings count, and the same with a gap.

    Without those from 0.2 to 0.405, 95 % of the spheres end at 0.96: the rings of a width of 0.08 from 0.24 to 0.4 are
    empty.
    """
    way = np.repeat(np.linspace(0.0, 1.0, 2400), 2)
    places = np.stack([way, 0 * way, (1.0 - way) * math.tan(math.radians(25.0))], axis=1)
    kept = {0: way >= 0.0, 10: (way < 0.2) | (way > 0.405)}
    frames = [spheres(step, places[keep], 1e-6) for step, keep in kept.items()]
    p = planned({"kind": "repose", "name": "angle", "over": "distance"})
    tables = {"particles": pd.concat(frames), "rows": pd.DataFrame({"step": [0, 10], "particles": 1})}
    tables["measures"] = measures.curves(p, tables)
    assert np.degrees(tables["measures"]["angle"].to_numpy()) == pytest.approx(25.0, abs=0.01)
    assert tables["measures"]["angle_rings"].to_list() == [10, 8]
    shown = summary.measured(p, tables).iloc[0]
    assert shown["kind"] == "repose of 8 rings" and shown["unit"] == "deg"
    assert float(shown["value"]) == pytest.approx(25.0, abs=0.01)


def test_height_and_centre_of_mass_are_those_of_the_masses():
    column = np.array([[1e-3, 0, z * 1e-3] for z in range(1, 21)])
    assert curve({"kind": "height", "share": 0.5}, spheres(0, column)) == [pytest.approx(10e-3)]
    assert curve({"kind": "height"}, spheres(0, column)) == [pytest.approx(19e-3)]
    alike = spheres(0, column).assign(mass=1.809557368e-5)  # 7 of them over 20 are a little below 0.35
    assert curve({"kind": "height", "share": 0.35}, alike) == [pytest.approx(7e-3)]
    assert curve({"kind": "center_of_mass"}, spheres(0, column)) == [pytest.approx(10.5e-3)]
    assert curve({"kind": "center_of_mass", "axis": "x"}, spheres(0, column)) == [pytest.approx(1e-3)]


@pytest.mark.parametrize(("over", "angle"), [("distance", 0.4), ("x", 0.3)])
def test_the_angle_of_repose_is_that_of_a_heap(over, angle):
    rng = np.random.default_rng(1)
    x, y = rng.uniform(-0.1, 0.1, (2, 40_000))
    way = {"distance": np.hypot(x, y), "x": x}[over]
    z = (0.2 - way * math.tan(angle)) * rng.uniform(0.0, 1.0, x.size) ** 0.05  # most lie near the surface
    at = {"diameter": "0.2 m", "z": ["0 m", "1 m"]}
    found = curve({"kind": "repose", "over": over, "region": at}, spheres(0, np.stack([x, y, z], axis=1), 1e-6))
    assert found[0] == pytest.approx(angle, abs=0.02)


def test_porosity_is_what_spheres_leave_of_a_region():
    grid = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (1, 3, 5, 7)]) * 1e-3
    simple_cubic = 1 - math.pi / 6
    assert curve({"kind": "porosity", "region": ROOM}, spheres(0, grid)) == [pytest.approx(simple_cubic, abs=1e-4)]
    half = ROOM | {"z": mm(0, 1)}  # cuts spheres through their centres
    assert curve({"kind": "porosity", "region": half}, spheres(0, grid)) == [pytest.approx(simple_cubic, abs=1e-4)]


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 0.6), st.booleans())
def test_porosity_is_exact_to_a_ten_thousandth(seed, overlap, upright):
    """Two spheres at random places that overlap by a share of a radius, within the region: each less half the lens."""
    rng, r = np.random.default_rng(seed), 1e-3
    way = rng.normal(size=3)
    first = rng.uniform(-0.3e-3, 0.3e-3, 3) + np.array([0, 0, 4e-3])
    places = np.array([first, first + (2 - overlap) * r * way / np.linalg.norm(way)])
    region = {"diameter": "8 mm", "z": mm(0, 8)} if upright else ROOM | {"x": mm(-4, 4), "y": mm(-4, 4)}
    volume = math.pi * 4e-3**2 * 8e-3 if upright else 8e-3**3
    h = overlap * r / 2  # of each cap of the lens
    lens = 2 * math.pi * h**2 * (r - h / 3)
    taken = (2 * 4 / 3 * math.pi * r**3 - lens) / volume
    assert curve({"kind": "porosity", "region": region}, spheres(0, places)) == [pytest.approx(1 - taken, abs=1e-4)]


CENTRE = dict.fromkeys("xyz", 0.0)


def test_the_speed_of_an_impact_is_read_from_its_largest_overlap():
    """An elastic sphere on a wall: m v^2/2 = 8/15 E* sqrt(R) alpha^(5/2)."""
    data = parts(measure=[{"name": "speed", "kind": "impact_speed", "bins": 2}], body=[])
    data["law"] = {"name": "hertz"}
    p = plan(parse(data))
    radius, mass, overlap = 1.5e-3, 3e-5, 2e-5
    E_star = 1 / ((1 - 0.25**2) / 10e6 + (1 - 0.3**2) / 100e6)
    tables = {
        "particles": pd.DataFrame({"step": [0], "id": 1, "radius": radius, "mass": mass, "type": 1} | CENTRE),
        "contacts": pd.DataFrame(
            {"step": 0, "wall": ["floor"] * 2, "i": 1, "j": 0, "delta_max": [0.5 * overlap, overlap]}
        ),
    }
    found = measures.histograms(p, tables)
    v = math.sqrt(2 * 8 / 15 * E_star * math.sqrt(radius) * overlap**2.5 / mass)
    assert found["number"].sum() == 1
    assert 0.5 * (found["low"].iloc[0] + found["high"].iloc[-1]) == pytest.approx(v, rel=1e-9)


@pytest.mark.parametrize("law", ["hertz", "thornton"])
def test_a_bed_of_many_radii_makes_one_law_for_each_pair_of_materials(law, monkeypatch):
    """Hertz as above; thornton beyond first yield at alpha_y: W = W_y + pi p_y R [(alpha^2 - alpha_y^2)/2 - alpha_y/3
    (alpha - alpha_y)], W_y = 8/15 E* sqrt(R) alpha_y^(5/2)."""
    data = parts(measure=[{"name": "speed", "kind": "impact_speed", "bins": 2}], body=[])
    data["law"] = {"name": "hertz"} if law == "hertz" else {"name": "thornton", "yield_pressure": "0.2 MPa"}
    p = plan(parse(data))
    rng, n, mass = np.random.default_rng(3), 1000, 3e-5
    ids = np.arange(1, n + 1)
    radius, overlap = rng.uniform(1e-3, 2e-3, n), rng.uniform(1e-5, 3e-5, n)
    tables = {
        "particles": pd.DataFrame({"step": 0, "id": ids, "radius": radius, "mass": mass, "type": 1} | CENTRE),
        "contacts": pd.DataFrame({"step": 0, "wall": "floor", "i": ids, "j": 0, "delta_max": overlap}),
    }
    made, real = [], LawSpec.backbone
    monkeypatch.setattr(LawSpec, "backbone", lambda self, **given: made.append(given) or real(self, **given))
    found = measures.values_of(p, p.scene.measure[0], tables)
    E_star = 1 / ((1 - 0.25**2) / 10e6 + (1 - 0.3**2) / 100e6)
    first = overlap if law == "hertz" else (math.pi * 0.2e6 / (2 * E_star)) ** 2 * radius
    assert (overlap >= first).all()
    work = 8 / 15 * E_star * np.sqrt(radius) * first**2.5
    flow = (overlap**2 - first**2) / 2 - first / 3 * (overlap - first)
    expected = np.sqrt(2 * (work + math.pi * 0.2e6 * radius * flow) / mass)
    assert found == pytest.approx(expected, rel=1e-9) and len(made) == 1


@pytest.mark.liggghts
def test_measures_stand_in_the_results_and_are_numbers_for_studies(tmp_path, capsys):
    wanted = [
        {"name": "top", "kind": "height", "share": 1.0},
        {"name": "pressed", "kind": "force", "wall": "floor", "component": "z"},
        {"name": "dents", "kind": "plastic_work", "bins": 5},
        {"name": "speeds", "kind": "impact_speed", "bins": 5},
    ]
    data = parts(measure=wanted, wall=[FLOOR], fill=[BED], periodic=True, phase=[timed("fall", "0.1 s")])
    outcome = ran(data, tmp_path)
    found, spheres_then = outcome.results, outcome.results.particles
    assert found.measures["top"].to_list() == spheres_then.groupby("step")["z"].max().to_list()
    assert found.rows["pressed"].to_list() == found.rows["floor_force_z"].to_list() and found.rows["pressed"].min() < 0
    stored = read(outcome.folder / "results.h5")
    assert (units(stored.rows)["pressed"], units(stored.measures)["top"]) == ("N", "m")
    number = found.histograms.groupby("measure")["number"].sum()
    assert number["dents"] == 40 and number["speeds"] >= 10
    fastest = math.sqrt(2 * 9.81 * 0.038)
    assert 0.3 * fastest < found.histograms.query("measure == 'speeds'")["high"].max() < 1.02 * fastest
    numbers = numbers_of(SimpleNamespace(tables=found.tables))
    assert numbers["top_last"] == found.measures["top"].iloc[-1] and "pressed_mean" in numbers
    drawn = {chart.name: chart for chart in charts(outcome)}
    assert set(drawn) >= {"scene", "scene_measures", "scene_dents", "scene_speeds"}
    (bins,) = drawn["scene_dents"].panels[0].series
    assert bins.y[1::2].sum() == 40 and bins.x[-1] == spheres_then.query("step == step.max()")["plastic_work"].max()
    assert "Histograms" in write_page(outcome).read_text()
    answer(None, summary.shown(outcome), as_json=False)
    said = capsys.readouterr().out
    dents = spheres_then.query("step == step.max()")["plastic_work"]
    assert f"{dents.mean():.5g}" in said and f" {found.measures['time'].iloc[-1]:.5g} " in said


@pytest.mark.liggghts
def test_a_measure_is_a_target_with_its_unit(tmp_path):
    """The mass in a region at rest gives the density: m = 8 beads of 4/3 pi R^3 rho; a sweep has the same column."""
    mass = {"name": "held", "kind": "mass", "region": {"diameter": "16 mm", "z": mm(0, 40)}}
    data = parts(fill=[BED | {"count": 8}], measure=[mass], phase=[timed("fall", "2 ms")])
    data["output"] = {"rows": 2, "particles": 2}
    one = 8 * 4 / 3 * math.pi * 1.5e-3**3
    free = {"materials.glass.density": "1000 kg/m^3..4000 kg/m^3"}
    path = write_case(data | {"numerics": {"time_step": "1e-5 s"}}, tmp_path)
    inside = run(path, out=tmp_path / "once").results.measures["held"].iloc[-1] / (one * 2500)
    found = fit(path, {"held_last": f"{float(one * inside * 1700 * 1e3)!r} g"}, free, out=tmp_path / "fit", jobs=1)
    assert float(found.values["materials.glass.density"].split()[0]) == pytest.approx(1700, rel=0.04)
    assert found.units == {"held_last": "kg"} and 0 < inside <= 1
    with pytest.raises(CaseError, match=r"wrong dimension.*held_last=1 kg"):
        fit(path, {"held_last": "1 m"}, free, out=tmp_path / "fit", jobs=1)


LIFT = {"name": "lift", "kind": "force", "wall": "floor", "component": "z"}
TILT = {"name": "tilt", "kind": "force", "wall": "floor"}


def test_a_force_has_a_value_in_every_row_and_its_peak_counts():
    """The largest force lies between two frames: 125.9 N in one row of five, 0 in both frames."""
    rows = pd.DataFrame({"step": [0, 10, 20, 30, 40], "time": np.arange(5.0), "particles": 1, "floor_force_x": 0.0})
    rows = rows.assign(floor_force_y=[0, 0, 3.0, 0, 0], floor_force_z=[0, 0, 125.9, 4.0, 0])
    p = planned(LIFT, TILT, {"name": "all", "kind": "count"})
    frames = pd.concat([spheres(step, np.zeros((1, 3))) for step in (0, 40)], ignore_index=True)
    tables = {"particles": frames, "rows": measures.with_loads(p, rows), "checks": pd.DataFrame()}
    tables["measures"] = measures.curves(p, tables)
    numbers = numbers_of(SimpleNamespace(tables=tables))
    assert (numbers["lift_max"], numbers["lift_mean"], numbers["lift_last"]) == (125.9, 0.0, 0.0)
    assert numbers["tilt_max"] == pytest.approx(math.hypot(125.9, 3.0)) and numbers["all_max"] == 1.0
    (drawn,) = curves_of(p, tables)
    panels = {panel.y.label: panel.series[0].y for panel in drawn.panels}
    assert panels["lift"].max() == 125.9 and len(panels["lift"]) == 5 and "all = 1" in drawn.alt


@pytest.mark.liggghts
@pytest.mark.parametrize("frames", [0, 1])
def test_a_force_needs_no_frames_and_is_a_target(frames, tmp_path, capsys):
    """A ball that lands and leaves between two frames presses the floor, by its density: a sweep and a fit see it."""
    ball = bead("ball", mm(0, 0, 1.6), "1.5 mm", "glass")
    data = parts(fill=[], body=[ball | {"velocity": mps(0, 0, -0.5)}], measure=[LIFT])
    data["scene"]["phase"] = [timed("fall", "2 ms")]
    data |= {"output": {"rows": 40, "particles": frames}, "numerics": {"time_step": "2e-6 s"}}
    path = write_case(data, tmp_path)
    outcome = run(path, out=tmp_path / "once")
    peak = -outcome.results.rows["floor_force_z"].min()
    assert peak > 0.01 and outcome.results.rows["lift"].to_list() == outcome.results.rows["floor_force_z"].to_list()
    answer(None, summary.shown(outcome), as_json=False)
    assert f"{-peak:.5g}" in capsys.readouterr().out
    document = summary.document(outcome)
    assert document["measures"][0]["lift"] == outcome.results.rows["lift"].iloc[-1]
    write_page(outcome)
    if frames:  # a sweep and a fit of frames: test_a_measure_is_a_target_with_its_unit
        return
    swept = study.run(study.plan(path, {"materials.glass.density": ["2500 kg/m^3"]}), tmp_path / "sweep", jobs=1)
    assert swept.table["lift_min"].iloc[0] == -peak
    target, free = {"lift_min": "-0.07 N"}, {"materials.glass.density": "1000 kg/m^3..4000 kg/m^3"}
    found = fit(path, target, free, out=tmp_path / "fit", jobs=1, tolerance=0.05)
    assert found.numbers["lift_min"] == pytest.approx(-0.07, rel=0.05) and found.units == {"lift_min": "N"}
