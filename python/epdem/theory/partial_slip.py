# SPDX-License-Identifier: GPL-2.0-or-later
"""Friction with partial slip for any history of load and shear: independent springs along a contact line.

Per length the line carries 4 G* tangentially and the law's own load normally (`line_load`); each spring sticks
until it carries mu times its load. That is Cattaneo's and Mindlin's friction for any history (Jaeger 1993; the method
of dimensionality reduction, Popov and Hess 2015), and the reference of the C++ law with few nodes.
"""

import numpy as np

from .curve import Curve
from .numerics import Array, Real, number, segment
from .restitution import impact as normal_impact


def line_load(x: Real, *, force: Real, a: Real, a_max: Real, flatness: Real) -> Array:
    """Load per length [N/m] of the contact line at distance x [m] from its middle: Abel's transform of the pressure.

    q(x) = 2 times the integral of r p(r)/sqrt(r^2 - x^2) from x to a. p is (1-tau) of Hertz's half-ellipse and tau of
    uniform pressure over the circle a_max, less the rigid punches that took it from there to a: a constant of q. Its
    integral over the line is `force` [N]; a <= a_max [m] > 0, flatness tau in [0, 1], all broadcast. 0 beyond a.
    """
    a, a_max = number("a", a), number("a_max", a_max)
    tau = number("flatness", flatness, high=1.0, low_ok=True)
    if np.any(a > a_max):
        raise ValueError(f"a = {np.max(a):g}, must lie in (0, a_max = {np.min(a_max):g}]")
    x = np.asarray(x, float)
    b, inside = a / a_max, np.maximum((a - x) * (a + x), 0.0)
    # sqrt(a_max^2 - x^2) - sqrt(a_max^2 - a^2), without cancellation
    roots = np.sqrt(np.maximum((a_max - x) * (a_max + x), 0.0)) + np.sqrt((a_max - a) * (a_max + a))
    flat = np.divide(inside, roots, out=np.zeros(np.broadcast(inside, roots).shape), where=roots > 0)
    share = (1 - tau) * 0.75 * inside / a_max**3 + tau * 2 / np.pi * flat / a_max**2
    return np.asarray(force * share / ((1 - tau) * b**3 + tau * 2 / np.pi * segment(np.arcsin(b))))


class Springs:
    """The springs of contacts that share one history of load; each has its own history of shear.

    G_star [Pa], mu >= 0, a_max [m] the largest contact radius that will come, `shape` that of the slips: the last axis
    holds the components (1 along a line, 2 in a plane). ValueError for numbers outside.
    """

    def __init__(self, *, G_star: Real, mu: Real, a_max: float, shape: tuple[int, ...], springs: int = 400):
        self.G_star, self.mu = number("G_star", G_star), number("mu", mu, low_ok=True)
        self.width = 1.001 * float(number("a_max", a_max)) / springs
        self.x: Array = (np.arange(springs, dtype=float) + 0.5) * self.width
        self.stretch = np.zeros((*shape, springs))

    def move(self, slip: Real, *, force: float, a: float, a_peak: float, flatness: float) -> Array:
        """Friction [N], shape (..., components), after a slip [m] of that shape under `force` [N] on radius a [m].

        a_peak [m] and flatness belong to the start of the unloading (a_peak = a while loading); friction is positive
        as the slip that stretched the springs. Without force nothing is left.
        """
        if not (force > 0 and a > self.x[0]):
            self.stretch[:] = 0.0
            return np.zeros(self.stretch.shape[:-1])
        load = line_load(self.x, force=force, a=a, a_max=a_peak, flatness=flatness)
        load = load * (0.5 * force / (load.sum() * self.width))  # of these springs, exactly
        limit = self.mu * load / (4 * self.G_star)
        trial = self.stretch + np.asarray(slip)[..., None]
        length = np.sqrt(np.sum(trial * trial, axis=-2, keepdims=True))
        share = np.divide(limit, length, out=np.ones_like(length), where=length > limit)
        self.stretch = trial * share
        return np.asarray(8 * self.G_star * self.width * self.stretch.sum(axis=-1))


def rebound(
    law: Curve,
    *,
    m_star: float,
    m_tangential: float,
    mu: float,
    G_star: float,
    v_n: float,
    slip: Real,
    steps: int = 2000,
    springs: int = 400,
) -> Array:
    """Slip velocity [m/s] after impacts at v_n [m/s] with `slip` [m/s]; the impulse is m_tangential times its change.

    The two surfaces slip with the effective mass m_tangential [kg], (2/7) m for a solid sphere on a plane, and approach
    with m_star [kg]. slip has any shape, the results have it; `steps` of velocity Verlet in the contact (error about
    1/steps^2). ValueError for numbers outside.
    """
    normal = normal_impact(law, m_star=m_star, speed=number("v_n", v_n))
    m_tangential, dt = float(number("m_tangential", m_tangential)), float(normal.contact_time) / steps
    u = np.asarray(slip, float)[..., None]
    line = Springs(G_star=G_star, mu=mu, a_max=float(normal.radius_max), shape=u.shape, springs=springs)
    alpha, v, reached = 0.0, float(v_n), 0.0
    force, friction = 0.0, np.zeros(u.shape)
    for _ in range(int(1.2 * steps)):
        v -= 0.5 * dt * force / m_star
        u = u - 0.5 * dt * friction / m_tangential
        alpha += dt * v
        reached = max(alpha, reached)
        a_peak, tau = float(law.radius(reached)), float(law.flatness(reached))
        if alpha >= reached:
            force, a = float(law.force(alpha)), a_peak
        else:
            force, a = (float(q) for q in law.unloading(max(alpha, 0.0), reached))
        friction = line.move(dt * u, force=force, a=a, a_peak=a_peak, flatness=tau)
        v -= 0.5 * dt * force / m_star
        u = u - 0.5 * dt * friction / m_tangential
        if force == 0 and v < 0:
            break
    return u[..., 0]
