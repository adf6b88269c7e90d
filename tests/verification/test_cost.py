# SPDX-License-Identifier: GPL-2.0-or-later
"""Error against run time: what is measured, how it is summed up, and what it must see. Nothing here is timed."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from epdem.engines import scene_engine
from epdem.theory.backbones import ADHESIVE, LAWS
from epdem.verification import cost
from epdem.verification.stability.bulk import convergence
from scripts import script

page = script("cost")


@pytest.fixture(scope="module")
def steel(tmp_path_factory):
    """The case with 8 of its 32 speeds."""
    path = tmp_path_factory.mktemp("cost") / "steel.toml"
    path.write_text(
        (Path(__file__).parents[2] / "cases/steel_wall.toml").read_text().replace("count = 32", "count = 8")
    )
    return path


@pytest.fixture(scope="module")
def embedded(steel):
    return cost.run(steel, engines=["embedded"], laws=["thornton", "cavity"], steps=(30, 100, 300, 1000), repetitions=2)


def test_restitution_converges_with_second_order_and_the_rms_stays_below_the_maximum(embedded):
    """Velocity Verlet: order 2; phases and speeds blur the slope over a factor of 33 in dt by less than 0.4."""
    assert np.all(np.abs(embedded.models["order"] - 2) < 0.4)
    for quantity in cost.QUANTITIES:
        assert np.all(embedded.rows[f"{quantity}_rms"] <= embedded.rows[f"{quantity}_error"])
        worst = embedded.rows.groupby("model")[f"{quantity}_error"]
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


@pytest.mark.figures
def test_table_figure_and_data_are_written_and_the_page_names_its_command(embedded, tmp_path):
    data, figure = cost.write(embedded, tmp_path)
    assert len(pd.read_csv(data)) == len(embedded.rows) == 8 and figure.stat().st_size > 10_000
    numbers = {"spheres": 512, "error": 1e-4, "order": 2.0}
    steps = [{"share": 0.1, "rms": 4e-4}, {"share": 0.05, "rms": 1e-4}]
    bulk = pd.DataFrame([{"model": "liggghts, cavity"} | numbers | step for step in steps])
    changes = {"density": [1e-3, 2e-3], "force": [0.05, 0.02], "plastic_work": [1e-2, 3e-3]}
    bed = pd.DataFrame({"law": ["cavity", "johnson"], "spheres": 432, "share": 0.1} | changes)
    text = page.document(*cost.tables(embedded).values(), bulk, bed)
    assert "512 steel spheres" in text
    assert "| model | 0.1 | 0.05 | order |\n|---|---|---|---|\n| liggghts, cavity | 0.0004 | 0.0001 | 2 |" in text
    assert "`.venv/bin/python docs/cost.py`" in text and "| cavity |" in text
    assert "| 0.1 | 0.002 | 0.05 | 0.01 |" in text  # largest of the laws
    assert json.dumps(embedded.models.to_dict("list"))


def test_the_page_is_that_of_its_tables_and_each_law_has_a_line_of_its_own():
    errors = page.load("cost")
    assert (page.DOCS / "cost.md").read_text() == page.document(*map(page.load, page.NAMES))
    lines = [s for s in cost.chart(errors, "").panels[1].series if s.name in {*LAWS, *ADHESIVE}]
    assert len({(s.colour, s.dash) for s in lines}) == len(lines) == len([*LAWS, *ADHESIVE])


@pytest.mark.liggghts
def test_our_plugin_converges_where_the_built_in_thornton_ning_does_not(steel):
    """thornton_ning integrates its force step by step: 5 to 8 % off eq. 8.83 at any step; hertz is the reference."""
    outcome = cost.run(steel, engines=["liggghts"], laws=[], steps=(30, 100, 300), repetitions=1)
    found = outcome.models.set_index("model")
    assert found.loc["liggghts, thornton", "best_error"] < 1e-4
    assert found.loc["liggghts-hertz", "best_error"] < 1e-5
    assert 0.02 < found.loc["liggghts-thornton_ning", "best_error"] < 0.2
    assert np.isnan(found.loc["liggghts-thornton_ning", "steps_for_0.01"])
    assert found.loc["liggghts-hertz", "ratio_to_hertz"] == 1
    parts = outcome.rows[["startup", "setup", "ns_per_step"]]
    assert np.all(np.isfinite(parts)) and np.all(parts >= 0) and np.all(outcome.rows["ns_per_step"] > 0)


@pytest.mark.parametrize(
    "host", [pytest.param("lammps", marks=pytest.mark.lammps), pytest.param("yade", marks=pytest.mark.yade("module"))]
)
def test_hertz_of_lammps_and_yade_have_the_modulus_of_the_case(host, steel):
    """Peak force of theory goes as E*^(2/5): a wrong modulus shows in it, not in e_n."""
    outcome = cost.run(steel, engines=[host], laws=["hertz"], steps=(300,), repetitions=1)
    own = outcome.rows.set_index("model").loc[{"lammps": "lammps-hertz", "yade": "yade-mindlin"}[host]]
    assert own["e_n_error"] < 1e-5 and own["force_max_error"] < 1e-4 and own["contact_time_error"] < 1e-4
    assert own["ns_per_step"] > 0


def test_the_ratio_is_to_the_reference_of_the_same_repetition_and_step():
    rows = [("a", 0, 10, 6.0), (cost.REFERENCE, 0, 10, 3.0), ("a", 1, 10, 8.0), (cost.REFERENCE, 1, 10, 2.0)]
    times = pd.DataFrame(rows, columns=["model", "repetition", "steps", "time"])
    assert cost.over_reference(times, "time", ["repetition", "steps"]).tolist() == [2, 1, 4, 1]
    alone = times[times["model"] == "a"]
    assert cost.over_reference(alone, "time", ["repetition", "steps"]).isna().all()


@pytest.mark.liggghts
def test_dissipated_energy_of_a_bulk_converges_with_second_order_for_every_law_that_yields():
    """Velocity Verlet: order 2 of the spheres' rms at fine steps; few collisions blur it by less than 0.5."""
    laws = ["thornton", "johnson", "cavity"]
    table = convergence(laws, scene_engine("liggghts"), shares=(0.1, 0.025))
    for _, part in table.groupby("model"):
        assert abs(part["order"].iloc[-1] - 2) < 0.5
        assert np.all(part["error"] <= part["rms"]) and part["rms"].iloc[-1] < 1e-3
