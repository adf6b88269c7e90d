# SPDX-License-Identifier: GPL-2.0-or-later
"""Equations 8.76 to 8.89 as Seville and Wu 2016 print them, with the pressure profiles of figures 8.15 to 8.17; SI.

Only 8.84 (`yielding.yield_speed`) and 8.85 (`johnson.Johnson`) stand elsewhere. Arguments broadcast. A function raises
ValueError for an argument outside of its domain, and returns NaN where the printed equation does not hold.
"""

import numpy as np
from numpy.typing import ArrayLike

from .numerics import Array, Real, bisect, number, poisson_ratio, segment

FIRST_YIELD_MEAN = 1.10  # p_m/Y at first yield; eq. 8.79
FULLY_PLASTIC = (2.8, 3.0)  # p_m/Y; eq. 8.80
ELASTIC = 1.07  # p_m/Y at first yield, 2/3 of 1.60


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


def axis_difference(z: Real, nu: Real) -> Array:
    """s_z - s_r on the axis of a Hertz contact at depth z (in a), in units of -p_0: the stress of both criteria."""
    z, nu = np.asarray(z, float), poisson_ratio("nu", nu)
    deep = np.maximum(z, 1e-300)
    s_r = -(1 + nu) * (1 - deep * np.arctan(1 / deep)) + 1 / (2 * (1 + z * z))
    return s_r + 1 / (1 + z * z)


def first_yield(nu: Real) -> tuple[Array, Array]:
    """(p_0/Y, depth z/a) of first yield on the axis under a sphere, exactly. nu in (-1, 0.5], of any shape.

    Eq. 8.78 [Johnson 1985]: p_0 = Y/max(s_r - s_z), 1.60 Y at nu = 0.3

    Both criteria coincide on the axis. The edge of the contact yields before it for nu below -0.34 (von
    Mises) or -0.13 (Tresca), where p_0/Y = sqrt(3)/(1-2 nu) or 1.5/(1-2 nu).
    """
    nu = poisson_ratio("nu", nu)
    low, high = 0.3 * (1 + nu), np.zeros(np.shape(nu)) + 1.5  # z goes to pi/6 (1 + nu) as nu goes to -1

    def slope(z: Array) -> Array:  # of axis_difference by z, in closed form
        return (1 + nu) * (np.arctan(1 / z) - z / (1 + z * z)) - 3 * z / (1 + z * z) ** 2

    z, _ = bisect(lambda z: slope(z) > 0, low, high)
    return 1 / axis_difference(z, nu), z


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


def cavity_mean(x: Real) -> Real:
    """Mean pressure p_m/Y of the expanding-cavity model, x = E* a/(Y R*) > 0, any shape.

    Eq. 8.81 [Johnson 1985]: p_m/Y = (2/3) [1 + ln((1/3) (E*/Y) (a/R*))]
    """
    return 2 / 3 * (1 + np.log(number("x", x) / 3))


def cavity_end(p: Real) -> Real:
    """x = E* a/(Y R*) at which the expanding cavity (8.81) reaches p_m/Y = p: 3 exp(1.5 p - 1), 73.6 at 2.8."""
    return 3 * np.exp(1.5 * number("p", p) - 1)


def elastic_mean(x: Real) -> Real:
    """Mean pressure p_m/Y of an elastic contact, x = E* a/(Y R*): 4 x/(3 pi) (figure 8.16)."""
    return 4 * number("x", x) / (3 * np.pi)


def mean_pressure(x: Real) -> Array:
    """p_m/Y over all three regimes of figure 8.16: elastic, expanding cavity, fully plastic."""
    elastic, cavity = elastic_mean(x), np.clip(cavity_mean(x), ELASTIC, FULLY_PLASTIC[0])
    return np.where(elastic <= ELASTIC, elastic, cavity)


def hertz_pressure(r: Real, *, p_0: Real, a: Real) -> Array:
    """Hertz's half-ellipse p_0 sqrt(1 - r^2/a^2) [Pa] at distances r from the axis; 0 outside the circle a."""
    x = np.asarray(r, float) / number("a", a)
    return np.asarray(number("p_0", p_0) * np.sqrt(np.maximum(1 - x * x, 0.0)))


def loading_pressure(r: Real, *, E_star: Real, R_star: Real, a: Real, p_y: Real) -> Array:
    """Pressure while the contact loads [Pa] (figure 8.17a; Thornton 1997): Hertz's at this a, cut off at p_y.

    r, a, R_star [m], E_star, p_y [Pa]. Hertz's peak is p_0 = 2 E* a/(pi R*).
    """
    p_0 = 2 * number("E_star", E_star) * number("a", a) / (np.pi * number("R_star", R_star))
    return np.minimum(hertz_pressure(r, p_0=p_0, a=a), number("p_y", p_y))


def _opening(a: Real, a_max: Real) -> tuple[Real, Real]:
    a, a_max = number("a", a), number("a_max", a_max)
    if np.any(a > a_max):
        raise ValueError(f"a = {np.max(a):g}, must lie in (0, a_max = {np.min(a_max):g}]")
    return a, a_max


