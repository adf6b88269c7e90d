# SPDX-License-Identifier: GPL-2.0-or-later
"""Scripts that pages name, in a short form: they read decks, runs and tables as the package has them now."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from stored_runs import STORED

from epdem.case.scene import load
from epdem.engines.liggghts.engine import Liggghts
from marks import thorough

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.liggghts
SHORT = [  # commands of pages with arguments for less
    pytest.param("bench/adhesion.py", "--liggghts 2", id="adhesion"),
    thorough("bench/million.py", "--cells 2 --steps 4 --steps-alone 2", id="million"),
    pytest.param(
        "bench/yade_packing.py", "40", id="yade_packing", marks=[pytest.mark.yade("module"), pytest.mark.thorough]
    ),
]
HERE = {"lean", "community", "laws", "lammps_speed", "scenes_speed", "yade_speed", "steps", "compaction_powder"}
ELSEWHERE = {  # the test that runs what a script computes
    "bulk_physics": "scenes/test_bulk_physics.py",
    "compaction": "verification/test_compaction.py",
    "cost": "verification/test_cost.py",
    "crosscheck": "verification/test_crosscheck.py",
    "decks": "decks/test_deck_page.py",
    "equations": "physics/test_equations.py",
    "lattices": "engines/test_lammps_lattices.py",
    "liggghts_invariance": "engines/test_plugin_invariance.py",
    "plastic_contacts": "verification/test_contacts.py",
    "slip_tables": "physics/test_slip_law.py",
    "stability": "verification/test_stability.py",
    "stl_scenes": "scenes/test_lammps_scenes.py",
    "validation": "verification/test_claims.py",
    "yield_pressure": "physics/test_yield_pressure.py",
}
BY_HAND = {
    "adhesive_powder",
    "benchmarks",
    "compaction_cost",
    "lateral",
    "liggghts_speed",
    "reliability",
    "tablets",
}  # CONTRIBUTING.md


def test_each_script_that_a_page_names_has_a_place_where_it_runs():
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md"), ROOT / "docs/data/commands.csv"]
    text = "".join(page.read_text() for page in pages)
    named = {*re.findall(r"python (?:bench|docs|tests/\w+)/(\w+)\.py", text)}
    short = {Path(case.values[0]).stem for case in SHORT}
    assert named | HERE == short | HERE | {*ELSEWHERE} | BY_HAND
    assert all((ROOT / "tests" / test).exists() for test in ELSEWHERE.values())
    assert all(f"`{name}.py`" in (ROOT / "CONTRIBUTING.md").read_text() for name in BY_HAND)


@pytest.mark.parametrize(("script", "arguments"), SHORT)
def test_a_command_of_a_page_runs(script, arguments):
    done = subprocess.run([sys.executable, script, *arguments.split()], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]
    assert len(done.stdout.splitlines()) > 3


@pytest.fixture
def scripts(monkeypatch):
    """The folders of scripts as those of modules."""
    for folder in ("bench", "docs"):
        monkeypatch.syspath_prepend(str(ROOT / folder))
    yield
    for name in HERE:
        sys.modules.pop(name, None)


def test_what_a_feature_adds_is_measured_and_the_page_has_it(scripts, tmp_path, monkeypatch):
    """History by hand: the law and a stamp, three values of the spring of friction, three of epsd2; 8 bytes each."""
    import lean

    names = [next(iter(lean.FEATURES)), "`contact.friction`", "friction, `rolling` `epsd2`", "`output.loads`"]
    monkeypatch.setattr(lean, "HOSTS", ("liggghts",))
    monkeypatch.setattr(lean, "STEPS", 2000)
    monkeypatch.setattr(lean, "FEATURES", {name: lean.FEATURES[name] for name in names})
    found = lean.measure(1, tmp_path)
    assert found["bytes"].tolist() == [16, 40, 64, 16]
    assert found["lines"].is_monotonic_increasing and (found["us_per_step"] > 0).all()
    assert "| `contact.friction` | +1 | +24 |" in lean.page(found, 1)


def test_the_page_of_lean_decks_is_that_of_its_table(scripts):
    import lean
    from pages import load

    assert (ROOT / "docs/lean.md").read_text() == lean.page(load("lean"), lean.REPEATS)


def test_a_run_of_the_benchmark_goes_on_from_its_restart_file(scripts, tmp_path, monkeypatch):
    import community

    shutil.copy(STORED / "settle/case.toml", tmp_path / "settle_glass.toml")
    text = (tmp_path / "settle_glass.toml").read_text().replace("[output]", "[output]\nrestarts = 8")
    (tmp_path / "settle_glass.toml").write_text(text)
    monkeypatch.setattr(community, "CASES", tmp_path)
    monkeypatch.setattr(community, "RUNS", tmp_path)
    case, folder = load(tmp_path / "settle_glass.toml"), tmp_path / "run"
    assert community.run(case, Liggghts(), folder, until=0.03) is None and not (folder / "results.h5").exists()
    outcome = community.run(case, Liggghts(), folder)
    assert outcome is not None and outcome.resumed_from


def test_the_laws_page_runs_impacts(scripts):
    import laws

    e_n, error = laws.liggghts(laws.steel("thornton", np.array([1.0, 5.0])))
    assert e_n[0] / e_n[1] == pytest.approx(5**0.25, rel=1e-3) and error < 1e-3  # far beyond yield e_n falls as v^-1/4


@pytest.mark.thorough
@pytest.mark.lammps
def test_a_bed_in_lammps_is_timed(scripts, tmp_path):
    import lammps_speed

    (tmp_path / "bed.data").write_text(lammps_speed.data())
    for name in lammps_speed.MODELS:
        assert min(lammps_speed.times(name, 2, tmp_path, "")) > 0.0


def test_scenes_of_both_laws_are_timed(scripts):
    import scenes_speed

    for model, environment in scenes_speed.ENVIRONMENT.items():
        texts = scenes_speed.files(STORED / "settle" / "case.toml", model)
        assert scenes_speed.measure(texts, model, environment)["processor"] > 0.0


@pytest.mark.thorough
@pytest.mark.yade("module")
def test_contacts_of_yade_are_timed(scripts, tmp_path, monkeypatch):
    import yade_speed

    monkeypatch.setattr(yade_speed, "SIDE", 3)
    for law in (yade_speed.NATIVE, *yade_speed.CLASSES[:2]):
        times, n = yade_speed.once(law, tmp_path, str(yade_speed.launcher.module().parent))
        assert n == 54 and min(times) > 0.0


def test_steps_of_the_c_interface_are_timed(scripts):
    import steps

    assert all(steps.batch(name, passes=1) > 0.0 for name in ("hertz", "meyer", "cavity"))


@pytest.mark.thorough
def test_a_powder_is_pressed_with_each_law_of_the_page(scripts, tmp_path, monkeypatch, capsys):
    import compaction_powder

    (tmp_path / "cases").mkdir()
    shutil.copy(STORED / "compaction/case.toml", tmp_path / "cases/compaction_powder.toml")
    monkeypatch.setattr(compaction_powder, "HERE", tmp_path)
    compaction_powder.main()
    assert len(capsys.readouterr().out.splitlines()) == 1 + len(compaction_powder.LAWS)
