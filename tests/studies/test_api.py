# SPDX-License-Identifier: GPL-2.0-or-later
"""The Python interface does what the commands do, and cases are made of plain values."""

import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pint
import pytest
from test_guide import blocks, play

from epdem import Case, Scene, SceneRun, calibrate, deck, predict, read, run, sweep, theory
from epdem.errors import CaseError
from epdem.scenes.tables import results as scene_results
from epdem.theory.indentation import VICKERS

ROOT = Path(__file__).parents[2]
EPDEM = str(Path(sys.executable).parent / "epdem")
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
    with pytest.raises(
        CaseError, match=r"'law.yield_pressure' is not given and has no default; the law has law.yield_p"
    ):
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


def test_run_and_command_give_the_same(ball, tmp_path):
    found = run(ball, engines=["embedded"], out=tmp_path / "a")
    words = [
        EPDEM,
        "run",
        str(ball.to_toml(tmp_path / "ball.toml")),
        "-e",
        "embedded",
        "-o",
        str(tmp_path / "b"),
        "--json",
    ]
    said = json.loads(subprocess.check_output(words))
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


def test_a_table_of_a_scene_has_the_units_of_the_columns_of_every_wall():
    table = pd.DataFrame([[1.0, 2.0, 3.0]], columns=["lid_force_z", "bowl_torque_x", "delta_max_floor"])
    scene = SceneRun(SimpleNamespace(results=SimpleNamespace(tables={"rows": table})))
    assert scene.tables["rows"].attrs["units"] == {"lid_force_z": "N", "bowl_torque_x": "N m", "delta_max_floor": "m"}


def test_sweep_and_command_give_the_same_table(ball, tmp_path):
    radii = np.array([0.001, 0.002])
    found = sweep(ball, {"impact.body.radius": radii}, engines=["embedded"], out=tmp_path / "a", jobs=1)
    path = str(ball.to_toml(tmp_path / "ball.toml"))
    words = ["--set", "impact.body.radius=0.001 m,0.002 m", "-e", "embedded", "-o", str(tmp_path / "b")]
    subprocess.check_call([EPDEM, "sweep", path, *words], stdout=subprocess.DEVNULL)
    assert (tmp_path / "a/sweep.csv").read_bytes() == (tmp_path / "b/sweep.csv").read_bytes()
    assert found.table["impact.body.radius"].unique() == pytest.approx(radii)
    assert found._repr_html_().count("<tr") == 1 + len(found.table)


def test_deck_and_command_write_the_same_files(ball, tmp_path):
    path = str(ball.to_toml(tmp_path / "ball.toml"))
    subprocess.check_call([EPDEM, "deck", path, "-o", str(tmp_path / "b")], stdout=subprocess.DEVNULL)
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


STEEL_CASE = ROOT / "cases/steel_wall.toml"


@pytest.fixture(scope="module")
def steel():
    return Case.from_toml(STEEL_CASE).replace({"impact.speeds": [1.0, 5.0]})


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
