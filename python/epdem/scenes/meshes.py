# SPDX-License-Identifier: GPL-2.0-or-later
"""Triangles of the scenes' walls. Arrays of shape (n, 3 corners, 3 coordinates), metres."""

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
FACETS = 48  # around a circle: the wall is at most 0.2 % of the radius off it


def _ring(radius: float, z: float, facets: int = FACETS) -> FloatArray:
    angle = 2 * np.pi * np.arange(facets) / facets
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(facets, z)])


def _band(lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Two triangles per facet between two rings of equally many points."""
    a, b = np.roll(lower, -1, axis=0), np.roll(upper, -1, axis=0)
    return np.concatenate([np.stack([lower, a, upper], axis=1), np.stack([a, b, upper], axis=1)])


def revolved(profile: Sequence[tuple[float, float]]) -> FloatArray:
    """Surface of revolution about z through (radius, z) points, split so that no triangle is a needle."""
    bands = []
    for (r0, z0), (r1, z1) in zip(profile[:-1], profile[1:], strict=True):
        edge = 2 * math.pi * max(r0, r1) / FACETS
        n = max(1, round(math.hypot(r1 - r0, z1 - z0) / (3 * edge)))
        for k in range(n):
            s, t = k / n, (k + 1) / n
            bands.append(
                _band(_ring(r0 + s * (r1 - r0), z0 + s * (z1 - z0)), _ring(r0 + t * (r1 - r0), z0 + t * (z1 - z0)))
            )
    return np.concatenate(bands)


def along(axis: int, points: FloatArray) -> FloatArray:
    """Triangles about the z axis, about axis 0, 1 or 2 instead."""
    return points[:, :, {0: [2, 1, 0], 1: [0, 2, 1], 2: [0, 1, 2]}[axis]]


def _disc(radius: float, z: float) -> FloatArray:
    ring = _ring(radius, z)
    middle = np.broadcast_to([0.0, 0.0, z], ring.shape)
    return np.stack([middle, ring, np.roll(ring, -1, axis=0)], axis=1)


def tube(diameters: tuple[float, float], low: float, high: float, *, closed: tuple[bool, bool]) -> FloatArray:
    """A round tube about z between two heights, with the diameters there; `closed`: by discs at low, at high."""
    r0, r1 = diameters[0] / 2, diameters[1] / 2
    ends = [_disc(r, z) for r, z, shut in ((r0, low, closed[0]), (r1, high, closed[1])) if shut]
    return np.concatenate([revolved([(r0, low), (r1, high)]), *ends])


def rectangle(axis: int, center: npt.ArrayLike, size: tuple[float, float]) -> FloatArray:
    """Two triangles across an axis; `size` along the two other axes, in the order x, y, z."""
    first, second = (k for k in range(3) if k != axis)
    corner = np.tile(np.asarray(center, float), (4, 1))
    corner[:, first] += np.array([-1, 1, 1, -1]) * size[0] / 2
    corner[:, second] += np.array([-1, -1, 1, 1]) * size[1] / 2
    return np.stack([corner[[0, 1, 2]], corner[[0, 2, 3]]])


def box(limits: tuple[float, ...], faces: set[str]) -> FloatArray:
    """The faces ("-x", "+z") of a room xlo xhi ylo yhi zlo zhi [m]."""
    low, high = np.array(limits[0::2]), np.array(limits[1::2])
    parts = []
    for face in sorted(faces):
        axis = "xyz".index(face[1])
        center = 0.5 * (low + high)
        center[axis] = (low if face[0] == "-" else high)[axis]
        others = [k for k in range(3) if k != axis]
        parts.append(rectangle(axis, center, (float((high - low)[others[0]]), float((high - low)[others[1]]))))
    return np.concatenate(parts)
