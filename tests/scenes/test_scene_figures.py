# SPDX-License-Identifier: GPL-2.0-or-later
"""The page of a scene: each figure once, every column that changes is drawn, no empty table, the bed with its walls."""

import base64
import re

import matplotlib.pyplot as plt
import numpy as np
import pytest
from parts_cases import BED, BOX, linear, mm, parts, pipe, timed
from scene_runs import ran
from test_parts_motions import PLATE

from epdem.report.pages import write_page
from epdem.report.scenes import charts

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
