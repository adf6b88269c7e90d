# SPDX-License-Identifier: GPL-2.0-or-later
"""Restitution and times of a normal impact."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Impact:
    e_n: np.ndarray
    contact_time: np.ndarray
    force_max: np.ndarray
    overlap_max: np.ndarray
    radius_max: np.ndarray
    residual_overlap: np.ndarray
    work_in: np.ndarray
    work_out: np.ndarray
    plastic_work: np.ndarray
    strain_ratio: np.ndarray


def impact(law, *, m_star, speed):
    v = np.asarray(speed, float)
    W = 0.5 * m_star * v**2
    top = law.overlap_of_work(W)
    out = np.where(top <= law.yield_overlap, W, law.recovered_work(top))
    x, w = np.polynomial.legendre.leggauss(60)
    t = np.zeros_like(v)
    edges = [np.zeros_like(v)] + [np.arcsin(np.sqrt(np.minimum(m / top, 1))) for m in law.marks()] + [np.full_like(v, np.pi / 2)]
    for a, b in zip(edges[:-1], edges[1:], strict=True):
        th = a[:, None] + (b - a)[:, None] * (x + 1) / 2
        al = top[:, None] * np.sin(th) ** 2
        left = 2 * (W[:, None] - law.work(al)) / m_star
        f = 2 * top[:, None] * np.sin(th) * np.cos(th) / np.sqrt(np.maximum(left, 1e-300))
        t += (b - a) / 2 * (f @ w)
    d = np.where(top <= law.yield_overlap, top, law.recovered_overlap(top))
    th = np.pi / 2 * (x + 1) / 2
    al = top[:, None] - d[:, None] * np.cos(th) ** 2
    # speed on the way out from the work of the unloading branch, by quadrature from the dent
    u, wu = x, w
    lo = (top - d)[:, None, None]
    pts = lo + (al[:, :, None] - lo) * ((u + 1) / 2) ** 2
    F = np.stack([law.unloading_force(pts[i], top[i]) if top[i] > law.yield_overlap else law.force(pts[i]) for i in range(v.size)])
    left = out[:, None] - ((al[:, :, None] - lo) * (u + 1) / 2 * F) @ wu
    # left: elastic energy still stored; kinetic = out - stored
    stored = out[:, None] - left
    kinetic = np.maximum(2 * (out[:, None] - stored) / m_star, 1e-300)
    f = 2 * d[:, None] * np.sin(th) * np.cos(th) / np.sqrt(kinetic)
    t += np.pi / 4 * (f @ w)
    a = law.radius(top)
    return Impact(np.sqrt(out / W), t, law.force(top), top, a, law.residual_overlap(top), W, out, W - out, a / law.R_star)
