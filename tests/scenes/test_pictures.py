# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of scenes: the key figure of each kind holds the numbers of the run, pictures show what is in front."""

from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from parts_cases import BED, bead, linear, mm, parts, timed
from stored_runs import STORED, planned
from test_start_and_paths import PLATE

from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.errors import CaseError
from epdem.report import pictures
from epdem.report import scenes as figures
from epdem.report.scenes import bed
from epdem.scenes.judge import checks, measures
from epdem.scenes.judge.energy_balance import kinetic, rotation
from epdem.scenes.plan.plan import plan

pytestmark = pytest.mark.figures


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
    p = plan(parse(parts(wall=[PLATE], fill=[BED], phase=[phase])))
    ball = {"id": 1, "type": 1, "radius": 2e-3, "mass": 1e-5, **dict.fromkeys(("x", "y", "z", "vx", "vy", "vz"), 0.0)}
    pictures.bed(p, pd.DataFrame([{"step": 0} | ball, {"step": p.steps // 2} | ball]), tmp_path / "bed.png")
    sunk = p.triangles["plate"] - shown[0]
    assert sunk[..., 2] == pytest.approx(1e-3, rel=1e-3) and not sunk[..., :2].any()
