# SPDX-License-Identifier: GPL-2.0-or-later
"""Points of a sweep: what a person writes, what is refused, and how they fill the space."""

import contextlib
import math
import re
from itertools import product
from pathlib import Path

import numpy as np
import pytest
import tomlkit

from epdem.base.declarations import declarations
from epdem.case.impact import parse
from epdem.case.keys import keys_of
from epdem.case.law import law_numbers
from epdem.case.toml import read_toml
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.studies.sweep import points
from epdem.studies.sweep.folder import Sweep
from epdem.studies.sweep.points import assign
from epdem.studies.sweep.run import check, plan

CASES = Path(__file__).parents[2] / "cases"
STEEL = CASES / "steel_wall.toml"
KEYS = keys_of(read_toml(STEEL))


def values(text: str, key: str = "impact.body.radius") -> list:
    return points.axes({key: text}, KEYS)[key].values()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1 mm,2 mm, 5 mm", ["1 mm", "2 mm", "5 mm"]),
        ("7 mm", ["7 mm"]),
        ("0.5 GPa..2 GPa:4", ["0.5 GPa", "1 GPa", "1.5 GPa", "2 GPa"]),
        ("0.1..0.5:5", [0.1, 0.2, 0.3, 0.4, 0.5]),
        ("1..3 mm:3", ["1 mm", "2 mm", "3 mm"]),
        ("1 mm..0.3 cm:3", ["1 mm", "2 mm", "3 mm"]),
        ("2 mm..1 mm:2", ["2 mm", "1 mm"]),
        ("log:1 m/s..100 m/s:3", ["1 m/s", "10 m/s", "100 m/s"]),
        ("log:1e-3..1e3:4", [0.001, 0.1, 10.0, 1000.0]),
        ("thornton,cavity", ["thornton", "cavity"]),
        ("true,3,2.5", [True, 3, 2.5]),
        ('["1 m/s", "2 m/s"],["3 m/s"]', [["1 m/s", "2 m/s"], ["3 m/s"]]),
        ('{from = "1 m/s", to = "2 m/s", count = 3}', [{"from": "1 m/s", "to": "2 m/s", "count": 3}]),
    ],
)
def test_values_are_read_as_a_person_writes_them(text, expected):
    assert values(text) == expected


def test_whole_numbers_stay_whole():
    assert values("100..400:4", "numerics.steps_in_contact") == [100, 200, 300, 400]
    assert all(isinstance(v, int) for v in values("log:5..50:4", "numerics.steps_in_contact"))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("1 mm..2 mm", "how many values"),
        ("1 mm..2 mm:1", "'1' is not a number of values"),
        ("1 mm..2 mm:x", "'x' is not a number of values"),
        ("1 mm..1 mm:3", "a range needs two limits that differ"),
        ("1 mm..2 kg:3", "wrong dimension"),
        ("one..2 mm:3", "'one' is not a number"),
        ("log:-1 mm..2 mm:3", "a range needs two limits > 0"),
        ("log:1 mm", "needs a range"),
        ("1 mm,,2 mm", "a value is empty"),
    ],
)
def test_values_that_make_no_sense_are_refused_with_their_key(text, words):
    with pytest.raises(CaseError, match=words) as refused:
        points.grid(points.axes({"impact.body.radius": text}, KEYS))
    assert "impact.body.radius" in str(refused.value)


@pytest.mark.parametrize(
    ("wrong", "nearest"),
    [
        ("impact.radius", "impact.body.radius"),
        ("law.yeild_pressure", "law.yield_pressure"),
        ("law.yield_stress", "materials.steel.yield_stress"),
        ("materials.iron.density", "materials.steel.density"),
        ("numeric.phases", "numerics.phases"),
        ("viscous.restitutoin", "viscous.restitution"),
    ],
)
def test_a_wrong_key_is_answered_by_the_nearest(wrong, nearest):
    with pytest.raises(CaseError, match=re.escape(f"no key '{wrong}'")) as refused:
        points.axes({wrong: "1"}, KEYS)
    assert nearest in str(refused.value).split("nearest: ")[1]


def leaves(data: dict) -> list[tuple[str, object]]:
    """The dotted name and value of every key."""
    found = []

    def walk(value, place):
        if isinstance(value, dict):
            for name, below in value.items():
                walk(below, (*place, name))
        elif isinstance(value, list) and any(isinstance(v, dict) for v in value):
            for n, below in enumerate(value):
                walk(below, (*place, str(n)))
        else:
            found.append((".".join(place), value))

    walk(data, ())
    return found


