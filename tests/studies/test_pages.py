# SPDX-License-Identifier: GPL-2.0-or-later
"""Every block of docs/studies.md runs as it stands, in the order of the page; the notebook runs from top to end."""

import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest
from cluster import cluster, needs_slurm

ROOT = Path(__file__).parents[2]


def blocks(page: str) -> list[tuple[str, str]]:
    """(kind, text) of the blocks of a page that can be run."""
    return re.findall(r"^```(sh|python|sh slurm)\n(.*?)^```$", (ROOT / f"docs/{page}.md").read_text(), re.M | re.S)


def play(wanted: list[tuple[str, str]], folder: Path, env: dict[str, str] | None = None, *, cases: bool = True) -> None:
    """Run blocks in a folder, which gets our `cases`."""
    if cases:
        shutil.copytree(ROOT / "cases", folder / "cases", dirs_exist_ok=True)
    found = dict(env or os.environ)
    found["PATH"] = f"{Path(sys.executable).parent}:{found['PATH']}"
    for k, text in wanted:
        program = [sys.executable, "-c", text] if k == "python" else ["bash", "-e", "-c", text]
        done = subprocess.run(program, cwd=folder, env=found, capture_output=True, text=True)
        assert done.returncode == 0, f"{text}\n{done.stdout}{done.stderr}"


@pytest.mark.thorough
def test_a_study_in_ten_minutes(tmp_path):
    play([(kind, text) for kind, text in blocks("studies") if kind != "sh slurm"], tmp_path)
    assert len(pd.read_csv(tmp_path / "runs/study/sweep.csv")) == 15 * 32
    assert "15 points on embedded" in (tmp_path / "runs/study/report.html").read_text()
    assert len(pd.read_csv(tmp_path / "runs/table/sweep.csv")) == 2 * 32
    forces = pd.read_csv(tmp_path / "runs/press/sweep.csv")["plate_force_max"]
    assert (abs(forces / 12.0 - 1.0) <= 0.05).any() and len(forces) <= 8


@needs_slurm
@pytest.mark.waits
def test_on_my_cluster(tmp_path):
    (tmp_path / "slurm").mkdir()
    with cluster(tmp_path / "slurm") as nodes:
        play([(kind, text) for kind, text in blocks("studies") if kind == "sh slurm"], tmp_path, nodes.env)
    assert pd.read_csv(tmp_path / "runs/byhand/sweep.csv")["status"].tolist() == ["done"] * 64


@pytest.mark.liggghts
def test_the_notebook_of_conductivity_gives_that_of_a_lattice_of_hertz_s_contacts(tmp_path, monkeypatch):
    """All contacts of a chain have one force: overlaps d of pairs and d/2^(1/3) at walls add up to the stroke."""
    import nbformat
    from nbclient import NotebookClient

    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}:{os.environ['PATH']}")
    notebook = nbformat.read(ROOT / "docs/conductivity.ipynb", as_version=4)
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    d = 60e-6 / (2 + 2 * 2 ** (-1 / 3))
    a, a_wall = math.sqrt(5e-4 * d), math.sqrt(1e-3 * d * 2 ** (-1 / 3))
    chain = 2 / (2 * a) + 2 / (4 * a_wall)
    found = float(re.search(r"conductivity ([\d.e-]+)", notebook.cells[-1].outputs[0].text)[1])
    assert found == pytest.approx(9 / chain * 5.94e-3 / 36e-6, rel=1e-4)


@pytest.mark.liggghts
def test_the_notebook_runs(tmp_path, monkeypatch):
    import nbformat
    from nbclient import NotebookClient

    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}:{os.environ['PATH']}")
    shutil.copytree(ROOT / "cases", tmp_path / "cases")
    notebook = nbformat.read(ROOT / "docs/notebook.ipynb", as_version=4)
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    kinds = [o.get("data", {}).keys() for cell in notebook.cells for o in cell.get("outputs", [])]
    assert sum("image/png" in k for k in kinds) >= 2 and sum("text/html" in k for k in kinds) >= 3
