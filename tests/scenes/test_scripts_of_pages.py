# SPDX-License-Identifier: GPL-2.0-or-later
"""Scripts that pages name, in a short form: they read decks, runs and tables as the package has them now."""

import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from stored_runs import STORED

from epdem.case.scene import load
from epdem.engines.liggghts.engine import Liggghts

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.liggghts


@pytest.fixture
def scripts(monkeypatch):
    """The folders of scripts as those of modules."""
    for folder in ("bench", "docs"):
        monkeypatch.syspath_prepend(str(ROOT / folder))
    yield
    for name in ("lean", "community", "laws"):
        sys.modules.pop(name, None)


@pytest.mark.parametrize("kind", ["settle", "compaction"])
def test_lean_and_full_decks_are_measured(kind, scripts, tmp_path):
    import lean

    found = lean.measure(STORED / kind / "case.toml", 1, tmp_path)
    assert found["lean_lines"] < found["full_lines"] and min(found["lean_seconds"], found["full_seconds"]) > 0.0
    assert found["name"] in lean.page([found])


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
