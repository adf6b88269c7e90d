# SPDX-License-Identifier: GPL-2.0-or-later
"""Two like spheres that meet at 2v and their mirror image, a sphere on a rigid plane at v, in every host."""

from dataclasses import replace

import numpy as np
import pytest
from lammps_decks import needs_lammps

from epdem.case.fields import Material
from epdem.engines import engine
from epdem.impacts.experiment import RIGID_PLANE, Experiment, pair_of, sphere
from epdem.impacts.measurement import measure
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from epdem.laws.strengths import default_numbers

NYLON = Material(young_modulus="2.8 GPa", poisson_ratio=0.4, density="1140 kg/m^3", yield_stress="70 MPa")
LAWS = {"thornton": {}, "cavity": {}, "cavity with finite_strain": {"finite_strain": 0.82}}
HOSTS = [
    "embedded",
    pytest.param("liggghts", marks=pytest.mark.liggghts),
    pytest.param("yade", marks=pytest.mark.yade),
    pytest.param("lammps", marks=needs_lammps),
]


def measured(host, law, target, factor, folder):
    numbers = default_numbers(law.split()[0])
    numbers = replace(numbers, ratios=numbers.ratios | LAWS[law])
    ball = sphere(NYLON, radius=0.01, name="ball")
    other = target or ball
    x = Experiment(pair_of(numbers, ball, other), ball, other, factor * np.array([0.3, 5.0, 60.0]), None)
    p = plan(x, predict(x))
    tool = engine(host)
    folder.mkdir()
    tool.write(p, folder)
    return measure(p, tool.run(p, folder))


@pytest.mark.parametrize("host", HOSTS)
@pytest.mark.parametrize("law", LAWS)
def test_an_impact_and_its_mirror_image_are_one(host, law, tmp_path):
    """Round-off: the places of spheres are numbers far larger than their overlaps."""
    pair = measured(host, law, None, 2.0, tmp_path / "pair")
    plane = measured(host, law, RIGID_PLANE, 1.0, tmp_path / "plane")
    assert np.allclose(pair.e_n, plane.e_n, rtol=1e-8, atol=0)
    assert np.allclose(pair.force_max, plane.force_max, rtol=1e-8, atol=0)
    assert np.allclose(pair.overlap_max, 2 * plane.overlap_max, rtol=1e-8, atol=0)
    assert plane.e_n.min() < 0.7
