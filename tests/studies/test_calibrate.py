# SPDX-License-Identifier: GPL-2.0-or-later
"""A measured e_n or a hardness gives back the strength it came from."""

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from epdem.base.declarations import declarations
from epdem.case.impact import load
from epdem.cli.main import app
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.impacts.prediction import predict
from epdem.studies.calibrate import (
    from_hardness,
    from_indentation,
    from_restitution,
    from_restitutions,
    hardness_test,
    measured_restitutions,
    summary,
)
from epdem.theory.adhesion import yield_speed
from epdem.theory.indentation import Indentation
from studies.test_soften import CASES, RATE, STEEL, with_law


@pytest.mark.parametrize("law", sorted(n for n, info in declarations().items() if info.parameters and not info.adheres))
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


@pytest.mark.parametrize(("factor", "said"), [(0.4, True), (0.6, False), (1.8, False), (2.5, True)])
def test_a_strength_far_from_that_of_the_material_is_said(factor, said, tmp_path):
    """e_n of a material that is `factor` times as strong, as made by theory."""
    path = with_law(tmp_path, "thornton")
    x = experiment(load(path))
    made = replace(x, law=x.law.of(*(factor * s for s in x.law.strengths)), speed=np.array([50.0]))
    found = from_restitution(path, float(predict(made).e_n[0]), 50.0)
    assert found.value == pytest.approx(factor * min(x.law.strengths), rel=1e-6)
    assert [f"is {factor:.3g} times the" in w and "may be viscous" in w for w in found.warnings] == [True] * said


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
    with pytest.raises(CaseError, match="give one hardness, --hv or --hb"):
        hardness_test()


E_STAR, MASS = 208e9 / (2 * (1 - 0.3**2)), 4 / 3 * math.pi * 0.01**3 * 7850.0  # of the steel case


def hardening_metal(p_y, x, *sizes):
    """(speed [m/s], e_n) of `meyer` at q = a/a_y: e_n^2 = (F/F_y)^2/(q W/W_y), (v/v_y)^2 = W/W_y."""
    v_y = (math.pi / (2 * E_STAR)) ** 2 * math.sqrt(8 * math.pi * 0.01**3 * p_y**5 / (15 * MASS))
    points = []
    for q in sizes:
        F = 1 + 3 / (2 + x) * (q ** (2 + x) - 1)
        W = 1 + 2.5 * ((1 - 3 / (2 + x)) * (q**2 - 1) + 6 / ((2 + x) * (4 + x)) * (q ** (4 + x) - 1))
        points.append((v_y * math.sqrt(W), F / math.sqrt(q * W)))
    return points


@pytest.mark.parametrize(("p_y", "x"), [(1.2e9, 0.25), (3e8, 0.05), (2e9, 0.6)])
@pytest.mark.parametrize("sizes", [(3, 12), (2, 4, 8, 16)])
def test_strength_and_hardening_exponent_are_found_from_several_restitutions(p_y, x, sizes, tmp_path):
    measured = hardening_metal(p_y, x, *sizes)
    found = from_restitutions(with_law(tmp_path, "meyer"), measured, 0.003)
    assert (found.value, found.hardening_exponent) == pytest.approx((p_y, x), rel=1e-5)
    assert found.largest_residual < 1e-3 and found.measured == tuple(measured)


def test_standard_errors_are_those_of_fits_to_shifted_measurements(tmp_path):
    path, measured, sigma = with_law(tmp_path, "meyer"), hardening_metal(1.2e9, 0.25, 2, 5, 16), 0.01
    found = from_restitutions(path, measured, sigma)
    shifts = []
    for k in range(3):
        both = []
        for sign in (1, -1):
            moved = [(v, e + sign * 0.01 * sigma * (j == k)) for j, (v, e) in enumerate(measured)]
            other = from_restitutions(path, moved, sigma)
            both.append([math.log(other.value), other.hardening_exponent])
        shifts.append(np.subtract(*both) / 0.02)
    covariance = np.transpose(shifts) @ shifts
    errors = np.sqrt(np.diag(covariance))
    assert found.standard_errors == pytest.approx([errors[0] * found.value, errors[1]], rel=1e-2)
    assert found.correlation == pytest.approx(covariance[0, 1] / errors.prod(), abs=1e-3)


