# SPDX-License-Identifier: GPL-2.0-or-later
"""`epdem deck --convert`: only the words of the contact model change, and one property is added."""

import json
import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from epdem.cli.main import app
from epdem.engines.liggghts import launcher
from epdem.errors import CaseError
from epdem.tools.convert import convert
from epdem.tools.deck_checks import check

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
    assert "workOfAdhesion peratomtypepair 2 0.1 0.1 0.1 0.1\n" in done.text
    assert done.text.count("ep/thornton_ning") == 2


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
        ((DECK, "units si\n"), "thornton", {"yieldPressure": "1e8"}, "pair_style gran model hertz"),
        (("m3 all property/global coefficientRestitution", "y all property/global yieldPressure"), "thornton",
         {"yieldPressure": "1e8"}, "gives this property"),
    ],
)  # fmt: skip
def test_what_cannot_be_converted_is_one_sentence(change, law, values, words):
    with pytest.raises(CaseError) as error:
        convert(DECK.replace(*change) if change[0] else DECK, law, values, "my.in")
    assert words in str(error.value) and "\n" not in str(error.value)


HYSTERESIS = """units si
fix m1 all property/global youngsModulus peratomtype 1.4e8 0.135e7  # softened
fix m2 all property/global poissonsRatio peratomtype 0.25 0.30
fix m3 all property/global coefficientRestitution peratomtypepair 2 0.3 0.3 &
  0.3 0.3
fix m6 all property/global coefficientMaxElasticStiffness peratomtypepair 2 1.5 3 3 5
fix m7 all property/global coefficientAdhesionStiffness peratomtypepair 2 1e5 2e5 2e5 1e6
fix m8 all property/global coefficientPlasticityDepth peratomtypepair 2 .05 .01 .01 .005
fix m9 all property/global characteristicVelocity scalar 2.0
pair_style gran model hooke/hysteresis tangential history cohesion sjkr
timestep 1.0e-6
variable r equal 5e-4
fix pts all particletemplate/sphere 1 atom_type 2 density constant 2000 radius constant ${r}
"""


def test_a_deck_with_hysteresis_gets_its_real_modulus_a_strength_and_shorter_steps():
    done = converted(HYSTERESIS, youngsModulus="140e9,24e9", yieldPressure="1.9e9")
    lines = done.text.splitlines()
    assert lines[1] == "hard_particles yes"
    assert lines[2] == "fix m1 all property/global youngsModulus peratomtype 140e9 24e9  # softened"
    assert lines[3] == "fix epdem_yieldPressure all property/global yieldPressure peratomtype 1.9e9 1.9e9"
    assert "pair_style gran model ep/thornton tangential history cohesion sjkr" in lines
    assert "timestep 7.5e-09" in lines  # sqrt(1.35e6/24e9) of 1e-6: type 2 stiffens most
    assert [line.split()[1] for line in lines if line.startswith("#")] == ["m6", "m7", "m8", "m9"]
    said = "\n".join(done.notes)
    assert all(f"my.in, line {n}: " in said for n in (6, 7, 8, 9)) and "epdem soften" in said
    with pytest.raises(CaseError, match=r"model hooke/hysteresis has no yield.*add --set youngsModulus=VALUE"):
        converted(HYSTERESIS, yieldPressure="1.9e9")
    with pytest.raises(CaseError, match="line 10: law thornton_ning has its attraction already; remove cohesion"):
        converted(HYSTERESIS, "thornton_ning", youngsModulus="24e9", yieldPressure="1.9e9", workOfAdhesion="0.1")
    with pytest.raises(CaseError, match="give one value > 0, or 2, one for each type"):
        converted(HYSTERESIS, youngsModulus="1e9,2e9,3e9", yieldPressure="1.9e9")


SOFT = """units si
variable E equal 1e9
fix m1 all property/global youngsModulus peratomtype 1e7 ${E}
fix m2 all property/global poissonsRatio peratomtype 0.3 0.3
pair_style gran model hertz tangential history
timestep 1e-5
run 10
fix m1 all property/global youngsModulus peratomtype 1e7 1e9
run 10
"""