def test_every_key_of_the_cases_of_the_project_can_be_set():
    for path in CASES.glob("*.toml"):
        data = read_toml(path)
        keys, found = keys_of(data), leaves(data)
        assert len(found) > 10
        for key, value in found:
            first = value[0] if isinstance(value, list) else value
            text = isinstance(first, str) and bool(re.fullmatch(r"[-\d.e]+ \S+", first))
            assert (keys[key].unit not in (None, "1")) == text, f"{path.stem}: {key}"


def law_with(name: str, **parameters) -> dict:
    """The steel case with another law."""
    return read_toml(STEEL) | {"law": {"name": name, **parameters}}


@pytest.mark.parametrize("law", sorted(declarations()))
def test_the_keys_of_a_law_are_those_that_a_case_may_give(law):
    candidates = {p.name: p for one in declarations().values() for p in one.parameters}
    values = {name: 0.5 if p.unit == "1" else f"1 {p.unit}" for name, p in candidates.items()}
    values |= {f"{one.strength}_ratio": 2.0 for one in declarations().values() if one.strength}
    values |= {"compaction": True, "meyer_index": 2.5, "first_yield_ratio": 1.6, "plastic_ratio": 2.8}
    taken = set()
    for key, value in values.items():
        with contextlib.suppress(CaseError):
            law_numbers(law, {key: value})
            taken.add(f"law.{key}")
    keys = keys_of(law_with(law))
    assert {key for key in keys if key.startswith("law.")} == taken | {"law.name"}
    assert "law.meyer_index" not in keys or keys["law.meyer_index"].unit == "1"


def test_a_point_has_the_exponent_or_the_index_that_it_sets():
    for given, key, values in (
        ({"hardening_exponent": 0.1}, "law.meyer_index", "2.2..2.4:2"),
        ({"meyer_index": 2.1}, "law.hardening_exponent", "0.2,0.4"),
        ({}, "law.meyer_index", "2.2,2.4"),
    ):
        sweep = plan(tomlkit.dumps(law_with("meyer", **given)), {key: values}, engines=["embedded"])
        cases = [parse(sweep.data(n), "x") for n in (1, 2)]
        assert [experiment(c).law.parameters["hardening_exponent"] for c in cases] == pytest.approx([0.2, 0.4])
        assert [parse(tomlkit.parse(sweep.text(n)).unwrap(), "x") for n in (1, 2)] == cases


def test_a_sweep_of_laws_has_the_keys_of_the_laws_that_it_chooses(tmp_path):
    sets = {"law.meyer_index": "2.2,2.4", "law.name": "meyer"}
    sweep = plan(tomlkit.dumps(law_with("thornton")), sets, engines=["embedded"])
    exponents = [experiment(parse(sweep.data(n), "x")).law.parameters["hardening_exponent"] for n in (1, 2)]
    assert exponents == pytest.approx([0.2, 0.4]) and sweep.units == {"law.meyer_index": "1", "law.name": None}
    (tmp_path / "points.csv").write_text("law.name,law.hardening_exponent\nmeyer,0.1\nthornton,0.1\n")
    both = plan(tomlkit.dumps(law_with("thornton")), {}, engines=["embedded"], table=tmp_path / "points.csv")
    assert check(both, 1) is None and "law.hardening_exponent" in str(check(both, 2))


def test_a_part_of_a_list_goes_by_its_name_and_by_its_number():
    text = (CASES / "impactor_bowl.toml").read_text()
    names = [wall["name"] for wall in tomlkit.parse(text)["scene"]["wall"]]
    number, wall = next((n, name) for n, name in enumerate(names) if "file" in tomlkit.parse(text)["scene"]["wall"][n])
    keys, documents = keys_of(tomlkit.parse(text).unwrap()), [tomlkit.parse(text) for _ in range(2)]
    for document, part in zip(documents, (wall, number), strict=True):
        assert f"scene.wall.{part}.file" in keys
        assign(document, f"scene.wall.{part}.file", "other.stl")
        assert document["scene"]["wall"][number]["file"] == "other.stl"
    assert documents[0].as_string() == documents[1].as_string()
    with pytest.raises(CaseError, match=f"the nearest: .*scene.wall.{wall}.file"):
        points.axes({f"scene.wall.{wall}s.file": "a,b"}, keys)


def test_a_grid_is_every_combination_in_order():
    axes = points.axes({"impact.body.radius": "1 mm,2 mm", "law.yield_pressure": "1 GPa..3 GPa:3"}, KEYS)
    expected = product(["1 mm", "2 mm"], ["1 GPa", "2 GPa", "3 GPa"])
    assert [tuple(p.values()) for p in points.grid(axes)] == list(expected)
    huge = points.axes({k: "1..9:9999" for k in ("impact.body.radius", "law.yield_pressure")}, KEYS)
    with pytest.raises(CaseError, match="99980001 points, at most 1000000"):
        points.grid(huge)


