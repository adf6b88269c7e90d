# SPDX-License-Identifier: GPL-2.0-or-later
"""Where triangles of walls run through regions and spheres."""

import math

import numpy as np

from ..case.measures import Region
from ..case.walls import Room
from .meshes import FloatArray

SIDES = 24  # of the prism that stands for a round region


def _faces(region: Region, free: float) -> tuple[FloatArray, FloatArray]:
    """(normals, shape (n, 3); distances [m] from the origin, shape (n,)) of the faces of a region, `free` inside it."""
    both = np.array([[-1.0], [1.0]])
    if isinstance(region, Room):
        normals: FloatArray = np.kron(np.eye(3), both)
        return normals, np.array(region.limits) * normals.sum(axis=1) - free
    angle = 2 * math.pi * np.arange(SIDES) / SIDES
    sides = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(SIDES)])
    apothem = region.radius * math.cos(math.pi / SIDES)
    around = apothem + sides[:, :2] @ np.array(region.center)
    return np.concatenate([both * [0.0, 0.0, 1.0], sides]), np.array([-region.z[0], region.z[1], *around]) - free


def _remains(triangle: FloatArray, normals: FloatArray, distances: FloatArray) -> bool:
    """Whether a part of a triangle lies below all faces; each face in turn cuts off the part beyond it."""
    polygon = triangle
    for normal, distance in zip(normals, distances, strict=True):
        height = polygon @ normal - distance
        corners = []
        for a, b, x, y in zip(polygon, np.roll(polygon, -1, axis=0), height, np.roll(height, -1), strict=True):
            if x < 0.0:
                corners.append(a)
            if x * y < 0.0:
                corners.append(a + (b - a) * x / (x - y))
        if not corners:
            return False
        polygon = np.array(corners)
    return True


def crosses(region: Region, triangles: FloatArray, free: float) -> bool:
    """Whether one of the triangles, shape (n, 3 corners, 3), has a part more than `free` [m] inside a region."""
    normals, distances = _faces(region, free)
    beyond = np.any(np.all(triangles @ normals.T >= distances, axis=1), axis=1)
    return any(_remains(t, normals, distances) for t in triangles[~beyond])


def depths(triangles: FloatArray, places: FloatArray, radii: FloatArray) -> FloatArray:
    """How far [m] the nearest of the triangles, shape (n, 3 corners, 3), lies in each sphere; below 0: it does not.

    places: centres, shape (m, 3), radii: shape (m,).
    """
    found = np.full(len(radii), -np.inf)
    low, high = places - radii[:, None], places + radii[:, None]
    beside = (triangles.min(axis=1) > high.max(axis=0)) | (triangles.max(axis=1) < low.min(axis=0))
    for triangle in triangles[~beside.any(axis=1)]:
        near = np.flatnonzero(((triangle.min(axis=0) <= high) & (triangle.max(axis=0) >= low)).all(axis=1))
        if near.size:
            import trimesh  # a second: only where a wall is near

            same = np.tile(triangle, (near.size, 1, 1))
            closest = trimesh.triangles.closest_point(same, places[near])  # type: ignore[no-untyped-call]
            found[near] = np.maximum(found[near], radii[near] - np.linalg.norm(closest - places[near], axis=1))
    return found
