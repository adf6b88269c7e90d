# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of spheres with compaction for every host, and the forces by numpy from positions alone."""

from functools import cache

import numpy as np
from free_spheres import Scene

from bed import Bed, Material
from epdem.theory.cavity import FINITE_STRAIN

E, NU, Y = 120e6, 0.34, 1e6
LIKE = {"E": E, "nu": NU, "yieldStress": Y, "firstYieldRatio": 1.6, "plasticRatio": 2.8, "finiteStrain": FINITE_STRAIN}
GAMMA = 0.4 * 5.9 * Y**3 * 0.5 / (E / (1 - NU**2) / 2) ** 2  # 0.4 of the largest work of adhesion of like spheres
STICKY = {"back": 0.01, "Gamma": GAMMA}  # so slow that no contact parts
HEAVY = 1e15  # density [kg/m^3] of spheres that no contact slows down
# A sphere, five neighbours that press it at unlike speeds and one that only its growth reaches; a floor below all.
RADII = np.array([1.0, 0.8, 1.2, 0.9, 1.1, 1.0])
WAYS = np.array([[0, 0, 0], [1, 0, 0], [-1, 0.05, 0], [0, 1, 0.1], [0, -1, 0], [0.02, 0, 1]], float)
WAYS[1:] /= np.linalg.norm(WAYS[1:], axis=1)[:, None]
GAPS = np.array([0.0, 0.002, 0.003, 0.001, 0.004, 0.004])
SPEEDS = np.array([0.0, 0.13, 0.16, 0.11, 0.15, 0.001])
MOVES = -SPEEDS[:, None] * WAYS - [0.0, 0.0, 0.25]  # all come down to the floor, which nothing touches at the start
CLUSTER = WAYS * (RADII[0] + RADII + GAPS)[:, None] + [0.0, 0.0, 1.205]


def scene(x, v, *, radius=1.0, density=HEAVY, compaction=True, Gamma=None, **more):
    """Spheres of one material of law cavity with finite strain, with the work of adhesion Gamma of cavity_adhesive."""
    material = LIKE | {"density": density} | ({} if Gamma is None else {"workOfAdhesion": Gamma})
    law = "cavity" if Gamma is None else "cavity_adhesive"
    return Scene(law, [material], x, v, radius=radius, compaction=compaction, **more)


def cluster(steps, back=0.3, **more):
    """The cluster at `steps` loading and as many unloading steps, over a second each; back: speed of unloading."""
    moves = (MOVES, steps), (-back * MOVES, steps)
    return scene(CLUSTER, MOVES, radius=RADII, dt=1.0 / steps, plane=0, moves=moves, **more)


@cache
def exact(steps, back=0.3, Gamma=0.0):
    """Forces on the cluster by numpy, shape (2 steps + 1, 6, 3), and the largest."""
    t = np.concatenate([np.arange(steps + 1) / steps, np.arange(1, steps + 1) / steps])
    first = np.arange(2 * steps + 1) <= steps
    F = forces(CLUSTER + np.where(first, t, 1.0 - back * t)[:, None, None] * MOVES, RADII, Gamma)
    return F, np.abs(F).max()


def geometry(x, radius):
    """Contacts of spheres along a path: bodies i and j (-1: the floor), overlaps and normals on i for each step. x:
    centres, shape (steps, n, 3)."""
    n = len(radius)
    pairs, overlap, normal = [], [], []
    for i in range(n):
        for j in range(i + 1, n):
            d = x[:, i] - x[:, j]
            r = np.linalg.norm(d, axis=1)
            pairs.append((i, j))
            overlap.append(radius[i] + radius[j] - r)
            normal.append(d / r[:, None])
        pairs.append((i, -1))
        overlap.append(radius[i] - x[:, i, 2])
        normal.append(np.broadcast_to([0.0, 0.0, 1.0], (len(x), 3)))
    return *np.array(pairs).T, np.array(overlap).T, np.moveaxis(np.array(normal), 0, 1)


def forces(x, radius, Gamma=0.0):
    """Forces on spheres along a path, shape (steps, n, 3), with the sums of each step itself: the exact limit."""
    i, j, overlap, normal = geometry(x, radius)
    like = Material(E, NU, Y)
    bodies = Bed(np.asarray(radius, float), i, j, like, plane=like, Gamma=Gamma)
    F = np.zeros(x.shape)
    for t in range(len(x)):
        f = bodies.step(overlap[t])[:, None] * normal[t]
        np.add.at(F[t], i, f)
        np.add.at(F[t], j[j >= 0], -f[j >= 0])
    return F


def alone(n):
    """Places, radii and velocities of n pairs of spheres, and n spheres that fall on the floor, in any order. The
    impacts are elastic to fully plastic."""
    rng = np.random.default_rng(5)
    a = np.column_stack([np.linspace(-60, 60, n), np.zeros(n), np.full(n, 5.0)])
    radius = rng.uniform(0.7, 1.3, 3 * n)
    b = a + np.column_stack([np.zeros(n), radius[:n] + radius[n : 2 * n] + 1e-3, rng.uniform(-0.3, 0.3, n)])
    c = a - np.column_stack([np.zeros(n), np.full(n, 20.0), 5.0 - radius[2 * n :] - 1e-3])
    v = np.zeros((3 * n, 3))
    v[n : 2 * n, 1] = v[2 * n :, 2] = -np.geomspace(0.05, 20, n)
    order = rng.permutation(3 * n)
    return np.concatenate([a, b, c])[order], radius[order], v[order]