def unloading_pressure(r: Real, *, a: Real, a_max: Real, p: Real) -> Array:
    """Pressure while a uniformly loaded circle unloads [Pa].

    Eq. 8.82 [Mesarovic and Johnson 2000]: p(r) = (2p/pi) asin sqrt((a^2 - r^2)/(a*^2 - r^2)), r <= a <= a*

    p [Pa] and a_max = a* belong to the start of unloading. a = a_max gives p everywhere; 0 outside a. ValueError if a
    exceeds a_max.
    """
    (a, a_max), p = _opening(a, a_max), number("p", p)
    r = np.asarray(r, float)
    inside = np.maximum(a**2 - r**2, 0.0)
    base = np.maximum(a_max**2 - r**2, 0.0)
    share = np.divide(inside, base, out=np.array(np.where(r <= a, 1.0, 0.0) + 0 * inside), where=base > 0)
    return np.asarray(2 * p / np.pi * np.arcsin(np.sqrt(np.minimum(share, 1.0))))


def unloading_force(*, a: Real, a_max: Real, p: Real) -> Array:
    """Integral of `unloading_pressure` over the circle [N]: 2 p a*^2 (t - sin t cos t), t = asin(a/a*).

    a, a_max = a* [m], p [Pa] > 0; full accuracy for small a. ValueError if a exceeds a_max.
    """
    a, a_max = _opening(a, a_max)
    return 2 * number("p", p) * a_max**2 * segment(np.arcsin(a / a_max))


def thornton_restitution(speed: Real, *, v_y: Real) -> Array:
    """Restitution of the truncated Hertz pressure; speed, v_y [m/s] > 0; 1 up to v_y.

    Eq. 8.83 [Thornton 1997]: e_n = sqrt(6 sqrt(3)/5) sqrt(1 - r^2/6) [r/(r + 2 sqrt(6/5 - r^2/5))]^(1/4), r = v_y/v
    """
    r = np.minimum(number("v_y", v_y) / number("speed", speed), 1.0)
    root = np.sqrt(6 / 5 - r * r / 5)
    e_n = np.sqrt(6 * np.sqrt(3) / 5) * np.sqrt(1 - r * r / 6) * (r / (r + 2 * root)) ** 0.25
    return np.where(r >= 1, 1.0, e_n)


def johnson_restitution(speed: Real, *, p_m: Real, E_star: Real, R_star: Real, m_star: Real) -> Array:
    """Fully plastic restitution. NaN where it exceeds 1: it is meant for v >> v_y.

    Eq. 8.86 [Johnson 1985]: e_n^2 = (3 sqrt2 pi^(5/4)/5) (p_m/E*) (m* v^2/(2 p_m R*^3))^(-1/4)

    speed [m/s], p_m, E_star [Pa], R_star [m], m_star [kg].
    """
    p_m, E_star = number("p_m", p_m), number("E_star", E_star)
    energy = number("m_star", m_star) * number("speed", speed) ** 2 / (2 * p_m * number("R_star", R_star) ** 3)
    e_n = np.sqrt(3 * np.sqrt(2) * np.pi**1.25 / 5 * p_m / E_star * energy**-0.25)
    return np.where(e_n <= 1, e_n, np.nan)


def johnson_plane_restitution(speed: Real, *, p_m: Real, E_star: Real, density: Real) -> Array:
    """Sphere on a plane, fully plastic. NaN where it exceeds 1.

    Eq. 8.87 [Johnson 1985]: e_n = 1.718 (p_m^5/(E*^4 rho))^(1/8) v^(-1/4)

    The radius drops out. density [kg/m^3]; 1.718 is the printed rounding of the general equation's constant.
    """
    p_m, E_star = number("p_m", p_m), number("E_star", E_star)
    e_n = 1.718 * (p_m**5 / (E_star**4 * number("density", density))) ** 0.125 * number("speed", speed) ** -0.25
    return np.where(e_n <= 1, e_n, np.nan)


def wu_restitution(speed: Real, *, v_y0: Real) -> Array:
    """Finite-element fit. NaN below v/v_y0 = 100.

    Eq. 8.88 [Wu et al. 2003]: e_n = 2.08 (v/v_y0)^(-1/4), v/v_y0 >= 100

    v_y0 [m/s] is the speed of first yield (1.60 Y), not that of 2.8 Y.
    """
    ratio = number("speed", speed) / number("v_y0", v_y0)
    return np.where(ratio >= 100, 2.08 * ratio**-0.25, np.nan)


def bridges_restitution(speed: Real) -> Array:
    """Ice spheres; speed in m/s here. NaN outside the measured range.

    Eq. 8.89 [Bridges et al. 1984]: e_n = 0.32 v^(-0.234), v in cm/s, 0.015 < v < 5.1

    (The text prints the exponent rounded to 0.23.)
    """
    v = 100 * number("speed", speed)
    return np.where((v > 0.015) & (v < 5.1), 0.32 * v**-0.234, np.nan)
