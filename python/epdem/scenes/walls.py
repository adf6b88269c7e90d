# SPDX-License-Identifier: GPL-2.0-or-later
"""Triangles of the walls of a scene at the start. Arrays of shape (n, 3 corners, 3 coordinates), metres."""

import numpy as np

from ..case.motions import RotateMove
from ..case.parts import Parts
from ..case.walls import (
    BoxWall,
    ConeWall,
    CylinderWall,
    Limits,
    MeshWall,
    PlaneWall,
    PlateWall,
    RevolvedWall,
    StlWall,
)
from . import meshes, stl_files
from .meshes import FloatArray


def _triangles(w: MeshWall, room: Limits, largest: float) -> FloatArray:
    match w:
        case PlateWall():
            first, second = w.size
            return meshes.rectangle("xyz".index(w.axis), np.array(w.center), (first, second))
        case BoxWall():
            faces = {sign + axis for sign in "-+" for axis in "xyz"} - set(w.open)
            return meshes.box((*w.x, *w.y, *w.z), faces)
        case CylinderWall() | ConeWall():
            closed = ("from" in w.ends, "to" in w.ends)
            tube = meshes.tube(w.diameters_of_ends(), w.start, w.to, closed=closed)
            turned: FloatArray = meshes.along("xyz".index(w.axis), tube) + np.array(w.axis_point)
            return turned
        case RevolvedWall():
            surface: FloatArray = meshes.revolved(w.profile) + np.array([*w.center, 0.0])
            return surface
        case StlWall():
            return stl_files.placed(w, room, largest)
    raise AssertionError(w)


def triangles(scene: Parts) -> dict[str, FloatArray]:
    """The triangles of each wall that is not a plane. Raises CaseError for a file that holds no wall."""
    largest = max(p.radii()[1] for p in scene.filled)
    room = scene.room.limits
    return {w.name: _triangles(w, room, largest) for w in scene.wall if isinstance(w, MeshWall)}


def sheet(plane: PlaneWall, room: Limits) -> FloatArray:
    """A plane as two triangles as large as the room."""
    low, high, axis = np.array(room[0::2]), np.array(room[1::2]), "xyz".index(plane.axis)
    center, size = (low + high) / 2, np.delete(high - low, axis)
    center[axis] = plane.at
    return meshes.rectangle(axis, center, (size[0], size[1]))


def spans(w: PlateWall, axis: str, box: Limits) -> bool:
    """Whether a plate is as wide as a box along an axis in its plane."""
    k = "xyz".index(axis)
    return dict(zip("xyz".replace(w.axis, ""), w.size, strict=True))[axis] >= (box[2 * k + 1] - box[2 * k]) * (1 - 1e-9)


def surface_rotation(w: MeshWall) -> RotateMove | None:
    """The rotation of the surface of a round wall, whose triangles stay where they are."""
    if not isinstance(w, CylinderWall | ConeWall) or not w.angular_velocity:
        return None
    axis = [float(axis == w.axis) for axis in "xyz"]
    return RotateMove.model_construct(
        wall=w.name, kind="rotate", axis=axis, origin=w.axis_point, rate=w.angular_velocity
    )
