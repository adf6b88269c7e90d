# SPDX-License-Identifier: GPL-2.0-or-later
"""The Python interface does what the commands do, takes plain values, and refuses others in one sentence."""

import json
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pint
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_guide import blocks, play
from typer.testing import CliRunner

from epdem import Case, Scene, SceneRun, calibrate, cite, deck, predict, read, run, sweep, theory
from epdem.cli.main import app
from epdem.errors import CaseError
from epdem.report.pages import write_page
from epdem.scenes.tables import results as scene_results
from epdem.theory.indentation import VICKERS

ROOT = Path(__file__).parents[2]
STEEL_CASE = ROOT / "cases/steel_wall.toml"
SPEEDS = [0.2, 1.0, 5.0]
STEEL = {"young_modulus": 208e9, "poisson_ratio": 0.3, "density": 7850.0, "yield_stress": "1 GPa"}


@pytest.fixture
def ball():
    """Steel, R = 10 mm, on a plane, as numbers of a program."""
    return Case(
        case={"name": "ball"},
        materials={"steel": STEEL},
        impact={
            "kind": "sphere-wall",
            "body": {"radius": 0.01, "material": "steel"},
            "target": {"material": "steel"},
            "speeds": np.array(SPEEDS),
        },
        law={"name": "thornton", "yield_pressure": pint.UnitRegistry().Quantity(2.8, "GPa")},
    )


@pytest.fixture(scope="module")
def steel():
    return Case.from_toml(STEEL_CASE).replace({"impact.speeds": [1.0, 5.0]})


def test_the_values_of_a_case_are_read_by_their_keys_in_si(ball):
    assert ball["law.yield_pressure"] == 2.8e9 and ball["law.name"] == "thornton"
    assert ball["materials.steel.yield_stress"] == 1e9 and ball["materials.steel.density"] == 7850.0
    assert ball["impact.body.radius"] == 0.01 and ball["impact.speeds"][1] == 1.0
    scene = Scene.from_toml(ROOT / "cases/hopper_beads.toml")
    assert scene["scene.kind"] == "hopper" and scene["output.rows"] > 0 and scene["numerics.seed"] == 1
    for key in ("impact.body.radious", "impact.speeds.9"):
        with pytest.raises(CaseError, match=r"the nearest: impact|is not given"):
            ball[key]
    ratio = ball.replace(law={"name": "thornton", "yield_pressure_ratio": 2.8})
    with pytest.raises(CaseError, match=r"'law.yield_pressure' is not given and has no default; the law has law"):
        ratio["law.yield_pressure"]
    assert ratio["law.yield_pressure_ratio"] == 2.8
    assert ball.replace(law={"name": "johnson"})["law.yield_pressure_ratio"] == 3.0  # a default


def test_a_case_of_plain_values_is_the_case_of_the_file(ball):
    file = Case.from_toml(ROOT / "cases/steel_wall.toml")
    same = file.replace({"impact.speeds": SPEEDS, "law.yield_pressure": 2.8e9})
    assert same.model.impact == ball.model.impact and same.model.materials == ball.model.materials
    assert predict(same).equals(predict(ball))
    assert "# Tolerances" in same.text and file.model.law.parameters() == {"yield_pressure_ratio": 2.8}


def test_the_prediction_is_the_table_of_reference_values_with_units(ball):
    """e_n of eq. 8.83 printed with 13 digits for speeds of 0.2, 1 and 5 m/s."""
    found = predict(ball)
    assert found["e_n"].to_numpy() == pytest.approx([1, 0.9476311322744, 0.6763264338717], abs=1e-13)
    assert found.attrs["units"]["contact_time"] == "s" and "e_n" not in found.attrs["units"]
    assert predict(ball, "hertz")["e_n"].tolist() == [1, 1, 1]
    assert theory.__name__ == "epdem.theory"


