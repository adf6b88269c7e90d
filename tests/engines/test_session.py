# SPDX-License-Identifier: GPL-2.0-or-later
"""A LIGGGHTS that runs deck after deck gives what a process for each gives; a deck that fails loses no other."""

from pathlib import Path

import numpy as np
import pytest

from epdem.base.processes import session
from epdem.case.impact import load
from epdem.engines import engine
from epdem.engines.liggghts.engine import Liggghts
from epdem.engines.liggghts.launcher import Session
from epdem.errors import EngineError, Stopped
from epdem.impacts.experiment import experiment
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from epdem.studies.sweep import run as study

pytestmark = pytest.mark.liggghts
CASES = Path(__file__).parents[2] / "cases"


@pytest.fixture
def kept():
    found = Session()
    yield found
    found.stop()


def test_decks_of_several_cases_one_after_the_other_give_the_same_bits(tmp_path):
    tool, alone, pids = engine("liggghts", stay=True), engine("liggghts"), set()
    names = ["steel_wall", "johnson_wall", "two_materials", "viscous_steel", "cavity_wall", "steel_wall"]
    for k, name in enumerate(names):
        x = experiment(load(CASES / f"{name}.toml"))
        p = plan(x, predict(x), time_step=predict(x).contact_time.min() / 60)
        for t in (tool, alone):
            t.write(p, tmp_path / t.name / f"{k}" / str(t is tool))
        one, other = (t.run(p, tmp_path / t.name / f"{k}" / str(t is tool)) for t in (tool, alone))
        for column in ("overlap", "force", "velocity"):
            assert np.array_equal(getattr(one, column), getattr(other, column), equal_nan=True), name
        assert one.seconds["stepping"] > 0
        pids.add(tool.session._process.pid)
    assert len(pids) == 1
    tool.session.stop()
    assert not session(pids.pop())


def deck(folder: Path, text: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "in.x").write_text(text)
    return folder


def test_a_deck_that_fails_says_why_and_the_next_one_runs(tmp_path, kept):
    kept.run("in.x", deck(tmp_path / "a", 'print "first"\n'), log="log", seconds=60)
    first = kept._process.pid
    with pytest.raises(EngineError, match=r"out\.liggghts: ERROR: Unknown command: nonsense"):
        kept.run("in.x", deck(tmp_path / "b", "nonsense\n"), log="log", seconds=60)
    assert not session(first)
    kept.run("in.x", deck(tmp_path / "c", 'print "third"\n'), log="log", seconds=60)
    said = [(tmp_path / name / "out.liggghts").read_text() for name in "ac"]
    assert said[0].endswith("first\n") and said[1].endswith("third\n") and "first" not in said[1]
    assert "third" in (tmp_path / "c/log").read_text() and kept._process.pid != first


def test_a_deck_that_does_not_end_is_stopped_and_so_is_one_that_we_leave(tmp_path, kept, monkeypatch):
    endless = 'label again\nprint "on"\njump in.x again\n'
    with pytest.raises(EngineError, match=r"did not end within 0\.5 s"):
        kept.run("in.x", deck(tmp_path / "a", endless), log="log", seconds=0.5)
    assert kept._process is None

    def interrupt(piece):
        raise Stopped

    kept.run("in.x", deck(tmp_path / "b", 'print "b"\n'), log="log", seconds=60)
    pid = kept._process.pid
    monkeypatch.setattr(kept, "_read", lambda: interrupt(None))
    with pytest.raises(Stopped):
        kept.run("in.x", deck(tmp_path / "c", endless), log="log", seconds=60)
    assert not session(pid)


def test_a_folder_whose_name_no_deck_can_have_gets_a_process_of_its_own(tmp_path, kept):
    for name in ("a", "b c $d #e &", "f"):
        kept.run("in.x", deck(tmp_path / name, "shell touch here\n"), log="log", seconds=60)
        assert (tmp_path / name / "here").exists()


def test_a_point_that_fails_in_the_engine_loses_no_other(tmp_path, monkeypatch):
    real = Liggghts.write

    def write(self, p, folder):
        files = real(self, p, folder)
        if p.experiment.body.radius == 0.002:
            files[0].write_text(files[0].read_text().replace("timestep", "nonsense"))
        return files

    monkeypatch.setattr(Liggghts, "write", write)
    planned = study.plan(
        CASES / "steel_wall.toml", {"impact.body.radius": "1 mm,2 mm,5 mm", "impact.speeds": [["5 m/s"]]}
    )
    found = study.run(planned, tmp_path / "out", jobs=1).table
    assert found["status"].tolist() == ["done", "failed", "done"]
    assert "thornton/liggghts/out.liggghts: ERROR: Unknown command: nonsense" in found["reason"][1]
    assert found["passed"].tolist() == [True, False, True]
    logs = [p.read_text(errors="replace") for p in tmp_path.glob("out/points/*/thornton/liggghts/log.liggghts")]
    assert len(logs) == 3 and not any("LIGGGHTS (Version" in text for text in logs)  # which a new process says
