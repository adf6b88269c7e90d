# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the energy of an impact goes: recovered, plastic, and radiated as elastic waves (section 8.2.4).

The laws of force lose no wave energy: this is an estimate beside them (Miller and Pursey 1955; Hunter 1957;
Hutchings 1979).
"""

import numpy as np
from numpy.typing import ArrayLike

from ...theory.backbone import Backbone
from ...theory.numerics import Array, Real, bisect, gauss, number, poisson_ratio
from ...theory.restitution import impact


def history(law: Backbone, *, m_star: float, speed: float, samples: int = 1001) -> tuple[Array, Array, Array]:
    """Time [s], overlap [m] and force [N] of one impact, arrays of shape (samples,), from first touch to no force.

    The motion follows from the energy: t(alpha) on both branches by quadrature, then inverted by interpolation in the
    variable in which it is smooth. m_star [kg] and speed [m/s] are scalars > 0. Overlaps to 1e-7 of the largest.
    """
    x = impact(law, m_star=m_star, speed=speed)
    top, dent = float(x.overlap_max), float(x.residual_overlap)
    theta = np.linspace(0, np.pi / 2, 4001)
    h = theta[1] - theta[0]
    middle = 0.5 * (theta[1:] + theta[:-1])
    # alpha = low + (top - low) sin^2 theta on each branch; time grows smoothly with theta
    there = law.force(top * np.sin(middle) ** 2)
    back = dent + (top - dent) * np.sin(middle) ** 2
    here = law.unloading_force(back, top) if dent > 0 else law.force(back)
    branches = []
    for low, force, energy in ((0.0, there, float(x.work_in)), (dent, here, float(x.work_out))):
        piece = force * 2 * (top - low) * np.sin(middle) * np.cos(middle) * h
        left = np.append(np.cumsum(piece[::-1])[::-1], 0.0)  # work between theta and the top
        left *= energy / left[0]
        kinetic = (0.5 * (np.sqrt(left[1:]) + np.sqrt(left[:-1]))) ** 2  # it goes as the square of pi/2 - theta
        rate = 2 * (top - low) * np.sin(middle) * np.cos(middle) / np.sqrt(2 * kinetic / m_star)
        branches.append(np.concatenate([[0.0], np.cumsum(rate * h)]))
    t_top = branches[0][-1]
    times = np.concatenate([branches[0], t_top + branches[1][-1] - branches[1][-2::-1]])
    times *= float(x.contact_time) / times[-1]
    t = np.linspace(0, times[-1], samples)
    angle = np.interp(t, times, np.concatenate([theta, np.pi - theta[-2::-1]]))
    rising = angle <= np.pi / 2
    start = np.where(rising, 0.0, dent)
    alpha = start + (top - start) * np.sin(angle) ** 2
    slope = law.unloading_force(alpha, top) if dent > 0 else law.force(alpha)
    return t, alpha, np.where(rising, law.force(alpha), slope)


def _rayleigh(k2: Array, g: float) -> Array:
    """R(k) = (2k^2-1)^2 - 4 k^2 sqrt(k^2-g) sqrt(k^2-1) for k^2 > 1."""
    return (2 * k2 - 1) ** 2 - 4 * k2 * np.sqrt(k2 - g) * np.sqrt(k2 - 1)


def _wave_parts(nu: float) -> tuple[float, float]:
    """Parts of C(nu) from the bulk waves and from the Rayleigh pole."""
    g = (1 - 2 * nu) / (2 * (1 - nu))
    x, w = gauss(200)

    def imaginary(
        k: Array,
    ) -> Array:  # of k nu_p/R on 0 < k < 1: nu_s (and below sqrt g also nu_p) is imaginary, of one sign
        k2 = k * k
        nu_p = np.where(k2 < g, 1j * np.sqrt(np.maximum(g - k2, 0)), np.sqrt(np.maximum(k2 - g, 0)))
        nu_s = 1j * np.sqrt(1 - k2)
        return np.imag(k * nu_p / ((2 * k2 - 1) ** 2 - 4 * k2 * nu_p * nu_s))

    corner, bulk = np.sqrt(g), 0.0
    for low, high in ((0.0, corner), (corner, 1.0)):
        # the integrand has square roots at both ends: k = low + (high-low) sin^2
        theta = np.pi / 2 * x
        k = low + (high - low) * np.sin(theta) ** 2
        bulk += np.pi / 2 * (high - low) * 2 * float((np.sin(theta) * np.cos(theta) * imaginary(k)) @ w)
    # k^2 of the pole: 1/0.874^2 = 1.31 (nu = 0) down to 1.096 (nu = 0.5)
    k2 = float(bisect(lambda k2: _rayleigh(k2, g) > 0, 1.0, 4.0)[0])
    k, p, s = np.sqrt(k2), np.sqrt(k2 - g), np.sqrt(k2 - 1)
    slope = 8 * k * (2 * k2 - 1) - 8 * k * p * s - 4 * k2 * k * (s / p + p / s)
    return abs(bulk), abs(np.pi * k * p / slope)


def wave_constant(nu: Real) -> Real:
    """C(nu) of E_w = C/(rho c_0^3) integral of (dF/dt)^2 dt, c_0 = sqrt(E/rho); from Lamb's point-load solution.

    nu in [0, 0.5): scalar or array. C = [2(1+nu)]^1.5/(2 pi) Im of the integral of k nu_p/R dk.
    """
    nu = number("nu", nu, low_ok=True, high=0.4999)
    values: Real = np.vectorize(lambda n: (2 * (1 + n)) ** 1.5 / (2 * np.pi) * sum(_wave_parts(float(n))))(nu)[()]
    return values


def rayleigh_share(nu: Real) -> Real:
    """Share of the radiated energy that the Rayleigh wave carries; nu in [0, 0.5)."""
    nu = number("nu", nu, low_ok=True, high=0.4999)

    def share(n: float) -> float:
        bulk, pole = _wave_parts(float(n))
        return pole / (bulk + pole)

    values: Real = np.vectorize(share)(nu)[()]
    return values


def radiated(force: ArrayLike, time: ArrayLike, *, E: Real, nu: Real, density: Real) -> Real:
    """Energy radiated into a half-space [J] by a force history: force [N] at times [s], shape (n,), any spacing but 0.

    E [Pa], nu and density [kg/m^3] are the half-space's. Between samples the force is taken as straight.
    """
    force = number("force", np.asarray(force, float), low=-np.inf)
    between = number("time, from sample to sample", np.diff(np.asarray(time, float)))
    c_0 = np.sqrt(number("E", E) / number("density", density))
    rate2 = float(np.sum(np.diff(force) ** 2 / between))
    return wave_constant(poisson_ratio("nu", nu)) / (density * c_0**3) * rate2


def elastic_wave_fraction(speed: Real, *, E: Real, nu: Real, density: Real) -> Real:
    """Share of the kinetic energy radiated by an elastic impact of a sphere on a half-space of the same material.

    speed [m/s]; about 1.11 (v/c_0)^0.6 for nu = 0.25 (Hunter 1957 prints 1.04): the integral over Hertz's force.
    """
    v, nu = number("speed", speed), poisson_ratio("nu", nu)
    c_0 = np.sqrt(number("E", E) / number("density", density))
    # F = F_m f(t): integral of (dF/dt)^2 dt = integral of F'(alpha)^2 v(alpha) d alpha, twice; alpha in alpha_max
    s, w = gauss(80)
    # alpha = 1 - u^2: v = sqrt(1 - alpha^2.5)
    alpha = 1 - s * s
    shape = 2 * float(w @ (2 * s * (1.5**2) * alpha * np.sqrt(-np.expm1(2.5 * np.log(alpha)))))
    # F_m^2 v/alpha_m with W = 2/5 F_m alpha_m = m v^2/2, E* = E/(2(1-nu^2)), m = 4/3 pi rho R^3
    ratio = E / (2 * (1 - nu**2)) / E
    m, R = 4 / 3 * np.pi, 1.0  # per density and radius^3
    alpha_m = (15 / 16 * m * (v / c_0) ** 2 / (ratio * np.sqrt(R))) ** 0.4  # in R
    F_m = 5 / 4 * m * (v / c_0) ** 2 / alpha_m  # in E R^2
    rate2 = F_m**2 * (v / c_0) / alpha_m * shape  # the radius drops out
    share: Real = wave_constant(nu) * rate2 / (0.5 * m * (v / c_0) ** 2)
    return share


def plastic_wave_fraction(p_d: Real, *, E: Real, nu: Real, e_n: Real | None = None) -> Real:
    """Share of the kinetic energy radiated by a fully plastic impact on a half-space at constant pressure p_d [Pa].

    (pi/2)(2 pi)^1.5/sqrt(4 pi/3) C (p_d/E)^1.5, 6.95 (p_d/E)^1.5 for nu = 0.3; with e_n the rebound is added, which
    radiates 0.811/e_n times as much again (Hutchings 1979: about 3 % for steel at 70 m/s).
    """
    p_d, E = number("p_d", p_d), number("E", E)
    loading: Real = np.pi / 2 * (2 * np.pi) ** 1.5 / np.sqrt(4 * np.pi / 3) * wave_constant(nu) * (p_d / E) ** 1.5
    return loading if e_n is None else loading * (1 + 0.811 / number("e_n", e_n, high=1.0))


def split(law: Backbone, *, m_star: float, speed: float, E: float, nu: float, density: float) -> dict[str, float]:
    """Shares of the kinetic energy of one impact: "recovered" (e_n^2), "plastic" (the rest), and "waves".

    The law's work is split between the first two without a remainder; waves radiated into a half-space of E [Pa], nu
    and density [kg/m^3] by the law's force history are an estimate beside them (W_in = recovered + plastic + waves
    holds for the real impact, where they come out of the recovered part). Scalars only.
    """
    x = impact(law, m_star=m_star, speed=speed)
    time, _, force = history(law, m_star=m_star, speed=speed, samples=2001)
    waves = float(radiated(force, time, E=E, nu=nu, density=density)) / float(x.work_in)
    recovered = float(x.work_out / x.work_in)
    return {"recovered": recovered, "plastic": 1 - recovered, "waves": waves}
