# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls of a scene: their triangles at the start, how far they move, where they are at the end, and whether they leave.

Arrays of triangles have the shape (n, 3 corners, 3 coordinates), metres.
"""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile

import numpy as np

from ..case.motions import LinearMove, Move, PressMove, RotateMove, VibrateMove
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
from ..errors import CaseError
from . import meshes
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
            return meshes.placed(w, room, largest)
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


@dataclass(frozen=True)
class Path:
    """Points that move for some time: their least and largest coordinates on the way, and where they are at its end."""

    low: FloatArray
    high: FloatArray
    end: FloatArray


def path(move: LinearMove | RotateMove | VibrateMove, points: FloatArray, seconds: float) -> Path:
    """The path of `points`, shape (n, 3), from the begin of a motion on [m]."""
    if isinstance(move, LinearMove):
        end = points + seconds * np.array(move.velocity)
        return Path(np.minimum(points, end), np.maximum(points, end), end)
    if isinstance(move, VibrateMove):
        angle, amplitude = move.omega * seconds, np.array(move.amplitude)
        sines = [0.0, math.sin(angle)] + [1.0] * (angle >= math.pi / 2) + [-1.0] * (angle >= 3 * math.pi / 2)
        places = np.stack([points + sine * amplitude for sine in sines])
        return Path(places.min(axis=0), places.max(axis=0), places[1])
    axis, angle = np.array(move.unit_axis) * math.copysign(1.0, move.rate), abs(move.rate) * seconds
    arm = points - np.array(move.origin)
    center = np.array(move.origin) + (arm @ axis)[:, None] * axis
    arm = points - center
    side = np.cross(axis, arm)
    turned = center + arm * math.cos(angle) + side * math.sin(angle)
    first = np.arctan2(side, arm) % math.pi  # where a coordinate is extreme, for the first time
    extremes = [points, turned]
    for extreme in (first, first + math.pi):
        there = center + arm * np.cos(extreme) + side * np.sin(extreme)
        extremes.append(np.where(extreme <= angle, there, points))
    return Path(np.min(extremes, axis=0), np.max(extremes, axis=0), turned)


def paths(
    phases: Iterable[tuple[Mapping[str, Move], float]], points: Mapping[str, FloatArray]
) -> Iterator[tuple[int, str, Path]]:
    """(number of the phase, wall, path) of every wall that moves in `phases`, each with its motions and duration [s].

    A wall that a force drives is left out from then on. points: of each wall at the start, shape (n, 3) [m].
    """
    here = dict(points)
    moving: dict[str, tuple[Move, FloatArray, float]] = {}  # motion, where and how long ago it began
    for number, (moves, duration) in enumerate(phases):
        moving = {name: begun for name, begun in moving.items() if moves.get(name) == begun[0]}
        for name, move in moves.items():
            if isinstance(move, PressMove) or name not in here:
                here.pop(name, None)
                continue
            _, begin, seconds = moving.get(name, (move, here[name], 0.0))
            moving[name] = (move, begin, seconds + duration)
            way = path(move, begin, seconds + duration)
            here[name] = way.end
            yield number, name, way


def at_end(
    phases: Sequence[tuple[Mapping[str, Move], float]], triangles: dict[str, FloatArray]
) -> dict[str, FloatArray]:
    """The triangles of each wall, shape (n, 3 corners, 3), after `phases`; without walls that a force drives."""
    pressed = {name for moves, _ in phases for name, move in moves.items() if isinstance(move, PressMove)}
    found = {name: corners for name, corners in triangles.items() if name not in pressed}
    for _, name, way in paths(phases, {name: corners.reshape(-1, 3) for name, corners in found.items()}):
        found[name] = way.end.reshape(-1, 3, 3)
    return found


def refuse_leaving(scene: Parts, triangles: dict[str, FloatArray]) -> None:
    """Raise CaseError for a wall whose motion takes the centre of a triangle out of the room.

    Not looked at are walls that a force drives, and what comes with a phase that may end early or later.
    """
    room = scene.room.limits
    phases = [*takewhile(lambda phase: not phase.condition, scene.phase)]
    centers = {name: corners.mean(axis=1) for name, corners in triangles.items()}
    for number, name, way in paths([(phase.moves, phase.seconds) for phase in phases], centers):
        for k, axis in enumerate("xyz"):
            low, high = float(way.low[:, k].min()), float(way.high[:, k].max())
            if low < room[2 * k] or high > room[2 * k + 1]:
                reached = high if high > room[2 * k + 1] else low
                raise CaseError(
                    f"scene.phase.{phases[number].name}.move: wall {name} leaves scene.room, the centre of a triangle "
                    f"reaches {axis} = {reached:.4g} m and the room is from {room[2 * k]:g} m to "
                    f"{room[2 * k + 1]:g} m; shorten its way, or enlarge the room"
                )
