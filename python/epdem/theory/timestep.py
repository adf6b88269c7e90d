# SPDX-License-Identifier: GPL-2.0-or-later
"""Reference times of an impact and the limits of explicit integration (velocity Verlet)."""

import numpy as np

from .checks import number, poisson_ratio
from .restitution import UNLOADING_TIME

# Shares of the limit of one normal contact that stay stable: with a tangential spring (sphere on a plane, nu = 0.3),
# and in a dense packing (face-centred cubic, central springs).
WITH_TANGENTIAL_SPRING = 0.59
DENSE_PACKING = 0.5
HERTZ_TIME = 2 * UNLOADING_TIME * (15 / 16) ** 0.4  # 2.8682657: contact time of Hertz in (m*^2/(R* E*^2 v))^(1/5)


def stability_limit(*, E_star, m_star, radius):
    """Largest stable step of one normal contact [s]: T/pi = 2 sqrt(m*/k_n), k_n = 2 E* a at its largest a [m]."""
    k_n = 2 * number("E_star", E_star) * number("radius", radius)
    return 2 * np.sqrt(number("m_star", m_star) / k_n)


def rayleigh_time(*, radius, density, young_modulus, poisson_ratio_):
    """Rayleigh time of a sphere [s]: pi R sqrt(rho/G)/(0.1631 nu + 0.8766)."""
    nu = poisson_ratio("poisson_ratio_", poisson_ratio_)
    G = number("young_modulus", young_modulus) / (2 * (1 + nu))
    return np.pi * number("radius", radius) * np.sqrt(number("density", density) / G) / (0.1631 * nu + 0.8766)


def hertz_time(*, E_star, R_star, m_star, speed):
    """Contact time of an elastic impact [s]: 2.87 (m*^2/(R* E*^2 v))^(1/5) (Hertz 1882)."""
    scale = number("m_star", m_star) ** 2 / (number("R_star", R_star) * number("E_star", E_star) ** 2)
    return HERTZ_TIME * (scale / number("speed", speed)) ** 0.2
