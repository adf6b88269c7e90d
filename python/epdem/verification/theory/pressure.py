# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact pressure: profiles, means and integrals (8.81, 8.82, figures 8.15 to 8.17). r and a in one unit, p in Pa."""

import numpy as np
from numpy.typing import NDArray

from ...theory.numerics import Array, Real, number, segment


def hertz(r: Real, *, p_0: Real, a: Real) -> Real:
    """Hertz's half-ellipse p_0 sqrt(1 - r^2/a^2) [Pa]; 0 outside the circle."""
    x = np.asarray(r, float) / number("a", a)
    return number("p_0", p_0) * np.sqrt(np.maximum(1 - x * x, 0.0))


def hertz_peak(*, E_star: Real, R_star: Real, a: Real) -> Real:
    """Peak pressure of a Hertz contact of radius a: p_0 = 2 E* a/(pi R*) [Pa]; the mean is two thirds of it."""
    return 2 * number("E_star", E_star) * number("a", a) / (np.pi * number("R_star", R_star))


def hertz_force(*, p_0: Real, a: Real) -> Real:
    """Integral of Hertz's pressure over the circle [N]: 2/3 pi a^2 p_0; the mean pressure is 2/3 p_0."""
    return 2 / 3 * np.pi * number("a", a) ** 2 * number("p_0", p_0)


def truncated(r: Real, *, p_0: Real, a: Real, p_y: Real) -> Real:
    """Thornton's flattened profile while loading: min(Hertz, p_y) with the Hertzian a (figure 8.15; Thornton 1997)."""
    return np.minimum(hertz(r, p_0=p_0, a=a), number("p_y", p_y))


def truncated_force(*, p_0: Real, a: Real, p_y: Real) -> Real:
    """Integral of the truncated profile over the circle [N]: 2/3 pi a^2 p_0 less the cut-off cap."""
    p_0, a, p_y = number("p_0", p_0), number("a", a), number("p_y", p_y)
    cap = np.where(p_0 > p_y, 2 / 3 * np.pi * a**2 * p_0 * (1 - np.minimum(p_y / p_0, 1.0) ** 3), 0.0)
    plateau = np.pi * a**2 * p_y * np.maximum(1 - (p_y / p_0) ** 2, 0.0)
    return 2 / 3 * np.pi * a**2 * p_0 - cap + plateau


def cavity_mean(x: Real) -> Real:
    """Mean pressure p_m/Y of the expanding-cavity model, x = E* a/(Y R*) > 0, any shape (section 6.3).

    Eq. 8.81 [Johnson 1985]: p_m/Y = (2/3) [1 + ln((1/3) (E*/Y) (a/R*))]

    Between about x = 2.5 (first yield) and 40 (fully plastic): see `regime`.
    """
    return 2 / 3 * (1 + np.log(number("x", x) / 3))


def cavity_end(p: Real) -> Real:
    """x = E* a/(Y R*) at which the expanding cavity (8.81) reaches p_m/Y = p: 3 exp(1.5 p - 1), 73.6 at 2.8."""
    return 3 * np.exp(1.5 * number("p", p) - 1)


def elastic_mean(x: Real) -> Real:
    """Mean pressure p_m/Y of an elastic contact, x = E* a/(Y R*): 4 x/(3 pi) (figure 8.16)."""
    return 4 * number("x", x) / (3 * np.pi)


def mean(x: Real, *, plastic: Real = 2.8) -> Array:
    """p_m/Y over all three regimes of figure 8.16: elastic to 1.07, expanding cavity, fully plastic at `plastic`."""
    x = number("x", x)
    middle = np.maximum(cavity_mean(x), 1.07)
    return np.where(elastic_mean(x) <= 1.07, elastic_mean(x), np.minimum(middle, plastic))


def regime(x: Real, *, plastic: Real = 2.8) -> NDArray[np.int_]:
    """0 elastic, 1 elastic-plastic, 2 fully plastic, at x = E* a/(Y R*)."""
    p = mean(x, plastic=plastic)
    return np.asarray(np.where(elastic_mean(x) <= 1.07, 0, np.where(p < plastic, 1, 2)))


def _opening(a: Real, a_max: Real) -> tuple[Real, Real]:
    a, a_max = number("a", a), number("a_max", a_max)
    if np.any(a > a_max):
        raise ValueError(f"a = {np.max(a):g}, must lie in (0, a_max = {np.min(a_max):g}]")
    return a, a_max


def unloading(r: Real, *, a: Real, a_max: Real, p: Real) -> Array:
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
    """Integral of `unloading` over the circle [N]: 2 p a*^2 [t - sin t cos t], t = asin(a/a*), to full accuracy.

    a, a_max = a* [m], p [Pa] > 0, any shapes that broadcast; ValueError if a exceeds a_max.
    """
    a, a_max = _opening(a, a_max)
    return 2 * number("p", p) * a_max**2 * segment(np.arcsin(a / a_max))
