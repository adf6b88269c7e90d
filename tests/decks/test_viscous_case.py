# SPDX-License-Identifier: GPL-2.0-or-later
"""A dashpot and two materials in a case file: what reaches the deck, what is refused, who yields at what speed."""

import math
from pathlib import Path

import numpy as np
import pytest

from epdem.case.impact import parse
from epdem.case.toml import read_toml
from epdem.engines import engine
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from epdem.jobs.engine import check
from epdem.verification.models import engine as model

CASES = Path(__file__).parents[2] / "cases"
# yield stresses of the pair and how often the harder body's is the softer's
SOFT, HARD = 0.4e9, {"1.3 times": 0.52e9, "1.7 times": 0.68e9, "1.8 times": 0.72e9}


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
    """johnson: 3.0 Y_soft = 1.60 Y_hard at 1.875; meyer with x = 0.1: 2.8 Y q^0.1 has no limit."""
    for ratio, ends in ((1.86, False), (1.89, True)):
        found = predict(two_materials(ratio * SOFT, "johnson")).yield_speeds["hard"]
        assert (found == math.inf) == ends
    assert predict(two_materials(3 * SOFT, "meyer")).yield_speeds["hard"] == math.inf
    hard = two_materials(3 * SOFT, {"name": "meyer", "hardening_exponent": 0.1})
    q = (1.6 * 3 / 2.8) ** 10  # of the contact radius
    W = 1 + 2.5 * ((1 - 3 / 2.1) * (q**2 - 1) + 6 / (2.1 * 4.1) * (q**4.1 - 1))
    law = hard.theory()
    v_y = math.sqrt(2 * float(law.work(law.yield_overlap)) / hard.m_star)
    assert predict(hard).yield_speeds["hard"] == pytest.approx(v_y * math.sqrt(W), rel=1e-9)


@pytest.mark.parametrize("law", ["thornton", "cavity"])
def test_a_body_1_8_times_as_strong_never_yields(law):
    """2.8 Y_soft = 1.60 Y_hard at Y_hard = 1.75 Y_soft: beyond it the softer body alone flows."""
    p = predict(two_materials(HARD["1.8 times"], law))
    assert p.yield_speeds["hard"] == math.inf
    assert p.yields == ("soft",)
    assert predict(two_materials(HARD["1.7 times"], law)).yield_speeds["hard"] < math.inf


def test_in_the_cavity_phase_the_harder_body_yields_later_than_hertz_would_have_it():
    """There pressure grows more slowly with speed; the harder body's 1.60 Y comes at a higher speed than 8.84 says."""
    x = two_materials(HARD["1.3 times"], "cavity")
    speeds = predict(x).yield_speeds
    assert speeds["hard"] > speeds["soft"] * 1.3**2.5
    law = x.theory()
    top = law.overlap_of_work(np.array([0.5 * x.m_star * speeds["hard"] ** 2]))
    tau, mean = law.flatness(top), law.force(top) / (np.pi * law.radius(top) ** 2)
    # centre of half-ellipse and uniform pressure, each with its share of the mean
    assert mean * (1.5 * (1 - tau) + tau) == pytest.approx(1.60 * HARD["1.3 times"], rel=1e-9)