def test_the_scatter_of_three_or_more_restitutions_gives_their_uncertainty(tmp_path):
    path, exact = with_law(tmp_path, "meyer"), hardening_metal(1.2e9, 0.25, 2, 4, 8, 16)
    noisy = [(v, e + d) for (v, e), d in zip(exact, (0.01, -0.012, -0.008, 0.009), strict=True)]
    free = from_restitutions(path, noisy)
    p_y, x = free.value, free.hardening_exponent
    q = np.geomspace(1, 100, 20_001)
    curve = np.array(hardening_metal(p_y, x, *q))
    residuals = [e - np.interp(v, *curve.T) for v, e in noisy]
    scatter = math.sqrt(sum(r**2 for r in residuals) / 2)  # four values, two unknowns
    assert free.largest_residual == pytest.approx(max(map(abs, residuals)) / scatter, rel=1e-3)
    assert f"scatter of e_n about the fit {scatter:.2g}, to be compared" in summary(free)[0]
    given = from_restitutions(path, noisy, scatter)
    assert "scatter" not in summary(given)[0]
    assert free.standard_errors == pytest.approx(given.standard_errors, rel=1e-3)
    assert free.value == pytest.approx(given.value)


def test_the_command_takes_several_restitutions_or_those_of_the_case(tmp_path):
    measured = hardening_metal(1.2e9, 0.25, 3, 6, 12)
    path = with_law(tmp_path, "meyer")
    options = [word for v, e in measured for word in ("--speed", f"{v!r} m/s", "--e-n", repr(e))]
    many = CliRunner().invoke(app, ["calibrate", str(path), *options, "--uncertainty", "0.01", "--json"])
    speeds, e_n = [f"{v!r} m/s" for v, _ in measured], [e for _, e in measured]
    path.write_text(path.read_text() + f'\n[measured]\nsource = "me"\nspeeds = {speeds}\ne_n = {e_n}\n')
    words = ["calibrate", str(path), "--measured", "--uncertainty", "0.01"]
    curve = CliRunner().invoke(app, words)
    found = json.loads(many.stdout)
    assert found["value"] == pytest.approx(1.2e9) and found["hardening_exponent"] == pytest.approx(0.25)
    (low, high), (least, most) = found["intervals"]
    said = f"1200 MPa ({low / 1e6:.4g} to {high / 1e6:.4g} MPa), hardening_exponent = 0.25 ({least:.3g} to {most:.3g})"
    assert said in " ".join(curve.stdout.split())


@pytest.mark.thorough
def test_intervals_hold_the_true_numbers_in_95_of_100_calibrations(tmp_path):
    """Three e_n leave one degree of freedom for their scatter: one or two standard errors hold 50 and 70 %."""
    path, exact = with_law(tmp_path, "meyer"), hardening_metal(1.2e9, 0.25, 2, 5, 16)
    draws = np.random.default_rng(1).normal(0.0, 0.01, (80, 3))
    held = np.zeros(2)
    for draw in draws:
        found = from_restitutions(path, [(v, e + d) for (v, e), d in zip(exact, draw, strict=True)])
        (low, high), (least, most) = found.intervals
        assert low < found.value < high and least <= found.hardening_exponent <= most
        held += [low < 1.2e9 < high, least < 0.25 < most]
    assert (np.abs(held - 0.95 * 80) < 6).all()  # three standard deviations of the binomial distribution


