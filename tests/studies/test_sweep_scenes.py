# SPDX-License-Identifier: GPL-2.0-or-later
"""Bulk scenes as points of a sweep: named numbers in one row, and a killed scene goes on from its restart file."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from epdem import Scene
from epdem import run as api_run
from epdem.scenes import results
from epdem.studies.sweep import folder, run, status, table

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
    assert table.read_sweep(tmp_path / "out").attrs["units"]["floor_load_mean"] == "N"
    again = run.run(planned, tmp_path / "out")
    assert again.ran == 0


def test_a_program_reads_in_its_log_how_far_a_scene_is(bed, tmp_path, caplog):
    caplog.set_level("INFO", "epdem")
    scene = Scene.from_toml(bed).replace({"scene.count": 20, "scene.duration": "0.02 s"})
    steps = api_run(scene, out=tmp_path / "out").outcome.plan.steps
    said = [record.getMessage() for record in caplog.records]
    assert len(said) > 5 and said[-1] == f"bed: step {steps} of {steps}"


def test_a_killed_scene_goes_on_from_its_restart_file(bed, tmp_path):
    bed.write_text(BED.replace("restarts = 0", "restarts = 10"))
    out = tmp_path / "out"
    command = [EPDEM, "sweep", str(bed), "--set", "scene.count=120", "-o", str(out), "-j", "1"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, start_new_session=True)
    end = time.monotonic() + 100
    while process.poll() is None and time.monotonic() < end and len(list(out.glob("points/*/restart.*.bin"))) < 2:
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.wait()
    while status.running(out) and time.monotonic() < end:
        time.sleep(0.01)
    assert json.loads(subprocess.check_output([EPDEM, "status", str(out), "--json"]))["waiting"] == 1
    subprocess.check_call(command, stdout=subprocess.DEVNULL)
    place = folder.of(folder.read(out), out, 1)
    assert (place / "in.resume").exists()
    whole = run.run(run.plan(bed, {"scene.count": "120"}), tmp_path / "whole")
    last = [
        results.read(p).tables["rows"].iloc[-1] for p in (place / "results.h5", *whole.folder.glob("points/*/*.h5"))
    ]
    assert last[0].equals(last[1])
