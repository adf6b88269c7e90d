# SPDX-License-Identifier: GPL-2.0-or-later
"""Presses whose end leaves the spheres no void, refused before anything starts."""

import math

from ..case.motions import LinearMove
from ..case.parts import Parts
from ..case.scene import SceneCase
from ..case.walls import CylinderWall, PlateWall
from ..errors import CaseError
from .filling import Insertion, mean_volume


def refuse_below_solid(case: SceneCase, scene: Parts, insertions: tuple[Insertion, ...]) -> None:
    """Raise CaseError for a plate that moves to a height where the spheres would have no void left.

    It covers the room or a tube; only spheres count that begin between the plate and the plane that it moves to.
    """
    for wall in scene.wall:
        if isinstance(wall, PlateWall) and not scene.open_boundary:
            _refuse_plate(case, scene, insertions, wall)


def _refuse_plate(case: SceneCase, scene: Parts, insertions: tuple[Insertion, ...], wall: PlateWall) -> None:
    """The same of one plate at the end of each of its motions, up to a phase whose end is not known."""
    axis = "xyz".index(wall.axis)
    begin = place = wall.center[axis]
    for n, phase in enumerate(scene.phase):
        move = phase.moves.get(wall.name)
        if phase.condition or (move is not None and not isinstance(move, LinearMove)):
            return
        if move is None or not move.velocity[axis]:
            continue
        place += phase.seconds * move.velocity[axis]
        sign = math.copysign(1.0, move.velocity[axis])
        stops = [w.at for w in scene.planes if w.axis == wall.axis and sign * (w.at - begin) > 0]
        stop = min([*stops, scene.room.limits[2 * axis + (sign > 0)]], key=lambda x: sign * x)
        low, high = min(begin, stop), max(begin, stop)
        coming = {later.name for later in scene.phase[n + 1 :]}
        fills = [f for f in insertions if f.phase not in coming]
        fills = [f for f in fills if low <= f.region.limits[2 * axis] and f.region.limits[2 * axis + 1] <= high]
        volume = sum(mean_volume(case, f) * f.count for f in fills)
        volume += sum(4.0 / 3.0 * math.pi * s.radius**3 for s in scene.table if low <= s.place[axis] <= high)
        area, height = _covered(scene, wall, (low, high), fills), sign * (stop - place)
        if area and height <= volume / area:
            compaction = case.scene.kind == "compaction"
            key = "scene.height" if compaction else f"scene.phase.{phase.name}.move: wall {wall.name} ends at a height"
            raise CaseError(
                f"{key} = {height:.4g} m: the spheres alone, without any void, are {volume / area:.4g} m high (sum of "
                f"their volumes over {area:.4g} m^2); give a larger height, or fewer spheres"
            )


def _covered(scene: Parts, wall: PlateWall, span: tuple[float, float], fills: list[Insertion]) -> float:
    """Area of the tube that holds the fills, or of the room between its planes, if the plate covers it [m^2]; else 0.

    span: heights between which the plate moves.
    """
    others = [k for k in range(3) if "xyz"[k] != wall.axis]
    edges = [(wall.center[k] - size / 2, wall.center[k] + size / 2) for k, size in zip(others, wall.size, strict=True)]
    for tube in scene.wall:
        if isinstance(tube, CylinderWall) and tube.axis == wall.axis and not scene.table:
            reach = [(c - tube.diameter / 2, c + tube.diameter / 2) for c in tube.center]
            limits = [f.region.limits[2 * k : 2 * k + 2] for f in fills for k in others]
            holds = all(_within(x, reach[n % 2]) for n, x in enumerate(limits))
            holds &= _within(span, (min(tube.start, tube.to), max(tube.start, tube.to)))
            if holds and all(map(_within, reach, edges)):
                return math.pi / 4 * tube.diameter**2
    sides = []
    for k, edge in zip(others, edges, strict=True):
        places = [w.at for w in scene.planes if w.axis == "xyz"[k]]
        low = max([x for x in places if x < wall.center[k]], default=scene.room.limits[2 * k])
        high = min([x for x in places if x > wall.center[k]], default=scene.room.limits[2 * k + 1])
        if not _within((low, high), edge):
            return 0.0
        sides.append(high - low)
    return math.prod(sides)


def _within(inner: tuple[float, ...], outer: tuple[float, ...]) -> bool:
    """Whether an interval lies in another one, but for round-off."""
    slack = 1e-9 * (outer[1] - outer[0])
    return outer[0] - slack <= inner[0] and inner[1] <= outer[1] + slack