def test_intervals_of_a_known_uncertainty_are_those_of_a_normal_distribution(tmp_path):
    path, exact = with_law(tmp_path, "meyer"), hardening_metal(1.2e9, 0.25, 2, 5, 16)
    noisy = [(v, e + d) for (v, e), d in zip(exact, (0.01, -0.012, 0.002), strict=True)]
    for uncertainty, k, said in (
        (0.001, 1.959964, "normal distribution"),
        (None, math.tan(0.475 * math.pi), "Student's t, 1 degree of freedom"),  # the quantile of Cauchy's distribution
    ):
        found = from_restitutions(path, noisy, uncertainty)
        (low, high), (_, most) = found.intervals
        error = found.standard_errors[0] / found.value
        assert (math.log(high / found.value), math.log(found.value / low)) == pytest.approx((k * error, k * error))
        expected = min(found.hardening_exponent + k * found.standard_errors[1], 1.0)
        assert most == pytest.approx(expected, abs=2e-3)
        sentence = summary(found)[0]
        for part in (f"95 % confidence intervals, {said}", f"{low / 1e6:.4g} to {high / 1e6:.4g} MPa"):
            assert part in sentence


def test_a_metal_that_hardly_hardens_is_calibrated_where_noise_lets_e_n_fall_faster_than_without_hardening(tmp_path):
    """x = 0, noise of half a standard error: the closest exponent is 0, and the interval ends above it."""
    path, exact = with_law(tmp_path, "meyer"), hardening_metal(1.2e9, 0.0, 2, 5, 16)
    noisy = [(v, e + d) for (v, e), d in zip(exact, (0.005, 0.0, -0.005), strict=True)]
    found = from_restitutions(path, noisy, 0.01)
    (low, high), (least, most) = found.intervals
    assert found.hardening_exponent == least == 0.0 < most < 0.1 and low < 1.2e9 < high
    steep = [(v, e + d) for (v, e), d in zip(exact, (0.05, 0.0, -0.05), strict=True)]
    with pytest.raises(CaseError, match="e_n falls faster than law meyer allows"):
        from_restitutions(path, steep, 0.01)


def test_restitutions_above_1_by_noise_are_data(tmp_path):
    """Noise of both signs near yield: the mean of the two calibrations is the true one."""
    path, (slow, *fast) = with_law(tmp_path, "meyer"), hardening_metal(1.2e9, 0.25, 1.1, 5, 16)
    noise = 1.004 - slow[1]
    up, down = (from_restitutions(path, [(slow[0], slow[1] + d), *fast], 0.01) for d in (noise, -noise))
    assert down.hardening_exponent - up.hardening_exponent > 0.04
    assert (up.hardening_exponent + down.hardening_exponent) / 2 == pytest.approx(0.25, abs=5e-4)
    assert math.sqrt(up.value * down.value) == pytest.approx(1.2e9, rel=3e-3)


def test_an_elastic_impact_of_the_case_takes_part_and_a_percentage_does_not(tmp_path):
    """Below first yield e_n of theory is 1 whatever the strength: a residual of 0.01, and nothing else."""
    path, fast = with_law(tmp_path, "meyer"), hardening_metal(1.2e9, 0.25, 3, 12)
    case = path.read_text()
    speeds = [f"{v!r} m/s" for v in (1e-3, *(v for v, _ in fast))]
    for slow in (0.99, 1.01):
        curve = f'[measured]\nsource = "me"\nspeeds = {speeds}\ne_n = {[slow, *(e for _, e in fast)]}\n'
        path.write_text(f"{case}\n{curve}")
        found = from_restitutions(path, measured_restitutions(path), 0.01)
        assert (found.value, found.hardening_exponent) == pytest.approx((1.2e9, 0.25), rel=1e-5)
        assert found.largest_residual == pytest.approx(1.0, rel=1e-6)
    path.write_text(path.read_text().replace("e_n = [1.01", "e_n = [1.3"))
    with pytest.raises(CaseError, match=r"measured.e_n.0 = 1.3, must lie in \[0, 1.2\]; percent\?"):
        measured_restitutions(path)


