# SPDX-License-Identifier: GPL-2.0-or-later
"""Material properties and settings of the models: what is accepted, and which impacts a change counts for."""

import re

import numpy as np
import pytest
from plugin_decks import DUMP, YIELDING, Bodies, good, materials, per_pair
from test_plugin_launch import BOX, bodies, deck, started

from marks import thorough

pytestmark = pytest.mark.liggghts


@pytest.mark.parametrize("law", ("hertz", "cavity"))
def test_settings_of_hertz_in_an_existing_deck_are_accepted(tmp_path, law):
    names = (
        "tangential_damping off limitForce on heating_tracking on heating_normal_hertz off computeElasticPotential off"
    )
    started(tmp_path, deck(f"ep/{law}", settings=names))


def test_an_unused_type_costs_nothing(tmp_path):
    """Must 4: properties are sized by the types in use; a box with a fourth, unused type must run."""
    four = re.sub(r"(peratomtype .*)", r"\1 1e9", materials("ep/any")).replace("0.4 1e9", "0.4 0.3")
    four = re.sub(r"peratomtypepair 3 .*", "peratomtypepair 4" + " 0.3" * 16, four)
    good(tmp_path, deck(properties=four), files={"box.data": bodies().data(BOX, types=4)})


CHANGES = {
    "youngsModulus": "peratomtype 50e9 150e9 3e9",
    "poissonsRatio": "peratomtype 0.2 0.25 0.3",
    "strength": "peratomtype 1e8 4e8 3e7",
    "coefficientFriction": "peratomtypepair 3" + " 0.1" * 9,
    "coefficientRestitution": "peratomtypepair 3" + " 0.5" * 9,
}


@pytest.mark.parametrize("name", CHANGES)
@pytest.mark.parametrize("law", [thorough(law, unless=law == "thornton") for law in YIELDING])
def test_a_property_that_changes_between_runs_counts_from_there_on_and_only_it(tmp_path, law, name):
    """Must 5: nothing computed from properties survives an init. Bitwise: an impact after the change is that of a deck
    which says so from the start, for pairs and wall; the first run, before any contact, connects the old value."""
    first = materials("ep/any") + per_pair("coefficientRestitution", 0.9)
    property_of = {"strength": "yieldStress" if law == "cavity" else "yieldPressure"}.get(name, name)
    (fix,) = re.findall(rf"^fix (\S+) all property/global {property_of} ", first, re.M)
    change = f"fix {fix} all property/global {property_of} {CHANGES[name]}\n"
    x = np.array(
        [[0, 0, 5.001e-3], [0.02, 0, 5.001e-3], [0.04, 0, 5.001e-3], [0, 0.02, 0.02], [0.010002, 0.02, 0.0201]]
    )
    v = np.array([[1, 0, -3.0], [1, 0, -3.0], [1, 0, -3.0], [0, 0, 0], [-5, 1, 0]])
    scene = Bodies(np.array([1, 2, 3, 1, 2]), np.full(5, 5e-3), x, v)

    def outcome(folder, before, between):
        text = deck(f"ep/{law}", properties=before, steps=1) + between
        text += "run 1200\n" + DUMP.format(every=1) + "run 0\n"
        return good(tmp_path / folder, text, files={"box.data": scene.data(BOX)}).last

    old, changed, always = (
        outcome("old", first, ""),
        outcome("changed", first, change),
        outcome("always", first + change, ""),
    )
    assert (changed == always).all()
    assert (changed[:, 4:] != old[:, 4:]).any(axis=1).all()
