# SPDX-License-Identifier: GPL-2.0-or-later
"""A sphere between two walls that it overlaps: two contacts that yield, part and meet again, with an energy balance."""

import numpy as np

from ...theory.backbones import Backbone
from ...theory.numerics import gauss
from ..runner import Row
from .bench import Bench
from .running import BROKEN, COARSE, FINE, POSITION_COARSE, Setting, order
from .variants import between_walls, edits

PERIODS = 20.0  # length of a run in stability limits


def stored(theory: Backbone, alpha: np.ndarray, top: np.ndarray) -> np.ndarray:
    """Elastic and plastic work in a contact [J] at overlap alpha that reached `top` > 0; arrays of one shape.

    On the elastic branch: what was put in less what came back from `top` to alpha, by Gauss points in an angle in
    which the branch is smooth at both of its ends.
    """
    (x, w), alpha = gauss(40), np.maximum(alpha, 0.0)
    recovered = np.asarray(theory.recovered_overlap(top))
    # alpha = top - recovered sin^2(angle)
    last = np.arcsin(np.sqrt(np.clip((top - alpha) / recovered, 0.0, 1.0)))
    angle = last[..., None] * x
    points = top[..., None] - recovered[..., None] * np.sin(angle) ** 2
    force = theory.unloading_force(np.maximum(points, 0.0), top[..., None])
    back = (force * np.sin(2 * angle)) @ w * recovered * last
    return np.asarray(np.where(top <= theory.yield_overlap, theory.work(alpha), theory.work(top) - back))


def embedded_path(s: Setting, time_step: float, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Overlap with the first wall [m] and velocity towards it [m/s], shape (steps + 1,), by velocity Verlet.

    Both walls overlap the sphere by alpha_max/2 at the start. A contact that ends loses its history.
    """
    x, law = s.x, s.x.native_law()
    half, d = 0.5 * time_step / x.m_star, s.overlap_max / 2
    z, v, memory = 0.0, float(x.speed[0]), np.zeros(2)
    overlap, speed = np.empty(steps + 1), np.empty(steps + 1)
    for n in range(steps + 1):
        alpha = np.array([d + z, d - z])
        force, _, memory = law.step(R_star=x.R_star, delta_max=np.where(alpha > 0, memory, 0.0), delta=alpha)
        push = half * (force[1] - force[0])
        v = v + push if n else v
        overlap[n], speed[n] = alpha[0], v
        v += push
        z += time_step * v
    return overlap, speed


def balance(s: Setting, overlap: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Kinetic, stored and lost energy over that at the start at every sample, shape of `overlap`."""
    theory, total = s.x.backbone(), 0.5 * s.x.m_star * velocity**2
    for alpha in (overlap, s.overlap_max - overlap):
        top, lost = np.empty_like(alpha), np.zeros_like(alpha)
        reached = gone = 0.0
        for n, a in enumerate(alpha):
            if a <= 0.0 < reached:  # the contact ends: its history is lost, its work is counted
                gone += float(theory.plastic_work(reached))
                reached = 0.0
            reached = max(reached, a)
            top[n], lost[n] = reached, gone
        touching = top > 0
        total = total + lost
        total[touching] += stored(theory, alpha[touching], top[touching])
    return np.asarray(total / total[0])


def path(s: Setting, bench: Bench, share: float) -> tuple[np.ndarray, np.ndarray]:
    """Overlap with the first wall [m] and velocity towards it [m/s] at a share of the limit of two springs."""
    time_step, steps = share * s.limit / np.sqrt(2.0), int(PERIODS / share)
    if not bench.positions:
        return embedded_path(s, time_step, steps)
    got = between_walls(s, bench, s.overlap_max / 2, time_step, steps)
    known = edits(bench).unknown  # the balance begins where the law knows the overlaps of the start
    return got.overlap[0, known:], got.velocity[0, known:]


def two_walls(s: Setting, bench: Bench) -> Row:
    """The energy balance of a sphere between two walls, which holds to second order in dt."""

    def off(share: float) -> np.ndarray:
        return balance(s, *path(s, bench, share)) - 1

    drift = [np.abs(off(share)).max() for share in FINE[:-1]]
    last = off(FINE[-1])
    drift.append(np.abs(last).max())
    coarse = POSITION_COARSE if bench.positions else COARSE
    breaks_at = next((share for share in coarse if not off(share).max() <= BROKEN), np.nan)
    found = {"e_n_error": drift[-1], "created": last.max(), "breaks_at": breaks_at}
    return found | order(FINE, drift, 1e-13)
