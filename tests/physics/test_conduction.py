# SPDX-License-Identifier: GPL-2.0-or-later
"""The conductance of a contact, from the potential of a half-space."""

import numpy as np
import pytest
from scipy.integrate import quad

from epdem.theory import contact_conductance


@pytest.mark.parametrize(("k_i", "k_j"), [(3.0, 3.0), (2.0, 50.0), (7.0, np.inf)])
def test_a_contact_is_two_discs_in_series(k_i, k_j):
    """A flux q = 1/(2 pi a sqrt(a^2 - r^2)) through the disc gives the half-space the potential V at its middle, where
    a flux through dA adds q dA/(2 pi k r); with r = a sin t no end is singular."""
    a = 1e-4
    flux = 2 * np.pi * quad(lambda t: a * np.sin(t) / (2 * np.pi * a), 0, np.pi / 2)[0]
    assert flux == pytest.approx(1.0)
    potential = sum(quad(lambda t, k=k: 1 / (2 * np.pi * a * k), 0, np.pi / 2)[0] for k in (k_i, k_j))
    assert contact_conductance(k_i=k_i, k_j=k_j, radius=a) == pytest.approx(1 / potential, rel=1e-12)


def test_bodies_in_any_order_and_arrays():
    radii = np.array([0.0, 1e-6, 2e-6])
    one, other = (contact_conductance(k_i=a, k_j=b, radius=radii) for a, b in ((4.0, 9.0), (9.0, 4.0)))
    assert np.array_equal(one, other) and one[0] == 0.0
    with pytest.raises(ValueError, match="k_j = 0, must lie in"):
        contact_conductance(k_i=1.0, k_j=0.0, radius=radii)
