# SPDX-License-Identifier: GPL-2.0-or-later
"""Pages, figures and pictures of scenes: each figure once, the numbers of the run, what is in front."""

import base64
import re
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from parts_cases import BED, BOX, bead, linear, mm, parts, pipe, timed
from scene_runs import ran
from stored_runs import STORED, planned
from test_parts_motions import PLATE
from test_start_and_paths import PLATE as SHEET

from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.errors import CaseError
from epdem.report import pictures
from epdem.report import scenes as figures
from epdem.report.pages import write_page
from epdem.report.scenes import bed, charts
from epdem.scenes.judge import checks, measures
from epdem.scenes.judge.energy_balance import kinetic, rotation
from epdem.scenes.plan.plan import plan

pytestmark = pytest.mark.figures

LID = {"name": "lid", "kind": "plate", "axis": "z", "center": mm(0, 0, 12), "size": mm(17.9, 17.9)}
TUBE = pipe("tube", "0 mm", "30 mm", "18 mm")


@pytest.fixture(scope="module")
def outcome(tmp_path_factory):
    """Beads fall in a tube with a lid of triangles; one measure grows, one never changes; no histogram."""
    place = tmp_path_factory.mktemp("figures")
    wanted = [{"name": "all", "kind": "count"}, {"name": "top", "kind": "height"}]
    data = parts(wall=[TUBE, PLATE | {"name": "lid"}], fill=[BED], measure=wanted)
    data["scene"]["phase"] = [timed("fall", "30 ms")]
    data["output"] = {"rows": 10, "particles": 5, "loads": True, "energy": True}
    return ran(data, place)


@pytest.fixture(scope="module")
def page(outcome):
    return write_page(outcome).read_text()


@pytest.mark.liggghts
def test_every_column_of_the_rows_that_changes_is_drawn_once(outcome):
    rows = outcome.results.rows.drop(columns=["step", "time"])
    changing = [name for name in rows if rows[name].nunique() > 1]
    chart = {c.name: c for c in charts(outcome)}["scene"]
    drawn = {}
    for panel in chart.panels:
        for series in panel.series:
            drawn[f"{panel.y.label}_{series.name}".removesuffix("_")] = series.y
    assert sorted(drawn) == sorted(changing) and len(drawn) > 6
    assert all(np.array_equal(drawn[name], rows[name]) for name in drawn)
    for name in set(rows) - set(changing):  # a flat curve is a number in the text
        assert f"{name} = {rows[name].iloc[0]:.5g}" in chart.alt


@pytest.mark.liggghts
def test_measures_are_the_first_figure_and_come_once(outcome, page):
    found = charts(outcome)
    assert [panel.y.label for panel in found[0].panels] == ["top"] and "all = " in found[0].alt
    labels = [panel.y.label for chart in found for panel in chart.panels]
    assert len(labels) == len(set(labels))
    drawn = re.findall(r'data-chart="(\w+)"', page)
    assert drawn == [chart.name for chart in found] and len(set(drawn)) == len(drawn)


@pytest.mark.liggghts
def test_a_page_has_no_empty_table_and_units_of_all_columns(page):
    assert "Histograms" not in page and re.search(r">Measures</h2>", page)
    assert "<tbody>\n</tbody>" not in page
    assert "tube_force_x [N]" in page and "lid_torque_z [N m]" in page and "top [mm]" in page


@pytest.mark.liggghts
def test_the_bed_is_the_picture_of_walls_and_spheres_with_its_scale(outcome, page):
    """The picture in the page is the file bed.png: wall outlines (grey-blue), colour bar (all of viridis) and scale."""
    found = re.findall(r'<img src="data:image/png;base64,([^"]+)" alt="([^"]+)"', page)
    assert [base64.b64decode(png) for png, _ in found] == [(outcome.folder / "bed.png").read_bytes()]
    assert "walls" in found[0][1] and "speed [m/s]" in found[0][1] and "<circle" not in page
    image = plt.imread(outcome.folder / "bed.png")[..., :3].reshape(-1, 3)
    shades = plt.get_cmap("viridis")(np.linspace(0, 1, 9))[:, :3]
    assert all((np.abs(image - shade).max(axis=1) < 0.01).sum() > 50 for shade in shades)


@pytest.mark.liggghts
def test_figures_and_tables_have_one_name_for_one_thing(outcome, page):
    """Axes carry names of columns: no symbol of its own, and no dollar sign is left in the page."""
    body = re.sub(r"<script.*?</script>", "", page, flags=re.S)
    assert "$" not in re.sub(r"<details>.*?</details>", "", body, flags=re.S)
    tables = outcome.results.tables
    named = {name for table in tables.values() for name in table}
    for panel in (panel for chart in charts(outcome) for panel in chart.panels):
        label = panel.y.label
        assert label in named or {f"{label}_{axis}" for axis in "xyz"} <= named or label == "energy", label
        assert panel.x.label == "time"


