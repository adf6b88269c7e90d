# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases of other people: single impacts in the engines, by Hertz's closed forms; scenes have their numbers."""

import math
from pathlib import Path

import numpy as np
import pytest

from epdem.case.scene import load
from epdem.engines import engine
from epdem.engines.liggghts import deck as scene_deck
from epdem.impacts.run import run
from epdem.scenes.plan.plan import plan

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


def matrix(deck, name):
    """A property of pairs, by the names of two types."""
    n, *full = next(p.values for p in deck.contact.properties if p.name == name)
    types = deck.plan.types
    assert n == len(types)
    return {(a, b): full[i * len(types) + j] for i, a in enumerate(types) for j, b in enumerate(types)}


DOSTA = {  # Dosta et al. 2024: spheres, steps [s], restitution, friction
    ("impact_25k", 25001, 5e-7): {
        ("M1", "M1"): (0.5, 0.3),
        ("M1", "steel"): (0.4, 0.2),
        ("steel", "steel"): (0.6, 0.5),
    },
    ("drum", 38000, 1e-4): {
        ("M1", "M1"): (0.5, 0.3),
        ("M1", "M2"): (0.45, 0.2),
        ("M2", "M2"): (0.4, 0.4),
        ("M1", "wall"): (0.4, 0.2),
        ("M2", "wall"): (0.4, 0.2),
    },
    ("silo_large", 100_000, 1.5e-6): {("M1", "M1"): (0.5, 0.3), ("M1", "wall"): (0.4, 0.2)},
}
DOSTA |= {("impact_50k", 50001, 5e-7): DOSTA["impact_25k", 25001, 5e-7]}
DOSTA |= {("impact_100k", 100_001, 5e-7): DOSTA["impact_25k", 25001, 5e-7]}
DOSTA |= {("silo_small", 100_000, 1.5e-6): DOSTA["silo_large", 100_000, 1.5e-6]}


@pytest.mark.parametrize(("about", "pairs"), DOSTA.items(), ids=[name for name, *_ in DOSTA])
def test_scenes_of_the_benchmark_have_its_numbers(about, pairs):
    name, spheres, step = about
    p = plan(load(CASES / f"{name}.toml"))
    deck = scene_deck.deck(p)
    assert (p.count, p.time_step) == (spheres, step)
    assert deck.contact.settings == ("viscous on", "computeContactStrain on")  # with the tangential dashpot
    restitution, friction = (matrix(deck, f"coefficient{key}") for key in ("Restitution", "Friction"))
    for (a, b), expected in pairs.items():
        assert (restitution[a, b], friction[a, b]) == (restitution[b, a], friction[b, a]) == expected


@pytest.mark.parametrize(("name", "radius", "z"), [("silo_large", 0.03, -0.0554222), ("silo_small", 0.02, -0.0593008)])
def test_the_cone_of_a_silo_has_45_degrees_and_its_outlet(name, radius, z):
    scene = plan(load(CASES / f"{name}.toml"))
    corners = scene.triangles["cone"].reshape(-1, 3)
    distance = np.hypot(corners[:, 0], corners[:, 1])
    assert corners[:, 2].min() == pytest.approx(z) == scene.scene.gates[0].at
    assert distance.min() == pytest.approx(radius, rel=3e-3) and distance.max() == pytest.approx(0.1, rel=3e-3)
    assert np.ptp(corners[:, 2]) == pytest.approx(0.1 - radius)
