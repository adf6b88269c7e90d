# SPDX-License-Identifier: GPL-2.0-or-later
"""Error against run time: what is measured, how it is summed up, and what it must see. Nothing here is timed."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from epdem import cost, cost_report
from epdem.stress import bulk_checks

STEEL = Path(__file__).parents[2] / "cases/steel_wall.toml"


@pytest.fixture(scope="module")
def embedded():
    return cost.run(STEEL, engines=["embedded"], laws=["thornton", "cavity"], steps=(30, 100, 300, 1000), repetitions=2)


def test_restitution_converges_with_second_order_and_the_rms_stays_below_the_maximum(embedded):
    """Velocity Verlet: order 2; phases and speeds blur the slope over a factor of 33 in dt by less than 0.4."""
    assert np.all(np.abs(embedded.contenders["order"] - 2) < 0.4)
    for quantity in cost.QUANTITIES:
        assert np.all(embedded.rows[f"{quantity}_rms"] <= embedded.rows[f"{quantity}_error"])
        worst = embedded.rows.groupby("contender")[f"{quantity}_error"]
        assert np.all(worst.last() < 1e-4 * 10) and np.all(worst.last() < worst.first() / 100)


def test_the_cheapest_setting_is_the_coarsest_from_which_all_finer_ones_are_good():
    rows = pd.DataFrame({"steps": [10, 30, 100, 300], "e_n_error": [5e-4, 5e-3, 8e-4, 1e-5]})
    assert cost.cheapest(rows, 1e-3)["steps"] == 100  # that of 10 is luck
    assert cost.cheapest(rows, 1e-2)["steps"] == 10
    assert cost.cheapest(rows, 1e-6) is None


def test_order_is_that_of_a_known_power_and_none_where_nothing_converges():
    steps = np.array([10.0, 30, 100, 300, 1000])
    assert cost.order(steps, 3 * steps**-2.0) == pytest.approx(2)
    assert cost.order(steps, 3 * steps**-1.0) == pytest.approx(1)
    assert np.isnan(cost.order(steps, 0.08 + 1e-4 / steps))


def test_table_figure_and_data_are_written_and_the_page_names_its_command(embedded, tmp_path):
    data, figure = cost_report.write(embedded, tmp_path)
    assert len(pd.read_csv(data)) == len(embedded.rows) == 8 and figure.stat().st_size > 10_000
    bulk = pd.DataFrame({"spheres": [512], "share of the limit": [0.1], "seconds": [0.01], "error": [1e-4]})
    assert "512 steel spheres" in cost_report.document(embedded, bulk, "epdem cost CASE")
    text = cost_report.document(embedded, None, "epdem cost CASE")
    assert "\n    epdem cost CASE\n" in text and "embedded, cavity" in text
    assert json.dumps(embedded.contenders.to_dict("list"))


@pytest.mark.liggghts
def test_our_plugin_converges_where_the_built_in_thornton_ning_does_not():
    """thornton_ning integrates its force step by step: 5 to 8 % off eq. 8.83 at any step; hertz is the yardstick."""
    outcome = cost.run(STEEL, engines=["liggghts"], laws=[], steps=(30, 100, 300), repetitions=1)
    found = outcome.contenders.set_index("contender")
    assert found.loc["liggghts, thornton", "best_error"] < 1e-4
    assert found.loc["liggghts-hertz", "best_error"] < 1e-5
    assert 0.02 < found.loc["liggghts-thornton_ning", "best_error"] < 0.2
    assert np.isnan(found.loc["liggghts-thornton_ning", "steps_for_0.01"])
    assert found.loc["liggghts-hertz", "ratio_to_hertz"] == 1
    parts = outcome.rows[["startup", "setup", "stepping"]]
    assert np.all(np.isfinite(parts)) and np.all(parts >= 0) and np.all(outcome.rows["stepping"] > 0)


@pytest.mark.liggghts
def test_the_bulk_error_of_dissipated_energy_falls_with_the_step():
    """Order 2 within the scatter of few collisions: a factor 16 in dt gains at least 50 where 256 is ideal."""
    table = bulk_checks.dissipation_cost(repetitions=1)
    assert table["error"].iloc[0] / table["error"].iloc[-1] > 50
    assert table["error"].iloc[-1] < 1e-4