def test_what_is_wrong_says_where(ball):
    with pytest.raises(CaseError, match=r"nearest: impact\.body\.radius"):
        ball.replace({"impact.radius": 1.0})
    with pytest.raises(CaseError, match="poisson_ratio = 30"):
        ball.replace({"materials.steel.poisson_ratio": 30})
    with pytest.raises(CaseError, match=r"^ball: law\.name = 'toffee'"):
        run(ball, engines=["embedded"], laws=["toffee"])
    with pytest.raises(CaseError, match="impact is missing"):
        Case(materials={})


def command(name, case, folder, *words):
    """What a command for a case says; its results are in the folder `b`."""
    path = case.to_toml(folder / "ball.toml")
    done = CliRunner().invoke(app, [name, str(path), "-o", str(folder / "b"), *words], catch_exceptions=False)
    assert done.exit_code == 0
    return done.stdout


def test_run_and_command_give_the_same(ball, tmp_path):
    found = run(ball, engines=["embedded"], out=tmp_path / "a")
    said = json.loads(command("run", ball, tmp_path, "-e", "embedded", "--json"))
    rows = pd.DataFrame(said["rows"])
    pd.testing.assert_frame_equal(found.table[rows.columns], rows, check_dtype=False)
    assert found.passed is said["passed"] is True
    assert found.table.attrs["units"]["force_max_theory"] == "N" and "<table" in found._repr_html_()
    picture = found.plot()
    drawn = picture.read_bytes()
    other = run(ball, engines="embedded", laws="hertz", out=tmp_path / "a")  # one name needs no list
    for again in (found, other):  # anew at each call
        picture.write_text("no picture")
        assert again.plot() == picture and picture.read_bytes() == drawn  # of a test: empty


def test_the_page_of_one_speed_has_one_share_of_the_energy_of_waves(steel, tmp_path):
    found = run(steel.replace({"impact.speeds": [3.0]}), engines="embedded", out=tmp_path)
    (share,) = re.findall(r"an estimated (.*?) % of the kinetic", write_page(found.outcome).read_text())
    assert float(share) > 0


def test_a_table_of_a_scene_has_the_units_of_the_columns_of_every_wall():
    table = pd.DataFrame([[1.0, 2.0, 3.0]], columns=["lid_force_z", "bowl_torque_x", "delta_max_floor"])
    scene = SceneRun(SimpleNamespace(results=SimpleNamespace(tables={"rows": table})))
    assert scene.tables["rows"].attrs["units"] == {"lid_force_z": "N", "bowl_torque_x": "N m", "delta_max_floor": "m"}


def test_sweep_and_command_give_the_same_table(ball, tmp_path):
    radii = np.array([0.001, 0.002])
    found = sweep(ball, {"impact.body.radius": radii}, engines=["embedded"], out=tmp_path / "a", jobs=1)
    command("sweep", ball, tmp_path, "--set", "impact.body.radius=0.001 m,0.002 m", "-e", "embedded")
    assert (tmp_path / "a/sweep.csv").read_bytes() == (tmp_path / "b/sweep.csv").read_bytes()
    assert found.table["impact.body.radius"].unique() == pytest.approx(radii)
    assert found._repr_html_().count("<tr") == 1 + len(found.table)


def test_deck_and_command_write_the_same_files(ball, tmp_path):
    command("deck", ball, tmp_path)
    for file in deck(ball, tmp_path / "a"):
        assert file.read_text() == (tmp_path / "b" / file.name).read_text()
    scene = Scene.from_toml(ROOT / "cases/compaction_powder.toml")
    assert "in.scene" in {p.name for p in deck(scene, tmp_path / "c")}
    assert scene.replace({"scene.count": 7}).model.scene["count"] == 7 and scene.model.scene["count"] == 1500


def test_compaction_and_index_are_replaced_like_all_keys(ball):
    press = Scene.from_toml(ROOT / "cases/compaction_powder.toml").replace(law={"name": "cavity"})
    grown = press.replace({"law.compaction": True})
    assert grown.model.law.parameters() == {"compaction": True}
    assert grown.replace({"law.compaction": False}).model.law.parameters() == {"compaction": False}
    hard = ball.replace(law={"name": "meyer", "hardening_exponent": 0.1}).replace({"law.meyer_index": 2.3})
    assert hard.model.law.parameters() == {"meyer_index": 2.3}
    with pytest.raises(CaseError, match=r"^compaction_powder: law.compaction: law meyer has none"):
        grown.replace({"law.name": "meyer"})
    with pytest.raises(CaseError, match=r"^ball: law.hardening_exponent: law thornton has no such parameter"):
        ball.replace(law={"name": "thornton", "hardening_exponent": 0.1})


