# SPDX-License-Identifier: GPL-2.0-or-later
"""A measured e_n or a hardness gives back the strength it came from."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from epdem.case.impact import load
from epdem.cli.main import app
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.impacts.prediction import predict
from epdem.laws.library import laws
from epdem.report.page import write
from epdem.studies.calibrate import from_hardness, from_restitution
from epdem.studies.hardness import hardness_test
from epdem.studies.pages import impacts as pages
from epdem.theory.adhesion import yield_speed
from epdem.theory.indentation import Indentation
from studies.test_soften import CASES, RATE, STEEL, with_law


@pytest.mark.parametrize("law", sorted(n for n, info in laws().items() if info.parameters and not info.adheres))
@pytest.mark.parametrize("times", [2.0, 10.0, 100.0])
def test_the_strength_found_from_e_n_is_the_one_that_made_it(law, times, tmp_path):
    x = experiment(load(with_law(tmp_path, law)))
    backbone = x.theory()
    speed = times * float(np.sqrt(2 * backbone.work(backbone.yield_overlap) / x.m_star))
    path = with_law(tmp_path, law, re.sub(r"speeds = .*", f'speeds = ["{speed} m/s"]', STEEL.read_text()))
    x = experiment(load(path))
    found = from_restitution(path, float(predict(x).e_n[0]), speed)
    # near v_y e_n hardly depends on the strength: a rounding error of theory is amplified a thousandfold
    assert math.isclose(found.value, min(x.law.strengths), rel_tol=1e-7)
    assert math.isclose(found.yield_stress, x.body.yield_stress, rel_tol=1e-7)


def test_the_strength_of_an_adhesive_law_is_found_from_e_n(tmp_path):
    path = with_law(tmp_path, "thornton_ning")
    x = experiment(load(path))
    e_n = float(predict(replace(x, speed=np.array([3.0]))).e_n[0])
    found = from_restitution(path, e_n, 3.0)
    assert math.isclose(found.value, min(x.law.strengths), rel_tol=1e-7)
    assert math.isclose(found.yield_speed, float(yield_speed(x.theory(), m_star=x.m_star)), rel_tol=1e-6)


def test_the_strength_that_grows_with_the_rate_is_found_at_the_rate_of_the_measurement(tmp_path):
    """A case with [rate] and one speed: the strength of its file is that at the reference rate."""
    path = tmp_path / "rated.toml"
    text = re.sub(r"speeds = .*", 'speeds = ["3 m/s"]', STEEL.read_text())
    path.write_text(f"{text}\n{RATE}")
    e_n = float(predict(experiment(load(path))).e_n[0])
    assert math.isclose(from_restitution(path, e_n, 3.0).yield_stress, 1e9, rel_tol=1e-7)
    assert from_hardness(path, Indentation(2.8e9, 0.36), "HV").value == pytest.approx(2.8e9, rel=2e-3)


def pyramid_of_the_cavity(E, nu, slope):
    """(p_m/Y at each Y/E, Y/E) of the expanding cavity: plastic radius from the volume, then core and mean pressure."""
    c = np.geomspace(1.01, 200, 200_001)  # plastic over contact radius
    strain = slope / 2 / (3 * (1 - nu) * c**3 - 2 * (1 - 2 * nu))  # Y/E
    return 2 / 3 + 2 * np.log(c) + 2 / 3, strain


@pytest.mark.parametrize(("hardness", "constraint"), [(100, 2.8), (300, 2.8), (600, 2.717), (675, 2.620), (955, 2.332)])
def test_the_yield_stress_of_a_vickers_hardness_is_that_of_the_expanding_cavity(hardness, constraint, tmp_path):
    edge = 1e-3  # of the square that a pyramid with 136 degrees between opposite facets leaves [m]
    slant_height = edge / 2 / math.sin(math.radians(136 / 2))
    load = hardness * 9.80665e6 * 4 * (edge * slant_height / 2)
    pressure = load / edge**2
    found = from_hardness(with_law(tmp_path, "cavity"), hardness_test(vickers=hardness), "HV").value
    assert pressure / found == pytest.approx(constraint, abs=6e-4)
    ratio, strain = pyramid_of_the_cavity(208e9, 0.3, math.tan(math.radians(19.7)))
    expected = np.interp(pressure, (np.minimum(ratio, 2.8) * strain * 208e9)[::-1], strain[::-1] * 208e9)
    assert found == pytest.approx(expected, rel=1e-4)  # 1.8544 has five digits


@pytest.mark.parametrize("ratio", [0.24, 0.375, 0.6])
def test_a_hard_steel_under_a_ball_has_the_constraint_of_its_own_dent(ratio, tmp_path):
    test = hardness_test(brinell=800, dent_ratio=ratio)
    assert test.slope == ratio
    found = from_hardness(with_law(tmp_path, "cavity"), test, "HB 800").value
    shares, strain = pyramid_of_the_cavity(208e9, 0.3, ratio)
    expected = np.interp(test.pressure, (np.minimum(shares, 2.8) * strain * 208e9)[::-1], strain[::-1] * 208e9)
    assert found == pytest.approx(expected, rel=1e-4)


def test_a_law_of_a_contact_pressure_has_the_measured_mean_pressure_in_the_hardness_test(tmp_path):
    """thornton: F = pi a^2 p_y - pi a_y^2 p_y/3 beyond yield; johnson's mean pressure is its strength."""
    test, E_star = hardness_test(vickers=955), 208e9 / (1 - 0.3**2)
    for law in ("thornton", "thornton_ning"):
        found = from_hardness(with_law(tmp_path, law), test, "HV 955").value
        a_y = math.pi * found / (2 * E_star)  # of R* = 1
        assert found * (1 - (a_y / test.slope) ** 2 / 3) == pytest.approx(test.pressure, rel=1e-9)
        assert 1.01 < found / test.pressure < 1.02
    assert from_hardness(with_law(tmp_path, "johnson"), test, "HV 955").value == pytest.approx(test.pressure, rel=1e-12)


