# SPDX-License-Identifier: GPL-2.0-or-later
"""Mirror symmetry: two like spheres that meet at 2v, and their mirror image, a sphere on a rigid smooth plane at v.

The plane of symmetry is a rigid plane. Force, contact radius, time and e_n are the same; overlap, work and the work of
adhesion of the pair are twice as large, because they belong to two halves.
"""

from dataclasses import replace

import numpy as np
import pytest

from epdem.case.fields import Material
from epdem.impacts.experiment import RIGID_PLANE, Experiment, pair_of, sphere
from epdem.impacts.prediction import predict
from epdem.laws.strengths import ADHESION, default_numbers, find_law

STEEL = Material(young_modulus="208 GPa", poisson_ratio=0.3, density="7850 kg/m^3", yield_stress="300 MPa")
SOFT = Material(young_modulus="2.8 GPa", poisson_ratio=0.4, density="1140 kg/m^3", yield_stress="70 MPa")
LAWS = {
    "hertz": {},
    "thornton": {},
    "johnson": {},
    "cavity": {},
    "cavity of other ratios": {"first_yield_ratio": 1.7, "plastic_ratio": 3.0},
    "cavity with finite_strain": {"finite_strain": 0.82},
    "cavity with much finite_strain": {"finite_strain": 0.1, "plastic_ratio": 2.9},
    "meyer": {"hardening_exponent": 0.3},
    "jkr": {ADHESION: 50.0},
    "thornton_ning": {ADHESION: 50.0},
    "cavity_adhesive": {ADHESION: 40.0},
    "cavity_adhesive with finite_strain": {ADHESION: 40.0, "finite_strain": 0.82},
}
SPEEDS = np.geomspace(0.01, 100.0, 13)
TWICE = {"speed", "overlap_max", "residual_overlap", "work_in", "work_out", "plastic_work"}
every_law = pytest.mark.parametrize("law", LAWS)
bodies = pytest.mark.parametrize("material", [STEEL, SOFT], ids=["steel", "nylon"])


def images(law, material, viscous=None):
    """(two like spheres at twice the speed, a sphere on a rigid plane) with the same law."""
    name, options = law.split()[0], dict(LAWS[law])
    adhesion, ball = options.pop(ADHESION, None), sphere(material, radius=0.01, name="ball")
    for target, factor in ((ball, 2.0), (RIGID_PLANE, 1.0)):
        numbers = default_numbers(name)
        numbers = replace(numbers, ratios=numbers.ratios | options, adhesion=adhesion and adhesion * factor / 2)
        yield Experiment(pair_of(numbers, ball, target), ball, target, factor * SPEEDS, viscous)


def same(pair, single, factor=1.0):
    np.testing.assert_allclose(pair, factor * np.asarray(single), rtol=1e-12, atol=0)


@bodies
@every_law
@pytest.mark.parametrize("viscous", [None, 0.9])
def test_the_theory_of_impacts_is_that_of_the_mirror_image(law, material, viscous):
    if viscous and find_law(law.split()[0]).adheres:
        pytest.skip("no theory has both adhesion and a dashpot")
    pair, single = (predict(x) for x in images(law, material, viscous))
    columns, other = pair.table(), single.table()
    if find_law(law.split()[0]).strength is None:
        columns, other = columns.drop(columns="strain"), other.drop(columns="strain")
    for name in columns:
        same(columns[name], other[name], 2.0 if name in TWICE else 1.0)


@bodies
@every_law
def test_the_law_in_c_is_that_of_the_mirror_image(law, material):
    """Backbones, unloading from 40 peaks, and impacts in 200 steps."""
    pair, single = images(law, material)
    peak = np.geomspace(1e-8, 4e-3, 40)
    (law2, x2), (law1, x1) = ((x.native_law(), x.R_star) for x in (pair, single))
    for n, (two, one) in enumerate(
        zip(law2.backbone(R_star=x2, delta=2 * peak), law1.backbone(R_star=x1, delta=peak), strict=True)
    ):
        scale = 2.0 if n > 1 else 1.0  # force, radius; work, plastic work
        np.testing.assert_allclose(two, scale * one, rtol=1e-12, atol=1e-12 * scale * np.abs(one).max() * (n == 3))
    for share in (0.999, 0.9, 0.5, 0.1):
        two = law2.step(R_star=x2, delta_max=2 * peak, delta=2 * share * peak)
        one = law1.step(R_star=x1, delta_max=peak, delta=share * peak)
        same(two[0], one[0])
        same(two[1], one[1])
        same(two[2], one[2], 2.0)
    time = predict(single).duration / 100
    numbers = {"time_step": time, "steps": 200, "viscous": pair.viscous_number}
    gap = 0.3 * SPEEDS * time
    two = law2.impacts(R_star=x2, m_star=pair.m_star, speed=pair.speed, gap=2 * gap, **numbers)
    one = law1.impacts(R_star=x1, m_star=single.m_star, speed=single.speed, gap=gap, **numbers)
    same(two["force_max"], one["force_max"])
    for name in ("rebound_speed", "overlap_max", "last_overlap"):
        same(two[name], one[name], 2.0)
    assert np.array_equal(two["first"], one["first"]) and np.array_equal(two["last"], one["last"])
