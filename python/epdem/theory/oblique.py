# SPDX-License-Identifier: GPL-2.0-or-later
"""Oblique impact of a sphere (section 8.2.5): sliding in closed form, sticking and partial slip by integration.

theta is the impact angle from the normal; f = P_t/P_n the ratio of impulses; w the spin, positive as friction turns it.
"""

from dataclasses import dataclass

import numpy as np

from .backbones import Backbone
from .checks import number, poisson_ratio

STEEPEST = 1.5707  # of impact angles [rad]: just below pi/2


def kappa(nu):
    """Ratio of tangential to normal stiffness of like bodies: 2(1-nu)/(2-nu), nu in (-1, 0.5]."""
    nu = poisson_ratio("nu", nu)
    return 2 * (1 - nu) / (2 - nu)


def _approach_and_rebound(e_n):
    """1 + e_n: the normal impulse in m v_n. e_n >= 0; a measured one may lie above 1 by its error."""
    return 1 + number("e_n", e_n, low_ok=True)


def tangential_restitution(f, *, e_n, theta):
    """e_t = 1 - f (1 + e_n)/tan theta; of the centre's tangential velocity. theta in (0, pi/2]; ValueError outside."""
    return 1 - f * _approach_and_rebound(e_n) / np.tan(number("theta", theta, high=np.pi / 2))


def spin(f, *, e_n, v_n, R, w_i=0.0):
    """Spin after the impact [rad/s] of a solid sphere: w_i + (5/2) f (1 + e_n) v_n/R; v_n [m/s] > 0, R [m]."""
    return w_i + 2.5 * f * _approach_and_rebound(e_n) * number("v_n", v_n) / number("R", R)


def patch_rebound(f, *, e_n, theta):
    """Velocity of the contact patch after the impact, in v_n: tan theta - (7/2) f (1 + e_n), for w_i = 0.

    theta in [0, pi/2); ValueError outside.
    """
    return np.tan(number("theta", theta, low_ok=True, high=STEEPEST)) - 3.5 * f * _approach_and_rebound(e_n)


def sliding_angle(mu, *, e_n, nu):
    """Angle [rad] from which the patch slides throughout: tan theta = mu [(7/2)(1+e_n) - e_n/kappa].

    For e_n = 1 it is mu (7 - 1/kappa) (Maw, Barber and Fawcett 1976).
    """
    return np.arctan(number("mu", mu, low_ok=True) * (3.5 * _approach_and_rebound(e_n) - e_n / kappa(nu)))


def sliding_angle_spring(mu, *, e_n, nu):
    """The same for a DEM spring k_t = 8 G* a that is cut off at mu F: mu [(7/2)(1+e_n) - (2/3) e_n/kappa]."""
    return np.arctan(number("mu", mu, low_ok=True) * (3.5 * _approach_and_rebound(e_n) - 2 / 3 * e_n / kappa(nu)))


@dataclass(frozen=True)
class Oblique:
    """Outcome of oblique impacts, arrays of the shape of theta."""

    f: np.ndarray  # impulse ratio P_t/P_n
    e_n: np.ndarray
    e_t: np.ndarray
    spin: np.ndarray  # [rad/s]
    patch: np.ndarray  # contact-patch velocity after impact, in v_n


def impact(law: Backbone, *, mass, R, mu, G_star, v_n, theta, steps=2000, springs=200) -> Oblique:
    """Oblique impacts of a solid sphere on a fixed plane, with stick, partial slip and slip.

    Cattaneo-Mindlin friction for any load history by independent springs along the contact (Jaeger 1993; the method
    of dimensionality reduction, Popov and Hess 2015): per length 4 G* tangentially, and a normal load that goes as
    a^2 - x^2 (exact for Hertz and for unloading with tau = 0; the half-ellipse is kept while the law yields). Each
    sticks until it carries mu times its load. mass [kg], R [m], G_star [Pa], v_n [m/s] > 0, theta [rad] in [0, pi/2)
    of any shape; `steps` in the contact (error about 1/steps^2) and `springs` over its radius.
    """
    from .restitution import impact as normal_impact

    theta = np.asarray(number("theta", theta, low_ok=True, high=STEEPEST), float)
    mu, mass, R = number("mu", mu, low_ok=True), number("mass", mass), number("R", R)
    normal = normal_impact(law, m_star=mass, speed=v_n)
    dt = float(normal.contact_time) / steps
    a_top = float(normal.radius_max)
    x = (np.arange(springs) + 0.5) / springs * a_top * 1.001
    stiffness = 2 * 4 * number("G_star", G_star) * (x[1] - x[0])  # both halves of the line
    slip = (np.tan(theta) * v_n).ravel()  # patch velocity
    stretch = np.zeros((slip.size, springs))
    alpha, v, reached, impulse = 0.0, float(v_n), 0.0, np.zeros(slip.size)
    force, friction = 0.0, np.zeros(slip.size)
    for _ in range(int(1.2 * steps)):
        v_half = v - 0.5 * dt * force / mass
        slip_half = slip - 0.5 * dt * 3.5 * friction / mass
        alpha += dt * v_half
        if alpha >= reached:
            reached = alpha
            force, a = float(law.force(alpha)), float(law.radius(alpha))
        else:
            force, a = (float(q) for q in law.unloading(alpha, reached))
        limit = np.zeros(springs)
        if force > 0:
            load = np.maximum(a * a - x * x, 0.0)
            limit = mu * force * load / load.sum()
        stretch = np.clip(stretch + dt * slip_half[:, None], -limit / stiffness, limit / stiffness)
        friction = stiffness * stretch.sum(axis=1)
        v = v_half - 0.5 * dt * force / mass
        slip = slip_half - 0.5 * dt * 3.5 * friction / mass
        impulse += dt * friction
        if force == 0 and v < 0:
            break
    e_n = np.asarray(normal.e_n)
    f = (impulse / (mass * v_n * (1 + e_n))).reshape(theta.shape)
    tangent = np.tan(theta)
    e_t = 1 - np.divide(f * (1 + e_n), tangent, out=np.full(theta.shape, np.nan), where=tangent > 0)
    turned, patch = spin(f, e_n=e_n, v_n=v_n, R=R), patch_rebound(f, e_n=e_n, theta=theta)
    return Oblique(f=f, e_n=e_n, e_t=e_t, spin=turned, patch=patch)
