# SPDX-License-Identifier: GPL-2.0-or-later
"""An engine says what it can do, and refuses the rest in a sentence."""

from pathlib import Path

import pytest

from epdem.base.declarations import declarations
from epdem.case.impact import parse
from epdem.case.toml import read_toml
from epdem.engines import ENGINES
from epdem.errors import CaseError
from epdem.impacts.engine import check_plan
from epdem.impacts.experiment import experiment
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from epdem.jobs.engine import Feature
from epdem.verification.models import OWN_LAW, SAME_LAW

ROOT = Path(__file__).parents[2]
ALL = ENGINES | SAME_LAW | OWN_LAW
SPHERES = {"kind": "sphere-sphere", "target": {"material": "steel", "radius": "4 mm"}}


def planned(changes=None, law=None):
    data = read_toml(ROOT / "cases/steel_wall.toml")
    data["impact"] |= changes or {}
    x = experiment(parse(data, "test"), law)
    prediction = predict(x)
    return plan(x, prediction), prediction


def test_what_an_engine_names_exists():
    for tool in (kind() for kind in ALL.values()):
        assert set(tool.laws or ()) <= set(declarations()), tool.name
        assert tool.ranks >= 1 and tool.features <= set(Feature)


@pytest.mark.parametrize("name", ["embedded", "yade", "yade-luding", "lammps-mdr"])
def test_an_engine_of_one_rank_refuses_two(name):
    tool = ALL[name]()
    assert tool.ranks == 1
    with pytest.raises(CaseError, match=rf"--ranks 2: engine {name} runs on one rank"):
        check_plan(tool, *planned(), ranks=2)


@pytest.mark.parametrize("name", ["embedded", "liggghts", "yade"])
def test_a_law_that_an_engine_lacks_is_refused_in_a_sentence(name):
    tool = ALL[name]()
    p, prediction = planned()
    check_plan(tool, p, prediction)
    tool.laws = ("hertz",)
    with pytest.raises(CaseError, match=rf"law\.name = 'thornton': engine {name} has hertz only; use another --eng"):
        check_plan(tool, p, prediction)


def test_lammps_runs_impacts_on_walls_only():
    check_plan(ALL["lammps-mdr"](), *planned())
    with pytest.raises(CaseError, match="mdr is compared on walls"):
        check_plan(ALL["lammps-mdr"](), *planned(SPHERES))


def test_positions_limit_only_engines_that_have_them():
    p, prediction = planned({"speeds": ["1e-13 m/s"]})
    check_plan(ALL["embedded"](), p, prediction)
    with pytest.raises(CaseError, match="not representable by positions"):
        check_plan(ALL["liggghts"](), p, prediction)
