# SPDX-License-Identifier: GPL-2.0-or-later
"""Decks of motions, variants of a set-up and LAMMPS's mdr are as stored."""

from dataclasses import replace
from pathlib import Path

import pytest

from epdem.engines.liggghts.engine import Liggghts
from epdem.engines.yade.engine import Yade
from epdem.verification import variants
from epdem.verification.models.hosts import LammpsMdr
from epdem.verification.motion.compare import touch_of
from epdem.verification.motion.hosts import LiggghtsMotions, YadeMotions
from epdem.verification.motion.paths import shear_elastic
from stored_decks import CASES, SPHERE, compare, planned

HERE = Path(__file__).parent


@pytest.fixture
def module(monkeypatch):
    """YADE has its module as far as decks are concerned."""
    monkeypatch.setattr("epdem.engines.yade.launcher.module", lambda: HERE)


def test_the_deck_of_mdr_is_as_stored(tmp_path):
    LammpsMdr().write(planned({}), tmp_path)
    compare(HERE, "lammps-mdr_wall", (tmp_path / "in.impact").read_text())


def test_the_header_of_the_deck_of_mdr_is_comments(tmp_path):
    p = planned({})
    LammpsMdr().write(
        replace(p, experiment=replace(p.experiment, title="two\nshell touch pwned", source="joined &")), tmp_path
    )
    assert (tmp_path / "in.impact").read_text().splitlines()[:2] == ["# two shell touch pwned", "# joined"]


@pytest.mark.parametrize(("engine", "script"), [(LiggghtsMotions, "in.motion"), (YadeMotions, "motion.py")])
def test_the_deck_of_a_motion_is_as_stored(engine, script, module):
    """The materials are of one name each: the second sphere is of the wall's."""
    touch = touch_of(CASES / "oblique_steel.toml")
    compare(HERE, f"motion_{script[-2:]}", engine().files(touch, shear_elastic(touch))[script])


@pytest.mark.parametrize("variant", ["swap", "sort", "migration", "restart"])
def test_the_decks_of_a_variant_are_as_stored(variant, module):
    found = variants.pairs(planned(SPHERE), 1e-5)
    tools = {"": Liggghts()} | ({"yade_": Yade()} if variant in variants.OF_YADE else {})
    for head, tool in tools.items():
        text = "".join(variants.scripts(tool, tool.deck(found.plan), found, variant))
        compare(HERE, f"{head}pairs_{variant}", text)
