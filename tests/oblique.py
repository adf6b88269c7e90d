# SPDX-License-Identifier: GPL-2.0-or-later
"""Oblique impact of a sphere (section 8.2.5): sliding in closed form, sticking and partial slip by integration.

theta is the impact angle from the normal; f = P_t/P_n the ratio of impulses; w the spin, positive as friction turns it.
"""

import math
from dataclasses import dataclass

import numpy as np

from epdem.theory.backbone import Backbone
from epdem.theory.hertz import Hertz
from epdem.theory.numerics import Array, Real, number, poisson_ratio
from epdem.theory.partial_slip import rebound
from epdem.theory.restitution import e_n as normal_restitution
from epdem.theory.viscous import damping_ratio

STEEPEST = 1.5707  # of impact angles [rad]: just below pi/2


def kappa(nu: Real) -> Real:
    """Ratio of tangential to normal stiffness of like bodies: 2(1-nu)/(2-nu), nu in (-1, 0.5]."""
    nu = poisson_ratio("nu", nu)
    return 2 * (1 - nu) / (2 - nu)


def _approach_and_rebound(e_n: Real) -> Real:
    """1 + e_n: the normal impulse in m v_n. e_n >= 0; a measured one may lie above 1 by its error."""
    return 1 + number("e_n", e_n, low_ok=True)


def tangential_restitution(f: Real, *, e_n: Real, theta: Real) -> Real:
    """e_t = 1 - f (1 + e_n)/tan theta; of the centre's tangential velocity. theta in (0, pi/2]; ValueError outside."""
    return 1 - f * _approach_and_rebound(e_n) / np.tan(number("theta", theta, high=np.pi / 2))


def spin(f: Real, *, e_n: Real, v_n: Real, R: Real, w_i: Real = 0.0) -> Real:
    """Spin after the impact [rad/s] of a solid sphere: w_i + (5/2) f (1 + e_n) v_n/R; v_n [m/s] > 0, R [m]."""
    return w_i + 2.5 * f * _approach_and_rebound(e_n) * number("v_n", v_n) / number("R", R)


def patch_rebound(f: Real, *, e_n: Real, theta: Real) -> Real:
    """Velocity of the contact patch after the impact, in v_n: tan theta - (7/2) f (1 + e_n), for w_i = 0.

    theta in [0, pi/2); ValueError outside.
    """
    return np.tan(number("theta", theta, low_ok=True, high=STEEPEST)) - 3.5 * f * _approach_and_rebound(e_n)


def sliding_angle(mu: Real, *, e_n: Real, nu: Real) -> Real:
    """Angle [rad] from which the patch slides throughout: tan theta = mu [(7/2)(1+e_n) - e_n/kappa].

    For e_n = 1 it is mu (7 - 1/kappa) (Maw, Barber and Fawcett 1976).
    """
    return np.arctan(number("mu", mu, low_ok=True) * (3.5 * _approach_and_rebound(e_n) - e_n / kappa(nu)))


@dataclass(frozen=True)
class Oblique:
    """Outcome of oblique impacts, arrays of the shape of theta."""

    f: Array  # impulse ratio P_t/P_n
    e_n: Array
    e_t: Array
    spin: Array  # [rad/s]
    patch: Array  # contact-patch velocity after impact, in v_n


