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


def changed(place: str, value):
    data = copy.deepcopy(STEEL)
    at = data
    *path, last = place.split(".")
    for key in path:
        at = at.setdefault(key, {})
    if value is KeyError:
        del at[last]
    else:
        at[last] = value
    return data


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


@pytest.mark.parametrize(
    "text",
    [
        "9**9**9 m",
        "1 m + 1 m",
        "1",
        "m",
        "nan m",
        "inf m",
        "1e999 m",
        "1 kg",
        "1 furlong_x",
        "",
        "1 m;",
        3,
        True,
        None,
        "1 " + "m" * 500,
    ],
)
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


@pytest.mark.parametrize(
    ("place", "value", "says"),
    [
        ("materials.steel.poisson_ratio", 30, "materials.steel.poisson_ratio = 30, must lie in [-0.99, 0.5]; percent?"),
        ("materials.steel.poisson_ratio", -0.9999999999, "poisson_ratio = -0.9999999999, must lie in [-0.99, 0.5]"),
        ("materials.steel.young_modulus", "208 kg", "wrong dimension"),
        (
            "measured",
            {"source": "x", "speeds": ["1 m/s"], "e_n": [1.3]},
            "measured.e_n.0 = 1.3, must lie in [0, 1.2]; percent",
        ),
        (
            "measured",
            {"source": "x", "speeds": ["1 m/s"], "e_n": []},
            "measured: speeds: 1, e_n: 0; give one e_n for each",
        ),
        ("materials.steel.young_modulus", "-1 GPa", "must lie in (0, inf) Pa"),
        ("materials.steel.young_modulus", float("nan"), "expected a quantity with a unit"),
        ("materials.steel.poisson_ratio", float("nan"), "not a finite number"),
        ("materials.steel.colour", "blue", "unknown key"),
        ("materials.rigid", STEEL["materials"]["steel"], "kept for a rigid target"),
        ("materials.steel.yield_stress", KeyError, "yield_stress"),
        ("impact.body.radius", "0 m", "must lie in (0, inf) m"),
        ("impact.body.material", "brass", "add [materials.brass]"),
        ("impact.target.radius", "1 m", "must not have a radius"),
        ("impact.kind", "sphere-cube", "sphere-wall"),
        ("impact.speeds", ["1 m/s", "fast"], "impact.speeds.1"),
        ("impact.speeds", [], "impact.speeds is empty; give at least one value"),
        ("impact.speeds.count", 10**9, "must be at most 1000"),
        ("impact.speeds.to", "1 mm/s", "must exceed 'from'"),
        ("impact.speeds.count", 1000, "at most 4096"),
        ("numerics.phases", 65, "must be at most 64"),
        ("numerics.steps_in_contact", 10**7, "must be at most 100000"),
        ("numerics.steps_in_contact", 100.5, "must be a whole number"),
        ("case.title", "a title & ", "swallow the next line"),
        ("case.title", "two\nlines", "one printable line"),
        ("case.source", "bell \a", "one printable line"),
        ("case.name", "../../etc", "a-z, A-Z, 0-9"),
        ("case.name", "größe", "of the characters a-z, A-Z, 0-9, - and _, the first of them not -"),
        ("case.name", "-rf", "case.name = '-rf', must be 1 to 64 of the characters a-z, A-Z, 0-9, - and _"),
        ("case.name", "n" * 1000, f"case.name = '{'n' * 76}..., must be"),
        ("materials.steel.young_modulus", "1 " + "G" * 200, "young_modulus = '1 GGG"),
        ("impact.speeds", "1 m/s", "impact.speeds = '1 m/s', must be a list; write it in [ ]"),
        ("materials.steel.two\nlines", 1, "materials.steel.'two\\nlines' = 1, unknown key"),
        ("case", KeyError, "case is missing"),
        ("law.name", "hook", "there are hertz, thornton"),
        ("law.stiffness", 1.0, "has no such parameter; it has yield_pressure, yield_pressure_ratio"),
        ("law.yield_pressure", "1 GPa", "keep one"),
        ("law.yield_pressure_ratio", -1.0, "must be > 0"),
        ("law", {"name": "cavity", "first_yield_ratio": 1.0}, "law.first_yield_ratio = 1"),
        ("impact.body.radius", "1e-200 m", "must lie in [1e-12, 1e+06] m"),
        ("impact.speeds.from", "1e-120 m/s", "must lie in [1e-30, 1e+12] m/s"),
        ("materials.steel.young_modulus", "1e200 Pa", "must lie in [1e-09, 1e+30] Pa"),
        ("law.yield_pressure_ratio", 1e200, "law.yield_pressure = 1e+209"),
        ("impact.body.material", "rigid", "only the target can be rigid"),
        ("impact.body", 3, "must be a table"),
        ("check.e_n", 0, "must lie in (0, inf)"),
    ],
)
def test_a_mistake_is_named_with_place_value_and_limit(place, value, says):
    with pytest.raises(CaseError) as caught:
        experiment(parse(changed(place, value), "f.toml"))
    assert says in str(caught.value)


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


