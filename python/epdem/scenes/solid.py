# SPDX-License-Identifier: GPL-2.0-or-later
"""Relative densities that presses reach: refused without void, named by a warning above DENSE, found during the run."""

import math
from collections.abc import Iterator
from typing import NamedTuple

from ..case.motions import LinearMove, PressMove, RotateMove
from ..case.parts import Parts
from ..case.scene import SceneCase
from ..case.walls import CylinderWall, PlateWall
from ..errors import CaseError
from .filling import Insertion, mean_volume

DENSE = 0.9  # relative density above which overlaps of spheres no longer describe the contacts


class PressedBed(NamedTuple):
    """A bed at the end of the motion of a plate in a phase: its height, that of its spheres without any void [m], its
    area [m^2].

    key: place in the case. axis, sign: the motion; stop: place [m] of the plane that the plate moves to. height: NaN if
    only the run tells it.
    """

    key: str
    phase: str
    wall: str
    axis: int
    sign: float
    stop: float
    height: float
    solid_height: float
    area: float


def refuse_below_solid(case: SceneCase, scene: Parts, insertions: tuple[Insertion, ...]) -> None:
    """Raise CaseError for a plate that moves to a height where the spheres would have no void left."""
    for bed in _pressed_beds(case, scene, insertions):
        if bed.height <= bed.solid_height:
            raise CaseError(
                f"{bed.key} = {bed.height:.4g} m: the spheres alone, without any void, are {bed.solid_height:.4g} m "
                f"high (sum of their volumes over {bed.area:.4g} m^2); give a larger height, or fewer spheres"
            )


def dense_beds(case: SceneCase, scene: Parts, insertions: tuple[Insertion, ...]) -> list[str]:
    """A sentence for the largest relative density above DENSE that a plate presses a bed to."""
    beds = [bed for bed in _pressed_beds(case, scene, insertions) if not math.isnan(bed.height)]
    beds.sort(key=lambda bed: bed.solid_height / bed.height)
    return [
        f"{bed.key} = {bed.height:.4g} m: the relative density reaches {bed.solid_height / bed.height:.3g}, and above "
        f"{DENSE} no contact law of spheres gives the pressure (docs/choose.md, Pressing); give a larger height"
        for bed in beds[-1:]
        if bed.solid_height > DENSE * bed.height
    ]


def pressed_beds_of_run(case: SceneCase, scene: Parts, insertions: tuple[Insertion, ...]) -> tuple[PressedBed, ...]:
    """The beds whose height only the run tells."""
    return tuple(bed for bed in _pressed_beds(case, scene, insertions) if math.isnan(bed.height))


def _pressed_beds(case: SceneCase, scene: Parts, insertions: tuple[Insertion, ...]) -> Iterator[PressedBed]:
    """The bed at the end of each motion of each plate that covers the room or a tube.

    Only spheres count that begin between the plate and the plane that it moves to.
    """
    for wall in scene.wall:
        if isinstance(wall, PlateWall) and not scene.open_boundary:
            yield from _pressed_by(case, scene, insertions, wall)


def _pressed_by(
    case: SceneCase, scene: Parts, insertions: tuple[Insertion, ...], wall: PlateWall
) -> Iterator[PressedBed]:
    """The same of one plate, up to a phase in which the plate turns."""
    axis = "xyz".index(wall.axis)
    begin = place = wall.center[axis]
    for n, phase in enumerate(scene.phase):
        move = phase.moves.get(wall.name)
        if isinstance(move, RotateMove):
            return
        speed = move.velocity[axis] if isinstance(move, LinearMove) else 0.0
        if move is not None:
            known = isinstance(move, LinearMove) and not phase.condition
            place += phase.seconds * speed if known else math.nan
        way = move.direction[axis] if isinstance(move, PressMove) else speed
        if not way:
            continue
        sign = math.copysign(1.0, way)
        stops = [w.at for w in scene.planes if w.axis == wall.axis and sign * (w.at - begin) > 0]
        stop = min([*stops, scene.room.limits[2 * axis + (sign > 0)]], key=lambda x: sign * x)
        low, high = min(begin, stop), max(begin, stop)
        coming = {later.name for later in scene.phase[n + 1 :]}
        fills = [f for f in insertions if f.phase not in coming]
        fills = [f for f in fills if low <= f.region.limits[2 * axis] and f.region.limits[2 * axis + 1] <= high]
        if math.isnan(place):  # a stream of this phase has not come yet
            fills = [f for f in fills if not (f.rate and f.phase == phase.name)]
        volume = sum(mean_volume(case, f) * f.count for f in fills)
        volume += sum(4.0 / 3.0 * math.pi * s.radius**3 for s in scene.table if low <= s.place[axis] <= high)
        area = _covered(scene, wall, (low, high), fills)
        if area:
            compaction = case.scene.kind == "compaction"
            key = "scene.height" if compaction else f"scene.phase.{phase.name}.move: wall {wall.name} ends at a height"
            height = sign * (stop - place)
            yield PressedBed(key, phase.name, wall.name, axis, sign, stop, height, volume / area, area)


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
