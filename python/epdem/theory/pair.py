# SPDX-License-Identifier: GPL-2.0-or-later
"""Quantities of a pair of bodies (Johnson 1985, sections 4.2 and 7.3). All arguments broadcast."""

import numpy as np

from .numerics import Array, Real, number, poisson_ratio

HARDENING = 1.75  # contact pressure of full plasticity over that of first yield: 2.8 Y over 1.60 Y


def _one_finite(name: str, a: Real, b: Real, otherwise: str) -> tuple[Real, Real]:
    a, b = number(name + "1", a, infinite=True), number(name + "2", b, infinite=True)
    if np.any(np.isinf(a) & np.isinf(b)):
        raise ValueError(f"{name}1 = {name}2 = inf, at least one must be finite: {otherwise}")
    return a, b


def E_star(E1: Real, nu1: Real, E2: Real, nu2: Real) -> Real:
    """Effective modulus [Pa]: 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2.

    E1, E2 [Pa] > 0, infinite for a rigid body; nu1, nu2 in (-1, 0.5]. ValueError outside and for two rigid bodies.
    """
    E1, E2 = _one_finite("E", E1, E2, "both bodies are rigid")
    nu1, nu2 = poisson_ratio("nu1", nu1), poisson_ratio("nu2", nu2)
    return 1 / ((1 - nu1**2) / E1 + (1 - nu2**2) / E2)


def G_star(E1: Real, nu1: Real, E2: Real, nu2: Real) -> Real:
    """Effective shear modulus [Pa]: 1/G* = (2-nu1)/G1 + (2-nu2)/G2 with G = E/(2(1+nu)); arguments as in E_star."""
    E1, E2 = _one_finite("E", E1, E2, "both bodies are rigid")
    nu1, nu2 = poisson_ratio("nu1", nu1), poisson_ratio("nu2", nu2)
    return 1 / (2 * (2 - nu1) * (1 + nu1) / E1 + 2 * (2 - nu2) * (1 + nu2) / E2)


def _reduced(a: Real, b: Real) -> Real:
    small, large = np.minimum(a, b), np.maximum(a, b)
    return small / (1 + small / large)  # no loss for a plane (inf) or very unequal bodies


def R_star(R1: Real, R2: Real) -> Real:
    """Effective radius [m]: 1/R* = 1/R1 + 1/R2; R1, R2 [m] > 0, infinite for a plane, not both."""
    return _reduced(*_one_finite("R", R1, R2, "both bodies are planes"))


def m_star(m1: Real, m2: Real) -> Real:
    """Effective mass [kg]: 1/m* = 1/m1 + 1/m2; m1, m2 [kg] > 0, infinite for a fixed body, not both."""
    return _reduced(*_one_finite("m", m1, m2, "both bodies are fixed"))


def strain_share(strength1: Real, strength2: Real, *, hardening: Real = HARDENING) -> Array:
    """Share w of body 1 in the strain of a contact; body 2 has 1 - w.

    The weaker body has (1 + t)/2, t = (S2/S1 - 1)/(hardening - 1) from 0 to 1, for strengths S1 <= S2: bodies of equal
    strength have 1/2 each, and a body that cannot yield, because the pressure of the other one stays below the pressure
    of its own first yield, has 0. strength1, strength2 [Pa] > 0, infinite: never yields; hardening > 1. ValueError
    outside.
    """
    one, other = number("strength1", strength1, infinite=True), number("strength2", strength2, infinite=True)
    low, high = np.minimum(one, other), np.maximum(one, other)
    ratio = np.divide(high, low, out=np.ones(np.broadcast(one, other).shape), where=np.isfinite(low))
    t = np.minimum((ratio - 1) / (number("hardening", hardening, low=1.0) - 1), 1.0)
    return np.where(one <= other, (1 + t) / 2, (1 - t) / 2)


def curvature_share(share1: Real, *, R_star: Real, R1: Real) -> Array:
    """Mean curvature of two bodies, weighted by their shares of the strain, times R*: R* (w/R1 + (1 - w)/R2).

    1/2 for bodies of equal strength, 1 for a sphere on a rigid plane, 0 for a rigid sphere on a plane. share1: w of
    body 1, 0 to 1; R_star, R1 [m] > 0, R1 infinite for a plane. ValueError outside.
    """
    w = number("share1", share1, low=0.0, high=1.0, low_ok=True)
    curvature = number("R_star", R_star) / number("R1", R1, infinite=True)
    return np.asarray(1 - w + (2 * w - 1) * np.minimum(curvature, 1.0))  # 1/(1/R1) can be above R1


def sphere_mass(*, radius: Real, density: Real) -> Real:
    """Mass of a solid sphere [kg]; radius [m] > 0, density [kg/m^3] > 0."""
    return 4 / 3 * np.pi * number("radius", radius) ** 3 * number("density", density)


def contact_conductance(*, k_i: Real, k_j: Real, radius: Real) -> Real:
    """Conductance of a circular contact: 2 k a, 2/k = 1/k_i + 1/k_j (Holm 1967, Batchelor and O'Brien 1977).

    k_i, k_j > 0: conductivity of both bodies [W/(m K)] or [S/m], inf of a body of one temperature or potential; radius
    a >= 0 [m], small beside the bodies. Heat flow over temperature difference [W/K], current over voltage [S]. Any
    shapes that broadcast; ValueError outside.
    """
    resistivity = 1 / number("k_i", k_i, infinite=True) + 1 / number("k_j", k_j, infinite=True)
    return 4 * number("radius", radius, low_ok=True) / resistivity
