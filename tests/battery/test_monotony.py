# SPDX-License-Identifier: GPL-2.0-or-later
"""Restitution against speed for random contacts, by theory: the faster, the more is lost."""

import numpy as np
from hypothesis import given
from laws import contacts, symbols

from epdem.theory import backbones, restitution


@given(contacts())
def test_restitution_of_any_contact_falls_with_speed_from_one(c):
    """v/v_y from 1e-2 to 1e4; 1e-12 is the accuracy that the closed forms promise."""
    law = backbones.LAWS[c.name](E_star=c.E_star, R_star=c.R_star, **symbols(c.name, c.strength))
    m = 1e4 * c.R_star**3
    v_y = np.sqrt(2 * law.work(c.delta_y) / m)
    e_n = restitution.e_n(law, m_star=m, speed=v_y * np.geomspace(1e-2, 1e4, 200))
    assert e_n[0] == 1.0 and np.all(e_n > 0)
    assert np.all(np.diff(e_n) <= 1e-12)
    assert c.name == "hertz" or e_n[-1] < 0.5
