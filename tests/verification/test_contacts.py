# SPDX-License-Identifier: GPL-2.0-or-later
"""The tests of plastic contacts that other codes can run: their references, and our engines against them."""

import importlib.util
import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from engines.hosts import CLASSES, LIGGGHTS
from epdem.errors import CaseError
from epdem.theory import restitution
from epdem.theory.meyer import Meyer
from epdem.verification import contacts

ROOT = Path(__file__).parents[2]
spec = importlib.util.spec_from_file_location("plastic_contacts", ROOT / "bench/plastic_contacts.py")
made = importlib.util.module_from_spec(spec)
spec.loader.exec_module(made)
FILES = {path.stem: path for path in contacts.stored_tests()}
PAGE = (ROOT / "docs/evidence.md").read_text()


def numbers(text):
    return np.array(re.findall(r"-?\d+\.?\d*(?:e[-+]\d+)?", text), float)


def test_the_files_are_what_the_closed_forms_give():
    cases = made.cases()
    assert set(cases) == set(FILES) and len(cases) == 10
    for name, (text, table) in cases.items():
        for suffix, new in ((".yaml", text), (".csv", table)):
            stored = FILES[name].with_suffix(suffix).read_text()
            assert re.sub(r"[-\d.e+]+", "", new) == re.sub(r"[-\d.e+]+", "", stored), name
            assert np.allclose(numbers(new), numbers(stored), rtol=1e-9, atol=1e-9), name


def thornton_1997(ratio):
    """Eq. 8.83 of Seville and Wu for v/v_y >= 1."""
    y = 1 / ratio
    root = y / (y + 2 * np.sqrt(1.2 - 0.2 * y * y))
    return np.sqrt(1.2 * np.sqrt(3)) * np.sqrt(1 - y * y / 6) * root**0.25


def test_the_restitutions_of_the_files_are_those_of_the_literature():
    tests = {name: contacts.read_test(path) for name, path in FILES.items()}
    expected = {"1_below_yield": 1.0} | {
        name: thornton_1997(ratio)
        for name, ratio in {
            "2_at_yield": 1,
            "3_ten_times_yield": 10,
            "4_hundred_times_yield": 100,
            "6_unloading": 30,
        }.items()
    }
    expected["5_two_impacts"] = thornton_1997(10) * thornton_1997(10 * thornton_1997(10))
    hard = Meyer(E_star=made.E_STAR, R_star=made.R_STAR, p_y=made.P_Y, x=0.25)
    speed = 2 * tests["8_hardening"].value("vin")
    expected["8_hardening"] = restitution.e_n(hard, m_star=made.MASS / 2, speed=speed)
    shown = dict(re.findall(r"^\| (\w+) .*e_n = ([\d.]+) ", PAGE, re.M))
    assert {name: float(e_n) for name, e_n in shown.items()} == {
        name: pytest.approx(expected[name], abs=6e-5) for name in shown
    } and len(shown) == 6
    for name, e_n in expected.items():
        assert abs(tests[name].value("en") - e_n) < 1e-9, name
    for name in ("3_ten_times_yield", "4_hundred_times_yield", "8_hardening"):  # the work of the forces of the motion
        motion, loads = tests[name].motion, tests[name].reference
        apart = np.linalg.norm(motion.place[:, 0] - motion.place[:, 1], axis=1)
        force = np.linalg.norm(loads.force[:, 0], axis=1)
        work = np.diff(-apart) * (force[1:] + force[:-1]) / 2
        assert abs(np.sqrt(-work[work < 0].sum() / work[work > 0].sum()) - expected[name]) < 2e-3, name


@pytest.mark.parametrize(("name", "ratio"), [("9_grazing", 2), ("10_two_materials", 5)])
def test_grazing_spheres_lose_energy_and_turn_as_friction_throughout_turns_them(name, ratio):
    """A steady line of centres gives the spin 2.5 mu (1 + e_n) v_n/R; it turns, so that the impact is weaker."""
    test = contacts.read_test(FILES[name])
    v_n, v_t, R = test.value("vn_in"), test.value("vt_in"), test.value("radius")
    v, spin = (test.table(key)[0, 2:] for key in ("run_vel", "run_omega"))
    impulse = made.FRICTION * (1 + thornton_1997(ratio)) * v_n  # over the mass
    lost = v_n**2 + v_t**2 - v @ v - 0.4 * R**2 * spin @ spin
    assert 0 < lost < v_n**2 + 2 * impulse * (v_t - 1.75 * impulse)
    turned = -spin[2] * R / (2.5 * impulse)
    assert 0 < turned < 1 and (name == "9_grazing" or turned > 0.99)


