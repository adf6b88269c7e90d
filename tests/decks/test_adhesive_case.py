# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts with adhesion or a dashpot as cases: what is given how, what sticks or yields, and what is refused."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from epdem.case.impact import parse
from epdem.case.toml import read_toml
from epdem.engines import engine
from epdem.errors import CaseError
from epdem.impacts.engine import check_features
from epdem.impacts.experiment import experiment
from epdem.impacts.measurement import compare, measure
from epdem.impacts.plan import plan, search
from epdem.impacts.prediction import predict
from epdem.impacts.run import run
from epdem.jobs.engine import check
from epdem.verification.models import engine as model

CASE = Path(__file__).parents[2] / "cases" / "adhesion_thornton_1998.toml"
# e_n by an integration of the motion for p_y = 1 GPa, R 10 um, Gamma 0.2 J/m^2
SPEEDS = {0.02: 0.58302506, 0.05: 0.89379872, 0.1: 0.84720647, 0.3: 0.69885380, 1.0: 0.53459153, 10.0: 0.30370701}


def data(law=None, materials=None, **tables):
    """The case with other keys of its law and material, and other tables."""
    made = read_toml(CASE)
    made["law"] = law or made["law"]
    made["materials"]["steel"] |= materials or {}
    return made | tables


def made(*args, **kwargs):
    return experiment(parse(data(*args, **kwargs), CASE))


def test_the_prediction_is_that_of_the_published_case():
    speeds = [f"{v} m/s" for v in SPEEDS]
    x = made(impact=read_toml(CASE)["impact"] | {"speeds": speeds})
    p = predict(x)
    assert p.e_n == pytest.approx(list(SPEEDS.values()), abs=2e-6)
    assert any("Tabor's number is 1.5 (< 3)" in w for w in p.caveats) and p.yields == ("steel",)


def test_surface_energies_make_the_same_pair_and_both_are_too_many():
    law = {"name": "jkr"}
    one = made({"name": "jkr", "work_of_adhesion": "0.2 J/m^2"})
    assert made(law, {"surface_energy": "0.1 J/m^2"}).law.parameters == one.law.parameters
    uneven = data(law, {"surface_energy": "0.1 J/m^2"})
    uneven["materials"]["other"] = uneven["materials"]["steel"] | {"surface_energy": "0.4 J/m^2"}
    uneven["impact"]["target"]["material"] = "other"
    gamma = experiment(parse(uneven, CASE)).law.parameters["work_of_adhesion"]
    assert gamma == pytest.approx(2 * math.sqrt(0.1 * 0.4))


def test_yade_refuses_adhesion():
    with pytest.raises(CaseError, match="engine yade has no law with adhesion"):
        check_features(engine("yade"), made())


@pytest.mark.parametrize("law", ["jkr", "thornton_ning"])
def test_bodies_that_stick_have_no_restitution_are_counted_and_pass(law, tmp_path):
    text = CASE.read_text().replace("count = 16", "count = 6").replace("phases = 8", "phases = 4")
    text = re.sub(r'name = "thornton_ning"', f'name = "{law}"', text)
    text = text if law == "thornton_ning" else text.replace("yield_pressure_ratio = 2.8\n", "")
    path = tmp_path / "case.toml"
    path.write_text(text.replace("0.01 m/s", "0.005 m/s").replace("30 m/s", "5 m/s"))
    outcome = run(path, engines=[engine("embedded")], out=tmp_path / "out")
    rows = outcome.results.comparison
    assert outcome.passed and rows["stuck"].to_list() == [4, 0, 0, 0, 0, 0]
    assert rows["e_n"][0] == 0.0 and np.isinf(rows["contact_time"][0]) and rows["e_n_error"].max() < 1e-4
    assert rows["energy_residual"][1:].abs().max() < 1e-3


def test_soft_bodies_that_stick_and_yield_are_observed_beyond_their_largest_overlap():
    """Slow ones take longer to it than the contact lasts that barely lets go."""
    soft = {"young_modulus": "10 MPa", "yield_stress": "0.03 MPa", "density": "1200 kg/m^3"}
    impact = read_toml(CASE)["impact"] | {"speeds": ["0.01 m/s", "0.1 m/s", "1 m/s"]}
    x = made({"name": "thornton_ning", "work_of_adhesion": "0.05 J/m^2"}, soft, impact=impact)
    prediction = predict(x)
    p = plan(x, prediction)
    rows = compare("e", "l", measure(p, engine("embedded").run(p, Path())), prediction, x.check)
    assert prediction.sticks.all() and rows["force_max_error"].max() < 1e-3 and rows["passed"].all()


def test_a_law_that_lets_go_where_theory_sticks_fails():
    """And one that sticks where theory lets go."""
    x = made(impact=read_toml(CASE)["impact"] | {"speeds": ["0.01 m/s", "0.1 m/s"]})
    prediction = predict(x)
    p = plan(x, prediction)
    measured = measure(p, engine("embedded").run(p, Path()))
    assert compare("e", "l", measured, prediction, x.check)["passed"].all()
    wrong = measured.assign(e_n=measured["e_n"][::-1].to_numpy())
    assert not compare("e", "l", wrong, prediction, x.check)["passed"].any()


