# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts of a law with a dashpot on its elastic branches: the equation of motion, solved to 1e-10.

m* alpha'' = -max(0, F(alpha) + c(a) alpha'),  c = 2 sqrt(5/6) zeta sqrt(2 E* a m*), and no dashpot while the contact
yields (there F lies on the backbone). zeta makes the restitution of an impact that does not yield a constant of the
pair (Tsuji, Tanaka and Ishida 1992, with the force cut off at 0): zeta = sin phi, e = exp(-(pi - 2 phi) tan phi).

Near first touch and near the dent the force goes as the 1/4 power of the overlap x above the dent. With x = L q^4 and
dt = 4 (L/V) q^3 dtheta the motion is smooth there and at the turning point: dq/dtheta = alpha'/V.
"""

from dataclasses import dataclass

import numpy as np

from . import restitution

RESTITUTION_MIN = 0.14  # the formula's limit for zeta -> 1 is exp(-2) = 0.135
_H = 1 / 16  # step in theta; the extrapolation below then leaves 1e-13


def damping_ratio(e):
    """zeta of a Hertz contact with restitution e in [0.14, 1], any shape; NaN outside. Bisection to round-off."""
    e = np.asarray(e, float)
    low, high = np.zeros_like(e), np.full_like(e, np.pi / 2)
    for _ in range(60):
        phi = 0.5 * (low + high)
        above = np.exp(-(np.pi - 2 * phi) * np.tan(phi)) > e
        low, high = np.where(above, phi, low), np.where(above, high, phi)
    return np.where((e >= RESTITUTION_MIN) & (e <= 1), np.sin(0.5 * (low + high)), np.nan)


@dataclass(frozen=True)
class DampedImpact(restitution.Impact):
    """As restitution.Impact; force_max is that of the whole force, residual_overlap where the whole force ends."""

    viscous_work: np.ndarray  # what is lost beside the plastic work [J]: m* v^2 (1 - e_n^2)/2 - plastic_work


def _extrapolated(f, y, h):
    """One step h (shape (n,)) of y' = f(y), y of shape (k, n): modified midpoint rule, extrapolated to order 16."""
    rows = []
    for j in range(1, 9):
        n = 2 * j
        d = h / n
        before, now = y, y + d * f(y)
        for _ in range(n - 1):
            before, now = now, before + 2 * d * f(now)
        row = [0.5 * (before + now + d * f(now))]
        for k in range(1, j):
            row.append(row[-1] + (row[-1] - rows[-1][k - 1]) / ((j / (j - k)) ** 2 - 1))
        rows.append(row)
    return rows[-1][-1]


def _integrate(f, y, event, peak):
    """Follow y from theta = 0 to the first zero of event(y), event > 0 before; peak(y) is a force to be maximised.

    y is (k, n); returns (y at the event, largest peak). The event is not looked for before the first step is over.
    """
    n = y.shape[1]
    done, end = np.zeros(n, bool), y.copy()
    best_y, best_h, best = y.copy(), np.zeros(n), peak(y)
    for _ in range(100_000):
        new = _extrapolated(f, y, np.full(n, _H))
        crossed = ~done & (event(new) <= 0)
        h = np.full(n, _H)
        if crossed.any():
            low, high = np.zeros(n), np.full(n, _H)
            for _ in range(50):
                h = 0.5 * (low + high)
                positive = event(_extrapolated(f, y, h)) > 0
                low, high = np.where(positive, h, low), np.where(positive, high, h)
            h = np.where(crossed, 0.5 * (low + high), _H)
            end = np.where(crossed, _extrapolated(f, y, h), end)
        here = np.where(done, -np.inf, peak(np.where(crossed, end, new)))
        better = here > best
        best_y, best_h, best = np.where(better, y, best_y), np.where(better, h, best_h), np.maximum(best, here)
        done |= crossed
        if done.all():
            break
        y = np.where(done, y, new)
    # the largest sample is the end of the step from best_y: the summit is in this step or in the next one
    low, high = np.zeros(n), 2 * best_h
    golden = 0.5 * (np.sqrt(5) - 1)
    for _ in range(60):
        left, right = high - golden * (high - low), low + golden * (high - low)
        rises = peak(_extrapolated(f, best_y, left)) < peak(_extrapolated(f, best_y, right))
        low, high = np.where(rises, left, low), np.where(rises, high, right)
    return end, best, (best_y, 0.5 * (low + high))