def test_a_latin_hypercube_has_one_point_in_each_part_of_each_axis_and_the_same_for_a_seed():
    axes = points.axes(
        {"law.yield_pressure": "log:1 GPa..100 GPa", "materials.steel.poisson_ratio": "0.1..0.4", "law.name": "a,b"},
        KEYS,
    )
    found = points.latin_hypercube(axes, 40, seed=3)
    pressure = [math.log10(float(p["law.yield_pressure"].split()[0])) / 2 for p in found]
    ratio = [(p["materials.steel.poisson_ratio"] - 0.1) / 0.3 for p in found]
    for share in (pressure, ratio):
        assert sorted(int(40 * s) for s in share) == list(range(40))
    assert abs(np.corrcoef(pressure, ratio)[0, 1]) < 0.5
    assert [p["law.name"] for p in found].count("a") == 20
    assert found == points.latin_hypercube(axes, 40, seed=3) != points.latin_hypercube(axes, 40, seed=4)


def test_a_table_has_units_in_its_cells_or_its_heading(tmp_path):
    path = tmp_path / "points.csv"
    path.write_text('# two of three\nimpact.body.radius [mm],law.yield_pressure\n1,"1 GPa"\n\n,\n2.5,2 GPa\n')
    assert points.table(path, KEYS) == [
        {"impact.body.radius": "1 mm", "law.yield_pressure": "1 GPa"},
        {"impact.body.radius": "2.5 mm", "law.yield_pressure": "2 GPa"},
    ]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("impact.body.radius\n", "at least one row"),
        ("impact.radius\n1 mm\n", "impact.body.radius"),
        ("impact.body.radius,law.yield_pressure\n1 mm\n", "line 2: 1 values, expected 2"),
        ("impact.body.radius,law.yield_pressure\n1 mm,\n", "line 2: a value is empty"),
        ("impact.body.radius [mm\n1\n", r"no key 'impact.body.radius \[mm'; the nearest: impact.body.radius"),
    ],
)
def test_a_table_that_makes_no_sense_is_refused(text, words, tmp_path):
    path = tmp_path / "points.csv"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(CaseError, match=words):
        points.table(path, KEYS)


def test_numbers_of_a_program_are_si_and_quantities_of_pint_keep_their_unit():
    import pint

    q = pint.UnitRegistry().Quantity(7850.0, "kg/m^3")
    assert points.axes({"impact.body.radius": np.array([0.001, 0.002])}, KEYS)["impact.body.radius"].values() == [
        "0.001 m",
        "0.002 m",
    ]
    assert points.with_units(q, KEYS, "materials.steel.density") == "7850.0 kg/m**3"
    assert points.with_units(np.float64(0.3), KEYS, "materials.steel.poisson_ratio") == 0.3


def test_a_point_replaces_its_keys_alone_and_what_says_the_same_in_another_way():
    text = STEEL.read_text()
    sweep = Sweep("x", text, ({"law.yield_pressure": "3 GPa", "viscous.restitution": 0.9},), ("embedded",))
    lines = [t for t in sweep.text(1).splitlines() if t not in text.splitlines()]
    assert lines == ['yield_pressure = "3 GPa"', "[viscous]", "restitution = 0.9"]
    assert "yield_pressure_ratio" not in sweep.text(1) and "# Tolerances" in sweep.text(1)
    data = read_toml(STEEL)
    assign(data, "numerics.error", 1e-3)
    assert data["numerics"] == {"phases": 8, "error": 1e-3}


@pytest.mark.parametrize(
    ("file", "point"),
    [
        ("steel_wall", {"law.yield_pressure": "3 GPa", "viscous.restitution": 1, "impact.body.radius": 'a "b" \\ \n'}),
        ("steel_wall", {"law.name": "cavity", "law.yield_stress": "1 GPa", "numerics.error": 1e-7}),
        ("steel_wall", {"impact.speeds": {"from": "1 m/s", "to": "2 m/s", "count": 3}}),
        ("hopper_beads", {"scene.particles.0.material": "beads", "scene.count": 5, "output.energy": False}),
    ],
)
def test_the_case_file_of_a_point_is_that_with_its_values_set_one_by_one(file, point):
    text = (CASES / f"{file}.toml").read_text()
    document = tomlkit.parse(text)
    for key, value in point.items():
        assign(document, key, value)
    other = {key: 7 for key in point}
    assert Sweep("x", text, (other, point), ("embedded",)).text(2) == document.as_string()


def test_a_sweep_has_at_least_one_rank():
    text = (CASES / "steel_wall.toml").read_text()
    with pytest.raises(CaseError, match="ranks = 0: must be at least 1"):
        plan(text, {"impact.body.radius": ["1 mm"]}, engines=["embedded"], ranks=0)
