# SPDX-License-Identifier: GPL-2.0-or-later
"""`epdem deck --convert`: only the words of the contact model change, and one property is added."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from epdem.engines.liggghts.own_decks import convert
from epdem.errors import CaseError

DECK = """# model hertz in a comment, don't touch
units si
fix  m1 all property/global youngsModulus peratomtype 23.3e3 ${E}   # two types
#fix m2 all property/global youngsModulus peratomtype 5e6
fix  m3 all property/global coefficientRestitution peratomtypepair 2 0.9 0.9 0.9 0.9
pair_style gran model hertz &
    tangential history computeDissipatedEnergy on  # with & in the comment
pair_coeff * *
fix w all wall/gran model &\t
  hooke viscous on tangential history &
  mesh n_meshes 1 meshes cad
variable model string "model hertz"
fix ins all insert/stream seed 1 vel constant 0. 0. -1.0&
  region bc
include more.in
"""


def converted(text, law="thornton", **values):
    return convert(text, law, values or {"yieldPressure": "1e8"}, "my.in")


def test_a_deck_changes_in_the_words_of_its_models_only():
    done = converted(DECK)
    expected = (
        DECK.replace("${E}   # two types\n", "${E}   # two types\nPROPERTY\n")
        .replace("gran model hertz &", "gran model ep/thornton &")
        .replace("computeDissipatedEnergy on", "")
        .replace("hooke viscous on ", "ep/thornton ")
        .replace("PROPERTY", "fix epdem_yieldPressure all property/global yieldPressure peratomtype 1e8 1e8")
    )
    assert [line.split() for line in done.text.splitlines()] == [line.split() for line in expected.splitlines()]
    said = "\n".join(done.notes)
    for part in (
        "my.in, line 6: setting 'computeDissipatedEnergy on' of model hertz is dropped",
        "my.in, line 9: setting 'viscous on' of model hooke is dropped",
        "my.in, line 12: the contact model inside quotes is left as it is",
        "my.in, line 15: the file more.in is left as it is",
        "coefficientRestitution acts on the tangential dashpot only",
        "2 contact models are ep/thornton now",
    ):
        assert part in said
    assert len(done.notes) == 7


def test_a_work_of_adhesion_is_a_property_of_pairs():
    done = converted(DECK, "thornton_ning", workOfAdhesion="0.1", yieldPressure="1e8")
    assert (
        "workOfAdhesion peratomtypepair 2 0.1 0.1 0.1 0.1\n" in done.text and done.text.count("ep/thornton_ning") == 2
    )


WORDS = st.lists(
    st.sampled_from([" ", "\t", "&\n", " & \n", "${x}", "'a b'", "word", "5.e6", "on", "#", "'", '"', "&", "\n"]),
    max_size=12,
).map("".join)


@given(WORDS, WORDS, WORDS)
def test_all_other_lines_of_any_deck_stay_bit_by_bit(first, second, third):
    """The changed deck without the changes is the deck, whatever stands around its three lines."""
    lines = (
        "fix m all property/global youngsModulus peratomtype 1e7",
        "pair_style gran model hertz tangential history",
        "fix w all wall/gran model hertz tangential history primitive type 1 zplane 0.0",
    )
    text = "".join(f"{between}\n\n{line}\n" for between, line in zip((first, second, third), lines, strict=True))
    if re.search(r"&[ \t]*\n\n?$", first + "\n\n") or any(re.search(r"&[ \t]*$", x) for x in (first, second, third)):
        text = text.replace("\n\n", "\n \n \n")
    done = converted(text)
    assert done.text.count("ep/thornton") == 2
    added = "fix epdem_yieldPressure all property/global yieldPressure peratomtype 1e8\n"
    assert done.text.replace(added, "").replace("ep/thornton", "hertz") == text


@pytest.mark.parametrize(
    ("change", "law", "values", "words"),
    [
        (("model hertz &", "model hooke/stiffness &"), "thornton", {"yieldPressure": "1e8"}, "line 6: model hooke"),
        (("fix  m1", "#fix  m1"), "thornton", {"yieldPressure": "1e8"}, "youngsModulus peratomtype"),
        (("", ""), "thornton", {}, "add --set yieldPressure=VALUE"),
        (("", ""), "thornton", {"yieldPressure": "-1"}, "must lie in (0, inf)"),
        (("", ""), "thornton", {"yieldStress": "1e8"}, "ep/thornton has no such property; it has yieldPressure"),
        (("", ""), "hertz", {"yieldPressure": "1e8"}, "it has none"),
        (("", ""), "nonsense", {}, "there are hertz"),
        (("m3 all property/global coefficientRestitution", "y all property/global yieldPressure"), "thornton",
         {"yieldPressure": "1e8"}, "gives this property"),
    ],
)  # fmt: skip
def test_what_cannot_be_converted_is_one_sentence(change, law, values, words):
    with pytest.raises(CaseError) as error:
        convert(DECK.replace(*change) if change[0] else DECK, law, values, "my.in")
    assert words in str(error.value) and "\n" not in str(error.value)


def test_a_deck_without_a_contact_model_says_so():
    with pytest.raises(CaseError, match="pair_style gran model hertz"):
        converted("units si\n")
