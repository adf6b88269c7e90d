# SPDX-License-Identifier: GPL-2.0-or-later
"""Measured impacts that everyone can look up: Leeb rebound devices, and how far `cavity`, with nothing fitted, is off.

Dents: manuals of PCE-2800 and Mitech MH310, table 3; restitution at the top of the scale: manual of Proceq Equotip 3.
The yield stress follows from the hardness by the expanding cavity under a pyramid. The deviations are the law's own and
are held to a tenth of a percent: they are what the heads of the case files say, and a change of the law must change
those.
"""

import math
from pathlib import Path

import pytest

from epdem.case.impact import parse
from epdem.case.toml import read_toml
from epdem.impacts.experiment import experiment
from epdem.impacts.prediction import predict

CASES = Path(__file__).parents[2] / "cases"
MEYER = 2 / 1.8544 * 9.807e6  # Pa of mean pressure per HV: the pyramid's facets to their projection
# device, HV, p_m/Y under the pyramid, quantity, measured, deviation of `cavity`
MEASURED = [
    ("D", 300, 2.8, "width", 0.54e-3, 0.094),
    ("D", 600, 2.7175, "width", 0.452e-3, 0.099),
    ("D", 955, 2.3324, "e_n", 0.890, -0.010),
    ("C", 300, 2.8, "width", 0.38e-3, 0.095),
    ("C", 600, 2.7175, "width", 0.32e-3, 0.103),
    ("C", 800, 2.4790, "width", 0.29e-3, 0.127),
    ("G", 300, 2.8, "width", 1.03e-3, 0.102),
    ("G", 600, 2.7175, "width", 0.90e-3, 0.058),
    ("G", 675, 2.6199, "e_n", 0.750, 0.005),
]


def on_steel(device, hardness, constraint):
    data = read_toml(CASES / f"leeb_{device}.toml")
    data["materials"]["steel"]["yield_stress"] = f"{hardness * MEYER / constraint!r} Pa"
    return experiment(parse(data, device))


@pytest.mark.parametrize(("device", "hardness", "constraint", "quantity", "measured", "deviation"), MEASURED)
def test_leeb_devices_deviate_as_the_case_files_say(device, hardness, constraint, quantity, measured, deviation):
    x = on_steel(device, hardness, constraint)
    p = predict(x)
    found = {"width": 2 * p.radius_max, "e_n": p.e_n}[quantity][0]
    assert found / measured - 1 == pytest.approx(deviation, abs=0.001)
    head = (CASES / f"leeb_{device}.toml").read_text().split("[case]")[0]
    assert f"{hardness} HV" in head and f"({100 * (found / measured - 1):+.1f} %)" in head


@pytest.mark.parametrize(("device", "grams", "joule"), [("D", 5.5, 11e-3), ("C", 3.0, 2.7e-3), ("G", 20.0, 90e-3)])
def test_leeb_bodies_have_their_mass_and_energy(device, grams, joule):
    x = experiment(parse(read_toml(CASES / f"leeb_{device}.toml"), device))
    assert x.m_star == pytest.approx(grams * 1e-3, rel=1e-6)
    assert 0.5 * x.m_star * x.speed[0] ** 2 == pytest.approx(joule, rel=1e-3)
    assert x.law.parameters["yield_stress"] == pytest.approx(300 * MEYER / 2.8, rel=1e-4)


def test_the_ball_does_not_yield_and_the_impact_is_small():
    for device in "DCG":
        p = predict(experiment(parse(read_toml(CASES / f"leeb_{device}.toml"), device)))
        assert p.yield_speeds["carbide"] == math.inf
        assert p.yields == ("steel",)
        assert p.strain.max() < 0.3 and not any("0.3" in text for text in p.caveats)
