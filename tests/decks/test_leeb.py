# SPDX-License-Identifier: GPL-2.0-or-later
"""Measured impacts that everyone can look up: Leeb rebound devices, and how far `cavity`, with nothing fitted, is off.

Dents: manuals of PCE-2800 and Mitech MH310, table 3; restitution at the top of the scale: manual of Proceq Equotip 3.
The deviations are the law's own (static hardness for one on impact) and are held to a percent: they are what the heads
of the case files say, and a change of the law must change those.
"""

import math
from pathlib import Path

import pytest

from epdem.case.impact import parse, read_toml
from epdem.impacts.experiment import experiment
from epdem.impacts.prediction import predict

CASES = Path(__file__).parents[2] / "cases"
VICKERS = 9.807e6  # Pa
# device, HV, quantity, measured, deviation of `cavity`
MEASURED = [
    ("D", 300, "width", 0.54e-3, 0.115),
    ("D", 300, "depth", 24e-6, -0.16),
    ("D", 600, "depth", 17e-6, -0.25),
    ("D", 955, "e_n", 0.890, -0.073),
    ("C", 300, "width", 0.38e-3, 0.098),
    ("C", 300, "depth", 12e-6, -0.21),
    ("C", 600, "width", 0.32e-3, 0.11),
    ("C", 600, "depth", 8e-6, -0.33),
    ("G", 300, "width", 1.03e-3, 0.112),
    ("G", 300, "depth", 53e-6, -0.14),
    ("G", 600, "width", 0.90e-3, 0.085),
    ("G", 600, "depth", 41e-6, -0.29),
    ("G", 675, "e_n", 0.750, -0.037),
]


def on_steel(device, hardness):
    data = read_toml(CASES / f"leeb_{device}.toml")
    data["materials"]["steel"]["yield_stress"] = f"{hardness * VICKERS / 2.8!r} Pa"
    return experiment(parse(data, device))


@pytest.mark.parametrize(("device", "hardness", "quantity", "measured", "deviation"), MEASURED)
def test_leeb_devices_are_missed_by_what_the_case_files_say(device, hardness, quantity, measured, deviation):
    x = on_steel(device, hardness)
    p = predict(x)
    found = {"width": 2 * p.strain_ratio * x.R_star, "depth": p.residual_overlap, "e_n": p.e_n}[quantity][0]
    assert found / measured - 1 == pytest.approx(deviation, abs=0.01)
    head = (CASES / f"leeb_{device}.toml").read_text().split("[case]")[0]
    assert f"({100 * deviation:+.0f} %)" in head or f"({100 * (found / measured - 1):+.0f} %)" in head


@pytest.mark.parametrize(("device", "grams", "joule"), [("D", 5.5, 11e-3), ("C", 3.0, 2.7e-3), ("G", 20.0, 90e-3)])
def test_leeb_bodies_have_their_mass_and_energy(device, grams, joule):
    x = experiment(parse(read_toml(CASES / f"leeb_{device}.toml"), device))
    assert x.m_star == pytest.approx(grams * 1e-3, rel=1e-6)
    # the standard rounds mass, speed and energy, each by itself: 2.54 mJ of 2.7 for device C
    assert 0.5 * x.m_star * x.speed[0] ** 2 == pytest.approx(joule, rel=0.07)
    assert x.law.parameters["yield_stress"] == pytest.approx(300 * VICKERS / 2.8, rel=1e-4)


def test_the_ball_does_not_yield_and_the_impact_is_small():
    for device in "DCG":
        p = predict(experiment(parse(read_toml(CASES / f"leeb_{device}.toml"), device)))
        assert p.yield_speeds["carbide"] == math.inf
        assert p.yields == ("steel",)
        assert not p.warnings()  # a/R* <= 0.3
