# SPDX-License-Identifier: GPL-2.0-or-later
"""Triangles of the scenes' walls. Arrays of shape (n, 3 corners, 3 coordinates), metres."""

import math

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


def _tube(profile: list[tuple[float, float]]) -> FloatArray:
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


def hopper(bin_diameter: float, bin_height: float, outlet: float, depth: float) -> FloatArray:
    """A cone from the outlet (z = -depth) to the bin (z = 0), and the bin above it; depth 0 is a flat bottom."""
    return _tube([(outlet / 2, -depth), (bin_diameter / 2, 0.0), (bin_diameter / 2, bin_height)])


def drum(diameter: float, length: float) -> FloatArray:
    """A tube about the y axis, open at its ends."""
    tube = _tube([(diameter / 2, -length / 2), (diameter / 2, length / 2)])
    return tube[:, :, [0, 2, 1]]


def plate(lx: float, ly: float, z: float) -> FloatArray:
    """A horizontal rectangle of two triangles about the z axis."""
    x, y = lx / 2, ly / 2
    corner = np.array([[-x, -y, z], [x, -y, z], [x, y, z], [-x, y, z]])
    return np.stack([corner[[0, 1, 2]], corner[[0, 2, 3]]])
