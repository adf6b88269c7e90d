# SPDX-License-Identifier: GPL-2.0-or-later
"""The main job: e_n(v) and the rest of an impact, from each engine, against theory."""

import json
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hosts import CASES, EMBEDDED, LIGGGHTS, TARGETS, prepared, run

from cli.calls import call
from epdem.case.impact import Check
from epdem.engines import engine
from epdem.impacts import store
from epdem.impacts.measurement import CHECKED, compare, measure
from epdem.impacts.run import run as run_case


@pytest.mark.parametrize("name", [EMBEDDED, LIGGGHTS])
@pytest.mark.parametrize("target", ["wall", "sphere"])
def test_contact_time_peak_force_overlaps_and_energy_agree_with_theory(name, target, tmp_path):
    """At 400 steps the time is known within a step; a sampled peak misses at most (pi/400)^2/8 = 8e-6 of itself."""
    p, prediction = prepared(steps=400, impact=TARGETS[target])
    rows = compare(name, "thornton", measure(p, run(name, p, tmp_path)), prediction, Check())
    assert np.all(np.abs(rows["contact_time"] - rows["contact_time_theory"]) <= p.time_step)
    for quantity in ("force_max", "overlap_max", "residual_overlap"):
        assert rows[quantity + "_error"].max() <= 1e-3
    assert np.abs(rows["energy_residual"]).max() <= 1e-4  # trapezoids over 400 samples: (pi/400)^2


@pytest.mark.liggghts
def test_more_ranks_give_the_same_impacts(tmp_path):
    """Every impact is independent: to the last bit."""
    p, _ = prepared()
    one, two = (run("liggghts", p, tmp_path / str(ranks), ranks=ranks) for ranks in (1, 2))
    assert np.array_equal(one.overlap, two.overlap) and np.array_equal(one.force, two.force)


def test_a_wrong_modulus_is_seen_although_restitution_may_be_right(tmp_path):
    """Rule: restitution alone is blind. E* 1.5 times too large with p_y to match leaves e_n, not time and force."""
    p, prediction = prepared(steps=400)
    x, factor = p.experiment, 1.5
    law = replace(x.law, parameters={"yield_pressure": x.law.parameters["yield_pressure"] * factor**0.8})
    stiffer = [replace(b, young_modulus=b.young_modulus * factor) for b in (x.body, x.target)]
    wrong = replace(p, experiment=replace(x, body=stiffer[0], target=stiffer[1], law=law))
    measured = measure(p, run("embedded", wrong, tmp_path))
    rows = compare("embedded", "thornton", measured, prediction, Check())
    assert rows["e_n_error"].max() < 1e-4
    for quantity in CHECKED[1:]:
        assert rows[quantity + "_error"].max() > 0.05
    assert not rows["passed"].any()


@pytest.fixture
def epdem(tmp_path, monkeypatch, capsys):
    """The command in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    return lambda *words: call(words, capsys, monkeypatch)


def test_run_json_prints_one_document_with_the_promised_keys(epdem):
    done = epdem("run", str(CASES / "steel_wall.toml"), "-e", "embedded", "--json")
    assert done.code == 0, done.err
    document = json.loads(done.out)
    assert document["yields"] == {"thornton": ["steel"]}
    assert {"case", "passed", "seconds", "rows"} <= document.keys() and len(document["rows"]) == 32
    keys = {"engine", "law", "speed", "energy_residual", "steps_in_contact"}
    for quantity in ("e_n", "contact_time", "force_max", "overlap_max", "residual_overlap"):
        keys |= {quantity, quantity + "_theory", quantity + "_error"}
    assert keys <= document["rows"][0].keys()


@pytest.mark.figures
def test_results_open_as_data_frames_and_a_second_run_takes_them_from_the_store(epdem, tmp_path):
    words = ("run", str(CASES / "steel_wall.toml"), "-e", "embedded", "-o", "out")
    assert epdem(*words).code == 0
    found = store.read(tmp_path / "out/results.h5")
    assert isinstance(found.comparison, pd.DataFrame) and len(found.impacts["thornton/embedded"]) == 256
    assert found.case_text == (CASES / "steel_wall.toml").read_text()
    written = pd.read_csv(tmp_path / "out/results.csv")
    assert np.array_equal(written["e_n"], found.comparison["e_n"])
    assert "1 of 1 from" in epdem(*words).out
    assert (tmp_path / "out/e_n.png").stat().st_size > 10_000
    for fresh, reused in ((False, ["thornton/embedded"]), (True, [])):
        again = run_case(CASES / "steel_wall.toml", engines=[engine("embedded")], out=tmp_path / "out", fresh=fresh)
        assert again.reused == reused and np.array_equal(again.results.comparison["e_n"], found.comparison["e_n"])


def test_a_run_with_another_law_keeps_what_is_stored(tmp_path):
    def run_with(*laws):
        return run_case(CASES / "steel_wall.toml", engines=[engine("embedded")], laws=laws, out=tmp_path / "out")

    assert run_with("thornton").reused == run_with("cavity").reused == []
    found = store.read(tmp_path / "out/results.h5")
    assert set(found.runs) == set(found.impacts) == {"thornton/embedded", "cavity/embedded"}
    assert len(found.comparison) == 64 and run_with().reused == ["thornton/embedded"]


def test_a_failed_check_exits_with_1(epdem, tmp_path):
    text = (CASES / "steel_wall.toml").read_text().replace("e_n = 1e-4", "e_n = 1e-9")
    text = re.sub("^speeds = .*$", 'speeds = ["5 m/s"]', text, flags=re.M)
    (tmp_path / "strict.toml").write_text(text)
    assert epdem("run", "strict.toml", "-e", "embedded").code == 1


@pytest.mark.liggghts
def test_an_engine_that_dies_exits_with_3_and_gives_its_last_words(tmp_path, monkeypatch):
    broken = tmp_path / "epdem-liggghts"
    broken.write_text("#!/bin/sh\n[ \"$1\" = -h ] && exit 0\necho 'ERROR: lost my atoms (../pair.cpp:1)'\nexit 1\n")
    broken.chmod(0o755)
    monkeypatch.setenv("EPDEM_LIGGGHTS", str(broken))
    words = [sys.executable, "-m", "epdem", "run", str(CASES / "steel_wall.toml"), "-e", "embedded", "-e", "liggghts"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.returncode == 3 and "ERROR: lost my atoms" in done.stderr
    assert set(store.read(tmp_path / "runs/steel_wall/results.h5").impacts) == {"thornton/embedded"}  # nothing lost
    assert (tmp_path / "runs/steel_wall/thornton/liggghts/out.liggghts").exists()