@pytest.mark.parametrize(
    ("radius", "says"),
    [
        ("1 kg", "scene.particles.0.radius = '1 kg', the unit 'kg' has the wrong dimension"),
        ({"from": "1 mm", "to": "2 mm", "classes": 1}, "scene.particles.0.radius.classes = 1, must be at least 2"),
        ({"from": "2 mm", "to": "1 mm"}, "scene.particles.0.radius: 'to' (0.001 m) must exceed 'from' (0.002 m)"),
        ({"from": "2 mm"}, "scene.particles.0.radius.to is missing; add it"),
    ],
)
def test_of_two_readings_of_a_value_the_message_takes_the_one_that_is_meant(radius, says):
    data = read_toml(CASES / "settle_glass.toml")
    data["scene"]["particles"][0]["radius"] = radius
    with pytest.raises(CaseError) as caught:
        scene.parse(data, "f.toml")
    assert str(caught.value).startswith("f.toml: " + says)


def test_bad_input_exits_with_2_one_line_and_writes_nothing(tmp_path):
    bad = tmp_path / "bad.toml"
    bad.write_text((CASES / "steel_wall.toml").read_text().replace("0.3", "30"))
    done = subprocess.run(
        [sys.executable, "-m", "epdem", "run", str(bad)], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 2
    assert done.stderr.startswith("epdem: ") and done.stderr.count("\n") == 1 and "poisson_ratio = 30" in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["bad.toml"]


COMMANDS = {
    "a folder that is a file": (("run", "-e", "embedded", "-o", "taken"), "taken"),
    "a folder nobody can make": (("run", "-e", "embedded", "-o", "/proc/here"), "/proc/here"),
    "a model of another code": (("run", "-e", "liggghts-thornton_ning"), "'epdem verify crosscheck' runs models"),
    "ranks of an engine that has one": (("run", "-e", "embedded", "--ranks", "2"), "leave it out"),
    "a deck of an engine without decks": (("deck", "-e", "embedded", "-o", "d"), "reads no deck"),
    "two laws in one deck": (("deck", "-l", "hertz", "-l", "cavity", "-o", "d"), "one deck for each"),
    "too many samples": (("run", "-e", "embedded", "--steps", "100000"), "samples, at most"),
}


@pytest.mark.parametrize("mistake", COMMANDS)
def test_a_mistake_on_the_command_line_exits_with_2_and_one_sentence(mistake, tmp_path):
    (command, *options), says = COMMANDS[mistake]
    (tmp_path / "taken").write_text("")
    case = tmp_path / "case.toml"
    case.write_text((CASES / "steel_wall.toml").read_text().replace("count = 32", "count = 512"))
    done = subprocess.run(
        [sys.executable, "-m", "epdem", command, str(case), *options], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 2 and says in done.stderr, done.stderr
    assert done.stderr.startswith("epdem: ") and done.stderr.count("\n") == 1


def test_another_law_drops_the_parameters_of_the_first():
    x = experiment(parse(STEEL, "f"), "cavity")
    assert x.law.parameters == {
        "yield_stress": 1e9,
        "first_yield_ratio": 1.6,
        "plastic_ratio": 2.8,
        "finite_strain": 1e6,
    }


def test_the_softer_body_gives_the_strength_of_the_pair():
    data = changed("materials.brass", dict(STEEL["materials"]["steel"], yield_stress="200 MPa"))
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