def test_the_step_for_an_error_is_found_with_speeds_that_stick():
    x = made(impact=read_toml(CASE)["impact"] | {"speeds": ["0.005 m/s", "0.05 m/s", "1 m/s"]})
    found = search(x, predict(x), 1e-3)
    assert found.error <= 1e-3 and 20 < found.steps_in_contact < 400


def test_the_law_of_the_case_keeps_its_numbers_if_it_is_named_and_others_have_their_own():
    law = {"name": "thornton", "yield_pressure": "3.2 GPa"}
    case = parse(read_toml(CASE.with_name("steel_wall.toml")) | {"law": law})
    assert [experiment(case, law).law.parameters["yield_pressure"] for law in (None, "thornton", "johnson")] == [
        pytest.approx(x) for x in (3.2e9, 3.2e9, 3e9)
    ]
    sticky = parse(read_toml(CASE))
    assert experiment(sticky, "jkr").law.parameters == {"work_of_adhesion": 0.2}
    assert "work_of_adhesion" not in experiment(sticky, "hertz").law.parameters


CASES = Path(__file__).parents[2] / "cases"
# yield stresses of the pair and how often the harder body's is the softer's
SOFT, HARD = 0.4e9, {"1.7 times": 0.68e9, "1.8 times": 0.72e9}


def viscous():
    return read_toml(CASES / "viscous_steel.toml")


def two_materials(hard, law):
    data = read_toml(CASES / "steel_wall.toml")
    base = data["materials"]["steel"]
    data["materials"] = {"hard": base | {"yield_stress": f"{hard} Pa"}, "soft": base | {"yield_stress": f"{SOFT} Pa"}}
    data["impact"] |= {"body": {"radius": "10 mm", "material": "hard"}, "target": {"material": "soft"}}
    data["law"] = {"name": law} if isinstance(law, str) else law
    return experiment(parse(data, "test"))


def test_a_deck_has_a_dashpot_only_if_the_case_asks(tmp_path):
    for file, expected in (("viscous_steel", True), ("steel_wall", False)):
        x = experiment(parse(read_toml(CASES / f"{file}.toml"), file))
        engine("liggghts").write(plan(x, predict(x)), tmp_path)
        deck = (tmp_path / "in.impact").read_text()
        assert deck.count("viscous on") == (2 if expected else 0)  # pair and wall agree
        assert ("coefficientRestitution peratomtypepair 1 0.9" in deck) is expected


@pytest.mark.parametrize("name", ["yade", "liggghts-hertz", "liggghts-thornton_ning"])
def test_an_engine_without_our_dashpot_says_so(name):
    x = experiment(parse(viscous(), "test"), "thornton")
    with pytest.raises(CaseError, match="--engine"):
        check(model(name), plan(x, predict(x)))


@pytest.mark.parametrize("law", ["thornton", "johnson"])
def test_while_elastic_each_body_yields_at_the_speed_of_its_own_pressure(law):
    """Eq. 8.84 with 1.60 Y of each body; the softer one's plastic pressure (2.8 or 3.0 Y) is not yet reached."""
    x = two_materials(HARD["1.7 times"], law)
    E, R, m = x.E_star, x.R_star, x.m_star
    speeds = predict(x).yield_speeds
    for name, Y in (("soft", SOFT), ("hard", HARD["1.7 times"])):
        p = 1.60 * Y
        v = (math.pi / (2 * E)) ** 2 * math.sqrt(8 * math.pi * R**3 * p**5 / (15 * m))
        assert speeds[name] == pytest.approx(v, rel=1e-12)


def test_the_pressure_of_the_softer_body_limits_the_yield_of_the_harder_one_as_the_law_does():
    """johnson: 3.0 Y_soft = 1.60 Y_hard at 1.875; meyer with x = 0: 2.8 Y."""
    for ratio, ends in ((1.86, False), (1.89, True)):
        found = predict(two_materials(ratio * SOFT, "johnson")).yield_speeds["hard"]
        assert (found == math.inf) == ends
    assert predict(two_materials(3 * SOFT, "meyer")).yield_speeds["hard"] == math.inf
    hard = two_materials(3 * SOFT, {"name": "meyer", "hardening_exponent": 0.1})  # 2.8 Y q^0.1 has no limit
    assert predict(hard).yield_speeds["hard"] < math.inf


@pytest.mark.parametrize("law", ["thornton", "cavity"])
def test_a_body_1_8_times_as_strong_never_yields(law):
    """2.8 Y_soft = 1.60 Y_hard at Y_hard = 1.75 Y_soft: beyond it the softer body alone flows."""
    p = predict(two_materials(HARD["1.8 times"], law))
    assert p.yield_speeds["hard"] == math.inf
    assert p.yields == ("soft",)
    assert predict(two_materials(HARD["1.7 times"], law)).yield_speeds["hard"] < math.inf