def test_the_hardness_is_that_of_the_softer_body():
    soft = from_hardness(CASES / "leeb_D.toml", hardness_test(vickers=955), "HV 955").value
    assert soft == pytest.approx(4.3305e9, rel=1e-4)  # E = 208 GPa; the carbide ball has 600 GPa


@pytest.mark.parametrize("ratio", [1e-9, 0.01, 0.24, 0.375, 0.6, 1.0])
def test_brinell_hardness_is_the_load_on_the_cap_and_the_mean_pressure_that_on_its_circle(ratio):
    radius = 5e-3
    depth = 2 * radius * math.sin(math.asin(ratio) / 2) ** 2
    load = 200 * 9.80665e6 * 2 * math.pi * radius * depth
    mean = load / (math.pi * (ratio * radius) ** 2)
    assert math.isclose(hardness_test(brinell=200, dent_ratio=ratio).pressure, mean, rel_tol=1e-9)
    assert hardness_test(brinell=200) == hardness_test(brinell=200, dent_ratio=0.375)


def test_a_brinell_indentation_has_a_diameter():
    done = CliRunner().invoke(app, ["calibrate", str(STEEL), "--hb", "200", "--dent-ratio", "0"])
    assert "--dent-ratio 0, must lie in (0, 1]" in str(done.exception)


def test_the_page_of_a_strength_shows_the_curve_through_the_measured_point(tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(pages, "write", lambda path, page: drawn.append(page()) or write(path, page))
    words = ["calibrate", str(STEEL), "--e-n", "0.6", "--speed", "5 m/s", "--out", str(tmp_path / "page")]
    assert "page/report.html" in CliRunner().invoke(app, words).stdout
    text = (tmp_path / "page/report.html").read_text()
    line, point = drawn[0].parts[0].panels[0].series
    assert (point.x, point.y) == pytest.approx((5.0, 0.6)) and max(line.y) > 0.9 > 0.3 > min(line.y)
    assert np.interp(5.0, line.x, line.y) == pytest.approx(0.6, abs=1e-3)
    assert "C. Thornton, J. Appl. Mech. 64 (1997) 383" in text and "Y = 1e+09" not in text
    foreign = tmp_path / "mine"
    foreign.mkdir()
    (foreign / "report.html").write_text("mine")
    assert "--force" in str(CliRunner().invoke(app, [*words[:-1], str(foreign)]).exception)
    assert (foreign / "report.html").read_text() == "mine"


@pytest.mark.parametrize("words", [["--hv", "1e9"], ["--hv", "1e-5"], ["--hb", "1e9"]])
def test_a_hardness_beyond_the_modulus_is_refused_with_its_unit(words):
    error = CliRunner().invoke(app, ["calibrate", str(STEEL), *words]).exception
    assert isinstance(error, CaseError) and "must lie between 1e-08 and 0.1" in str(error)
    assert f"{words[0].upper()[2:]} {float(words[1]):g}: " in str(error) and "kgf/mm^2" in str(error)


def test_impossible_measurements_are_refused(tmp_path):
    for e_n, speed in ((0.0, 1.0), (1.0, 1.0), (0.6, -1.0), (1e-7, 1.0)):
        with pytest.raises(CaseError, match=r"must lie in|must be > 0|no strength between 1e-08 and 1 of E"):
            from_restitution(STEEL, e_n, speed)
    with pytest.raises(CaseError, match="never yields; it has nothing to calibrate"):
        from_restitution(with_law(tmp_path, "hertz"), 0.6, 1.0)
    with pytest.raises(CaseError, match="give one hardness, --hv or --hb"):
        hardness_test()
