# SPDX-License-Identifier: GPL-2.0-or-later
"""Single impacts of Chung and Ooi's kind in the engines; numbers by Hertz's closed forms."""

import math
from pathlib import Path

import pytest

from epdem.engines import engine
from epdem.impacts.run import run

CASES = Path(__file__).parents[2] / "cases/benchmarks"
CHUNG = ["spheres", "wall", "dashpot", "oblique", "spin"]
LIGGGHTS = pytest.param("liggghts", marks=pytest.mark.liggghts)


@pytest.mark.parametrize("tool", ["embedded", LIGGGHTS])
@pytest.mark.parametrize("name", CHUNG)
def test_single_impacts_are_those_of_theory(name, tool, tmp_path):
    assert run(CASES / f"{name}_chung_2011.toml", engines=[engine(tool)], out=tmp_path / "out").passed


@pytest.mark.parametrize(
    ("name", "E_star", "R_star", "m_star", "v"),
    [
        ("spheres", 48e9 / (2 * (1 - 0.04)), 5e-3, 0.5 * 2800 * 4 / 3 * math.pi * 1e-6, 20.0),
        ("wall", 70e9 / (1 - 0.09), 0.1, 2699 * 4 / 3 * math.pi * 1e-3, 0.2),
    ],
)
def test_elastic_peaks_are_hertzs(name, E_star, R_star, m_star, v, tmp_path):
    found = run(CASES / f"{name}_chung_2011.toml", engines=[engine("embedded")], out=tmp_path / "out")
    row = found.results.comparison.iloc[0]
    overlap = (15 * m_star * v**2 / (16 * E_star * math.sqrt(R_star))) ** 0.4
    assert row["overlap_max"] == pytest.approx(overlap, rel=1e-4)
    assert row["force_max"] == pytest.approx(4 / 3 * E_star * math.sqrt(R_star) * overlap**1.5, rel=1e-4)
    assert row["contact_time"] == pytest.approx(2.9432751843 * overlap / v, rel=1e-4)
    assert row["e_n"] == pytest.approx(1.0, abs=1e-5)
