# SPDX-License-Identifier: GPL-2.0-or-later
"""Case files: what is refused, and how the sentence reads; nothing is written for a bad one."""

import copy
import math
import re
import subprocess
import sys
from pathlib import Path

import pytest

from epdem.case import scene, units
from epdem.case.impact import load, parse
from epdem.case.toml import read_toml
from epdem.case.units import to_si
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment

CASES = Path(__file__).parents[2] / "cases"
STEEL = read_toml(CASES / "steel_wall.toml")


@pytest.mark.parametrize("path", sorted(CASES.glob("*.toml")), ids=lambda p: p.stem)
def test_every_case_of_the_project_is_valid(path):
    case = scene.load(path) if scene.is_scene(read_toml(path)) else experiment(load(path))
    assert case.name == path.stem


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("208 GPa", "Pa", 208e9),
        ("7850 kg/m^3", "kg/m^3", 7850.0),
        ("7.85 g/cm**3", "kg/m^3", 7850.0),
        ("1e-2 m", "m", 1e-2),
        ("36 km/hour", "m/s", 10.0),
        ("-3 um", "m", -3e-6),
        ("60 rpm", "rad/s", 2 * math.pi),
        ("1e-3 1/s", "1/s", 1e-3),
    ],
)
def test_a_quantity_is_number_blank_unit(text, unit, value):
    assert to_si(text, unit) == pytest.approx(value, rel=1e-15)


NO_LENGTHS = ["9**9**9 m", "1 m + 1 m", "1", "m", "nan m", "inf m", "1e999 m", "1 kg", "1 furlong_x", "", "1 m;"]


@pytest.mark.parametrize("text", [*NO_LENGTHS, 3, True, None, "1 " + "m" * 500])
def test_anything_else_is_refused(text):
    with pytest.raises(ValueError):
        to_si(text, "m")


TURNS = ("does not say whether it counts turns", r"is one of angles; write how many in a second")


@pytest.mark.parametrize(
    ("text", "unit"), [("50 Hz", "rad/s"), ("1 1/s", "rad/s"), ("1 rpm", "Hz"), ("1 rad/s", "1/s")]
)
def test_a_frequency_is_no_angular_speed(text, unit):
    """Both are 1/s to pint: 3000 rpm were 314 Hz, and a spin of 50 Hz 8 turns a second."""
    with pytest.raises(ValueError, match=TURNS[unit != "rad/s"]):
        to_si(text, unit)


@pytest.mark.parametrize("text", ["9**9**9 m", "1 m**9**9**9", "1 (9**9**9)", "1 m*9**9**9"])
def test_pint_never_sees_powers_that_it_would_compute_for_hours(text, monkeypatch):
    monkeypatch.setattr(units, "_factor", lambda unit, si: pytest.fail(f"pint was given {unit!r}"))
    with pytest.raises(ValueError, match="is not number, blank, unit"):
        to_si(text, "m")


def paths_in(data, keys=()):
    """Every key of nested tables and lists."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        yield (*keys, key)
        if isinstance(value, dict | list):
            yield from paths_in(value, (*keys, key))


@pytest.mark.parametrize("name", ["steel_wall", "two_materials", "settle_glass", "hopper_beads", "compaction_powder"])
def test_a_wrong_value_anywhere_is_one_line_with_its_place_in_the_words_of_this_project(name):
    """Every key of a case in turn takes values of every type of TOML."""
    whole = read_toml(CASES / f"{name}.toml")
    refused = 0
    for *path, last in paths_in(whole):
        for value in (3, -1.5, "x", "y" * 500, True, [], {}, ["a"], {"a": 1}, "1 kg"):
            data = copy.deepcopy(whole)
            at = data
            for key in path:
                at = at[key]
            at[last] = value
            try:
                (scene.parse if scene.is_scene(whole) else parse)(data, "f.toml")
            except CaseError as error:
                refused += 1
                text = str(error)
                assert text.startswith("f.toml: ") and "\n" not in text and len(text) < 300, text
                assert not re.search(r"Input should|should have|should be|valid|Field|SpeedRange|Range|function-", text)
    assert refused > 100


def test_a_file_of_the_other_kind_is_named_as_such():
    with pytest.raises(CaseError, match=r"^f is a bulk scene .* needs impacts .* --target take scenes$"):
        parse(read_toml(CASES / "settle_glass.toml"), "f")
    with pytest.raises(CaseError, match=r"^f is a case of impacts .* needs a bulk scene"):
        scene.parse(STEEL, "f")
    with pytest.raises(CaseError, match=r"^f: both \[impact\] and \[scene\]"):
        parse(STEEL | {"scene": {}}, "f")


def test_bad_input_exits_with_2_one_line_and_writes_nothing(tmp_path):
    bad = tmp_path / "bad.toml"
    bad.write_text((CASES / "steel_wall.toml").read_text().replace("0.3", "30"))
    words = [sys.executable, "-m", "epdem", "run", str(bad)]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr.startswith("epdem: ") and done.stderr.count("\n") == 1 and "poisson_ratio = 30" in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["bad.toml"]


def test_another_law_drops_the_parameters_of_the_first():
    x = experiment(parse(STEEL, "f"), "cavity")
    ratios = {"first_yield_ratio": 1.6, "plastic_ratio": 2.8, "finite_strain": 1e6}
    assert x.law.parameters == {"yield_stress": 1e9} | ratios


def test_the_softer_body_gives_the_strength_of_the_pair():
    data = copy.deepcopy(STEEL)
    data["materials"]["brass"] = STEEL["materials"]["steel"] | {"yield_stress": "200 MPa"}
    data["impact"]["target"]["material"] = "brass"
    x = experiment(parse(data, "f"))
    assert x.law.strengths == (2.8e9, 2.8 * 200e6) and x.law.parameters["yield_pressure"] == 2.8 * 200e6


@pytest.mark.parametrize(
    ("raw", "says"),
    [
        (b"a = " + b"[" * 100_000, "nested more than 20 deep"),
        (b"#" * 1_000_001, "1000001 bytes, must be at most 1000000"),
        ("a = 1".encode("utf-16"), "not UTF-8 at byte 0"),
        (b'a = "\xe4"', "not UTF-8 at byte 5"),
        (b"a = \x00", "not valid TOML"),
    ],
)
def test_a_file_that_is_no_case_is_named_and_not_swallowed(raw, says, tmp_path):
    path = tmp_path / "case.toml"
    path.write_bytes(raw)
    with pytest.raises(CaseError, match=f"{path}: .*{says}"):
        read_toml(path)


def test_a_device_is_not_read_to_its_end():
    with pytest.raises(CaseError, match="/dev/zero: not a regular file"):
        read_toml("/dev/zero")


def test_line_ends_and_byte_order_marks_of_other_systems_are_no_mistake(tmp_path):
    (tmp_path / "case.toml").write_bytes(b"\xef\xbb\xbfa = 1\r\nb = 2\r\n")
    assert read_toml(tmp_path / "case.toml") == {"a": 1, "b": 2}
