# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of scenes: the key figure of each kind holds the numbers of the run, pictures show what is in front."""

import numpy as np
import pandas as pd
import pytest
from stored_runs import STORED, planned

from epdem.engines import scene_engine
from epdem.scenes import checks, report
from epdem.scenes.checks import kinetic, rotation

pytestmark = pytest.mark.figures


def drawn(name: str):
    """(plan, tables, panels of the key figure) of a stored run."""
    p = planned(name)
    tables = scene_engine("liggghts").read(p, STORED / name)
    (chart,) = report.key(p, tables)
    return p, tables, chart.panels


def test_a_compaction_shows_force_over_the_displacement_of_its_plate():
    p, tables, (panel,) = drawn("compaction")
    s, (load, unload) = p.case.scene, panel.series
    assert [*load.y, *unload.y] == tables["rows"]["plate_force"].to_list()
    middle = tables["rows"]["time"][1:] - 0.5 * p.every * p.time_step  # of the interval of a mean
    assert load.x[1:] == pytest.approx(s.speed * middle[: len(load.x) - 1].to_numpy(), rel=1e-6)
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
    assert height.series[0].y.tolist() == tables["particles"].groupby("step")["z"].quantile(0.95).to_list()
    assert energy.series[0].y[-1] == tables["rows"]["kinetic_energy"].iloc[-1]


def test_translation_and_spin_are_counted_apart():
    table = pd.DataFrame({"mass": [2.0], "radius": [0.5], "vx": [3.0], "vy": [0.0], "vz": [4.0]})
    assert kinetic(table).item() == 25.0 and rotation(table).item() == 0.0
    spinning = table.assign(omega_x=0.0, omega_y=2.0, omega_z=0.0)
    assert kinetic(spinning).item() == 25.0 and rotation(spinning).item() == pytest.approx(0.4)
