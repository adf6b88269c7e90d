# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts of a law with a dashpot on its elastic branches: the equation of motion, solved to 1e-10.

m* alpha'' = -max(0, F(alpha) + c alpha'), c = 2 sqrt(5/6) zeta sqrt(2 E* a m*), and no dashpot while the contact
yields (there F lies on the backbone). zeta makes the restitution of impacts that do not yield a constant of the pair
(Tsuji, Tanaka and Ishida 1992, with the force cut off at 0): zeta = sin phi, e = exp(-(pi - 2 phi) tan phi).

Near first touch and near the dent sqrt(a) goes as the 1/4 power of the overlap x above the dent. With x = L q^4 and
dt = 4 (L/V) q^3 dtheta the motion is smooth there and at the turning point: dq/dtheta = alpha'/V.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import TypeAlias

import numpy as np

from . import restitution as undamped
from .curve import Curve
from .numerics import Array, Real, bisect, gauss, number, zero

RESTITUTION_MIN = 0.14  # the formula's limit for zeta -> 1 is exp(-2) = 0.135
Rate: TypeAlias = Callable[[Array], Array]  # of states (k, n): one number or their change for each
_STEP = 1 / 8  # of theta; the extrapolation below then leaves 1e-12
_X, _W = gauss(32)


@dataclass(frozen=True)
class DampedImpact(undamped.Impact):
    """As without a dashpot, but force_max and residual_overlap are those of the total force with the dashpot."""

    viscous_work: Array  # lost beside plastic_work [J]: to the dashpot, or still stored when the bodies part


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


def _path(f: Rate, y: Array, going: Rate) -> Array:
    """States from y (k, n) on until going(y) <= 0 in every column, shape (steps + 1, k, n); a column then stands."""
    path = [y]
    while np.any(active := going(path[-1]) > 0):
        path.append(np.where(active, _advance(f, path[-1], _STEP), path[-1]))
        if len(path) > 2000:  # an impact takes 20 to 100
            raise ArithmeticError("the impact does not end")
    return np.array(path)


def _first_zero(f: Rate, path: Array, g: Rate) -> Array:
    """The state of each column where g first ceases to be positive after the start; its last one if it never does."""
    ended = np.array([g(y) <= 0 for y in path[1:]])
    start = np.where(ended.any(axis=0), ended.argmax(axis=0), len(path) - 2)
    y = np.take_along_axis(path, start[None, None, :], axis=0)[0]
    place = zero(lambda h: g(_advance(f, y, h)), np.zeros(y.shape[1]), np.full(y.shape[1], _STEP))
    return np.where(ended.any(axis=0), _advance(f, y, place), path[-1])


def _largest(f: Rate, path: Array, g: Rate) -> Array:
    """The largest g along the path: sampled, then by golden section in the two steps around the largest sample."""
    samples = np.array([g(y) for y in path])
    start = np.maximum(samples.argmax(axis=0) - 1, 0)
    y = np.take_along_axis(path, start[None, None, :], axis=0)[0]
    width, golden = np.full(y.shape[1], 2 * _STEP), 0.5 * (np.sqrt(5) - 1)
    left, right = (1 - golden) * width, golden * width
    at_left, at_right = g(_advance(f, y, left)), g(_advance(f, y, right))
    for _ in range(30):  # the value is flat at its summit: 1e-6 of the place is 1e-12 of the value
        width, rises = golden * width, at_left < at_right
        new = np.where(rises, left + golden * width, right - golden * width)
        at_new = g(_advance(f, y, new))
        left, right = np.where(rises, right, new), np.where(rises, new, left)
        at_left, at_right = np.where(rises, at_right, at_new), np.where(rises, at_new, at_left)
    return np.maximum(at_left, at_right)


def _yielding_time(law: Curve, m: Array, start: Array, top: Array) -> Array:
    """Time on the backbone from overlap `start` to rest at `top`: quadrature in c, alpha = top - (top - start) c^2."""
    edges = [start, *(np.clip(kink, start, top) for kink in law.kinks()), top]
    total = np.zeros_like(top)
    for a, b in zip(edges[:-1], edges[1:], strict=True):
        far, near = (np.sqrt((top - x) / (top - start)) for x in (a, b))
        c = near[:, None] + (far - near)[:, None] * _X
        width = np.maximum((top - start)[:, None] * c * c, np.finfo(float).tiny)  # a piece may be empty
        alpha = top[:, None] - width
        mean = sum(w * law.force(alpha + width * x) for x, w in zip(_X, _W, strict=True))
        exact = (law.work(top[:, None]) - law.work(alpha)) / width  # loses digits near the top, kinks spoil the other
        mean = np.where(width < 1e-3 * top[:, None], mean, exact)
        total += (far - near) * ((2 * np.sqrt((top - start)[:, None] * m[:, None] / (2 * mean))) @ _W)
    return total


def _elastic(share: Array, dashpot: float, q_yield: Array) -> tuple[Array, Array, Array]:
    """Hertz contact from touch in units of L and of the impact speed; share = (L/its own undamped peak)^(5/4)."""
    k, d = 1.25 * share**2, dashpot * np.sqrt(15 / 8) * share

    def force(y: Array) -> Array:
        q, v, _ = y
        return np.asarray(q * (k * q**5 + d * v))

    def rate(y: Array) -> Array:
        q, v, _ = y
        return np.array([v, -4 * q**3 * force(y), 4 * q**3])

    def loaded(y: Array) -> Array:
        q, v, _ = y
        return np.asarray(np.minimum(q_yield - q, np.where(v > 0, 1.0, k * q**5 + d * v)))

    path = _path(rate, np.array([np.zeros_like(share), np.ones_like(share), np.zeros_like(share)]), loaded)
    end, turn = _first_zero(rate, path, loaded), _first_zero(rate, path, lambda y: np.minimum(y[1], q_yield - y[0]))
    inside = _largest(rate, path, lambda y: np.where(y[0] <= q_yield, force(y), 0.0))
    return end, turn, np.maximum(inside, force(end))


def _unload(law: Curve, top: Array, L: Array, V: Array, m: Array, dashpot: float) -> Array:
    """The elastic branch from rest at `top`, in units of the elastic recovery (L) and of the undamped rebound (V)."""

    def forces(q: Array, v: Array) -> Array:
        F, a = law.unloading(np.minimum(top - L * (1 - q**4), top), top)
        return F * L / (m * V * V) + dashpot * np.sqrt(2 * law.E_star * a / m) * L / V * v

    def rate(y: Array) -> Array:
        q, v, _ = y
        return np.array([v, -4 * q**3 * forces(q, v), 4 * q**3])

    def loaded(y: Array) -> Array:
        return np.where(y[0] > 0, forces(y[0], y[1]), -1.0)

    path = _path(rate, np.array([np.ones_like(top), np.zeros_like(top), np.zeros_like(top)]), loaded)
    return _first_zero(rate, path, loaded)


def impact(law: Curve, *, m_star: Real, speed: Real, restitution: float) -> DampedImpact:
    """The impact at `speed` [m/s] > 0 with effective mass m_star [kg] > 0; they broadcast.

    restitution in [0.14, 1] is that of impacts that do not yield. Raises ValueError for values outside.
    """
    zeta = float(damping_ratio(restitution))
    m, v = np.broadcast_arrays(number("m_star", m_star), number("speed", speed))
    plain = undamped.impact(law, m_star=m, speed=v)
    if zeta == 0.0:
        return DampedImpact(**{f.name: getattr(plain, f.name) for f in fields(plain)}, viscous_work=np.zeros(v.shape))
    shape, m, v = v.shape, m.ravel(), v.ravel()
    dashpot, W = 2 * np.sqrt(5 / 6) * zeta, 0.5 * m * v * v

    own = (15 * m * v * v / (16 * law.E_star * np.sqrt(law.R_star))) ** 0.4  # peak overlap of Hertz without a dashpot
    L = np.minimum(own, law.yield_overlap)
    end, turn, peak = _elastic((L / own) ** 1.25, dashpot, (law.yield_overlap / L) ** 0.25)
    top, back, time, parting = L * turn[0] ** 4, -v * end[1], L / v * end[2], L * end[0] ** 4
    force_max, W_plastic = peak * m * v * v / L, np.zeros_like(v)

    yielded = end[1] > 0
    if yielded.any():
        y, m_y = law.yield_overlap, m[yielded]
        kinetic = 0.5 * m_y * (v * end[1])[yielded] ** 2
        summit = np.asarray(law.overlap_of_work(law.work(y) + kinetic))
        given, recovery = law.recovered_work(summit), np.asarray(law.recovered_overlap(summit))
        V = np.sqrt(2 * given / m_y)
        out = _unload(law, summit, recovery, V, m_y, dashpot)
        time[yielded] += _yielding_time(law, m_y, np.full(summit.shape, y), summit) + recovery / V * out[2]
        top[yielded], back[yielded], parting[yielded] = summit, -V * out[1], summit - recovery * (1 - out[0] ** 4)
        force_max[yielded] = np.maximum(force_max[yielded], law.force(summit))
        W_plastic[yielded] = law.plastic_work(summit)
    work_out = 0.5 * m * back * back
    columns = {
        "e_n": back / v,
        "contact_time": time,
        "force_max": force_max,
        "overlap_max": top,
        "radius_max": law.radius(top),
        "residual_overlap": parting,
        "parting_overlap": parting,
        "work_in": W,
        "work_out": work_out,
        "plastic_work": W_plastic,
        "viscous_work": W - work_out - W_plastic,
    }
    return DampedImpact(**{name: np.reshape(column, shape) for name, column in columns.items()})
