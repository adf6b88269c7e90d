# SPDX-License-Identifier: GPL-2.0-or-later
"""What friction under the pressure of the yielding contact would change: docs/partial_slip.md."""

import sys
from pathlib import Path

import numpy as np
import pytest
from slip import LAWS, V_Y, rebound

from epdem.theory.numerics import gauss
from epdem.theory.partial_slip import line_load

sys.path.append(str(Path(__file__).parents[2] / "bench"))
from yield_pressure import HARDENED, IMPACTS, PSI_1, cut_line_load, flatness, springs


@pytest.mark.parametrize(("law", "unit"), IMPACTS, ids=lambda x: getattr(x, "name", ""))
def test_the_cut_pressure_has_the_force_of_the_law(law, unit):
    x, w = gauss(400)
    for q in (1.01, 2.0, 10.0):
        alpha = law.yield_overlap * q**2
        F, a = float(law.force(alpha)), float(law.radius(alpha))
        load = cut_line_load(a * x, force=F, a=a, p=float(law.pressure_max(alpha)))
        assert 2 * a * float(w @ load) == pytest.approx(F, rel=1e-5)


def test_at_first_yield_the_cut_pressure_is_hertz_and_far_above_it_uniform():
    law = LAWS["thornton"]
    for q, tau in ((1 + 1e-9, 0.0), (1e4, 1.0)):
        alpha = law.yield_overlap * q**2
        F, a = float(law.force(alpha)), float(law.radius(alpha))
        x = a * np.linspace(0, 0.95, 20)
        assert cut_line_load(x, force=F, a=a, p=2.8e9) == pytest.approx(
            line_load(x, force=F, a=a, a_max=a, flatness=tau), rel=1e-3
        )


def test_the_flatness_is_1_less_the_exponent_far_above_yield():
    """tau = (1 - x)(1 - F_y/F); johnson is uniform."""
    alpha = HARDENED.yield_overlap * np.array([1.0, 3.0, 1e8])
    for law, x in ((LAWS["thornton"], 0.0), (HARDENED, 0.3)):
        expected = (1 - x) * (1 - law.force(law.yield_overlap) / law.force(alpha))
        assert flatness(law)(alpha) == pytest.approx(expected, abs=1e-12)
    assert flatness(LAWS["johnson"])(10 * LAWS["johnson"].yield_overlap) == 1.0


def test_psi_2_of_thornton_moves_by_up_to_0_076_and_no_energy_appears():
    law = LAWS["thornton"]
    shift = [
        np.abs(np.subtract(*(springs(law, PSI_1, n * V_Y, own=own, steps=400, count=200) for own in (True, False))))
        for n in (2, 5, 20)
    ]
    assert np.max(shift, axis=1) == pytest.approx([0.043, 0.076, 0.069], abs=4e-3)
    _, lost, most = rebound(law, PSI_1, 5 * V_Y, steps=100, loading_flatness=flatness(law))
    assert lost.min() > 0 and most <= 1 + 1e-12
