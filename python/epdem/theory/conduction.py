# SPDX-License-Identifier: GPL-2.0-or-later
"""Conduction of heat and current through the area of a contact."""

from .numerics import Real, number


def contact_conductance(*, k_i: Real, k_j: Real, radius: Real) -> Real:
    """Conductance of a circular contact: 2 k a, 2/k = 1/k_i + 1/k_j (Holm 1967, Batchelor and O'Brien 1977).

    k_i, k_j > 0: conductivity of both bodies [W/(m K)] or [S/m], inf of a body of one temperature or potential; radius
    a >= 0 [m], small beside the bodies. Heat flow over temperature difference [W/K], current over voltage [S]. Any
    shapes that broadcast; ValueError outside.
    """
    resistivity = 1 / number("k_i", k_i, infinite=True) + 1 / number("k_j", k_j, infinite=True)
    return 4 * number("radius", radius, low_ok=True) / resistivity
