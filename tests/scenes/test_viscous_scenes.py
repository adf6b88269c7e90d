# SPDX-License-Identifier: GPL-2.0-or-later
"""The dashpot of slow impacts in bulk scenes: in the deck only if asked for, and what LIGGGHTS makes of it."""

from pathlib import Path

import numpy as np
import pytest
from scene_runs import run

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.engines.liggghts.deck import files
from epdem.scenes.plan.plan import plan
from epdem.scenes.plan.timestep import time_step
from stored_decks import reasons

CASES = Path(__file__).parents[2] / "cases"


def beads(restitution=None, **contact) -> dict:
    """The settling beads, with a dashpot of `restitution`."""
    data = read_toml(CASES / "settle_glass.toml") | {"contact": contact}
    return data if restitution is None else data | {"viscous": {"restitution": restitution}}


def setup_of(data: dict) -> str:
    return files(plan(parse(data, "case.toml")))["setup.in"]


def test_a_scene_has_the_dashpot_in_pair_and_walls_only_if_it_asks():
    models = sum(word in line for line in setup_of(beads()).splitlines() for word in ("pair_style", "wall/gran"))
    for data, expected in ((beads(), 0), (beads(0.7), models)):
        text = setup_of(data)
        assert text.count("viscous on") == expected
        assert ("coefficientRestitution peratomtypepair 1 0.7 " in text) is (expected > 0)
        assert "tangential_damping" not in text, "there is no friction, so nothing to switch off"
        lines = reasons(plan(parse(data, "case.toml")))
        assert [line for _, line, why in lines if not why] == []


def test_a_dashpot_along_the_normal_does_not_bring_one_along_the_tangent():
    assert "tangential_damping off" in setup_of(beads(0.7, friction=0.3))
    assert "tangential_damping" not in setup_of(beads(0.7, friction=0.3, tangential_restitution=0.7))


def test_a_strong_dashpot_makes_the_step_smaller():
    """The engine knows the speed half a step late: an error of first order that grows with the dashpot."""
    steps = [time_step(parse(beads(e) | {"numerics": {"error": 0.01}}), 0.0) for e in (None, 0.9, 0.3)]
    assert steps[0] > steps[1] > 2 * steps[2]


@pytest.mark.liggghts
@pytest.mark.parametrize("restitution", [0.9, 0.4])
def test_elastic_shot_with_a_dashpot_leaves_the_plate_with_its_restitution(restitution, tmp_path):
    """Hertz never yields, so the restitution of the dashpot is that of every impact, by definition."""
    text = (CASES / "peening_steel.toml").read_text().replace('"johnson"', '"hertz"')
    text = text.replace("count = 200", "count = 60").replace('"2.4 ms"', '"1.2 ms"').replace("energy = true", "")
    (tmp_path / "case.toml").write_text(f"{text}\n[viscous]\nrestitution = {restitution}\n")
    table = run(tmp_path / "case.toml", out=tmp_path / "out").results.particles
    alone = table[(table["vz"] > 0) & (np.hypot(table["vx"], table["vy"]) < 1e-9)]
    ratio = alone.groupby("id")["vz"].max() / 30.0
    assert len(ratio) > 10
    # the case's own target error of e_n is 1e-3
    assert np.abs(ratio / restitution - 1).max() < 1e-3


@pytest.mark.liggghts
def test_elastic_beads_come_to_rest_by_a_dashpot_alone_and_the_ledger_names_the_loss(tmp_path):
    text = (CASES / "settle_glass.toml").read_text().replace('"thornton"', '"hertz"').split("[contact]")[0]
    for old, new in (
        ('["30 mm", "30 mm", "80 mm"]', '["12 mm", "12 mm", "30 mm"]'),
        ("count = 1000", "count = 70"),
        ('"0.5 s"', '"0.3 s"'),
    ):
        text = text.replace(old, new)
    text += "[viscous]\nrestitution = 0.3\n[output]\nparticles = 20\nenergy = true\n[numerics]\nerror = 0.1\n"
    (tmp_path / "case.toml").write_text(text)
    found = run(tmp_path / "case.toml", out=tmp_path / "out").results
    table = found.energy_balance
    given = table.loc[0, ["kinetic", "elastic", "gravity"]].sum() - table["gravity"].iloc[-1]
    assert table["kinetic"].iloc[-1] < 1e-4 * given
    # nothing else takes energy here: what fell and is neither moving nor elastic (below 1 % in a bed at rest) is lost
    assert table["friction"].iloc[-1] == pytest.approx(given, rel=0.01)
    assert np.diff(table["friction"]).min() > -1e-3 * given
    assert "energy_residual" not in set(found.checks["key"])
