# SPDX-License-Identifier: GPL-2.0-or-later
"""`--engine yade`: a deck that runs by hand, and every way to fail."""

import ast
import os
import subprocess
import sys

import numpy as np
import pytest
from hosts import CASES, TARGETS, prepared, run
from test_stopping import alive, until

from epdem.base.rendering import render
from epdem.engines import engine
from epdem.engines.yade import engine as module
from epdem.engines.yade import launcher
from epdem.errors import CaseError, EngineError
from epdem.impacts import store
from epdem.impacts.engine import check_plan
from epdem.impacts.prediction import predict

NATIVE = launcher.module


def one_impact():
    return prepared(steps=20, impact={"speeds": ["1 m/s"]})[0]


@pytest.mark.yade("alone")
def test_the_deck_is_plain_travels_with_its_law_and_runs_by_hand(tmp_path):
    p, _ = prepared(law="cavity", steps=30, impact=TARGETS["sphere"] | {"speeds": ["3 m/s"]})
    files = engine("yade").write(p, tmp_path / "a")
    assert (tmp_path / "a/impact.py") in files and all(f.exists() for f in files)
    assert {"libepdem.so", "contacts.py"} <= {f.name for f in files}
    (tmp_path / "a").rename(tmp_path / "b")  # it knows no absolute path, and nothing of this package
    with (tmp_path / "b/impact.py").open("a") as deck:
        deck.write("print('YADE leaves a folder:', Path(O.tmpFilename()).parent.exists())\n")
    alone = {"PATH": os.environ["PATH"], "HOME": str(tmp_path)}
    done = subprocess.run(
        ["yade", "-n", "-x", "b/impact.py"],
        cwd=tmp_path,
        env=alone,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    assert "YADE leaves a folder: False" in done.stdout
    samples = np.load(tmp_path / "b/path.bin")
    assert samples.shape == (p.steps + 2, 3, 1, 2 * p.n) and samples[:, 2].max() > 0
    assert not list((tmp_path / "b").glob("*.part"))


def test_the_deck_computes_nothing_and_holds_every_digit(tmp_path):
    """Every number stands there whole: no product, no power, no sum of literals."""
    for kind, target in TARGETS.items():
        p, _ = prepared(law="cavity", impact=target)
        tree = ast.parse(text := render(module.Yade.template, deck=module.Yade().deck(p)))
        for node in ast.walk(tree):
            if isinstance(node, ast.BinOp) and ast.unparse(node.left) != "here":  # paths are joined with /
                numbers = [n for n in (node.left, node.right) if isinstance(n, ast.Constant)]
                assert not numbers, ast.unparse(node)
        assert repr(p.time_step) in text and repr(p.experiment.E_star) in text
        assert ("wall(0, axis=2" in text) == (kind != "sphere")


def test_what_yade_cannot_do_is_refused_before_it_starts():
    p, _ = prepared()
    with pytest.raises(CaseError, match="--ranks 2"):
        check_plan(engine("yade"), p, predict(p.experiment), ranks=2)


FAKE = {
    "raises": (
        "echo 'Traceback (most recent call last):'; echo 'RuntimeError: no such sphere'; exit 1",
        "exit code 1.*RuntimeError: no such sphere",
    ),
    "dies": ("echo half > path.bin.part; echo 'about to die'; kill -SEGV $$", "signal 11.*about to die"),
    "is silent": ("exit 0", "no complete result"),
    "half-writes": ("head -c 100 /dev/zero > path.bin", "no complete result"),
}


@pytest.fixture
def fake(tmp_path, monkeypatch):
    def install(body: str):
        program = tmp_path / "fake-yade"
        program.write_text("#!/bin/sh\n" + body + "\n")
        program.chmod(0o755)
        monkeypatch.setenv("EPDEM_YADE", str(program))

    return install


@pytest.mark.yade
@pytest.mark.parametrize("built_for", ["the program", "another one"])
def test_the_module_is_for_the_program_that_make_yade_was_called_with(built_for, fake, tmp_path, monkeypatch):
    """For another one decks call the C library, and the version in results and doctor says so."""
    fake('exec yade "$@"')
    monkeypatch.delenv("EPDEM_YADE_MODULE", raising=False)
    own = tmp_path / "own-yade"
    own.symlink_to(tmp_path / "fake-yade")
    monkeypatch.setenv("EPDEM_YADE", str(own))
    program = tmp_path / "fake-yade" if built_for == "the program" else "/usr/bin/yade"
    (tmp_path / launcher.PROGRAM).write_text(f"{program}\n")
    (tmp_path / launcher.MODULE).write_text("")
    monkeypatch.setattr(launcher.paths, "native", lambda name: tmp_path / name)
    monkeypatch.setattr(launcher, "module", NATIVE)
    tool = engine("yade")
    assert tool.classes == (built_for == "the program")
    assert ("epdem_yade" if tool.classes else "C library") in launcher.version()


@pytest.mark.parametrize("way", FAKE)
def test_a_run_that_fails_says_how_with_its_last_words(way, fake, tmp_path):
    body, words = FAKE[way]
    fake(body)
    with pytest.raises(EngineError, match=words):
        run("yade", one_impact(), tmp_path / "deck")


def test_a_run_that_hangs_is_stopped_with_all_its_children(fake, tmp_path, monkeypatch):
    fake("echo 'step 7'; sleep 60 & echo $! > child; wait")
    call = launcher.call
    monkeypatch.setattr(launcher, "call", lambda *a, **k: call(*a, **k | {"seconds": 3.0}))
    with pytest.raises(EngineError, match=r"did not end within 3 s.*step 7"):
        run("yade", one_impact(), tmp_path / "deck")
    child = int((tmp_path / "deck/child").read_text())
    assert until(lambda: not alive(child), 20.0)  # the system may need a moment to take a killed process away


@pytest.mark.yade("alone")
@pytest.mark.parametrize(
    ("after", "before"), [("    O.step()\n", ""), ("", "    now[0][0] =")], ids=["deck", "PyRunner"]
)
def test_a_deck_that_raises_in_the_middle_leaves_no_result(after, before, tmp_path):
    """Also in `record`, which YADE runs from a PyRunner: what it raises must not be swallowed."""
    p, tool = one_impact(), engine("yade")
    tool.write(p, tmp_path)
    (tmp_path / "path.bin").write_bytes(b"of an earlier run")
    deck = tmp_path / "impact.py"
    raises = f"{after}    assert O.iter < 9, 'planted'\n{before}"
    deck.write_text(deck.read_text().replace(after or before, raises))
    with pytest.raises(EngineError, match="planted"):
        tool.run(p, tmp_path)
    assert not (tmp_path / "path.bin").exists()


def test_yade_missing_is_said_with_the_install_command_before_anything_starts(tmp_path):
    """Nothing of the other engine is run either."""
    words = [sys.executable, "-m", "epdem", "run", str(CASES / "steel_wall.toml"), "-e", "embedded", "-e", "yade"]
    done = subprocess.run(
        words, cwd=tmp_path, capture_output=True, text=True, timeout=60, env=os.environ | {"EPDEM_YADE": "no-such-yade"}
    )
    assert done.returncode not in (0, 1) and "apt-get install yade" in done.stderr
    assert not (tmp_path / "runs").exists()
    done = subprocess.run(
        [*words[:3], "doctor"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        env=os.environ | {"EPDEM_YADE": "no-such-yade"},
    )
    assert "apt-get install yade" in done.stdout + done.stderr


@pytest.mark.yade("alone")
def test_a_failed_run_exits_with_3_and_keeps_what_other_engines_found(tmp_path, fake):
    fake("[ \"$1\" = --version ] && exec yade --version; echo 'RuntimeError: planted'; exit 1")
    words = [sys.executable, "-m", "epdem", "run", str(CASES / "steel_wall.toml"), "-e", "embedded", "-e", "yade"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 3 and "RuntimeError: planted" in done.stderr
    assert set(store.read(tmp_path / "runs/steel_wall/results.h5").impacts) == {"thornton/embedded"}