def test_a_law_that_hardens_has_the_measured_mean_pressure_in_the_hardness_test(tmp_path):
    """p_m = 2/3 p_y [1 + 3/(2+x) (q^(2+x) - 1)]/q^2 at q = (a/R) 2E*/(pi p_y), E* of a rigid indenter."""
    test = hardness_test(brinell=200, dent_ratio=0.4)
    for x in (0.1, 0.4):
        path = with_law(tmp_path, "meyer")
        path.write_text(path.read_text().replace('name = "meyer"\n', f'name = "meyer"\nhardening_exponent = {x}\n'))
        p_y = from_hardness(path, test, "HB 200").value
        q = 0.4 * 2 * 208e9 / (1 - 0.3**2) / (math.pi * p_y)
        assert 2 / 3 * p_y * (1 + 3 / (2 + x) * (q ** (2 + x) - 1)) / q**2 == pytest.approx(test.pressure, rel=1e-9)
        index = path.read_text().replace(f"hardening_exponent = {x}", f"meyer_index = {2 + x}")
        path.write_text(index)
        assert from_hardness(path, test, "HB 200").value == pytest.approx(p_y, rel=1e-12)


# law, options, what the command says. Far above yield e_n of meyer falls as v^(-(1-x)/(4+x)): as v^(-1/4) at most, from
# 0.69 at 1 m/s to 0.39 at 10 m/s. `hardest`, x = 0.9: p_m ~ p_y^0.1, so that 1e-8 E* still gives 6.2 times 1.06 GPa
FAST = "--speed 16.5m/s --e-n 0.4193"
TWO, KNOWN = f"--speed 0.851m/s --e-n 0.7057 {FAST}", "--uncertainty 0.01"
REFUSED = [
    ("thornton", "--hb 200 --dent-ratio 0", "--dent-ratio 0, must lie in (0, 1]"),
    ("thornton", "--hv 1e9", "HV 1e+09: ... must lie between 1e-08 and 0.1 ... kgf/mm^2"),
    ("thornton", "--hv 1e-5", "HV 1e-05: ... must lie between 1e-08 and 0.1 ... kgf/mm^2"),
    ("thornton", "--hb 1e9", "HB 1e+09: ... must lie between 1e-08 and 0.1 ... kgf/mm^2"),
    ("thornton", "--hv 200 --uncertainty 0.01", "--uncertainty: it belongs to --e-n and --measured"),
    ("thornton", "--speed 1m/s --e-n 0", "e_n = 0 at 1 m/s, must lie in (0, 1.2]"),
    ("thornton", "--speed 1m/s --e-n 1", "e_n = 1 at 1 m/s, must lie in (0, 1)"),
    ("thornton", "--speed 1m/s --e-n 1.01", "e_n = 1.01 at 1 m/s, must lie in (0, 1); ... take a faster impact"),
    ("thornton", "--speed=-1m/s --e-n 0.6", "--speed = '-1 m/s', must be > 0"),
    ("thornton", "--speed 1m/s --e-n 1e-7", "no strength between 1e-08 and 1 of E"),
    ("thornton", f"{TWO} {KNOWN}", "law thornton has one strength; give one e_n, or law.name = 'meyer'"),
    ("hertz", "--speed 1m/s --e-n 0.6", "never yields; it has nothing to calibrate"),
    ("meyer", "--speed 1m/s --e-n 69 --speed 10m/s --e-n 0.5", "e_n = 69 at 1 m/s, must lie in (0, 1.2]"),
    ("meyer", f"--speed 1m/s --e-n 0.69 --speed 10m/s --e-n 0.75 {KNOWN}", "toml: e_n hardly falls with speed; check"),
    ("meyer", f"--speed 1m/s --e-n 0.9 --speed 2m/s --e-n 0.9 {KNOWN}", "e_n hardly falls with speed; check speeds"),
    ("meyer", f"--speed 1m/s --e-n 0.5 --speed 10m/s --e-n 0.9 {KNOWN}", "e_n hardly falls with speed; check speeds"),
    ("meyer", f"--speed 1m/s --e-n 0.69 --speed 10m/s --e-n 0.3 {KNOWN}", "e_n falls faster than law meyer allows"),
    (
        "meyer",
        f"{FAST} --speed 18.2m/s --e-n 0.4151 {KNOWN}",
        "do not tell yield_pressure and hardening_exponent apart",
    ),
    ("meyer", f"{FAST} {FAST} {FAST} {KNOWN}", "these e_n do not tell"),
    ("meyer", TWO, "give --uncertainty"),
    ("meyer", f"{TWO} --uncertainty 2", "--uncertainty 2, must lie in (0, 1)"),
    (
        "hardest",
        "--hv 100",
        "HV 100: no yield_pressure above 1e-08 of E* = 2.29e+11 Pa gives 1.06e+09 Pa ... lower law.hard",
    ),
]