def impact(
    law: Backbone,
    *,
    mass: float,
    R: float,
    mu: float,
    G_star: float,
    v_n: float,
    theta: Real,
    steps: int = 2000,
    springs: int = 200,
) -> Oblique:
    """Oblique impacts of a solid sphere on a fixed plane, with stick, partial slip and slip (`partial_slip`).

    mass [kg], R [m], G_star [Pa], v_n [m/s] > 0, theta [rad] in [0, pi/2) of any shape; `steps` in the contact (error
    about 1/steps^2) and `springs` over its radius. ValueError outside.
    """
    theta = np.asarray(number("theta", theta, low_ok=True, high=STEEPEST), float)
    mass, tangent = float(number("mass", mass)), np.tan(theta)
    after = rebound(
        law,
        m_star=mass,
        m_tangential=2 / 7 * mass,
        mu=mu,
        G_star=G_star,
        v_n=v_n,
        slip=tangent * v_n,
        steps=steps,
        springs=springs,
    )
    e_n = np.asarray(normal_restitution(law, m_star=mass, speed=v_n))
    f = 2 / 7 * mass * (tangent * v_n - after) / (mass * v_n * (1 + e_n))
    e_t = 1 - np.divide(f * (1 + e_n), tangent, out=np.full(theta.shape, np.nan), where=tangent > 0)
    turned, patch = np.asarray(spin(f, e_n=e_n, v_n=v_n, R=R)), np.asarray(patch_rebound(f, e_n=e_n, theta=theta))
    return Oblique(f=f, e_n=e_n, e_t=e_t, spin=turned, patch=patch)


def maw_barber_fawcett(psi_1: Real, *, kappa: float, steps: int = 2000) -> Array:
    """psi_2 of elastic oblique impacts of a solid sphere: psi = (kappa/mu) times slip velocity over v_n.

    (Maw, Barber and Fawcett 1976.) psi_1 >= 0 before, of any shape; kappa = 4 G*/E*, 2 (1-nu)/(2-nu) for like bodies.
    From psi_1 = 7 kappa - 1 on everything slides: psi_2 = psi_1 - 7 kappa.
    """
    psi_1, kappa = number("psi_1", psi_1, low_ok=True), float(number("kappa", kappa))
    after = rebound(
        Hertz(E_star=1.0, R_star=1.0),
        m_star=1.0,
        m_tangential=2 / 7,
        mu=kappa,
        G_star=kappa / 4,
        v_n=1e-3,
        slip=1e-3 * np.asarray(psi_1),
        steps=steps,
    )
    return 1e3 * after


def one_spring(slip, *, E_star, G_star, R, mass, mu, dt, speed=1.0, e_n=1.0, e_t=1.0, pulls=False):
    """(velocity along the plane, spin, velocity off it, f/mu) after impacts of Hertz contacts, in steps of `dt`.

    Cundall and Strack: a spring 8 G* a is cut off at mu F, with a dashpot inside of the limit; e_n, e_t: restitutions
    of both dashpots; slip [m/s]: velocities along the plane, an array. The arm of the torque is R - delta/2. pulls: the
    dashpots of LIGGGHTS's own hertz: one pulls, the other acts wherever the spring sticks, without a limit.
    """
    beta, zeta = (-math.log(e) / math.hypot(math.log(e), math.pi) for e in (e_t, e_n))
    zeta, c = zeta if pulls or e_n == 1.0 else float(damping_ratio(e_n)), 2 * math.sqrt(5 / 6)
    z, v, u = R, -speed, np.array(slip, float)
    w, s, along, across = (np.zeros(u.shape) for _ in range(4))
    while (delta := R - z) >= 0:
        a = math.sqrt(R * delta)
        F = 4 / 3 * E_star * a * delta - c * zeta * math.sqrt(2 * E_star * a * mass) * v
        F, k_t, arm = F if pulls else max(F, 0.0), 8 * G_star * a, R - delta / 2
        most, patch = mu * abs(F), u - arm * w
        spring = np.clip(k_t * (s + patch * dt), -most, most)
        s = spring / k_t if k_t > 0 else 0 * s
        T = spring + c * beta * math.sqrt(k_t * mass) * patch
        T = np.where(np.abs(spring) == most, spring, T) if pulls else np.clip(T, -most, most)
        along, across = along + T * dt, across + F * dt
        v, u, w = v + F / mass * dt, u - T / mass * dt, w + T * arm / (0.4 * mass * R * R) * dt
        z += v * dt
    return u, w, v, along / across / mu
