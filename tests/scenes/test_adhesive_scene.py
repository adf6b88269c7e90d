# SPDX-License-Identifier: GPL-2.0-or-later
"""Beds of a law with adhesion, with few spheres: looser where they fell, a pull to open, and books that close."""

from pathlib import Path

import numpy as np
import pytest

from epdem.case import scene
from epdem.engines import scene_engine
from epdem.scenes.plan.plan import plan
from epdem.scenes.run import run_plan

pytestmark = pytest.mark.liggghts

CASE = Path(__file__).parents[2] / "cases" / "adhesive_powder.toml"
SMALL = {
    "count = 2000": "count = 90",
    '"0.5 mm", "0.5 mm", "2.2 mm"': '"0.15 mm", "0.15 mm", "1.1 mm"',
    '"8 ms"': '"5 ms"',
    '"0.8 mm"': '"0.42 mm"',
    '"0.12 mm"': '"0.06 mm"',
    "rows = 400": "rows = 100",
    "restarts = 1": "",
}


def text(changes=None):
    """The case with few spheres in a narrow box, and further changes."""
    found = CASE.read_text()
    for old, new in (SMALL | (changes or {})).items():
        assert found.count(old) >= 1, old
        found = found.replace(old, new)
    return found


def outcome(folder, changes=None):
    """(plan, tables) of a run."""
    (folder / "case.toml").write_text(text(changes))
    p = plan(scene.load(folder / "case.toml"))
    return p, run_plan(p, scene_engine("liggghts"), folder / "run")


@pytest.fixture(scope="module")
def beds(tmp_path_factory):
    """Without adhesion and with it."""
    gammas = ({"0.025 J/m^2": "0 J/m^2"}, {})
    return [outcome(tmp_path_factory.mktemp("bed"), changes) for changes in gammas]


def height(p, tables, step):
    """Height [m] below which nine tenths of the spheres lie."""
    spheres = tables["particles"]
    at = min(spheres["step"].unique(), key=lambda s: abs(s - step))
    return float(np.quantile(spheres[spheres["step"] == at]["z"], 0.9))


def test_a_bed_with_adhesion_is_looser_where_it_fell(beds):
    plain, sticky = (height(p, tables, p.phases[0].end) for p, tables in beds)
    assert sticky > 1.15 * plain


def test_a_pressed_bed_with_adhesion_holds_the_plate_and_its_contacts(beds):
    pulls, held = [], []
    for p, tables in beds:
        after = tables["rows"][tables["rows"]["step"] > p.phases[1].end]
        pulls.append(-after["stress"].min() / tables["rows"]["stress"].max())
        last = tables["contacts"][tables["contacts"]["step"] == p.steps]
        held.append(int((last["force"] < 0).sum()))
    assert pulls[0] == 0 and pulls[1] > 1e-4  # how much depends on where so few spheres came to rest
    assert held[0] == 0 and held[1] > 20


def test_contacts_across_a_gap_are_in_the_table(beds):
    _, tables = beds[1]
    contacts = tables["contacts"]
    across = contacts[(contacts["overlap"] <= 0)]
    assert len(across) and (across["force"] < 0).all()
    assert (beds[0][1]["contacts"]["overlap"] > 0).all()


def test_the_ledger_of_a_smooth_bed_closes_within_one_percent(tmp_path):
    """Kinetic, gravity, elastic and surface, plastic energy, what adhesion took, and the plate's work."""
    from epdem.scenes.judge.energy_balance import closure, energy_balance

    smooth = {
        "friction = 0.5\ntangential_restitution = 0.5": "friction = 0.0",
        "contacts = 20": "energy = true",
        "error = 1e-2": "error = 1e-3",
    }
    p, tables = outcome(tmp_path, smooth)
    table = energy_balance(p, tables)
    assert closure(table) < 0.01
    scale = table[["kinetic", "plastic", "work"]].abs().max().sum()
    assert table["adhesion"].iloc[-1] > 0.02 * scale and table["plastic"].iloc[-1] > 0.01 * scale
