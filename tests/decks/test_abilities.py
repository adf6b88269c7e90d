# SPDX-License-Identifier: GPL-2.0-or-later
"""An engine says what it can do, and refuses the rest in a sentence."""

from pathlib import Path

import psutil
import pytest

from epdem.base import processes
from epdem.base.declarations import declarations
from epdem.case.impact import parse
from epdem.case.toml import read_toml
from epdem.engines import ENGINES
from epdem.errors import CaseError, EngineError
from epdem.impacts.engine import check_plan
from epdem.impacts.experiment import experiment
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from epdem.jobs.engine import Feature, refusal
from epdem.jobs.stage import write_deck
from epdem.verification.models import OWN_LAW, SAME_LAW

ROOT = Path(__file__).parents[2]
ALL = ENGINES | SAME_LAW | OWN_LAW
SPHERES = {"kind": "sphere-sphere", "target": {"material": "steel", "radius": "4 mm"}}


def planned(changes=None, law=None):
    data = read_toml(ROOT / "cases/steel_wall.toml")
    changes = dict(changes or {})
    if (viscous := changes.pop("viscous", None)) is not None:
        data["viscous"] = {"restitution": viscous}
    data["impact"] |= {"speeds": ["1 m/s", "5 m/s"]} | changes
    data |= {"contact": {"friction": 0.3}} if "angles" in changes else {}
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
    with pytest.raises(CaseError, match=rf"law\.name = 'thornton': engine {name} has hertz only; use --eng"):
        check_plan(tool, p, prediction)


OBLIQUE = {"angles": ["20 deg"]}


@pytest.mark.parametrize(
    ("name", "lacks", "changes", "others"),
    [
        ("yade", Feature.FRICTION, OBLIQUE, "embedded or liggghts or lammps"),
        ("liggghts", Feature.SPHERE_FRICTION, OBLIQUE | SPHERES, "embedded or lammps"),
        ("embedded", Feature.DASHPOT, {"viscous": 0.9}, "liggghts or lammps"),
        ("lammps", Feature.POSITIONS, {"speeds": ["1e-13 m/s"]}, "embedded"),
        ("embedded", Feature.DECK, {}, "liggghts or yade or lammps"),
    ],
)
def test_a_refusal_names_the_engines_that_take_the_job(name, lacks, changes, others, tmp_path):
    """The names are written here, not read from the engines; tests without a mark have YADE without its module."""
    tool = ALL[name]()
    tool.features = tool.features ^ {lacks} if lacks in (Feature.FRICTION, Feature.DASHPOT) else tool.features
    p, prediction = planned(changes)
    with pytest.raises(CaseError) as found:
        write_deck(tool, p, tmp_path) if lacks is Feature.DECK else check_plan(tool, p, prediction)
    assert str(found.value).endswith(f" use --engine {others}")


def test_a_refusal_of_all_engines_names_none():
    reason = "--steps: three steps"
    found = refusal(ALL["yade"](), planned()[0], reason, fits=lambda features: False)
    assert str(found) == f"{reason}; no engine has it"


@pytest.mark.parametrize(
    ("name", "program", "package"),
    [("liggghts", "mpirun", "apt-get install openmpi-bin"), ("lammps", "mpiexec", "pip install .*mpich")],
)
def test_a_missing_program_of_ranks_is_answered_with_its_own_package(name, program, package, monkeypatch):
    monkeypatch.setattr("epdem.jobs.engine.shutil.which", lambda program: None)
    with pytest.raises(EngineError, match=f"--ranks needs .*{program}, which was not found; .*{package}"):
        check_plan(ALL[name](), *planned(), ranks=2)


@pytest.mark.parametrize(
    ("loads", "ranks", "job", "said"),
    [
        ([0, 100, 100, 50], 2, None, "about 1.0 of 2 cores free"),
        ([10, 100, 20, 0], 2, None, None),
        ([100, 0, 100, 0], 1, None, None),
        ([100, 0, 100, 0], 2, "7", None),
    ],
)
def test_ranks_that_exceed_the_free_cores_are_named(loads, ranks, job, said, monkeypatch):
    """Of four cores this process has the first and the third."""
    monkeypatch.setattr(psutil, "cpu_percent", lambda seconds, percpu: loads)
    monkeypatch.setattr(processes.os, "sched_getaffinity", lambda process: {0, 2})
    monkeypatch.delenv("SLURM_JOB_ID", raising=False)
    if job:
        monkeypatch.setenv("SLURM_JOB_ID", job)
    found = processes.crowded(ranks)
    assert found is None if said is None else said in found


def test_lammps_runs_impacts_on_walls_only():
    check_plan(ALL["lammps-mdr"](), *planned())
    with pytest.raises(CaseError, match="mdr is compared on walls"):
        check_plan(ALL["lammps-mdr"](), *planned(SPHERES))
