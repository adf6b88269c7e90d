# SPDX-License-Identifier: GPL-2.0-or-later
"""Material properties and settings of the models: what is accepted, and the refusal of a wrong deck."""

import re

import numpy as np
import pytest
from plugin_decks import DUMP, YIELDING, Bodies, good, materials, per_pair
from test_plugin_launch import BOX, bodies, deck, refusal, started

from marks import thorough

pytestmark = pytest.mark.liggghts

RATIO = "fix q all property/global yieldPressureRatio scalar {}\n"


def without(*names):
    return "\n".join(line for line in materials("ep/any").splitlines() if not any(n in line for n in names)) + "\n"


RANGES = {
    "youngsModulus": ("m1", {"0": "0", "-5e9": "-5e+09", "1e400": "inf"}, "> 0"),
    "poissonsRatio": ("m2", {"-0.1": "-0.1", "0.6": "0.6", "1e400": "inf"}, "[0, 0.5]"),
    "yieldPressure": ("p1", {"0": "0", "-3e9": "-3e+09", "1e400": "inf"}, "> 0"),
    "hardeningExponent": ("p3", {"-0.1": "-0.1", "1": "1", "1e400": "inf"}, "[0, 1)"),
}


@pytest.mark.parametrize("name", RANGES)
def test_an_absurd_property_is_refused_with_model_property_value_and_range(tmp_path, name):
    """Must 7: unchecked, a negative yield pressure shoots a 1 m/s sphere off at 18 m/s."""
    fix, values, limits = RANGES[name]
    for value, said in values.items():
        text = re.sub(rf"(fix {fix} .* peratomtype \S+) \S+", rf"\1 {value}", materials("ep/any"))
        error = refusal(tmp_path / value, deck("ep/meyer", properties=text))
        assert "model ep/meyer" in error and f"{name} = {said}" in error and limits in error and "type 2" in error


@pytest.mark.parametrize(
    ("law", "name"), [("thornton", "yieldPressure"), ("johnson", "yieldPressure"), ("cavity", "yieldStress")]
)
def test_a_missing_property_is_named_with_the_line_to_write(tmp_path, law, name):
    error = refusal(tmp_path, deck(f"ep/{law}", properties=without(name, "yieldStress")))
    assert f"model ep/{law}" in error and f"property/global {name} peratomtype" in error


@pytest.mark.parametrize("law", ("thornton", "johnson"))
def test_a_strength_in_two_ways_or_half_given_is_refused(tmp_path, law):
    twice = refusal(tmp_path / "a", deck(f"ep/{law}", properties=materials("ep/any") + RATIO.format(2.9)))
    assert f"model ep/{law}" in twice and "both yieldPressure and yieldPressureRatio are given" in twice
    no_stress = without("yieldPressure", "yieldStress") + RATIO.format(2.9)
    assert "property/global yieldStress peratomtype" in refusal(tmp_path / "b", deck(f"ep/{law}", properties=no_stress))
    nothing = refusal(tmp_path / "c", deck(f"ep/{law}", properties=without("yieldPressure", "yieldStress")))
    assert "property/global yieldPressure peratomtype" in nothing and "yieldStress" in nothing
    assert f"is {2.8 if law == 'thornton' else 3} times, or yieldPressureRatio" in nothing


def test_an_absurd_yield_stress_or_ratio_is_refused(tmp_path):
    negative = refusal(tmp_path / "a", deck(properties=without("yieldPressure") + RATIO.format(-2)))
    assert "yieldPressureRatio = -2 of all types, must be > 0" in negative
    no_stress = re.sub(r"(fix p2 .* peratomtype \S+) \S+", r"\1 0", without("yieldPressure"))
    assert "yieldStress = 0 [Pa] of type 2, must be > 0" in refusal(tmp_path / "b", deck(properties=no_stress))
    open_question = without("yieldPressure", "yieldStress") + (
        "fix y all property/global yieldStress peratomtypepair 3" + " 1e9" * 9 + "\n"
        "fix q all property/global yieldPressureRatio peratomtype 2.8 3 2.8\n"
    )
    ambiguous = refusal(tmp_path / "c", deck(properties=open_question))
    assert "yieldPressureRatio per type and yieldStress per pair leave open which body" in ambiguous


def test_parameters_that_create_energy_are_refused(tmp_path):
    odd = materials("ep/any") + "fix q all property/global firstYieldRatio scalar 1.1\n"
    error = refusal(tmp_path, deck("ep/cavity", properties=odd))
    assert "firstYieldRatio = 1.1" in error and "do not go together" in error


def test_a_pair_value_must_be_symmetric(tmp_path):
    pairs = "\n".join(line for line in materials("ep/any").splitlines() if "yieldPressure" not in line)
    pairs += "\nfix q all property/global yieldPressure peratomtypepair 3 1e9 2e9 1e9 1e9 1e9 1e9 1e9 1e9 1e9\n"
    error = refusal(tmp_path, deck(properties=pairs))
    assert "symmetric" in error or "Symmetric" in error


def test_no_history_without_restitution_says_why_it_is_needed(tmp_path):
    error = refusal(tmp_path, deck(tangential="no_history"))
    assert "no_history needs coefficientRestitution" in error


def test_moduli_keep_the_limits_that_hold_for_all_models(tmp_path):
    soft_only = deck(edit=lambda t: t.replace("hard_particles yes\n", ""))
    assert "hard_particles" in refusal(tmp_path, soft_only)


@pytest.mark.parametrize(
    "setting",
    [
        "tangential_damping off",
        "limitForce on",
        "heating_tracking on",
        "heating_normal_hertz off",
        "computeElasticPotential off",
    ],
)
@pytest.mark.parametrize("law", ("hertz", "cavity"))
def test_settings_of_hertz_in_an_existing_deck_are_accepted(tmp_path, law, setting):
    started(tmp_path, deck(f"ep/{law}", settings=setting))


@pytest.mark.parametrize(
    "setting", ["heating_normal_hertz", "computeElasticPotential", "computeDissipatedEnergy", "disableNormalWhenBonded"]
)
def test_other_settings_of_hertz_are_refused_by_name(tmp_path, setting):
    error = refusal(tmp_path, deck(settings=f"{setting} on"))
    assert setting in error and "not available" in error


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


@pytest.mark.parametrize(("units", "said"), [("si", "[Pa]"), ("cgs", "[units cgs]")])
def test_a_message_names_the_unit_of_the_deck(units, said, tmp_path):
    text = re.sub(r"(fix p1 .* peratomtype \S+) \S+", r"\1 0", materials("ep/any"))
    assert f"yieldPressure = 0 {said} of type 2" in refusal(
        tmp_path, deck(properties=text).replace("units si", f"units {units}")
    )
