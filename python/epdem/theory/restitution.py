# SPDX-License-Identifier: GPL-2.0-or-later
"""A normal impact of any law: restitution, times, peaks, and the motion (section 8.2.3)."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .curve import Curve
from .numerics import Array, Real, gauss, number

_X, _W = gauss(48)
UNLOADING_TIME = 1.4716375921623523  # (2/5) B(2/5, 1/2): t_unload e_n v/delta_e for tau = 0


@dataclass(frozen=True)
class Impact:
    """Theory of impacts, arrays of one shape, SI; bodies that stick have e_n = 0, contact_time = inf, work_out = 0."""

    e_n: Array
    contact_time: Array  # [s]
    force_max: Array  # [N]
    overlap_max: Array  # [m]
    radius_max: Array  # [m]
    residual_overlap: Array  # at which the contact ends [m]
    work_in: Array  # [J]
    work_out: Array  # [J]
    plastic_work: Array  # [J]


def e_n(law: Curve, *, m_star: Real, speed: Real) -> Array:
    """Coefficient of restitution of an impact at `speed` [m/s] > 0 with effective mass m_star [kg] > 0.

    e_n^2 = kappa F^2/(a E* W) at W(alpha_max) = m* v^2/2; exactly 1 up to yield.
    """
    W = 0.5 * number("m_star", m_star) * np.square(number("speed", speed))
    top = law.overlap_of_work(W)
    return np.where(top <= law.yield_overlap, 1.0, np.sqrt(np.minimum(law.recovered_work(top) / W, 1.0)))


def _integral(rate: Callable[[Array], Array], shape: tuple[int, ...]) -> Array:
    """Integral over x in [0, 1] of rate(x), arrays of `shape`; nodes in blocks, so that a million impacts fit."""
    total, block = np.zeros(shape), max(1, 200_000 // max(1, math.prod(shape)))
    for k in range(0, len(_X), block):  # along a new first axis, so that a law's own parameters still broadcast
        x, w = _X[k : k + block], _W[k : k + block]
        total = total + np.tensordot(w, rate(x.reshape(-1, *[1] * len(shape))), 1)
    return total


def _work_between(law: Curve, low: Real, high: Real, width: Real) -> Array:
    """W(high) - W(low) within one formula of the law; width = high - low. By Gauss where a difference would cancel."""
    near = width * sum(w * law.force(high - width * x) for x, w in zip(*gauss(8), strict=True))
    return np.where(width < 1e-3 * high, near, law.work(high) - law.work(low))


def loading_time(law: Curve, m_star: Array, top: Array, start: Array) -> Array:
    """Time from overlap `start` to rest at `top`: the integral of d alpha/sqrt(2 (W(top) - W(alpha))/m*).

    alpha = top sin^2 theta takes both end singularities.

    Split where the law changes its formula: no piece of the work is integrated across a kink.
    """
    edges = [start, *(np.clip(kink, start, top) for kink in law.kinks()), top]
    total, above = np.zeros_like(top), np.zeros_like(top)  # above: work from the upper edge of the piece to the top
    for low, high in reversed(list(zip(edges[:-1], edges[1:], strict=True))):
        left, right = (np.arcsin(np.sqrt(edge / top)) for edge in (low, high))

        def rate(x: Array, high: Real = high, above: Array = above, left: Any = left, right: Any = right) -> Array:
            theta, rest = left + (right - left) * x, (right - left) * (1 - x)
            alpha, width = top * np.sin(theta) ** 2, top * np.sin(rest) * np.sin(right + theta)
            speed = np.sqrt(2 * (above + _work_between(law, alpha, high, width)) / m_star)
            wide = 2 * top * np.sin(theta) * np.cos(theta)
            return np.asarray(np.divide(wide, speed, out=np.zeros_like(alpha), where=speed > 0))

        total = total + (right - left) * _integral(rate, top.shape)
        above = above + _work_between(law, low, high, high - low)
    return total


def _unloading_time(law: Curve, m_star: Array, top: Array, work_out: Array) -> Array:
    """Time from the peak to zero force; closed for tau = 0, else by quadrature in y of the opening circle."""
    closed = UNLOADING_TIME * law.recovered_overlap(top) / np.sqrt(2 * work_out / m_star)
    tau = np.asarray(law.flatness(top), float)
    if not np.any(tau > 0):
        return closed
    A, B = 0.75 * (1 - tau), 2 / np.pi * tau

    def rate(x: Array) -> Array:
        y = x * x  # speed rises from 0 like sqrt y
        return (2 * A * y + B) * 2 * x / np.sqrt(_given_back(y, A, B, tau))

    flat = np.sqrt(m_star / (2 * law.E_star * law.radius(top))) * _integral(rate, top.shape)
    return np.where(tau > 0, flat, closed)


def _given_back(y: Array, A: Array, B: Array, tau: Array) -> Array:
    """Energy given back while the circle opens to y, in F_max^2/(E* a_max): integral of f (2 A t + B) dt."""
    total = np.zeros(np.shape(y))
    for xk, wk in zip(*gauss(24), strict=True):
        t = y * xk * (2 - xk)  # dense towards y = 1, where f ~ (1-y)^1.5
        f = (1 - tau) * (1 - t * t) ** 1.5 + 2 / np.pi * tau * (np.arccos(t) - t * np.sqrt(1 - t * t))
        total = total + wk * y * 2 * (1 - xk) * f * (2 * A * t + B)
    return total


def impact(law: Curve, *, m_star: Real, speed: Real) -> Impact:
    """The impact at `speed` [m/s] > 0 with effective mass m_star [kg] > 0; they broadcast."""
    m, v, _ = np.broadcast_arrays(number("m_star", m_star), number("speed", speed), law.E_star * law.yield_overlap)
    W = 0.5 * m * v * v
    top = np.asarray(law.overlap_of_work(W), float)
    elastic = top <= law.yield_overlap
    out = np.where(elastic, W, np.minimum(law.recovered_work(top), W))
    time = loading_time(law, m, top, np.zeros_like(top))
    back = np.where(elastic, time, _unloading_time(law, m, top, out))
    return Impact(
        e_n=np.where(elastic, 1.0, np.sqrt(out / W)),
        contact_time=time + back,
        force_max=np.asarray(law.force(top)),
        overlap_max=top,
        radius_max=np.asarray(law.radius(top)),
        residual_overlap=np.asarray(law.residual_overlap(top)),
        work_in=W,
        work_out=out,
        plastic_work=np.asarray(law.plastic_work(top)),
    )