def test_cases_do_not_change_and_show_themselves(ball):
    known = {ball: 1, ball.replace({"impact.body.radius": 0.02}): 2}
    assert known[ball.replace({"impact.body.radius": 0.01})] == 1 and len(known) == 2
    for path in (ROOT / "cases").glob("*.toml"):
        case = (Scene if "[scene]" in path.read_text() else Case).from_toml(path)
        assert len({case, case.replace({})}) == 1
    ratio = ball.replace(law={"name": "thornton", "yield_pressure_ratio": 2})
    assert len({ratio, ball.replace(law={"name": "thornton", "yield_pressure_ratio": 2.0})}) == 1
    assert ball == ball.replace({}) and ball != ball.replace({"impact.body.radius": 0.02})
    assert "ball" in repr(ball) and "<pre>" in ball._repr_html_()


def test_impacts_are_read_as_they_ran(steel, tmp_path):
    ran = run(steel, engines="embedded", laws=["thornton", "hertz"], out=tmp_path / "a")
    found = read(str(tmp_path / "a"))
    pd.testing.assert_frame_equal(found.comparison, ran.table)
    assert found.comparison.attrs["units"]["force_max"] == "N" and found.passed is ran.passed is True
    assert {"comparison", "impacts", "predictions", "paths"} <= {*dir(found)}
    assert found.impacts.groupby(["law", "engine"]).size().tolist() == [16, 16]  # 2 speeds, 8 phases
    assert set(found.predictions["law"]) == {"thornton", "hertz"} and found.text == steel.text
    pd.testing.assert_frame_equal(read(tmp_path / "a/results.h5").paths, found.paths)
    for shown in (repr(found), repr(ran)):
        assert shown.splitlines()[0] == "impacts steel_wall: passed" and len(shown.splitlines()) == 2
    with pytest.raises(AttributeError, match="no table 'rows'; there are comparison, impacts"):
        found.rows  # noqa: B018


def test_a_scene_is_read_with_a_table_for_each_attribute(tmp_path):
    tables = {
        "rows": pd.DataFrame({"step": [0, 1], "time": [0.0, 0.5], "kinetic_energy": [1.0, 2.0]}),
        "checks": pd.DataFrame({"check": ["load"], "key": ["load"], "value": [1.0], "passed": [False]}),
    }
    made = scene_results.SceneResults("text", {"case": "bed", "engine": "liggghts"}, tables)
    with scene_results.h5.new_file(tmp_path / "results.h5") as file:
        scene_results.h5.write_attributes(file, {"kind": "scene", **made.attributes})
        scene_results.h5.write_text(file, "case", "text")
        for name, table in tables.items():
            scene_results.h5.write_table(file.create_group(name), table, {})
    found = read(tmp_path)
    assert found.rows["kinetic_energy"].tolist() == [1.0, 2.0] and found.rows.attrs["units"]["time"] == "s"
    assert {"rows", "checks"} <= {*dir(found)} and found.passed is False
    assert repr(found).splitlines()[0] == "scene bed: not passed"


def test_a_sweep_is_read_and_has_a_page(steel, tmp_path):
    ran = sweep(steel, {"impact.body.radius": [0.001, 0.002]}, engines="embedded", out=tmp_path / "s", jobs=1)
    found = read(tmp_path / "s")
    pd.testing.assert_frame_equal(found.points, ran.table)
    assert found.passed and "2 done of 2 points" in repr(ran) and len(repr(ran).splitlines()) == 2
    page = ran.report()
    assert page == tmp_path / "s/report.html" and "Sweep of steel_wall" in page.read_text()


def test_a_folder_without_results_is_named(tmp_path):
    with pytest.raises(CaseError, match=f"{tmp_path}: no results.h5 and no sweep"):
        read(tmp_path)


