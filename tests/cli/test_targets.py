# SPDX-License-Identifier: GPL-2.0-or-later
"""Targets of the Makefile in several orders, each in a fresh clone."""

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
pytestmark = [
    pytest.mark.packaging,
    pytest.mark.liggghts,
    pytest.mark.yade,
    pytest.mark.skipif("YADE_SOURCE" not in os.environ, reason="YADE_SOURCE names no source of YADE"),
]


@pytest.mark.parametrize("order", ["yade lammps demo", "lammps wheel yade demo lammps"])
def test_targets_work_in_any_order(order, tmp_path):
    subprocess.run(["git", "clone", "-q", ROOT, tmp_path / "a clone"], check=True)
    done = subprocess.run(
        ["make", *order.split()], cwd=tmp_path / "a clone", capture_output=True, text=True, stdin=subprocess.DEVNULL
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    native = list((tmp_path / "a clone/.venv").rglob("epdem/native/*"))
    assert {"epdem_yade.so", "lammps", "libepdem.so"} <= {path.name for path in native}
