# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the energy of an impact goes: recovered, plastic, and radiated as elastic waves (section 8.2.4).

The laws of force lose no wave energy: the share of the waves is an estimate beside them (Miller and Pursey 1955; Hunter
1957; Hutchings 1979).
"""

from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from .backbone import Backbone
from .hertz import Hertz
from .numerics import Array, Real, bisect, gauss, number, poisson_ratio
from .pair import E_star, sphere_mass
from .restitution import impact


def history(law: Backbone, *, m_star: Real, speed: Real, samples: int = 201) -> tuple[Array, Array, Array]:
    """Time [s], overlap [m] and force [N] of impacts from first touch to no force (figure 8.18).

    law: with one E* and R*; m_star [kg], speed [m/s] > 0, of any shapes that broadcast. The results have that shape and
    a last axis of 2 samples - 1; the largest overlap is in its middle. Samples crowd where the overlap turns. The time
    follows from the energy of the law, to 1e-5 of the contact time.
    """
    m, v = number("m_star", np.asarray(m_star)[..., None]), number("speed", np.asarray(speed)[..., None])
    x = impact(law, m_star=m, speed=v)
    top, dent = x.overlap_max, x.residual_overlap
    # alpha = low + (top - low) sin^2 theta on each branch; time grows smoothly with theta
    theta = np.linspace(0, np.pi / 2, samples)
    middle = 0.5 * (theta[1:] + theta[:-1])
    steps: list[Array] = []
    for low, energy in ((np.zeros_like(top), x.work_in), (dent, x.work_out)):
        alpha = low + (top - low) * np.sin(middle) ** 2
        force = law.force(alpha) if not steps else law.unloading_force(alpha, top)
        way = (top - low) * np.sin(2 * middle) * theta[1]
        left = np.cumsum((force * way)[..., ::-1], axis=-1)[..., ::-1]  # work between theta and the top
        left = np.concatenate([left, 0 * top], axis=-1) * energy / left[..., :1]
        root = 0.5 * (np.sqrt(left[..., 1:]) + np.sqrt(left[..., :-1]))  # the work goes as the square of pi/2 - theta
        steps.append(way / (np.sqrt(2 / m) * root))
    ticks = np.concatenate([0 * top, steps[0], steps[1][..., ::-1]], axis=-1)
    time = np.cumsum(ticks, axis=-1)
    up = top * np.sin(theta) ** 2
    down = dent + (top - dent) * np.sin(theta[-2::-1]) ** 2
    overlap = np.concatenate([up, down], axis=-1)
    force = np.concatenate([law.force(up), law.unloading_force(down, top)], axis=-1)
    return time * x.contact_time / time[..., -1:], overlap, force


def _rayleigh(k2: Array, g: float) -> Array:
    """R(k) = (2k^2-1)^2 - 4 k^2 sqrt(k^2-g) sqrt(k^2-1) for k^2 > 1."""
    return (2 * k2 - 1) ** 2 - 4 * k2 * np.sqrt(k2 - g) * np.sqrt(k2 - 1)


@cache
def _wave_parts(nu: float) -> tuple[float, float]:
    """Parts of C(nu) from the bulk waves and from the Rayleigh pole."""
    g = (1 - 2 * nu) / (2 * (1 - nu))
    x, w = gauss(96)  # 1e-14 of C

    def imaginary(k: Array) -> Array:  # of k nu_p/R, 0 < k < 1: nu_s, below sqrt g nu_p, too, is imaginary
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

    nu in [0, 0.5), any shape. C = [2(1+nu)]^1.5/(2 pi) Im of the integral of k nu_p/R dk (Miller and Pursey 1955).
    """
    nu = number("nu", nu, low_ok=True, high=0.4999)
    return (2 * (1 + nu)) ** 1.5 / (2 * np.pi) * sum(np.vectorize(_wave_parts)(nu))


def rayleigh_share(nu: Real) -> Array:
    """Share of the radiated energy that the Rayleigh wave carries; nu in [0, 0.5), any shape."""
    bulk, pole = np.vectorize(_wave_parts)(number("nu", nu, low_ok=True, high=0.4999))
    return np.asarray(pole / (bulk + pole))


def radiated(force: ArrayLike, time: ArrayLike, *, E: Real, nu: Real, density: Real) -> Array:
    """Energy radiated into a half-space [J] by force histories: force [N] at increasing times [s], shape (..., n).

    E [Pa], nu and density [kg/m^3] are the half-space's. Between samples the force is taken as straight.
    """
    force = number("force", np.asarray(force, float), low=-np.inf)
    between = number("time, from sample to sample", np.diff(np.asarray(time, float)))
    c_0 = np.sqrt(number("E", E) / number("density", density))
    rate2 = np.sum(np.diff(force) ** 2 / between, axis=-1)
    return np.asarray(wave_constant(poisson_ratio("nu", nu)) / (density * c_0**3) * rate2)


def elastic_wave_share(speed: Real, *, E: float, nu: float, density: float) -> Array:
    """Share of the kinetic energy radiated by an elastic impact of a sphere on a half-space of the same material.

    speed [m/s]; 1.11 (v/c_0)^0.6 for nu = 0.25 (Hunter 1957 prints 1.04). The radius drops out.
    """
    law, mass = Hertz(E_star=E_star(E, nu, E, nu), R_star=1.0), sphere_mass(radius=1.0, density=density)
    return energy_split(law, m_star=mass, speed=speed, E=E, nu=nu, density=density)["waves"]


def plastic_wave_share(p_d: Real, *, E: Real, nu: Real, e_n: Real | None = None) -> Real:
    """Share of the kinetic energy radiated by a fully plastic impact on a half-space at constant pressure p_d [Pa].

    (pi/2)(2 pi)^1.5/sqrt(4 pi/3) C (p_d/E)^1.5, 6.95 (p_d/E)^1.5 for nu = 0.3; with e_n the rebound is added, which
    radiates 0.811/e_n times as much again (Hutchings 1979: about 3 % for steel at 70 m/s).
    """
    p_d, E = number("p_d", p_d), number("E", E)
    loading: Real = np.pi / 2 * (2 * np.pi) ** 1.5 / np.sqrt(4 * np.pi / 3) * wave_constant(nu) * (p_d / E) ** 1.5
    return loading if e_n is None else loading * (1 + 0.811 / number("e_n", e_n, high=1.0))


def energy_split(law: Backbone, *, m_star: Real, speed: Real, E: float, nu: float, density: float) -> dict[str, Array]:
    """Shares of the kinetic energy of impacts: "recovered" (e_n^2), "plastic" (the rest), and "waves".

    The work of the law is split between the first two without a remainder. The waves that the law's force history
    radiates into a half-space of E [Pa], nu and density [kg/m^3] are an estimate: in the real impact they come out of
    the recovered part. m_star [kg] and speed [m/s] > 0 broadcast.
    """
    x = impact(law, m_star=m_star, speed=speed)
    time, _, force = history(law, m_star=m_star, speed=speed)
    recovered = x.work_out / x.work_in
    waves = radiated(force, time, E=E, nu=nu, density=density) / x.work_in
    return {"recovered": recovered, "plastic": 1 - recovered, "waves": np.asarray(waves)}
