# SPDX-License-Identifier: GPL-2.0-or-later
"""Reference times of an impact and the limits of explicit integration (velocity Verlet)."""

import numpy as np

from .numerics import Real, number, poisson_ratio
from .restitution import UNLOADING_TIME

# Share of the limit of one normal contact that stays stable in a dense frictionless packing (face-centred cubic,
# central springs). With friction see `sticking_packing`.
DENSE_PACKING = 0.5
LOOSE = 0.64  # relative density of a random close packing, from which a pressed bed of spheres has contacts
LEAST_SCREENING = 0.05
HERTZ_TIME = 2 * UNLOADING_TIME * (15 / 16) ** 0.4  # 2.8682657: contact time of Hertz in (m*^2/(R* E*^2 v))^(1/5)


def sticking_packing(kappa: Real, *, contacts: Real = 12) -> Real:
    """Share of that limit which is stable in a dense packing whose contacts stick: sqrt(0.6/(z kappa)).

    All grains of mass m that turn alike shear every contact: m omega^2 = (10/3) z kappa k_n, the highest frequency of a
    face-centred cubic packing (z = 12). kappa = k_t/k_n = 4 G*/E* > 0, 2 (1-nu)/(2-nu) for like bodies; `contacts` z
    per grain. At nu = 0.3 and z = 12: 0.246. Any shapes that broadcast; ValueError outside.
    """
    share: Real = np.sqrt(0.6 / (number("contacts", contacts) * number("kappa", kappa)))
    return share


def retreating_packing(screening_: float) -> float:
    """Share of that limit which is stable in a pressed frictionless packing: 0.5 (1 - 0.4 (1 - gamma)).

    The retreat of the sides of a body (law.compaction) follows from the forces of the steps before. At gamma = 0.39
    (80 spheres of copper, pressed to 0.94) the release creates 5.5 % of the work of the press at 0.8 of DENSE_PACKING,
    1.6 % at 0.8 of that step and 0.3 % at 0.7. screening_: gamma in (0, 1], 1 without compaction.
    """
    return DENSE_PACKING * (1 - 0.4 * (1 - screening_))


def stability_limit(*, E_star: Real, m_star: Real, radius: Real) -> Real:
    """Largest stable step of one normal contact [s]: T/pi = 2 sqrt(m*/k_n), k_n = 2 E* a at its largest a [m]."""
    k_n = 2 * number("E_star", E_star) * number("radius", radius)
    return 2 * np.sqrt(number("m_star", m_star) / k_n)


def pressed_radius(relative_density: Real) -> Real:
    """Contact radius over radius in a bed of equal spheres pressed to a relative density D in (0, 1].

    a^2 = 2 R x, x = 1 - (0.64/D)^(1/3): spheres of a random close packing that come nearer, and fully plastic contacts,
    the widest ones. 0 below the density of that packing.
    """
    approach = 1 - np.cbrt(LOOSE / number("relative_density", relative_density, high=1.0))
    radius: Real = np.sqrt(2 * np.maximum(approach, 0.0))
    return radius


def screening(radius: Real, *, poisson_ratio_: Real, contacts: Real = 12) -> Real:
    """gamma: recovery of a contact that unloads beside others of its size, over that of the contact alone.

    gamma = (1 - e)^1.5 + A/(a R) (1 - 2 nu)/(2 pi (1 - nu^2)), e = sqrt(A)/(2 R), A = (z - 1) a^2, from 0.05 to 1; its
    stiffness is 2 E* a/gamma (law.compaction). radius: a/R >= 0 of each of z `contacts`. 0.39 at a/R = 0.49, nu = 0.34.
    """
    a, nu = number("radius", radius, low_ok=True), poisson_ratio("poisson_ratio_", poisson_ratio_)
    others = number("contacts", contacts, low=1.0, low_ok=True) - 1
    tube = np.maximum(1 - np.sqrt(others) * a / 2, 0.0) ** 1.5
    gamma: Real = np.clip(tube + others * a * (1 - 2 * nu) / (2 * np.pi * (1 - nu**2)), LEAST_SCREENING, 1.0)
    return gamma


def rayleigh_time(*, radius: Real, density: Real, young_modulus: Real, poisson_ratio_: Real) -> Real:
    """Rayleigh time of a sphere [s]: pi R sqrt(rho/G)/(0.1631 nu + 0.8766)."""
    nu = poisson_ratio("poisson_ratio_", poisson_ratio_)
    G = number("young_modulus", young_modulus) / (2 * (1 + nu))
    time: Real = np.pi * number("radius", radius) * np.sqrt(number("density", density) / G) / (0.1631 * nu + 0.8766)
    return time


def hertz_time(*, E_star: Real, R_star: Real, m_star: Real, speed: Real) -> Real:
    """Contact time of an elastic impact [s]: 2.87 (m*^2/(R* E*^2 v))^(1/5) (Hertz 1882)."""
    scale = number("m_star", m_star) ** 2 / (number("R_star", R_star) * number("E_star", E_star) ** 2)
    time: Real = HERTZ_TIME * (scale / number("speed", speed)) ** 0.2
    return time