def lid(speed: float) -> dict:
    return linear("lid", 0, 0, speed)


@pytest.mark.liggghts
def test_a_press_of_parts_has_force_over_displacement_and_time_has_the_ends_of_phases(tmp_path):
    """6.6 mm down at 0.2 m/s from 20 ms on, then 1.4 mm back; places are those of the middle of each row."""
    phases = [timed("fall", "20 ms")]
    phases += [timed(name, t, move=[lid(v)]) for name, t, v in (("down", "33 ms", -0.2), ("up", "7 ms", 0.2))]
    walls = [BOX | {"open": ["+z"]}, LID | {"material": "steel"}]
    bed = BED | {"region": BED["region"] | {"z": mm(0, 11.9)}, "count": 66}
    data = parts(wall=walls, fill=[bed], phase=phases) | {"output": {"rows": 60, "particles": 2, "loads": True}}
    outcome = ran(data, tmp_path)
    found = {chart.name: chart for chart in charts(outcome)}
    (panel,) = found["key"].panels
    assert (panel.x.label, panel.y.label) == ("displacement of lid", "force on lid")
    rows = outcome.results.rows.iloc[1:]
    middle = (rows["time"] - 0.5e-3).to_numpy()
    place = np.where(middle < 0.053, 0.2 * (middle - 0.02), 6.6e-3 - 0.2 * (middle - 0.053))
    for series, (begin, end) in zip(panel.series, ((0.02, 0.053), (0.053, 0.06)), strict=True):
        during = ((middle > begin) & (middle < end)).nonzero()
        assert series.x == pytest.approx(place[during], abs=1e-9)
        assert series.y == pytest.approx(rows["lid_force_z"].to_numpy()[during], abs=1e-12)
    assert [series.name for series in panel.series] == ["down", "up"] and max(panel.series[0].y) > 0.1
    for name in ("scene",):
        for panel in found[name].panels:
            ends = [series.x for series in panel.series if series.dash == "dot"]
            assert ends == [pytest.approx([t, t]) for t in (0.02, 0.053)]


def drawn(name: str):
    """(plan, tables, panels of the key figure) of a stored run."""
    p = planned(name)
    tables = scene_engine("liggghts").read(p, STORED / name)
    tables["measures"] = measures.curves(p, tables)
    tables["checks"] = checks.checks(p, tables)
    (chart,) = figures.key(p, tables)
    return p, tables, chart.panels


def test_a_compaction_shows_force_over_the_displacement_of_its_plate():
    p, tables, (panel,) = drawn("compaction")
    s, (load, unload) = p.case.scene, panel.series
    assert [*load.y, *unload.y] == pytest.approx(tables["rows"]["plate_force"][1:].to_list(), rel=1e-12)
    middle = tables["rows"]["time"][1:] - 0.5 * p.every * p.time_step  # of the interval of a mean
    assert load.x == pytest.approx(s["speed"] * middle[: len(load.x)].to_numpy(), rel=1e-6)
    assert (np.diff(unload.x) < 0).all()


def test_the_rebounds_of_shot_stand_beside_theory():
    p, tables, (panel,) = drawn("peening")
    up = tables["particles"].query("vz > 0").groupby("id")["vz"].max()
    bars, theory = panel.series
    assert sum(bars.y[::2]) == len(up) > 0 and (bars.x[0], bars.x[-1]) == pytest.approx((up.min(), up.max()), abs=0.5)
    assert theory.x[0] == pytest.approx(checks.single_rebound(p.case, p.scene.check[0]))


def test_a_hopper_a_drum_and_a_bed_show_mass_torque_and_height():
    p, tables, (panel,) = drawn("hopper")
    last = tables["particles"].query(f"step == {p.steps}")
    assert panel.series[0].y[-1] == pytest.approx(last[last["z"] < p.scene.gates[0].at]["mass"].sum())
    _, tables, (panel,) = drawn("drum")
    assert panel.series[0].y.tolist() == tables["rows"]["torque"].to_list()
    _, tables, (height, energy) = drawn("settle")
    assert height.series[0].y.tolist() == tables["measures"]["bed_height"].to_list()
    assert energy.series[0].y[-1] == tables["rows"]["kinetic_energy"].iloc[-1]