def test_the_strength_from_a_measurement(steel, tmp_path):
    """e_n of the case itself gives back its 2.8 GPa; HV 100 is 1.0785 kgf/mm^2 times 100 of mean pressure."""
    table = predict(steel.replace({"impact.speeds": [5.0]}))
    found = calibrate(steel, e_n=float(table["e_n"][0]), speed="5 m/s")
    assert found.parameter == "yield_pressure" and found.value == pytest.approx(2.8e9, rel=1e-6)
    assert calibrate(STEEL_CASE, e_n=[np.float64(table["e_n"][0])], speed=[5.0]).value == pytest.approx(2.8e9, rel=1e-6)
    johnson = steel.replace(law={"name": "johnson"})
    assert calibrate(johnson, hv=100).value == pytest.approx(100 * VICKERS, rel=1e-12)
    (tmp_path / "curve.csv").write_text("depth [um],force [N]\n" + "".join(f"{d},{f}\n" for d, f in curve(steel)))
    assert calibrate(steel, indentation=tmp_path / "curve.csv").value == pytest.approx(2.8e9, rel=1e-3)


def curve(case):
    """Thornton's backbone: Hertz up to the pressure p_y, then F = F_y + pi p_y R* (alpha - alpha_y)."""
    E, R, p = 208e9 / (2 * (1 - 0.3**2)), 0.01, 2.8e9
    start = (np.pi * p / (2 * E)) ** 2 * R
    for depth in np.linspace(0.2, 60, 100) * 1e-6:
        hertz = 4 / 3 * E * np.sqrt(R) * min(depth, start) ** 1.5
        yield 1e6 * depth, hertz + np.pi * p * R * max(depth - start, 0.0)


def test_the_blocks_of_the_page_run(tmp_path):
    found = blocks("studies")
    first = next(n for n, (_, text) in enumerate(found) if "from epdem import Case, predict, run, sweep" in text)
    assert "from epdem import calibrate, read" in found[first + 1][1]
    play(found[first : first + 2], tmp_path)


CASES = ROOT / "cases"
SCENE = CASES / "settle_glass.toml"
BOWL = Scene.from_toml(CASES / "impactor_bowl.toml")
RADIUS = "impact.body.radius"