@pytest.mark.parametrize(("law", "options", "says"), REFUSED)
def test_a_measurement_that_gives_no_strength_is_refused_in_one_sentence(law, options, says, tmp_path):
    path = with_law(tmp_path, law.replace("hardest", "meyer"))
    if law == "hardest":
        path.write_text(path.read_text().replace('"meyer"\n', '"meyer"\nhardening_exponent = 0.9\n'))
    words = [word.replace("m/s", " m/s") for word in options.split()]
    error = CliRunner().invoke(app, ["calibrate", str(path), *words]).exception
    assert isinstance(error, CaseError) and "\n" not in str(error)
    assert re.search(".*".join(map(re.escape, says.split(" ... "))), str(error)), error


def indentation(tmp_path, p_y, noise=0.0, unit=(1e9, 1e3), deepest=100.0):
    """A curve of the steel sphere on the steel wall up to `deepest` yield overlaps and back, by thornton's lines."""
    E_star, R = 208e9 / 2 / (1 - 0.3**2), 0.01
    first = R * (math.pi * p_y / 2 / E_star) ** 2
    depth = np.linspace(0.0, deepest * first, 60)
    hertz = 4 / 3 * E_star * math.sqrt(R) * np.minimum(depth, first) ** 1.5
    force = hertz + math.pi * p_y * R * np.maximum(depth - first, 0.0)
    force *= 1 + noise * np.random.default_rng(1).standard_normal(depth.size)
    rows = [*zip(depth * unit[0], force * unit[1], strict=True), (0.9 * depth[-1] * unit[0], 0.1 * force[-1] * unit[1])]
    path = tmp_path / "curve.csv"
    path.write_text("depth [nm],force [mN]\n" + "\n".join(f"{a!r},{b!r}" for a, b in np.array(rows).tolist()))
    return path


def test_the_strength_of_an_indentation_curve_is_the_one_that_made_it(tmp_path):
    found = from_indentation(STEEL, indentation(tmp_path, 2.2e9))
    assert found.value == pytest.approx(2.2e9, rel=1e-5)
    assert from_indentation(STEEL, indentation(tmp_path, 2.2e9, noise=0.02)).value == pytest.approx(2.2e9, rel=0.01)
    said = CliRunner().invoke(app, ["calibrate", str(STEEL), "--indentation", str(tmp_path / "curve.csv")]).stdout
    assert "yield_pressure = 2" in said and "59 points of curve.csv" in said and "% of the largest force" in said


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("depth [nm],load [mN]\n1,1\n", "must be depth and force, as 'depth [nm],force [mN]'"),
        ("depth [nm],force [mN]\n1,1\n2,x\n3,1\n", "line 3: force = 'x'"),
        ("depth [nm],force [kg]\n1,1\n2,2\n", "has the wrong dimension"),
        ("depth [nm],force [mN]\n1,1\n2,2\n", "2 points of loading with a depth > 0, must be at least 3"),
        ("", "needs a line of heads and at least one row"),
    ],
)
def test_a_curve_that_cannot_be_read_is_named_with_its_line(text, words, tmp_path):
    path = tmp_path / "curve.csv"
    path.write_text(text)
    with pytest.raises(CaseError) as caught:
        from_indentation(STEEL, path)
    assert words in str(caught.value)


def test_an_elastic_curve_has_no_strength(tmp_path):
    with pytest.raises(CaseError, match="the curve is that of an elastic contact"):
        from_indentation(STEEL, indentation(tmp_path, 2.2e9, deepest=0.9))
