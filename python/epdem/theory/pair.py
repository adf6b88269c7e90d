# SPDX-License-Identifier: GPL-2.0-or-later
"""Quantities of a pair of bodies."""

import numpy as np


def E_star(E1, nu1, E2, nu2):
    return 1 / ((1 - nu1**2) / E1 + (1 - nu2**2) / E2)


def G_star(E1, nu1, E2, nu2):
    return 1 / (2 * (2 - nu1) * (1 + nu1) / E1 + 2 * (2 - nu2) * (1 + nu2) / E2)


def R_star(R1, R2):
    return 1 / (1 / R1 + 1 / R2) if np.isfinite(R2) else R1


m_star = R_star


def sphere_mass(*, radius, density):
    return 4 / 3 * np.pi * radius**3 * density