def test_the_path_of_a_file_is_a_case(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    expected = Case.from_toml(STEEL_CASE)
    assert predict(str(STEEL_CASE)).equals(predict(expected)) and predict(STEEL_CASE).equals(predict(expected))
    assert run(STEEL_CASE, engines="embedded", out=tmp_path / "a").table["e_n"].size == predict(expected)["speed"].size
    assert "in.scene" in {path.name for path in deck(SCENE, tmp_path / "b")}
    found = sweep(str(STEEL_CASE), {RADIUS: 0.002}, engines="embedded", out=tmp_path / "c", jobs=1)
    assert found.table[RADIUS].unique().tolist() == [0.002]


def test_one_value_of_a_key_needs_no_list(steel, tmp_path):
    for value in (0.001, np.float64(0.001), np.array(0.001), "1 mm", ["1 mm"], (0.001,)):  # one point: it runs once
        found = sweep(steel, {RADIUS: value}, engines="embedded", out=tmp_path / "a", jobs=1)
        assert found.table[RADIUS].unique().tolist() == [0.001], value


WRONG = {  # what the sentence holds, of a case and a folder
    r"^a: no such file": lambda c, p: run("a"),
    r"^case = 3: of type int; must be the path of a file or folder": lambda c, p: predict(3),
    "of type Scene; give a Case": lambda c, p: predict(Scene.from_toml(SCENE)),
    "type Scene; give a Case": lambda c, p: predict(SCENE),
    "of type Case; give a Scene": lambda c, p: calibrate(c, {"x": 1}, {"y": "1..2"}),
    "law = 3: of type int; must be a text in quotes": lambda c, p: predict(c, 3),
    r"^ranks = '2': of type str; must be a whole number": lambda c, p: run(c, ranks="2"),
    "^ranks = 0: of type int; must be at least 1": lambda c, p: run(c, ranks=0),
    "ranks = 1.5: of type float": lambda c, p: sweep(c, {RADIUS: 1e-3}, ranks=1.5),
    "jobs = '2': of type str": lambda c, p: sweep(c, {RADIUS: 1e-3}, jobs="2"),
    "latin_hypercube = '2'": lambda c, p: sweep(c, {RADIUS: "1 mm..2 mm"}, latin_hypercube="2"),
    "seed = 'x'": lambda c, p: sweep(c, {RADIUS: "1 mm..2 mm"}, latin_hypercube=2, seed="x"),
    "engines = 3: of type int; must be a list": lambda c, p: run(c, engines=3),
    "engines = None: of type NoneType": lambda c, p: run(c, engines=None),
    "engines = 3: of type int": lambda c, p: run(c, engines=["embedded", 3]),
    "laws = 3: of type int": lambda c, p: run(c, laws=[3]),
    "out = 3: of type int; must be the path": lambda c, p: run(c, out=3),
    "out = 3: of type int": lambda c, p: deck(c, 3),
    "settings = .*: of type list; must be a table": lambda c, p: sweep(c, [RADIUS]),
    "settings = 3: of type int; must be a text": lambda c, p: sweep(c, {3: [1]}),
    f"{RADIUS} = None: of type NoneType": lambda c, p: sweep(c, {RADIUS: None}),
    f"{RADIUS} = None: of type None": lambda c, p: sweep(c, {RADIUS: [1e-3, None]}),
    "targets = 3: of type int": lambda c, p: calibrate(SCENE, 3, {"y": "1..2"}),
    "scene.count = 5.*LOW..HIGH": lambda c, p: calibrate(SCENE, {"x": 1}, {"scene.count": 5}),
    "case = 'ball', must be a table": lambda c, p: c.replace(case="ball"),
    "law = 3, must be a table": lambda c, p: c.replace(law=3),
    "impact = None: of type NoneType": lambda c, p: Case(impact=None),
    "path = 3: of type int; must be the path": lambda c, p: Case.from_toml(3),
    "changes = 3: of type int; must be a table": lambda c, p: c.replace(3),
    f"{RADIUS} = 1j: of type complex": lambda c, p: c.replace({RADIUS: 1j}),
    f"nearest: {RADIUS}": lambda c, p: c.replace({RADIUS + ".x": 1}),
    r"no key 'scene\.body\.7\.radius'": lambda c, p: BOWL.replace({"scene.body.7.radius": 1}),
    "case = 3: of type int": lambda c, p: cite(3),
    "ranks 2: engine embedded runs on one rank": lambda c, p: run(c, engines="embedded", ranks=2, out=p),
    "engines 'nothing' does not exist": lambda c, p: run(c, engines="nothing", out=p),
    "it reads no deck; use engine liggghts or": lambda c, p: deck(c, p, engine="embedded"),
    "a sweep needs points: settings KEY=VALUES or --points": lambda c, p: sweep(c, {}, out=p),
    "give one measurement: e_n with speed, measured, hv, hb, or indentation": lambda c, p: calibrate(c),
    "speed: it belongs to e_n; leave it out": lambda c, p: calibrate(c, hv=200, speed="1 m/s"),
    "must be > 0": lambda c, p: calibrate(c, e_n=0.6, speed=-1.0),
    "vickers: no measurement of a Case; there are dent_ratio, e_n": lambda c, p: calibrate(c, vickers=200),
}


@pytest.mark.parametrize("says", WRONG)
def test_what_cannot_be_taken_is_refused_with_one_sentence(says, steel, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(CaseError, match=says) as raised:
        WRONG[says](steel, tmp_path)
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
    ball = {"name": "ball", "material": "steel", "radius": 3e-3, "position": np.array([0.0, 0.0, 0.03]), "phase": "hit"}
    assert BOWL.replace({"scene.body": [ball]}).model.scene.body[0].radius == 3e-3


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
    assert {"epdem", "liggghts"} <= set(found)
    assert found["law thornton, Thornton 1997"].startswith("C. Thornton, J. Appl")
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
