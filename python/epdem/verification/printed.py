# SPDX-License-Identifier: GPL-2.0-or-later
"""Equations 8.80 to 8.86 as Seville and Wu 2016 print them: contact pressures (figures 8.16, 8.17), restitution. SI."""

import numpy as np

from ..theory.numerics import Array, Real, number

FULLY_PLASTIC = (2.8, 3.0)  # p_m/Y; eq. 8.80
ELASTIC = 1.07  # p_m/Y at first yield; eq. 8.79


def cavity_mean(x: Real) -> Real:
    """Mean pressure p_m/Y of the expanding-cavity model, x = E* a/(Y R*) > 0, any shape (section 6.3).

    Eq. 8.81 [Johnson 1985]: p_m/Y = (2/3) [1 + ln((1/3) (E*/Y) (a/R*))]
    """
    return 2 / 3 * (1 + np.log(number("x", x) / 3))


def cavity_end(p: Real) -> Real:
    """x = E* a/(Y R*) at which the expanding cavity (8.81) reaches p_m/Y = p: 3 exp(1.5 p - 1), 73.6 at 2.8."""
    return 3 * np.exp(1.5 * number("p", p) - 1)


def elastic_mean(x: Real) -> Real:
    """Mean pressure p_m/Y of an elastic contact, x = E* a/(Y R*): 4 x/(3 pi) (figure 8.16)."""
    return 4 * number("x", x) / (3 * np.pi)


def mean(x: Real) -> Array:
    """p_m/Y over all three regimes of figure 8.16: elastic, expanding cavity, fully plastic."""
    elastic, cavity = elastic_mean(x), np.clip(cavity_mean(x), ELASTIC, FULLY_PLASTIC[0])
    return np.where(elastic <= ELASTIC, elastic, cavity)


def unloading(r: Real, *, a: Real, a_max: Real, p: Real) -> Array:
    """Pressure while a uniformly loaded circle unloads [Pa].

    Eq. 8.82 [Mesarovic and Johnson 2000]: p(r) = (2p/pi) asin sqrt((a^2 - r^2)/(a*^2 - r^2)), r <= a <= a*

    p [Pa] and a_max = a* belong to the start of unloading. a = a_max gives p everywhere; 0 outside a. ValueError if a
    exceeds a_max.
    """
    a, a_max, p = number("a", a), number("a_max", a_max), number("p", p)
    if np.any(a > a_max):
        raise ValueError(f"a = {np.max(a):g}, must lie in (0, a_max = {np.min(a_max):g}]")
    r = np.asarray(r, float)
    inside = np.maximum(a**2 - r**2, 0.0)
    base = np.maximum(a_max**2 - r**2, 0.0)
    share = np.divide(inside, base, out=np.array(np.where(r <= a, 1.0, 0.0) + 0 * inside), where=base > 0)
    return np.asarray(2 * p / np.pi * np.arcsin(np.sqrt(np.minimum(share, 1.0))))


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