@pytest.mark.parametrize(
    ("given", "step"),
    [("2e9,1e9", "7.07e-07"), ("1e9", "1e-06"), ("1e7,4e9", "5e-06"), ("1e7,1e9", None), ("1e6,1e9", None)],
)
def test_the_time_step_follows_the_type_that_stiffens_most(given, step):
    """sqrt(1e7/2e9) = 0.0707; sqrt(1e7/1e9) = 0.1; sqrt(1e9/4e9) = 0.5, of a modulus that is a variable."""
    done = converted(SOFT, youngsModulus=given, yieldPressure="1e6")
    assert f"timestep {step or '1e-5'}\n" in done.text and ("correct run" in "".join(done.notes)) == bool(step)


def test_a_modulus_that_the_deck_computes_leaves_the_time_step_to_the_user():
    deck = SOFT.replace("equal 1e9", "equal 2*5e8").replace("peratomtype 1e7 1e9", "peratomtype 1e7 ${E}")
    done = converted(deck, youngsModulus="1e7,4e9", yieldPressure="1e6")
    assert "timestep 1e-5\n" in done.text
    assert "my.in, line 3: 1e7 ${E} is computed: give sqrt(E before/E now) of the time step by hand" in done.notes


def test_a_strength_of_each_type_stands_before_the_first_run():
    done = converted(SOFT, yieldPressure="1e6,2e6").text.splitlines()
    assert done[3] == "fix epdem_yieldPressure all property/global yieldPressure peratomtype 1e6 2e6"
    with pytest.raises(CaseError, match="yieldPressure=1,2,3: give one value, or 2, one for each type"):
        converted(SOFT, yieldPressure="1,2,3")


WALL = "fix w all wall/gran/hertz/history"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("pair_style gran/hertz/history 1 0 # old", "pair_style gran MODEL # old"),
        ("pair_style gran/hooke/history 0 1", "pair_style gran MODEL cohesion sjkr tangential_damping off"),
        ("pair_style gran/hertz/history rolling_friction cdt", "pair_style gran MODEL rolling_friction cdt"),
        (f"{WALL} 1 0 zplane 0.01 NULL 2", "fix w all wall/gran MODEL primitive type 2 zplane 0.01"),
        (
            f"{WALL} 0 1 zcylinder 0.05 1",
            "fix w all wall/gran MODEL cohesion sjkr primitive type 1 zcylinder 0.05 0 0 tangential_damping off",
        ),
        (f"{WALL} primitive type 1 zplane 0.0", "fix w all wall/gran MODEL primitive type 1 zplane 0.0"),
    ],
)
def test_models_of_liggghts_1_and_2_are_those_of_today(old, new):
    done = converted(f"{SOFT}{old}\n", yieldPressure="1e6")
    assert new.replace("MODEL", "model ep/thornton tangential history") in done.text.splitlines()
    assert any(note.startswith("my.in, line 10: 'gran/") or "wall/gran/" in note for note in done.notes)


@pytest.mark.parametrize("wall", ["zplane 0.0 0.2 1", "mesh/gran 1 cad"])
def test_a_wall_that_is_no_single_one_of_today_names_its_line(wall):
    with pytest.raises(CaseError, match=rf"line 10: {wall}: no single wall of today; write one fix wall/gran"):
        converted(f"{SOFT}fix w all wall/gran/hertz/history 1 0 {wall}\n", yieldPressure="1e6")


