# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program reads and is told: stored results by folder, two lines for each object, errors with its arguments."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from test_pages import blocks, play

from epdem import Case, calibrate, deck, predict, read, run, sweep
from epdem.errors import CaseError
from epdem.scenes.tables import results as scene_results
from epdem.theory.indentation import VICKERS

ROOT = Path(__file__).parents[2]
STEEL = ROOT / "cases/steel_wall.toml"


@pytest.fixture(scope="module")
def steel():
    return Case.from_toml(STEEL).replace({"impact.speeds": [1.0, 5.0]})


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
    assert calibrate(STEEL, e_n=[np.float64(table["e_n"][0])], speed=[5.0]).value == pytest.approx(2.8e9, rel=1e-6)
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


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda c, p: run(c, engines="embedded", ranks=2, out=p), "ranks 2: engine embedded runs on one rank"),
        (lambda c, p: run(c, engines="nothing", out=p), "engines 'nothing' does not exist"),
        (lambda c, p: deck(c, p, engine="embedded"), "it reads no deck; use engine liggghts or"),
        (lambda c, p: sweep(c, {}, out=p), "a sweep needs points: settings KEY=VALUES or --points"),
        (lambda c, p: calibrate(c), "give one measurement: e_n with speed, measured, hv, hb, or indentation"),
        (lambda c, p: calibrate(c, hv=200, speed="1 m/s"), "speed: it belongs to e_n; leave it out"),
        (lambda c, p: calibrate(c, vickers=200), "vickers: no measurement of a Case; there are dent_ratio, e_n"),
    ],
)
def test_an_error_names_arguments(call, said, steel, tmp_path):
    with pytest.raises(CaseError) as found:
        call(steel, tmp_path / "out")
    assert said in str(found.value)
