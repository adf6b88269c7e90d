# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of scenes: the key figure of each kind holds the numbers of the run, pictures show what is in front."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from parts_cases import BED, parts
from stored_runs import STORED, planned

from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.errors import CaseError
from epdem.scenes import checks, key_figures, pictures
from epdem.scenes.ledger import kinetic, rotation
from epdem.scenes.plan import plan


def drawn(name: str):
    """(plan, tables, axis with the key figure) of a stored run."""
    p = planned(name)
    tables = scene_engine("liggghts").read(p, STORED / name)
    axis = plt.figure().subplots()
    key_figures.DRAW[type(p.case.scene)](p, p.case.scene, tables, axis)
    return p, tables, axis


def test_a_compaction_shows_force_over_the_displacement_of_its_plate():
    p, tables, axis = drawn("compaction")
    s, (load, unload) = p.case.scene, axis.lines
    force = np.concatenate([load.get_ydata(), unload.get_ydata()])
    assert force.tolist() == tables["rows"]["plate_force"].to_list()
    middle = tables["rows"]["time"][1:] - 0.5 * p.every * p.time_step  # of the interval of a mean
    n = len(load.get_xdata())
    assert load.get_xdata()[1:] == pytest.approx(1e3 * s.speed * middle[: n - 1].to_numpy(), rel=1e-6)
    assert (np.diff(unload.get_xdata()) < 0).all()


def test_the_rebounds_of_shot_stand_beside_theory():
    p, tables, axis = drawn("peening")
    up = tables["particles"].query("vz > 0").groupby("id")["vz"].max()
    assert sum(bar.get_height() for bar in axis.patches) == len(up) > 0
    assert axis.lines[0].get_xdata()[0] == pytest.approx(checks.single_rebound(p.case, p.case.scene))


def test_a_hopper_a_drum_and_a_bed_show_mass_torque_and_height():
    p, tables, axis = drawn("hopper")
    last = tables["particles"].query(f"step == {p.steps}")
    assert axis.lines[0].get_ydata()[-1] == pytest.approx(1e3 * last[last["z"] < p.layout.gates[0].place]["mass"].sum())
    _, tables, axis = drawn("drum")
    assert axis.lines[0].get_ydata().tolist() == tables["rows"]["torque"].to_list()
    _, tables, axis = drawn("settle")
    heights = tables["particles"].groupby("step")["z"].quantile(0.95)
    assert axis.figure.axes[1].lines[0].get_ydata() == pytest.approx(1e3 * heights.to_numpy())


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


def test_a_picture_before_the_run_has_the_spheres_that_can_be_placed(tmp_path):
    ball = {"name": "ball", "material": "steel", "radius": "2 mm", "place": ["0 mm", "0 mm", "20 mm"], "phase": "more"}
    phases = [{"name": "fall", "duration": "20 ms"}, {"name": "more", "duration": "20 ms"}]
    p = plan(parse(parts(body=[ball], phase=phases)))
    assert pictures.before(p, tmp_path / "a.png") == 41
    assert plt.imread(tmp_path / "a.png").shape[1] == 1200


def test_a_window_without_pyvista_and_an_unknown_field_are_refused(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pyvista", None)
    p = plan(parse(parts()))
    with pytest.raises(CaseError, match="there is no pyvista; pip install pyvista"):
        pictures.window(p)
    data = parts()
    data["output"]["color"] = "omega_x"
    with pytest.raises(CaseError, match=r"output.color = 'omega_x': spheres of this scene have speed, energy, id"):
        pictures.refuse_color(plan(parse(data)))


def test_translation_and_spin_are_counted_apart():
    table = pd.DataFrame({"mass": [2.0], "radius": [0.5], "vx": [3.0], "vy": [0.0], "vz": [4.0]})
    assert kinetic(table).item() == 25.0 and rotation(table).item() == 0.0
    spinning = table.assign(omega_x=0.0, omega_y=2.0, omega_z=0.0)
    assert kinetic(spinning).item() == 25.0 and rotation(spinning).item() == pytest.approx(0.4)
