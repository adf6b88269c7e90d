# SPDX-License-Identifier: GPL-2.0-or-later
"""Equations of the chapter that tests alone use: yield criteria, mean pressures at first yield and at full plasticity,
and two printed restitutions."""

import numpy as np
from numpy.typing import ArrayLike

from epdem.theory.numerics import Array, Real, bisect, number, poisson_ratio
from epdem.verification.printed import FULLY_PLASTIC

FIRST_YIELD_MEAN_ROUNDED = 1.10  # p_m/Y at first yield; eq. 8.79


def axis_difference(z: Real, nu: Real) -> Array:
    """s_z - s_r on the axis of a Hertz contact at depth z (in a), in units of -p_0: the stress of both criteria."""
    z, nu = np.asarray(z, float), poisson_ratio("nu", nu)
    deep = np.maximum(z, 1e-300)
    s_r = -(1 + nu) * (1 - deep * np.arctan(1 / deep)) + 1 / (2 * (1 + z * z))
    return s_r + 1 / (1 + z * z)


def first_yield(nu: Real) -> tuple[Array, Array]:
    """(p_0/Y, depth z/a) of first yield on the axis under a sphere, exactly. nu in (-1, 0.5], of any shape.

    Eq. 8.78 [Johnson 1985]: p_0 = Y/max(s_r - s_z), 1.60 Y at nu = 0.3

    Both criteria coincide on the axis (section 6.1). The edge of the contact yields before it for nu below -0.34 (von
    Mises) or -0.13 (Tresca), where p_0/Y = sqrt(3)/(1-2 nu) or 1.5/(1-2 nu).
    """
    nu = poisson_ratio("nu", nu)
    low, high = 0.3 * (1 + nu), np.zeros(np.shape(nu)) + 1.5  # z goes to pi/6 (1 + nu) as nu goes to -1

    def slope(z: Array) -> Array:  # of axis_difference by z, in closed form
        return (1 + nu) * (np.arctan(1 / z) - z / (1 + z * z)) - 3 * z / (1 + z * z) ** 2

    z, _ = bisect(lambda z: slope(z) > 0, low, high)
    return 1 / axis_difference(z, nu), z


def von_mises(s1: ArrayLike, s2: ArrayLike, s3: ArrayLike) -> Array:
    """Equivalent stress sqrt(3 J2) of principal stresses [Pa]: yield when it reaches Y. Any shapes that broadcast.

    Eq. 8.76 [Johnson 1985]: J2 = [(s1-s2)^2 + (s2-s3)^2 + (s3-s1)^2]/6 = k^2 = Y^2/3
    """
    s1, s2, s3 = (np.asarray(s, float) for s in (s1, s2, s3))
    return np.asarray(np.sqrt(((s1 - s2) ** 2 + (s2 - s3) ** 2 + (s3 - s1) ** 2) / 2))


def tresca(s1: ArrayLike, s2: ArrayLike, s3: ArrayLike) -> Array:
    """Largest difference of principal stresses [Pa]: yield when it reaches Y. Any shapes that broadcast.

    Eq. 8.77 [Johnson 1985]: max(|s1-s2|, |s2-s3|, |s3-s1|) = 2k = Y
    """
    s = np.stack(np.broadcast_arrays(*(np.asarray(x, float) for x in (s1, s2, s3))))
    return np.asarray(s.max(axis=0) - s.min(axis=0))


def first_yield_mean(nu: Real) -> Array:
    """Mean pressure p_m/Y at first yield, exactly. nu in (-1, 0.5], any shape; ValueError outside.

    Eq. 8.79 [Johnson 1985]: p_m = 2/3 p_0, rounded to 1.10 Y
    """
    return 2 / 3 * first_yield(nu)[0]


def fully_plastic_mean(Y: Real) -> tuple[Real, Real]:
    """Mean pressure of fully plastic contact (low, high) [Pa]; Y [Pa] > 0, any shape; ValueError outside.

    Eq. 8.80 [Johnson 1985]: p_m = 2.8 Y to 3.0 Y
    """
    Y = number("Y", Y)
    low, high = FULLY_PLASTIC
    return low * Y, high * Y


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
