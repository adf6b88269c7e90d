# SPDX-License-Identifier: GPL-2.0-or-later
"""Spheres with given positions at the start: on the limit of the room, inside each other."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from ..case.parts import FileFill, Parts, Sphere
from ..errors import CaseError
from .meshes import FloatArray

IntArray = npt.NDArray[np.int64]
Named = list[tuple[str, Sphere]]  # the name of a sphere in messages, the sphere


def overlaps(spheres: Sequence[Sphere]) -> tuple[IntArray, IntArray, FloatArray]:
    """(i, j, overlap over the smaller radius) of the pairs of spheres that overlap, except pairs of frozen ones.

    If centres lie in other spheres, only the nearest neighbours are found: a table of one position has too many pairs.
    """
    from scipy.spatial import cKDTree

    if len(spheres) < 2:
        return np.zeros(0, int), np.zeros(0, int), np.zeros(0)
    positions = np.array([s.place for s in spheres])
    radius = np.array([s.radius for s in spheres])
    frozen = np.array([s.frozen for s in spheres])
    every = np.arange(len(spheres))

    def found(i: IntArray, j: IntArray) -> tuple[IntArray, IntArray, FloatArray]:
        distance = np.linalg.norm(positions[i] - positions[j], axis=1)
        share = (radius[i] + radius[j] - distance) / np.minimum(radius[i], radius[j])
        chosen = (share > 0) & ~(frozen[i] & frozen[j])
        return i[chosen], j[chosen], share[chosen]

    _, first, group = np.unique(positions, axis=0, return_index=True, return_inverse=True)
    again = every[first[group.ravel()] != every]  # a tree takes minutes for many spheres at one position
    same = found(first[group.ravel()[again]], again)
    if len(same[0]):
        return same
    tree = cKDTree(positions)
    two = tree.query(positions, k=2)[1]  # of spheres at one position itself and another one, in any order
    nearest = found(every, np.where(two[:, 0] == every, two[:, 1], two[:, 0]))
    if (nearest[2] >= 1.0).any():
        return nearest
    around = tree.query_ball_point(positions, 2.0 * radius)  # of two spheres the larger one finds the other
    i = np.repeat(every, [len(x) for x in around])
    j = np.concatenate([np.asarray(x, int) for x in around])
    once = (radius[j] < radius[i]) | ((radius[j] == radius[i]) & (i < j))
    return found(i[once], j[once])


def _by_phase(s: Parts) -> list[Named]:
    """The spheres with given positions, in the order of `Parts.table`, by the phase with which they come."""
    first = s.phase[0].name
    files = [f for f in s.fill if isinstance(f, FileFill)]
    groups = {first: [(f"scene.fill.{f.name}, sphere {n}", x) for f in files for n, x in enumerate(f.spheres, 1)]}
    for body in s.body:
        groups.setdefault(body.phase or first, []).append((f"scene.body.{body.name}.position", body.sphere))
    return [*groups.values()]


def refuse_positions(s: Parts) -> None:
    """Raise CaseError for a sphere outside of the room or on its limit, and for one whose centre lies in another one.

    Engines lose the former and divide by zero for the latter. A periodic room has no limits in x and y.
    """
    limits = s.room.limits
    sides = [*zip("xyz", limits[0::2], limits[1::2], strict=True)]
    for group in _by_phase(s):
        for name, x in group:
            inside = all(
                low < v < high or (s.periodic and axis != "z" and low <= v <= high)
                for v, (axis, low, high) in zip(x.place, sides, strict=True)
            )
            if not inside:
                raise CaseError(
                    f"{name}: {tuple(x.place)} m lies beyond scene.room or on its limit; move it, or enlarge the room"
                )
        i, j, share = overlaps([x for _, x in group])
        if len(share) and share.max() >= 1.0:
            worst = int(share.argmax())
            one, other = group[max(i[worst], j[worst])][0], group[min(i[worst], j[worst])][0]
            raise CaseError(
                f"{one}: overlaps {other} by {share[worst]:.0%} of the smaller radius at the start, must be below "
                "100 %; move one of them"
            )
