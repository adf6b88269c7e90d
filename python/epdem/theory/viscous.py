# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts of a law with a dashpot on its elastic branches: the equation of motion, solved to 1e-10.

m* alpha'' = -max(0, F(alpha) + c alpha'), c = 2 sqrt(5/6) zeta sqrt(2 E* a m*), and no dashpot while the contact
yields (there F lies on the backbone). zeta makes the restitution of impacts that do not yield a constant of the pair
(Tsuji, Tanaka and Ishida 1992, with the force cut off at 0): zeta = sin phi, e = exp(-(pi - 2 phi) tan phi).

Where F goes as x^1.5 and a as x^0.5 (x: overlap above the dent), the motion is a damped oscillator: with u = x^(5/4)
and a phase that grows by x^(1/4) dt, u'' + 2 zeta u' + u = 0. The branch of a flattened contact is integrated.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from . import restitution as undamped
from .curve import Curve
from .numerics import Array, Real, bisect, gauss, number

RESTITUTION_MIN = 0.14  # the formula's limit for zeta -> 1 is exp(-2) = 0.135
Rate: TypeAlias = Callable[[Array], Array]  # of states (k, n): one number or their change for each
_STEP = 1 / 8  # of theta; the extrapolation below then leaves 1e-12
_X, _W = gauss(32)


def damping_ratio(e: Real) -> Array:
    """zeta of a Hertz contact with restitution e in [0.14, 1], any shape. Raises ValueError outside."""
    e = np.asarray(number("restitution", e, low=RESTITUTION_MIN, high=1.0, low_ok=True))
    phi, _ = bisect(lambda phi: np.exp(-(np.pi - 2 * phi) * np.tan(phi)) > e, 0.0, np.pi / 2)
    return np.where(e < 1, np.sin(phi), 0.0)


def _advance(f: Rate, y: Array, h: Real) -> Array:
    """One step h (scalar or (n,)) of y' = f(y), y (k, n): modified midpoint rule, extrapolated to order 16."""
    rows: list[list[np.ndarray]] = []
    for j in range(1, 9):
        d = h / (2 * j)
        before, now = y, y + d * f(y)
        for _ in range(2 * j - 1):
            before, now = now, before + 2 * d * f(now)
        row = [0.5 * (before + now + d * f(now))]
        for k in range(1, j):
            row.append(row[-1] + (row[-1] - rows[-1][k - 1]) / ((j / (j - k)) ** 2 - 1))
        rows.append(row)
    return rows[-1][-1]


def _end(f: Rate, y: Array, going: Rate) -> Array:
    """The state of each column of y (k, n) where going(y), positive at first, has become 0."""
    before = y
    for _ in range(2000):  # an impact takes 20 to 100
        if not np.any(active := going(y) > 0):
            break
        before, y = np.where(active, y, before), np.where(active, _advance(f, y, _STEP), y)
    else:
        raise ArithmeticError("the impact does not end")
    _, h = bisect(lambda h: going(_advance(f, before, h)) > 0, np.zeros(y.shape[1]), _STEP, steps=50)
    return _advance(f, before, h)


@dataclass(frozen=True)
class _Oscillator:
    """u'' + 2 zeta u' + u = 0 from u = 0, u' = 1: Hertz's contact with a dashpot, in units of its undamped impact."""

    zeta: float

    @property
    def omega(self) -> float:
        """Frequency of the sine, over the phase."""
        return float(np.sqrt(1 - self.zeta**2))

    def state(self, phase: Real) -> tuple[Array, Array]:
        """u and u' at a phase."""
        decay, sine = np.exp(-self.zeta * phase), np.sin(self.omega * phase) / self.omega
        return np.asarray(decay * sine), np.asarray(decay * (np.cos(self.omega * phase) - self.zeta * sine))

    def phase(self, ratio: float) -> float:
        """The phase at which u'/u, which falls all the time, has this value."""
        return float(np.arctan2(self.omega, ratio + self.zeta)) / self.omega

    @property
    def turn(self) -> float:
        """The phase of the largest overlap."""
        return self.phase(0.0)

    @property
    def end(self) -> float:
        """The phase without a force."""
        return self.phase(-0.5 / self.zeta)

    @property
    def summit(self) -> float:
        """The phase of the largest force: 2 zeta r^2 + (6 - 20 zeta^2) r - 10 zeta = 0, r = u'/u."""
        z = self.zeta
        half = 3 - 10 * z * z
        root = np.sqrt(half * half + 20 * z * z)
        return self.phase(10 * z / (half + root) if half > 0 else (root - half) / (2 * z))

    def force(self, phase: Real) -> Array:
        """Force with the dashpot over 5/4 m v^2/L."""
        u, rate = self.state(phase)
        return np.asarray(u**0.2 * (u + 2 * self.zeta * rate))

    def time(self, phase: Real) -> Array:
        """Time from phase 0 on over 4/5 L/v: the integral of u^(-1/5)."""
        half = 0.5 * np.pi / self.omega  # u vanishes at 0 and at 2 half: in w = distance^(1/5) the integrand is smooth

        def between(near: Real, far: Real, sign: float) -> Array:
            low, high = (np.asarray(x, float)[..., None] ** 0.2 for x in (near, far))
            w = low + (high - low) * _X
            at = w**5 if sign > 0 else 2 * half - w**5
            u = np.exp(-self.zeta * at) * np.sin(self.omega * w**5) / self.omega
            return np.asarray(((high - low) * 5 * w**4 * u**-0.2) @ _W)

        return between(0.0, np.minimum(phase, half), 1.0) + between(2 * half - np.maximum(phase, half), half, -1.0)


def _unload(law: Curve, top: Array, L: Array, V: Array, m: Array, dashpot: float) -> Array:
    """q, speed and time at the end of a rebound from rest at `top`, in units of the elastic recovery L, of the undamped
    rebound V and of L/V.

    Near the dent sqrt(a) goes as the 1/4 power of the overlap x above it. With x = L q^4 and dt = 4 (L/V) q^3 dtheta
    the motion is smooth there and at the turning point: dq/dtheta = alpha'/V.
    """
    branch = law.elastic_branch(top)
    of_force, of_dashpot = L / (m * V * V), dashpot * np.sqrt(2 * law.E_star / m) * L / V

    def forces(q: Array, v: Array) -> Array:
        F, a = branch(np.minimum(top - L * (1 - q**4), top))
        return of_force * F + of_dashpot * np.sqrt(a) * v

    def rate(y: Array) -> Array:
        q, v, _ = y
        return np.array([v, -4 * q**3 * forces(q, v), 4 * q**3])

    def loaded(y: Array) -> Array:
        return np.where(y[0] > 0, forces(y[0], y[1]), -1.0)

    return _end(rate, np.array([np.ones_like(top), np.zeros_like(top), np.zeros_like(top)]), loaded)


def _rebound(law: Curve, top: Array, L: Array, V: Array, m: Array, motion: _Oscillator) -> tuple[Array, Array, Array]:
    """Overlap above the dent, speed and time at the end of a rebound from rest, in units of L, V and L/V."""
    if np.any(law.flatness(top) != 0):
        q, speed, time = _unload(law, top, L, V, m, 2 * np.sqrt(5 / 6) * motion.zeta)
        return q**4, speed, time
    (rest, _), (u, rate) = motion.state(motion.turn), motion.state(motion.end)
    time = 0.8 * rest**0.2 * (motion.time(motion.end) - motion.time(motion.turn))
    one = np.ones_like(top)
    return (u / rest) ** 0.8 * one, rate / rest * one, time * one


def impact(law: Curve, *, m_star: Real, speed: Real, restitution: float) -> undamped.Impact:
    """The impact at `speed` [m/s] > 0 with effective mass m_star [kg] > 0; they broadcast.

    restitution in [0.14, 1] is that of impacts that do not yield. force_max and residual_overlap are those of the total
    force. Raises ValueError for values outside.
    """
    zeta = float(damping_ratio(restitution))
    m, v = np.broadcast_arrays(number("m_star", m_star), number("speed", speed))
    plain = undamped.impact(law, m_star=m, speed=v)
    if zeta == 0.0:
        return plain
    shape, m, v = v.shape, m.ravel(), v.ravel()
    W = 0.5 * m * v * v
    motion, own = _Oscillator(zeta), (15 * m * v * v / (16 * law.E_star * np.sqrt(law.R_star))) ** 0.4
    (most, _), (left, rate) = motion.state(motion.turn), motion.state(motion.end)
    top, parting, back = own * most**0.8, own * left**0.8, -v * rate
    unit_force, unit_time = 1.25 * m * v * v / own, 0.8 * own / v
    time, force_max = unit_time * motion.time(motion.end), unit_force * motion.force(motion.summit)
    W_plastic = np.zeros_like(v)

    yielded = top > law.yield_overlap
    if yielded.any():
        y, m_y, v_y = law.yield_overlap, m[yielded], v[yielded]
        u_y = (y / own[yielded]) ** 1.25
        phase, _ = bisect(lambda p: motion.state(p)[0] < u_y, u_y, motion.turn)
        kinetic = 0.5 * m_y * (v_y * motion.state(phase)[1]) ** 2
        summit = np.asarray(law.overlap_of_work(law.work(y) + kinetic))
        given, recovery = law.recovered_work(summit), np.asarray(law.recovered_overlap(summit))
        V = np.sqrt(2 * given / m_y)
        x, rate, after = _rebound(law, summit, recovery, V, m_y, motion)
        time[yielded] = unit_time[yielded] * motion.time(phase) + recovery / V * after
        time[yielded] += undamped.loading_time(law, m_y, summit, np.full(summit.shape, y))
        top[yielded], back[yielded], parting[yielded] = summit, -V * rate, summit - recovery * (1 - x)
        before = unit_force[yielded] * motion.force(np.minimum(phase, motion.summit))
        force_max[yielded] = np.maximum(before, law.force(summit))
        W_plastic[yielded] = law.plastic_work(summit)
    columns = {
        "e_n": back / v,
        "contact_time": time,
        "force_max": force_max,
        "overlap_max": top,
        "radius_max": law.radius(top),
        "residual_overlap": parting,
        "work_in": W,
        "work_out": 0.5 * m * back * back,
        "plastic_work": W_plastic,
    }
    return undamped.Impact(**{name: np.reshape(column, shape) for name, column in columns.items()})
