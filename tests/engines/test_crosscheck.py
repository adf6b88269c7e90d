# SPDX-License-Identifier: GPL-2.0-or-later
"""The cross-code table: our model does not care how an impact is told, LIGGGHTS's thornton_ning does."""

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

from epdem.case import load
from epdem.engines import engine
from epdem.experiment import experiment
from epdem.invariance import WAYS, examine

STEEL = Path(__file__).parents[2] / "cases" / "steel_wall.toml"
pytestmark = pytest.mark.liggghts


@pytest.mark.parametrize("law", ["hertz", "thornton", "johnson", "cavity"])
def test_restitution_and_momentum_do_not_depend_on_how_the_impact_is_told(law, tmp_path):
    """Swap, sort, migration and restart repeat every bit of e_n; momentum is kept to round-off of drifting bodies."""
    found = examine(engine("liggghts"), experiment(load(STEEL), law), tmp_path)
    for way in WAYS:
        assert found.e_n[way] == 0, way
        assert found.momentum[way] < 1e-11, way
    assert found.unequal_error < 5e-5  # 400 steps in contact


def test_thornton_ning_depends_on_order_and_owners(tmp_path):
    """The comparison would be worth nothing if the scene could not tell."""
    found = examine(engine("liggghts-thornton_ning"), experiment(load(STEEL)), tmp_path)
    assert found.e_n["swap"] > 0.01 and found.e_n["sort"] > 0.01
    assert found.momentum["migration"] > 0.01
    assert found.unequal_error > 0.01


def test_crosscheck_tells_our_second_order_from_a_wrong_limit(tmp_path):
    done = subprocess.run([sys.executable, "-m", "epdem.cli", "crosscheck", str(STEEL), "--json"], cwd=tmp_path,
                          capture_output=True, text=True)  # fmt: skip
    assert done.returncode == 0, done.stderr
    rows = {row["model"]: row for row in json.loads(done.stdout)["rows"]}
    assert rows["theory"]["e_n"] == pytest.approx(rows["liggghts"]["e_n"], rel=1e-4)
    assert rows["embedded"]["order"] == pytest.approx(2, abs=0.3) == rows["liggghts"]["order"]
    assert abs(rows["liggghts-thornton_ning"]["order"]) < 0.1
    assert math.isclose(rows["liggghts-thornton_ning"]["e_n_error"], 0.081, rel_tol=0.05)
    assert (tmp_path / "runs/crosscheck/steel_wall/e_n.png").exists()
