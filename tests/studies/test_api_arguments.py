# SPDX-License-Identifier: GPL-2.0-or-later
"""What a notebook user gives to the Python interface is taken, or refused with one sentence that names its type."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import epdem
from epdem import Case, Scene, calibrate, cite, deck, predict, run, sweep
from epdem.errors import CaseError

CASES = Path(__file__).parents[2] / "cases"
STEEL, SCENE = CASES / "steel_wall.toml", CASES / "settle_glass.toml"
RADIUS = "impact.body.radius"


@pytest.fixture(scope="module")
def steel():
    return Case.from_toml(STEEL).replace({"impact.speeds": [1.0, 5.0]})


def test_the_path_of_a_file_is_a_case(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    expected = Case.from_toml(STEEL)
    assert predict(str(STEEL)).equals(predict(expected)) and predict(STEEL).equals(predict(expected))
    assert run(STEEL, engines="embedded", out=tmp_path / "a").table["e_n"].size == predict(expected)["speed"].size
    assert "in.scene" in {path.name for path in deck(SCENE, tmp_path / "b")}
    found = sweep(str(STEEL), {RADIUS: 0.002}, engines="embedded", out=tmp_path / "c", jobs=1)
    assert found.table[RADIUS].unique().tolist() == [0.002]


@pytest.mark.parametrize("value", [0.001, np.float64(0.001), np.array(0.001), "1 mm", ["1 mm"], (0.001,)], ids=repr)
def test_one_value_of_a_key_needs_no_list(steel, tmp_path, value):
    found = sweep(steel, {RADIUS: value}, engines="embedded", out=tmp_path / "a", jobs=1)
    assert found.table[RADIUS].unique().tolist() == [0.001]


WRONG = {
    "a text that is no file": (lambda c, p: run("a"), r"^a: no such file"),
    "a number as a case": (lambda c, p: predict(3), r"^case = 3: of type int; must be the path of a file or folder"),
    "a scene to predict": (lambda c, p: predict(Scene.from_toml(SCENE)), "of type Scene; give a Case"),
    "a file of a scene to predict": (lambda c, p: predict(SCENE), "of type Scene; give a Case"),
    "impacts to calibrate": (lambda c, p: calibrate(c, {"x": 1}, {"y": "1..2"}), "of type Case; give a Scene"),
    "a law that is no name": (lambda c, p: predict(c, 3), "law = 3: of type int; must be a text in quotes"),
    "ranks as text": (lambda c, p: run(c, ranks="2"), r"^ranks = '2': of type str; must be a whole number"),
    "no ranks": (lambda c, p: run(c, ranks=0), "^ranks = 0: of type int; must be at least 1"),
    "half a rank": (lambda c, p: sweep(c, {RADIUS: 1e-3}, ranks=1.5), "ranks = 1.5: of type float"),
    "jobs as text": (lambda c, p: sweep(c, {RADIUS: 1e-3}, jobs="2"), "jobs = '2': of type str"),
    "points as text": (lambda c, p: sweep(c, {RADIUS: "1 mm..2 mm"}, latin_hypercube="2"), "latin_hypercube = '2'"),
    "a seed as text": (lambda c, p: sweep(c, {RADIUS: "1 mm..2 mm"}, latin_hypercube=2, seed="x"), "seed = 'x'"),
    "an engine that is no name": (lambda c, p: run(c, engines=3), "engines = 3: of type int; must be a list"),
    "no engines": (lambda c, p: run(c, engines=None), "engines = None: of type NoneType"),
    "engines that are no names": (lambda c, p: run(c, engines=["embedded", 3]), "engines = 3: of type int"),
    "laws that are no names": (lambda c, p: run(c, laws=[3]), "laws = 3: of type int"),
    "a number as a folder": (lambda c, p: run(c, out=3), "out = 3: of type int; must be the path"),
    "a number as a folder of a deck": (lambda c, p: deck(c, 3), "out = 3: of type int"),
    "settings in a list": (lambda c, p: sweep(c, [RADIUS]), "settings = .*: of type list; must be a table"),
    "a key that is no text": (lambda c, p: sweep(c, {3: [1]}), "settings = 3: of type int; must be a text"),
    "no value": (lambda c, p: sweep(c, {RADIUS: None}), f"{RADIUS} = None: of type NoneType"),
    "none among values": (lambda c, p: sweep(c, {RADIUS: [1e-3, None]}), f"{RADIUS} = None: of type NoneType"),
    "targets as a number": (lambda c, p: calibrate(SCENE, 3, {"y": "1..2"}), "targets = 3: of type int"),
    "a number as a range": (lambda c, p: calibrate(SCENE, {"x": 1}, {"scene.count": 5}), "scene.count = 5.*LOW..HIGH"),
    "a header as text": (lambda c, p: c.replace(case="ball"), "case = 'ball', must be a table"),
    "a law as a number": (lambda c, p: c.replace(law=3), "law = 3, must be a table"),
    "a table of none": (lambda c, p: Case(impact=None), "impact = None: of type NoneType"),
    "a number as a file": (lambda c, p: Case.from_toml(3), "path = 3: of type int; must be the path"),
    "changes as a number": (lambda c, p: c.replace(3), "changes = 3: of type int; must be a table"),
    "a complex number": (lambda c, p: c.replace({RADIUS: 1j}), f"{RADIUS} = 1j: of type complex"),
    "a key below a number": (lambda c, p: c.replace({RADIUS + ".x": 1}), f"nearest: {RADIUS}"),
    "a place in a list that is none": (
        lambda c, p: Scene.from_toml(CASES / "impactor_bowl.toml").replace({"scene.body.7.radius": 1}),
        r"no key 'scene\.body\.7\.radius'",
    ),
    "cite of a number": (lambda c, p: cite(3), "case = 3: of type int"),
    "two ranks of one": (
        lambda c, p: run(c, engines="embedded", ranks=2, out=p),
        "ranks 2: engine embedded runs on one rank",
    ),
    "an engine that is none": (
        lambda c, p: run(c, engines="nothing", out=p),
        "engines 'nothing' does not exist",
    ),
    "a deck of an engine without": (
        lambda c, p: deck(c, p, engine="embedded"),
        "it reads no deck; use engine liggghts or",
    ),
    "a sweep of no point": (
        lambda c, p: sweep(c, {}, out=p),
        "a sweep needs points: settings KEY=VALUES or --points",
    ),
    "no measurement": (
        lambda c, p: calibrate(c),
        "give one measurement: e_n with speed, measured, hv, hb, or indentation",
    ),
    "a speed without e_n": (
        lambda c, p: calibrate(c, hv=200, speed="1 m/s"),
        "speed: it belongs to e_n; leave it out",
    ),
    "a measurement that is none": (
        lambda c, p: calibrate(c, vickers=200),
        "vickers: no measurement of a Case; there are dent_ratio, e_n",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_be_taken_is_refused_with_one_sentence(name, steel, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    call, message = WRONG[name]
    with pytest.raises(CaseError, match=message) as raised:
        call(steel, tmp_path)
    assert "\n" not in str(raised.value) and not any(tmp_path.iterdir())


def test_replace_takes_what_a_case_is_made_of(steel):
    """Tables, arrays and plain numbers of quantities at any depth; a law with its own parameters."""
    glass = {"young_modulus": 70e9, "poisson_ratio": 0.2, "density": 2500.0, "yield_stress": "0.1 GPa"}
    found = steel.replace({"materials.glass": glass, "impact.body": {"radius": 0.02, "material": "glass"}})
    assert found.model.materials["glass"].young_modulus == 70e9 and found.model.impact.body.radius == 0.02
    assert found.model.materials["steel"] == steel.model.materials["steel"]
    other = steel.replace(law={"name": "johnson", "yield_pressure": np.float64(2e9)})
    assert other.model.law.name == "johnson" and other.model.law.parameters()["yield_pressure"] == "2000000000.0 Pa"
    assert steel.replace({"law.name": "johnson", "law.yield_pressure": 2e9}) == other
    scene = Scene.from_toml(CASES / "impactor_bowl.toml")
    ball = {"name": "ball", "material": "steel", "radius": 3e-3, "position": np.array([0.0, 0.0, 0.03]), "phase": "hit"}
    assert scene.replace({"scene.body": [ball]}).model.scene.body[0].radius == 3e-3


BODY = {"material": "steel"}
CHANGES = {
    "impact": st.builds(
        lambda radius, speeds: {
            "kind": "sphere-wall",
            "body": BODY | {"radius": radius},
            "target": BODY,
            "speeds": speeds,
        },
        st.sampled_from([0.001, "2 mm", np.float64(0.003)]),
        st.sampled_from([(1.0, 2.0), ["1 m/s"], np.array([0.5])]),
    ),
    "law": st.sampled_from([{"name": "hertz"}, {"name": "johnson", "yield_pressure": 1e9}, {"name": "thornton"}]),
    "materials": st.sampled_from(
        [
            {"steel": {"young_modulus": E, "poisson_ratio": 0.3, "density": 7850, "yield_stress": 1e9}}
            for E in (1e11, 2e11)
        ]
    ),
    "numerics": st.sampled_from([{"phases": 8}, {"steps_in_contact": 200}]),
}


@settings(max_examples=30, deadline=None)
@given(st.data(), st.sets(st.sampled_from(sorted(CHANGES)), min_size=2))
def test_tables_replaced_are_tables_given(data, names):
    """Any two or more tables: a case with them replaced is the case made of them."""
    first = {name: data.draw(CHANGES[name], f"first {name}") for name in CHANGES}
    second = {name: data.draw(CHANGES[name], f"second {name}") for name in names}
    assert Case(**first).replace(**second) == Case(**(first | second))


def test_a_case_is_cited_in_words_and_in_bibtex(steel):
    found = cite(steel, engines=["embedded", "liggghts"])
    assert {"epdem", "liggghts"} <= set(found) and found["law thornton, Thornton 1997"].startswith(
        "C. Thornton, J. Appl"
    )
    text = found.bibtex()
    entries = re.findall(r"^@(\w+)\{([\w.:-]+),\n((?:  .*\n)+)\}$", text, re.M)
    assert [kind for kind, _, _ in entries] == ["misc", "book", "article", "article"]
    keys = [key for _, key, _ in entries]
    assert keys == ["epdem", "SevilleWu2016", "Thornton1997", "KlossEtAl2012"]
    fields = dict(re.findall(r"  (\w+) = \{(.*)\},", entries[2][2]))
    assert fields == {
        "author": "C. Thornton",
        "title": "Coefficient of restitution for collinear collisions of elastic-perfectly plastic spheres",
        "journal": "J. Appl. Mech.",
        "volume": "64",
        "pages": "383",
        "year": "1997",
    }


def test_partial_slip_and_oblique_impacts_have_sources():
    oblique = cite(CASES / "oblique_steel.toml")
    assert any("Wear 38 (1976) 101" in text for text in oblique.values())
    scene = Scene.from_toml(SCENE)
    assert not any("partial slip" in what for what in cite(scene))
    contact = {"friction": 0.3, "tangential": "partial_slip"}
    slips = cite(scene.replace({"contact": contact}))
    assert any("Jaeger" in text for what, text in slips.items() if what.startswith("partial slip"))


def test_the_interface_names_cite():
    assert epdem.cite is cite
