# SPDX-License-Identifier: GPL-2.0-or-later
"""Bulk scenes as points of a sweep: named numbers in one row, and a killed scene goes on from its restart file."""

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest
from typer.testing import CliRunner

from epdem import Scene
from epdem import run as api_run
from epdem.base.files import running
from epdem.cli.main import app
from epdem.engines.liggghts.engine import Liggghts
from epdem.errors import EngineError
from epdem.report.sweeps import _by_key
from epdem.scenes.tables import results
from epdem.studies.sweep import folder, run

pytestmark = pytest.mark.liggghts
EPDEM = str(Path(sys.executable).parent / "epdem")
BED = """
[case]
name = "bed"
title = "Beads that settle"
source = "weight of the beads"

[materials.glass]
young_modulus = "1 MPa"
poisson_ratio = 0.25
density = "2500 kg/m^3"

[law]
name = "hertz"

[viscous]
restitution = 0.5

[scene]
kind = "settle"
box = ["20 mm", "20 mm", "30 mm"]
particles = [{ material = "glass", radius = "1 mm" }]
count = 200
walls = "glass"
duration = "0.3 s"

[output]
rows = 20
loads = true
particles = 1
restarts = 0
"""

MEASURES = """
[[scene.measure]]
name = "held"
kind = "mass"
region = { x = ["-10 mm", "10 mm"], y = ["-10 mm", "10 mm"], z = ["0 mm", "15 mm"] }

[[scene.measure]]
name = "top"
kind = "height"
"""


@pytest.fixture
def bed(tmp_path):
    path = tmp_path / "bed.toml"
    path.write_text(BED)
    return path


def weight(count: int) -> float:
    return count * 4.0 / 3.0 * 3.141592653589793 * 0.001**3 * 2500.0 * 9.81


def test_a_scene_is_one_row_of_named_numbers(bed, tmp_path):
    planned = run.plan(bed, {"scene.count": "40,80"})
    found = run.run(planned, tmp_path / "out").table
    assert found["status"].tolist() == ["done"] * 2 and found["scene.count"].tolist() == [40, 80]
    assert found["floor_load_mean"].to_numpy() == pytest.approx([weight(40), weight(80)], rel=0.02)
    assert found["particles_last"].tolist() == [40, 80]
    assert found.attrs["units"]["floor_load_mean"] == "N"
    again = run.run(planned, tmp_path / "out")
    assert again.ran == 0


def test_the_page_shows_the_measures_of_the_case_first_and_every_number_that_changes(bed, tmp_path):
    """Two keys: a chart for each. Every number that differs between the points stands in both, and no other one."""
    bed.write_text(BED.replace("particles = 1\n", "particles = 4\n").replace("0.3 s", "0.02 s") + MEASURES)
    planned = run.plan(bed, {"scene.count": "10,20", "materials.glass.density": "2000 kg/m^3,3000 kg/m^3"})
    found = run.run(planned, tmp_path / "out")
    page = found.report().read_text()
    drawn = _by_key(found.table, [*found.sweep.points[0]], ["held", "top"], found.table.attrs["units"])
    assert re.findall(r'data-chart="([^"]+)"', page) == [chart.name for chart in drawn]
    assert [chart.panels[0].x.label for chart in drawn] == ["count", "density"]
    numbers = found.table.filter(regex="^(held|top|floor_load|spheres_in_room)(_|$)")  # measures and checks
    changing = {name for name in numbers if numbers[name].nunique() > 1}
    for key, chart in zip(("scene.count", "materials.glass.density"), drawn, strict=True):
        assert {panel.y.label for panel in chart.panels[:2]} == {"held", "top"} and chart.panels[0].y.unit == "kg"
        named = {
            panel.y.label + ("" if series.name == "value" else f"_{series.name}"): series
            for panel in chart.panels
            for series in panel.series
        }
        assert set(named) == changing and len(changing) > 6
        for name, series in named.items():
            points = zip(series.x, series.y, strict=True)
            assert sorted(points) == sorted(zip(found.table[key], found.table[name], strict=True))


def test_a_key_with_one_value_a_point_has_lines_from_low_to_high(bed, tmp_path):
    bed.write_text(BED.replace("0.3 s", "0.02 s") + MEASURES)
    found = run.run(run.plan(bed, {"scene.count": "20,5,10"}), tmp_path / "out")
    (chart,) = _by_key(found.table, ["scene.count"], ["held", "top"], {})
    series = [series for panel in chart.panels for series in panel.series]
    assert series and all(list(x.x) == [5, 10, 20] and x.dash is not None for x in series)