def test_the_check_names_inputs_that_are_probably_wrong():
    found = check(HYSTERESIS, "my.in")
    assert [text.split(":")[0] for text in found] == ["my.in, line 7", "my.in, line 4"]
    assert "coefficientAdhesionStiffness = 1e+06 is the ratio" in found[0] and "restitution acts twice" in found[1]
    limit = math.pi * 5e-4 * math.sqrt(2000 * 2 * 1.25 / 1.4e8) / (0.1631 * 0.25 + 0.8766)  # Rayleigh's time
    for factor, many in ((0.99, 0), (1.01, 1)):
        said = check(HYSTERESIS.replace("1.0e-6", f"{factor * limit!r}"), "my.in")
        step = [text for text in said if "timestep" in text]
        assert len(step) == many and all("my.in, line 11" in text for text in step)
    E_star = 1.35e6 / (2 * (1 - 0.3**2))
    for factor, many in ((0.099, 0), (0.101, 1)):
        strength = f"fix y all property/global yieldPressure peratomtype 1e6 {factor * E_star!r}\n"
        hard = [text for text in check(HYSTERESIS + strength, "my.in") if "yieldPressure of type 2" in text]
        assert len(hard) == many and all("epdem soften" in text for text in hard)


def test_a_good_deck_and_values_that_the_deck_computes_give_no_sentence(tmp_path):
    good = HYSTERESIS.replace("1e5 2e5 2e5 1e6", "0.1 0.2 0.2 ${kc}").replace("0.3 0.3", "0.9 0.9")
    assert check(good, "my.in") == []
    path = tmp_path / "my.in"
    path.write_text(good)
    assert CliRunner().invoke(app, ["deck", str(path), "--check"]).stdout.endswith("my.in: nothing found\n")
    path.write_text(HYSTERESIS)
    done = CliRunner().invoke(app, ["deck", str(path), "--check", "--json"])
    assert done.exit_code == 1 and len(json.loads(done.stdout)["warnings"]) == 2
    assert "--out is missing" in str(CliRunner().invoke(app, ["deck", str(path)]).exception)
    converted = ["deck", str(path), "--convert", "--set", "youngsModulus=1e9", "--set", "yieldPressure=1e8"]
    done = CliRunner().invoke(app, [*converted, "--out", str(tmp_path / "out")])
    place = f"{tmp_path / 'out/my.in'}, line 3: yieldPressure of type 1 = 1e+08 is 0.19 E*"
    assert done.exit_code == 0 and place in done.stderr
    path.write_text("units si\n")
    assert "name a LIGGGHTS deck" in str(CliRunner().invoke(app, ["deck", str(path), "--check"]).exception)


RESTART = """units si
atom_style granular
atom_modify map array
newton off
communicate single vel yes
{begin}
neighbor 0.001 bin
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix {wall} all wall/gran model hertz tangential history primitive type 1 zplane 0.0
"""
BOX = """region r block -0.01 0.01 -0.01 0.01 -0.001 0.02 units box
create_box 1 r"""


@pytest.mark.liggghts
def test_walls_that_lose_their_contacts_in_a_restart_are_named(tmp_path):
    written = RESTART.format(begin=BOX, wall="floor") + "create_atoms 1 single 0 0 0.001 units box\n"
    written += "set group all diameter 0.002 density 2500\nfix move all nve/sphere\nrun 1\n"
    (tmp_path / "first.in").write_text(written + "write_restart bed.restart\n")
    launcher.run("first.in", tmp_path)
    place = tmp_path / "next.in"
    begin = "read_restart bed.restart"
    assert check(RESTART.format(begin=begin, wall="floor"), place) == []
    (said,) = check(RESTART.format(begin=begin, wall="bottom"), place)
    assert "bed.restart holds the contacts of walls floor, and walls bottom of the deck begin without any" in said
    assert check(RESTART.format(begin=begin, wall="bottom"), tmp_path / "elsewhere/next.in") == []


def test_a_wall_that_is_defined_again_loses_its_dents():
    wall = "fix lid all wall/gran model {model} tangential history primitive type 1 zplane 0.1\n"
    plastic = wall.format(model="ep/thornton") + "run 100\nunfix lid\n"
    (said,) = check(plastic + wall.format(model="ep/thornton"), "my.in")
    assert said.startswith("my.in, line 4: wall lid is defined a second time: its contacts begin without dents")
    assert check(plastic, "my.in") == []
    assert check(2 * wall.format(model="hertz"), "my.in") == []
