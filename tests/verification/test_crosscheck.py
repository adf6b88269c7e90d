# SPDX-License-Identifier: GPL-2.0-or-later
"""The cross-code table: our model gives one impact in every variant of its set-up, thornton_ning does not."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from epdem.case.impact import load
from epdem.engines.lammps.engine import Lammps
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.impacts.measurement import measure
from epdem.impacts.plan import plan
from epdem.verification.commands import app
from epdem.verification.engine_comparison import crosscheck
from epdem.verification.models import OWN_LAW, engine
from epdem.verification.models.theories import Mdr
from epdem.verification.models.theories import prediction as theory_of
from epdem.verification.variants import VARIANTS, examine, unequal_spheres
from marks import thorough

CASES = Path(__file__).parents[2] / "cases"
STEEL = CASES / "steel_wall.toml"
LAWS = ("hertz", "thornton", "johnson", "cavity")
CLOSED = [name for name in OWN_LAW if name != "lammps-mdr"]
in_liggghts, in_yade = pytest.mark.liggghts, pytest.mark.yade("module")
in_lammps = pytest.mark.lammps


@pytest.mark.parametrize("host", [pytest.param("liggghts", marks=in_liggghts), pytest.param("lammps", marks=in_lammps)])
@pytest.mark.parametrize("law", [thorough(law, unless=law in ("thornton", "cavity")) for law in LAWS])
def test_restitution_and_momentum_do_not_depend_on_the_variant_of_the_set_up(law, host, tmp_path):
    """Swap, sort, migration and restart repeat every bit of e_n; momentum is kept to round-off of drifting bodies."""
    found = examine(engine(host), experiment(load(STEEL), law), tmp_path)
    assert {variant: found[variant] for variant in VARIANTS} == dict.fromkeys(VARIANTS, 0)
    assert found["momentum"] < 1e-11
    assert found["unequal_error"] < 5e-5  # 400 steps in contact


@in_yade
@pytest.mark.parametrize("law", LAWS)
def test_restitution_in_yade_does_not_depend_on_names_or_on_a_restart_in_mid_contact(law, tmp_path):
    """The other half of a restarted run is a process of its own that knows what O.save wrote."""
    found = examine(engine("yade"), experiment(load(STEEL), law), tmp_path)
    assert found["swap"] == found["restart"] == 0 and found["momentum"] < 1e-11
    assert math.isnan(found["sort"]) and math.isnan(found["migration"])
    assert found["unequal_error"] < 5e-5  # as in LIGGGHTS
    assert (tmp_path / "restart/middle.yade.gz").exists()


@in_liggghts
def test_thornton_ning_depends_on_order_and_owners(tmp_path):
    """The comparison would be worth nothing if the scene could not tell."""
    found = examine(engine("liggghts-thornton_ning"), experiment(load(STEEL)), tmp_path)
    assert found["swap"] > 0.01 and found["sort"] > 0.01
    assert found["momentum"] > 0.01
    assert found["unequal_error"] > 0.01


@in_liggghts
def test_edinburgh_forgets_its_dent_when_atoms_are_sorted_while_they_part(tmp_path):
    """It turns the sign of its largest overlap; luding, which does not, keeps every bit."""
    x = experiment(load(STEEL))
    found = {name: examine(OWN_LAW[name](), x, tmp_path / name) for name in ("liggghts-edinburgh", "liggghts-luding")}
    assert found["liggghts-edinburgh"]["sort"] > 0.01
    assert all(found["liggghts-luding"][variant] == 0 for variant in VARIANTS)


@pytest.mark.parametrize("case", ["steel_wall", "two_materials", "pair"])
@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.yade if n.startswith("yade") else in_liggghts) for n in CLOSED]
)
def test_laws_of_others_have_their_own_closed_restitution(name, case, tmp_path):
    """At 400 steps in contact velocity Verlet leaves 2e-5 of e_n; the contact ends within a step, 1/400."""
    x = experiment(load(CASES / f"{case}.toml")) if case != "pair" else pair_of_two_materials()
    x = replace(x, speed=x.speed[np.linspace(0, x.speed.size - 1, 8).round().astype(int)])
    tool = OWN_LAW[name]()
    prediction = theory_of(tool, x)
    p = plan(x, prediction)
    tool.write(p, tmp_path)
    found = measure(p, tool.run(p, tmp_path))
    for quantity, limit in {"e_n": 4e-5, "contact_time": 1e-4, "force_max": 2e-5, "overlap_max": 2e-5}.items():
        theory = np.repeat(getattr(prediction, quantity), p.phases)
        assert np.abs(getattr(found, quantity) / theory - 1).max() < limit, quantity
    if name.endswith("luding") and case == "steel_wall":  # both branches of the law are seen
        assert prediction.e_n[0] > 0.99 and prediction.e_n.min() < 0.5 < prediction.e_n[-1]


@in_lammps
def test_mdr_of_lammps_has_its_own_theory_while_its_radius_does_not_grow(tmp_path):
    """It takes the first step after yielding for the yield overlap: of first order, 2.3e-3 of overlap_max at 400 steps.
    Up to 6 m/s its apparent radius grows by less than 1e-5 of the radius, which is 1e-3 of the overlap."""
    tool = OWN_LAW["lammps-mdr"]()
    x = experiment(load(STEEL))
    x = replace(x, speed=x.speed[x.speed < 6])
    prediction = theory_of(tool, x)
    p = plan(x, prediction)
    tool.write(p, tmp_path)
    found = measure(p, tool.run(p, tmp_path))
    for quantity in ("e_n", "contact_time", "force_max", "overlap_max"):
        theory = np.repeat(getattr(prediction, quantity), p.phases)
        assert np.abs(getattr(found, quantity) / theory - 1).max() < 3.5e-3, quantity
    assert prediction.e_n[0] == pytest.approx(1, rel=1e-8) and prediction.e_n[-1] < 0.8


def test_mdr_knows_rigid_flats_only():
    with pytest.raises(CaseError, match="on walls"):
        Mdr.of(pair_of_two_materials())


def pair_of_two_materials():
    return unequal_spheres(experiment(load(CASES / "two_materials.toml")))


def test_run_refuses_a_law_that_is_not_the_case_s():
    with pytest.raises(CaseError, match=r"law of its own.*crosscheck"):
        engine("liggghts-luding")


def with_speeds(case, count):
    """The text of a case with fewer speeds in the same range."""
    return re.sub(r"(speeds = .*count = )\d+", rf"\g<1>{count}", case.read_text())


def crosschecked(text, folder, monkeypatch):
    """The document of `epdem verify crosscheck` for a case."""
    monkeypatch.chdir(folder)
    Path("steel.toml").write_text(text)
    done = CliRunner().invoke(app, ["verify", "crosscheck", "steel.toml", "--json"])
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


@in_liggghts
@in_yade
@pytest.mark.thorough
def test_crosscheck_tells_our_second_order_from_a_wrong_limit(tmp_path, monkeypatch):
    document = crosschecked(with_speeds(STEEL, 8), tmp_path, monkeypatch)
    rows = {row["model"]: row for row in document["rows"]}
    for name in ("liggghts", "yade"):
        assert rows["theory"]["e_n"] == pytest.approx(rows[name]["e_n"], rel=1e-4)
        assert rows[name]["order"] == pytest.approx(2, abs=0.3) == rows["embedded"]["order"]
        assert rows[name]["swap"] == rows[name]["restart"] == 0
    assert abs(rows["liggghts-thornton_ning"]["order"]) < 0.1
    assert math.isclose(rows["liggghts-thornton_ning"]["e_n_error"], 0.081, rel_tol=0.05)
    for name in CLOSED:
        assert rows[name]["e_n"] == pytest.approx(rows[name]["e_n_theory"], rel=4e-5)
        assert rows[name]["e_n"] != pytest.approx(rows["theory"]["e_n"], rel=0.1)  # another law
        assert document["notes"][name]
    assert (tmp_path / "runs/crosscheck/steel_wall/e_n.png").exists()
    page = (tmp_path / "runs/crosscheck/steel_wall/report.html").read_text()
    assert "All models" in page and all(f"{name}</td>" in page for name in rows)


@in_liggghts
@in_yade
@pytest.mark.thorough
def test_engines_that_cannot_run_the_case_are_left_out_with_their_reason(tmp_path, monkeypatch):
    """Models of other codes do not have our dashpot."""
    document = crosschecked(with_speeds(CASES / "viscous_steel.toml", 3), tmp_path, monkeypatch)
    shown = [row["model"] for row in document["rows"]]
    assert shown[:3] == ["theory", "embedded", "liggghts"] and ("lammps" in shown) == (Lammps().missing() is None)
    assert set(shown[3:]) <= {"lammps", "yade"}  # yade where epdem_yade is built
    assert "dashpot" in document["absent"]["yade-luding"]


@in_liggghts
@pytest.mark.parametrize(("tolerance", "code"), [thorough("1e-3", 0), ("1e-6", 1)])
def test_the_exit_code_and_the_verdict_are_about_our_engines_alone(tolerance, code, tmp_path, monkeypatch):
    """At 400 steps in contact e_n of the law is off by 2e-5, and that of thornton_ning by 8e-2: it is another model."""
    text = with_speeds(STEEL, 6)
    assert text.count("e_n = 1e-4") == 1
    (tmp_path / "steel.toml").write_text(text.replace("e_n = 1e-4", f"e_n = {tolerance}"))
    words = ["verify", "crosscheck", "steel.toml", "-e", "embedded", "-e", "liggghts-thornton_ning", "-o", "out"]
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, words)
    assert done.exit_code == code, done.output
    checks = pd.read_csv(tmp_path / "out/crosscheck.csv").set_index("model")["check"]
    assert checks["liggghts-thornton_ning"] == "other code: outside" and checks["embedded"] == ("pass", "fail")[code]
    page = (tmp_path / "out/report.html").read_text()
    assert ("All checks hold" in page, "A check fails" in page) == ((True, False), (False, True))[code]
    assert "Models of other codes outside of the tolerances of the case: liggghts-thornton_ning." in page


def test_crosscheck_is_a_function_of_python(tmp_path):
    (tmp_path / "steel.toml").write_text(with_speeds(STEEL, 3))
    found = crosscheck(tmp_path / "steel.toml", engines=["embedded"], out=tmp_path / "out")
    assert found.passed and list(found.table["model"]) == ["theory", "embedded"]
    with pytest.raises(CaseError, match="--engine 'abaqus' does not exist; there are embedded, liggghts"):
        crosscheck(STEEL, engines=["abaqus"], out=tmp_path)