def test_a_sweep_of_a_press_draws_densities_springback_and_side_pressure_before_its_other_columns():
    names = ["stage1_time", "stage1_relative_density", "release1_springback", "stage1_radial_pressure", "density"]
    table = pd.DataFrame({"point": [1, 2], "k": [0.0, 0.3]} | {name: [1.0, 2.0] for name in names})
    (chart,) = _by_key(table, ["k"], [], {})
    assert [panel.y.label for panel in chart.panels] == [*names[1:4], names[0], "density"]
    assert {series.name for panel in chart.panels for series in panel.series} == {"value"}
    (chart,) = _by_key(table.assign(held=table["k"]), ["k"], ["held"], {})  # beside the measures of a case, too
    assert [panel.y.label for panel in chart.panels] == ["held", *names[1:4], "density"]


def test_the_warnings_of_the_points_stand_in_terminal_table_and_page(bed, tmp_path):
    """A step above the stable one of a contact, at both points."""
    bed.write_text(BED.replace("0.3 s", "0.02 s") + '[numerics]\ntime_step = "0.5 ms"\n')
    out = tmp_path / "out"
    command = ["sweep", str(bed), "--set", "scene.count=5,10", "-o", str(out)]
    said = CliRunner().invoke(app, command).stdout
    expected = r"2 of 2 points, here point 1: numerics\.time_step = 0\.0005 s: .* is stable up to"
    assert re.search(f"warning: {expected}", said)
    warnings = json.loads(CliRunner().invoke(app, [*command, "--json"]).stdout)["warnings"]
    assert re.match(expected, warnings[0]) and "the spheres still move" in warnings[1]
    assert pd.read_csv(out / "sweep.csv")["warnings"].str.startswith("numerics.time_step").all()
    page = (out / "report.html").read_text()
    assert "with 2 warnings" in page and "2 of 2 points, here point 1: numerics.time_step" in page


def test_a_program_reads_in_its_log_how_far_a_scene_is(bed, tmp_path, caplog):
    caplog.set_level("INFO", "epdem")
    scene = Scene.from_toml(bed).replace({"scene.count": 20, "scene.duration": "0.02 s"})
    steps = api_run(scene, out=tmp_path / "out").outcome.plan.steps
    said = [record.getMessage() for record in caplog.records]
    assert len(said) > 5 and said[-1] == f"bed: step {steps} of {steps}"


def test_an_engine_that_dies_in_a_resumed_scene_is_a_failed_point(bed, tmp_path, monkeypatch):
    """It does not begin again from step 0: `run` of the engine is not called."""
    bed.write_text(BED.replace("restarts = 0", "restarts = 10"))
    planned, out, calls = run.plan(bed, {"scene.count": "20"}), tmp_path / "out", []
    run.run(planned, out, jobs=1)
    place = folder.point_folder(planned, out, 1)
    (place / "results.h5").unlink()  # as if it had been killed
    assert any(place.glob("restart.*.bin"))

    def dies(*words, **named):
        calls.append("resume")
        raise EngineError("the engine has died")

    monkeypatch.setattr(Liggghts, "resume", dies)
    monkeypatch.setattr(Liggghts, "run", lambda *words, **named: calls.append("run"))
    run.evaluate(planned, out, 1)
    about = folder.record(planned, out, 1)
    assert calls == ["resume"] and (about["state"], about["reason"]) == ("failed", "the engine has died")


def test_a_killed_scene_goes_on_from_its_restart_file(bed, tmp_path):
    bed.write_text(BED.replace("restarts = 0", "restarts = 10"))
    out = tmp_path / "out"
    command = [EPDEM, "sweep", str(bed), "--set", "scene.count=60", "-o", str(out), "-j", "1"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, start_new_session=True)
    end = time.monotonic() + 100
    while process.poll() is None and time.monotonic() < end and len(list(out.glob("points/*/restart.*.bin"))) < 2:
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.wait()
    while (running(out) or folder.status(out)["running"]) and time.monotonic() < end:  # its processes end after it
        time.sleep(0.01)
    assert folder.status(out)["waiting"] == 1
    run.run(run.plan(bed, {"scene.count": "60"}), out, jobs=1)
    place = folder.point_folder(folder.read(out), out, 1)
    assert (place / "in.resume").exists()
    whole = run.run(run.plan(bed, {"scene.count": "60"}), tmp_path / "whole")
    last = [
        results.read(p).tables["rows"].iloc[-1] for p in (place / "results.h5", *whole.folder.glob("points/*/*.h5"))
    ]
    assert last[0].equals(last[1])
