# SPDX-License-Identifier: GPL-2.0-or-later
"""Equations 8.83 to 8.89 of restitution as Seville and Wu 2016 print them; NaN outside their domains, see `why_not`."""

import numpy as np

from ...theory.numerics import Array, Real, number


def thornton(speed: Real, *, v_y: Real) -> Array:
    """Restitution of the truncated Hertz pressure; speed, v_y [m/s] > 0; 1 up to v_y.

    Eq. 8.83 [Thornton 1997]: e_n = sqrt(6 sqrt(3)/5) sqrt(1 - r^2/6) [r/(r + 2 sqrt(6/5 - r^2/5))]^(1/4), r = v_y/v
    """
    r = np.minimum(number("v_y", v_y) / number("speed", speed), 1.0)
    root = np.sqrt(6 / 5 - r * r / 5)
    e_n = np.sqrt(6 * np.sqrt(3) / 5) * np.sqrt(1 - r * r / 6) * (r / (r + 2 * root)) ** 0.25
    return np.where(r >= 1, 1.0, e_n)


def johnson(speed: Real, *, p_m: Real, E_star: Real, R_star: Real, m_star: Real) -> Array:
    """Fully plastic restitution. NaN where it exceeds 1: it is meant for v >> v_y.

    Eq. 8.86 [Johnson 1985]: e_n^2 = (3 sqrt2 pi^(5/4)/5) (p_m/E*) (m* v^2/(2 p_m R*^3))^(-1/4)

    speed [m/s], p_m, E_star [Pa], R_star [m], m_star [kg].
    """
    p_m, E_star = number("p_m", p_m), number("E_star", E_star)
    energy = number("m_star", m_star) * number("speed", speed) ** 2 / (2 * p_m * number("R_star", R_star) ** 3)
    e_n = np.sqrt(3 * np.sqrt(2) * np.pi**1.25 / 5 * p_m / E_star * energy**-0.25)
    return np.where(e_n <= 1, e_n, np.nan)


def johnson_plane(speed: Real, *, p_m: Real, E_star: Real, density: Real) -> Array:
    """Sphere on a plane, fully plastic. NaN where it exceeds 1.

    Eq. 8.87 [Johnson 1985]: e_n = 1.718 (p_m^5/(E*^4 rho))^(1/8) v^(-1/4)

    The radius drops out. density [kg/m^3]; 1.718 is the printed rounding of the general equation's constant.
    """
    p_m, E_star = number("p_m", p_m), number("E_star", E_star)
    e_n = 1.718 * (p_m**5 / (E_star**4 * number("density", density))) ** 0.125 * number("speed", speed) ** -0.25
    return np.where(e_n <= 1, e_n, np.nan)


def bridges(speed: Real) -> Array:
    """Ice spheres; speed in m/s here. NaN outside the measured range.

    Eq. 8.89 [Bridges et al. 1984]: e_n = 0.32 v^(-0.234), v in cm/s, 0.015 < v < 5.1

    (The text prints the exponent rounded to 0.23.)
    """
    v = 100 * number("speed", speed)
    return np.where((v > 0.015) & (v < 5.1), 0.32 * v**-0.234, np.nan)
