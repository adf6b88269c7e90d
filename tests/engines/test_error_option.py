# SPDX-License-Identifier: GPL-2.0-or-later
"""`--error`: the measured error of e_n is the requested one, for every law in every host; the cost beside hertz."""

import json

import numpy as np
import pytest
from hosts import ADHESIVE, CASES, CLASSES, EMBEDDED, LAMMPS, LAWS, LIGGGHTS, on
from typer.testing import CliRunner

from epdem.cli.main import app
from epdem.engines import engine
from epdem.impacts import prediction_report as report
from epdem.impacts.run import run
from marks import thorough

STEEL, STICKY, VISCOUS = (CASES / f"{name}.toml" for name in ("steel_wall", "adhesion_thornton_1998", "viscous_steel"))


def measured(path, name, law, error, folder):
    """Largest error of e_n over all speeds and 8 phases against the table of theory, over the requested one."""
    outcome = run(path, engines=[engine(name)], laws=[law], error=error, out=folder)
    e_n = outcome.results.impacts[f"{law}/{name}"]["e_n"].to_numpy()
    theory = outcome.results.predictions[law]["e_n"].to_numpy()
    assert outcome.passed and outcome.plans[law].phases >= 8
    scale = np.where(theory > 0, theory, 1.0)[:, None]  # 0: the bodies stick
    return (np.abs(e_n.reshape(theory.size, -1) - theory[:, None]) / scale).max() / error


@pytest.mark.parametrize(("name", "law"), on([EMBEDDED, LIGGGHTS, LAMMPS, CLASSES], [*LAWS, *ADHESIVE]))
def test_the_measured_error_is_between_half_and_one_and_a_half_of_the_requested_one(name, law, tmp_path):
    path = STICKY if law in ADHESIVE else STEEL
    assert 0.5 <= measured(path, name, law, 1e-3, tmp_path / "out") <= 1.5


@pytest.mark.parametrize(
    ("law", "error"),
    [
        thorough(law, error, unless=law != "cavity_adhesive" or error > 1e-4)  # its steps are the slowest
        for law in (*LAWS, *ADHESIVE)
        for error in (1e-2, 1e-4, 1e-5)
    ],
)
def test_other_errors_are_met_too(law, error, tmp_path):
    assert 0.5 <= measured(STICKY if law in ADHESIVE else STEEL, "embedded", law, error, tmp_path) <= 1.5


@pytest.mark.parametrize("error", [1e-2, 1e-3])
def test_an_error_is_met_with_a_dashpot(error, tmp_path):
    assert 0.5 <= measured(VISCOUS, "embedded", "thornton", error, tmp_path) <= 1.5


def test_the_command_prints_steps_and_cost_and_judges_by_the_requested_error(tmp_path, monkeypatch):
    """Cost: steps for the same time over those of hertz, times the ratio per step of the table."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(report, "step_times", lambda: {("embedded", "thornton"): 0.2, ("yade", "thornton"): 9.0})

    def printed(command, *words):
        done = CliRunner().invoke(app, [command, str(STEEL), "--error", "1e-3", *words])
        assert done.exit_code == 0
        return done.stdout

    found = printed("run", "-e", "embedded")
    line = next(line for line in found.splitlines() if "steps in the shortest contact" in line)
    thornton, hertz = (json.loads(printed("predict", "-l", law, "--json")) for law in ("thornton", "hertz"))
    ratio = hertz["time_step"] / thornton["time_step"]
    assert ratio > 1.5 and line.endswith(f"with the same error: embedded {0.2 * ratio:.2g}")
    assert f"thornton: {thornton['steps_in_contact']:.0f} steps" in line
    assert thornton["cost"] == pytest.approx({"embedded": 0.2 * ratio, "yade": 9.0 * ratio})


def test_the_table_of_step_times_has_every_law_in_every_host():
    found = report.step_times()
    assert set(found) == {(host, law) for host in ("embedded", "liggghts", "lammps", "yade") for law in LAWS + ADHESIVE}
    assert all(0.01 < ratio < 100 for ratio in found.values())
