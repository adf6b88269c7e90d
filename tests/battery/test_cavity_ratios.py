# SPDX-License-Identifier: GPL-2.0-or-later
"""Parameters that the theory of `cavity` refuses are refused by the C++ law."""

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from epdem.errors import CaseError
from epdem.laws.library import Law
from epdem.theory.cavity import Cavity


@given(st.floats(0.05, 3.0) | st.floats(0.05, 0.7), st.floats(0.9, 4.0) | st.floats(0.9, 1.2))
def test_theory_and_law_accept_the_same_ratios_of_cavity(c_Y, factor):
    """Also with 3 c_P - 2 c_Y < ln 2, which puts full plasticity before first yield (ln s_P < 0)."""
    c_P = factor * c_Y
    numbers = {"E_star": 1e11, "Y": 1e9, "c_Y": c_Y, "c_P": c_P}
    ln_s_P = 3 * c_P - 2 * c_Y - 0.6931471805599453
    assume(abs(ln_s_P) > 1e-9)
    try:
        Cavity(R_star=0.01, **numbers)
        valid = True
    except ValueError:
        valid = False
    law = Law("cavity", E_star=1e11, yield_stress=1e9, first_yield_ratio=c_Y, plastic_ratio=c_P)
    if valid:
        law.step(R_star=0.01, delta_max=0.0, delta=1e-6)
    else:
        with pytest.raises(CaseError, match="range"):
            law.step(R_star=0.01, delta_max=0.0, delta=1e-6)
    assert not (valid and ln_s_P <= 0)