def test_a_picture_shows_the_nearest_sphere_and_its_field(tmp_path):
    """Two spheres in the line of sight: the middle of the picture has the colour of the near one."""
    _, towards = pictures._axes()
    p = plan(parse(parts(wall=[], fill=[BED])))
    places = {"near": 0.005 * towards, "far": -0.005 * towards}
    fast = {"near": 1.0, "far": 0.0}
    for order in (["near", "far"], ["far", "near"]):
        table = pd.DataFrame([[*places[k], fast[k]] for k in order], columns=["x", "y", "z", "vx"])
        table = table.assign(step=0, id=[1, 2], type=1, radius=2e-3, mass=1e-5, vy=0.0, vz=0.0)
        pictures.bed(p, table, tmp_path / "bed.png")
        image = plt.imread(tmp_path / "bed.png")
        seen = image[..., :3].reshape(-1, 3)
        yellow, violet = ((np.abs(seen - plt.get_cmap("viridis")(x)[:3]).max(axis=1) < 0.02).sum() for x in (1.0, 0.0))
        assert image.shape[1] == 1200 and yellow > 20 * violet


def test_a_sphere_has_a_dark_rim_and_a_highlight_and_fades_with_its_distance():
    _, towards = pictures._axes()
    red = np.array([0.8, 0.2, 0.1])
    axis = plt.figure().subplots()
    pictures._draw_spheres(axis, np.array([towards, -towards]), np.full(2, 0.1), np.array([red, red]))
    far, near = axis.collections[0].get_facecolor()[:, :3].reshape(2, -1, 3)
    assert np.abs(near - red).max(axis=1).min() < 1e-12  # its colour, which the colour bar explains
    assert (near[0] < 0.5 * red).all() and (near[-1] > red).all() and (np.diff(near.sum(axis=1)) > 0).all()
    assert (far.sum(axis=1) > near.sum(axis=1)).all()


def test_a_picture_before_the_run_has_the_spheres_that_can_be_placed(tmp_path):
    ball = bead("ball", mm(0, 0, 20), "2 mm", "steel", phase="more")
    phases = [timed("fall", "20 ms"), timed("more", "20 ms")]
    p = plan(parse(parts(body=[ball], phase=phases)))
    assert pictures.before(p, tmp_path / "a.png") == 41
    assert plt.imread(tmp_path / "a.png").shape[1] == 1200


def test_an_unknown_field_is_refused():
    data = parts()
    data["output"]["color"] = "omega_x"
    with pytest.raises(CaseError, match=r"output.color = 'omega_x': spheres of this scene have speed, energy, id"):
        measures.refuse_measures(plan(parse(data)))


def test_translation_and_spin_are_counted_apart():
    table = pd.DataFrame({"mass": [2.0], "radius": [0.5], "vx": [3.0], "vy": [0.0], "vz": [4.0]})
    assert kinetic(table).item() == 25.0 and rotation(table).item() == 0.0
    spinning = table.assign(omega_x=0.0, omega_y=2.0, omega_z=0.0)
    assert kinetic(spinning).item() == 25.0 and rotation(spinning).item() == pytest.approx(0.4)


def test_the_time_of_the_bed_counts_the_steps_of_each_phase(tmp_path):
    """1000 steps of 2e-5 s and 1000 of 1e-5 s."""
    phases = [timed("fall", "20 ms"), timed("rest", "10 ms", time_step="1e-5 s")]
    p = plan(parse(parts(phase=phases)))
    still = dict.fromkeys(("x", "y", "vx", "vy", "vz"), 0.0)
    frame = pd.DataFrame({"step": [p.steps], "z": 1e-3, "radius": 1e-3, "mass": 1e-5} | still)
    (picture,) = bed(SimpleNamespace(plan=p, folder=tmp_path, results=SimpleNamespace(tables={"particles": frame})))
    assert p.steps == 2000 and "at 0.03 s;" in picture.alt


def test_a_wall_is_drawn_where_it_is_in_the_last_frame(tmp_path, monkeypatch):
    """A plate sinks 2 mm in a phase of 20 ms; the frame at half of it shows 1 mm."""
    shown = []
    monkeypatch.setattr(pictures, "_draw_walls", lambda axis, walls, front: shown.append(walls[0][0]))
    move = linear("plate", 0, 0, -0.1)
    phase = timed("sink", "20 ms", move=[move])
    p = plan(parse(parts(wall=[SHEET], fill=[BED], phase=[phase])))
    ball = {"id": 1, "type": 1, "radius": 2e-3, "mass": 1e-5, **dict.fromkeys(("x", "y", "z", "vx", "vy", "vz"), 0.0)}
    pictures.bed(p, pd.DataFrame([{"step": 0} | ball, {"step": p.steps // 2} | ball]), tmp_path / "bed.png")
    sunk = p.triangles["plate"] - shown[0]
    assert sunk[..., 2] == pytest.approx(1e-3, rel=1e-3) and not sunk[..., :2].any()