def test_the_embedded_engine_passes_and_a_wrong_law_fails(tmp_path):
    assert contacts.compare(engines=["embedded"], out=tmp_path / "right").passed
    folder = tmp_path / "wrong"
    folder.mkdir()
    for name in ("1_below_yield", "4_hundred_times_yield"):
        shutil.copy(FILES[name].with_suffix(".csv"), folder)
        text = FILES[name].read_text().replace("thornton ${emod} ${poisson} ${pyield}", "hertz ${emod} ${poisson}")
        (folder / f"{name}.yaml").write_text(text)
    found = contacts.compare(sorted(folder.glob("*.yaml")), engines=["embedded"], out=tmp_path / "out").rows
    assert list(found["passed"]) == [True, True, False, True]  # no torque in either
    spring = FILES["7_oblique"].read_text().replace("partial_slip", "history")  # one spring without partial slip
    (folder / "7_oblique.yaml").write_text(spring)
    shutil.copy(FILES["7_oblique"].with_suffix(".csv"), folder)
    found = contacts.compare([folder / "7_oblique.yaml"], engines=["embedded"], out=tmp_path / "spring").rows
    assert not found["passed"].any() and abs(found["error"][0] - 0.045) < 1e-3


def test_the_comparison_of_the_page_runs(monkeypatch):
    monkeypatch.chdir(ROOT)
    exec(re.search(r"^```python.*?\n(.*?)^```$", PAGE, re.M | re.S)[1], {})


@pytest.mark.slow
@pytest.mark.parametrize("host", [LIGGGHTS, CLASSES])
def test_a_host_passes(host, tmp_path):
    found = contacts.compare(engines=[host], out=tmp_path / "out")
    assert found.passed and len(found.rows) == 20, found.rows


@pytest.mark.lammps
def test_lammps_passes(tmp_path):
    found = contacts.compare(engines=["lammps"], out=tmp_path / "out")
    assert found.passed and (found.rows["quantity"] == "e_n").sum() == 7, found.rows
    limits = found.rows.groupby("quantity")["error"].max()
    assert limits["e_n"] < 5e-6 and limits["spin"] < 6e-3


@pytest.mark.lammps
@pytest.mark.parametrize("name", ["3_ten_times_yield", "4_hundred_times_yield"])
def test_hertz_of_lammps_fails(name, tmp_path):
    test = contacts.read_test(FILES[name])
    words = "* * hertz/material ${emod} 0.0 ${poisson} tangential linear_nohistory 0 0"
    own = {"pair_style": "granular", "pair_coeff": words}
    found = contacts.dynamic_errors(replace(test, keys=test.keys | own), tmp_path)
    assert found["e_n"][0] > 0.5 and found["velocity"][0] > 0.5  # it rebounds without loss
    shown = float(re.search(r"tests 3 and 4 .*\| ([\d.]+), ([\d.]+): fails", PAGE)[1 + (name[0] == "4")])
    assert abs(found["e_n"][0] / shown - 1) < 0.05


def test_incomplete_files_are_refused(tmp_path):
    for name in ("broken.yaml", "broken.csv"):
        shutil.copy(FILES["3_ten_times_yield"].with_suffix(Path(name).suffix), tmp_path / name)
    yaml, table = tmp_path / "broken.yaml", tmp_path / "broken.csv"
    text, rows = yaml.read_text(), table.read_text()
    yaml.write_text(text.replace("pair_coeff", "pair_coefficient"))
    with pytest.raises(CaseError, match="pair_coeff missing"):
        contacts.read_test(yaml)
    yaml.write_text(text.replace("force_tol", "tolerance"))
    with pytest.raises(CaseError, match="force_tol is missing"):
        contacts.compare([yaml], engines=["embedded"], out=tmp_path / "out")
    yaml.write_text("- 1\n")
    with pytest.raises(CaseError, match="not a mapping with the keys variables"):
        contacts.read_test(yaml)
    yaml.write_text("a: [")
    with pytest.raises(CaseError, match="not YAML"):
        contacts.read_test(yaml)
    yaml.write_text(text)
    table.write_text(rows.replace(",F_i,F_j,T_i,T_j", ""))
    with pytest.raises(CaseError, match="F_i, F_j, T_i, T_j missing"):
        contacts.read_test(yaml)
