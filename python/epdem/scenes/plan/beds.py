# SPDX-License-Identifier: GPL-2.0-or-later
"""Beds that plates press: their height, area and relative density at the end of each motion; SI."""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from ...case.parts import Parts
from ...case.scene import SceneCase
from ...case.walls import CasePhase, CylinderWall, PlateWall
from ...errors import CaseError
from .filling import Insertion, mean_volume

DENSE = 0.9  # relative density above which overlaps of spheres no longer describe the contacts
DENSEST = 0.98  # that a press by a force is taken to reach


class PressedBed(NamedTuple):
    """A bed at the end of the motion of a plate in a phase: its height, the height of its spheres without void [m],
    its area [m^2].

    key: place in the case. axis, sign: the motion; stop: place [m] of the plane that the plate moves to, or at the
    start of the plate `against` it. height: NaN if it is known in the run alone.
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
    against: str = ""


def refuse_below_solid(beds: Iterable[PressedBed]) -> None:
    """Raise CaseError for a plate that moves to a height where the spheres would have no void left."""
    for bed in beds:
        if bed.height <= bed.solid_height:
            raise CaseError(
                f"{bed.key} = {bed.height:.4g} m: the spheres alone, without any void, are {bed.solid_height:.4g} m "
                f"high (sum of their volumes over {bed.area:.4g} m^2); give a larger height, or fewer spheres"
            )


def bed_of(beds: Iterable[PressedBed], phase: CasePhase) -> PressedBed | None:
    """The bed that the wall of the condition of a phase presses in it."""
    wall = phase.until.wall if phase.until else None
    return next((bed for bed in beds if (bed.phase, bed.wall) == (phase.name, wall) and bed.solid_height > 0.0), None)


def closing_speed(bed: PressedBed, phase: CasePhase) -> float:
    """Speed [m/s] at which a bed becomes lower while its plate moves at its constant velocity."""
    along = (phase.moves[name].along[bed.axis] if name in phase.moves else 0.0 for name in (bed.wall, bed.against))
    plate, against = along
    return bed.sign * (plate - against)


def refuse_heights(scene: Parts, beds: Sequence[PressedBed]) -> None:
    """Raise CaseError for a phase that ends at a height or density that its wall does not press a bed to."""
    for phase in scene.phase:
        if not (phase.until and phase.until.of_bed):
            continue
        bed, key = bed_of(beds, phase), "height" if phase.until.height else "density"
        place = f"scene.phase.{phase.name}.until.{key}"
        if any(move.constant_velocity is None for move in phase.moves.values()):
            raise CaseError(f"{place}: each wall that moves in this phase moves linearly; give another condition")
        if bed is None or closing_speed(bed, phase) <= 0.0:
            raise CaseError(
                f"{place}: wall {phase.until.wall} presses no bed in this phase: a bed is pressed by a plate that "
                "covers the room or a tube and moves towards its spheres, with a plane or a plate at rest of its size "
                "behind them; name another wall, or give travel"
            )
        if phase.until.density == 1.0 or (phase.until.height and phase.until.height <= bed.solid_height):
            raise CaseError(
                f"{place} = {phase.until.limit:g}: no void would be left; the spheres alone are "
                f"{bed.solid_height:.4g} m high; give a height above it, or a density below 1"
            )


def dense_beds(beds: Iterable[PressedBed]) -> list[str]:
    """A sentence for the largest relative density above DENSE that a plate presses a bed to."""
    known = [bed for bed in beds if bed.solid_height > DENSE * bed.height]
    return [
        f"{bed.key} = {bed.height:.4g} m: the relative density reaches {bed.solid_height / bed.height:.3g}, and above "
        f"{DENSE} no contact law of spheres gives the pressure (docs/press.md); give a larger height"
        for bed in sorted(known, key=lambda bed: bed.solid_height / bed.height)[-1:]
    ]


def largest_density(scene: Parts, beds: Iterable[PressedBed]) -> float:
    """Largest relative density that plates press a bed to: DENSEST where the run alone knows it, 0 without a press."""
    moves = (move for phase in scene.phase for move in phase.moves.values())
    found = [min(bed.solid_height / bed.height, 1.0) if bed.height > 0.0 else DENSEST for bed in beds]
    presses = any(any(move.along) and math.isinf(move.period) for move in moves)
    return max(found, default=DENSEST if presses else 0.0)


def pressed_beds(case: SceneCase, scene: Parts, insertions: tuple[Insertion, ...]) -> Iterator[PressedBed]:
    """The bed at the end of each motion of each plate that covers the room or a tube, up to a turn of the plate.

    Only spheres count that begin between the plate and the plane that it moves to.
    """
    plates = [w for w in scene.wall if isinstance(w, PlateWall) and not scene.open_boundary]
    for wall in plates:
        plate_at = {w.name: w.center["xyz".index(w.axis)] for w in plates if w.axis == wall.axis}
        axis = "xyz".index(wall.axis)
        planes = [w.at for w in scene.planes if w.axis == wall.axis]
        begin = place = wall.center[axis]
        for n, phase in enumerate(scene.phase):
            move = phase.moves.get(wall.name)
            if move is None:
                continue
            if move.rotation:
                break
            known = move.constant_velocity and not phase.condition
            place += phase.seconds * move.along[axis] if known else math.nan
            if not move.along[axis] or math.isfinite(move.period):
                continue
            sign = math.copysign(1.0, move.along[axis])
            stages, against = scene.stages, ""
            if stages and wall.name == stages.against:
                break  # the punch has the bed
            if stages and wall.name == stages.wall and stages.against in plate_at:
                against = stages.against
                if sign * (plate_at[against] - begin) < 0:
                    continue
            beyond = [x for x in (*planes, *_floors(scene, wall)) if sign * (x - begin) > 0]
            ends = [plate_at[against]] if against else [*beyond, scene.room.limits[2 * axis + (sign > 0)]]
            stop = min(ends, key=lambda x: sign * x)
            low, high = min(begin, stop), max(begin, stop)
            coming = {later.name for later in scene.phase[n + 1 :]}
            fills = [f for f in insertions if f.phase not in coming]
            fills = [f for f in fills if low <= f.region.limits[2 * axis] and f.region.limits[2 * axis + 1] <= high]
            if math.isnan(place):  # a stream of this phase has not come yet
                fills = [f for f in fills if not (f.rate and f.phase == phase.name)]
            volume = sum(mean_volume(case, f) * f.count for f in fills)
            volume += sum(4.0 / 3.0 * math.pi * s.radius**3 for s in scene.table if low <= s.place[axis] <= high)
            if area := _covered(scene, wall, (low, high), fills):
                key = scene.place(f"scene.phase.{phase.name}.move: wall {wall.name} ends at a height")
                height = sign * (stop - place)
                yield PressedBed(key, phase.name, wall.name, axis, sign, stop, height, volume / area, area, against)


def _floors(scene: Parts, wall: PlateWall) -> list[float]:
    """Places [m] of the plates that never move and are opposite the whole of a plate."""
    moved = {name for phase in scene.phase for name in phase.moves}
    plates = [w for w in scene.wall if isinstance(w, PlateWall) and w.axis == wall.axis and w.name not in moved]
    axis = "xyz".index(wall.axis)
    return [w.center[axis] for w in plates if all(map(_within, _edges(wall), _edges(w)))]


def _edges(wall: PlateWall) -> list[tuple[float, float]]:
    """From and to [m] of a plate along the two axes across it."""
    others = [k for k in range(3) if "xyz"[k] != wall.axis]
    return [(wall.center[k] - size / 2, wall.center[k] + size / 2) for k, size in zip(others, wall.size, strict=True)]


def _covered(scene: Parts, wall: PlateWall, span: tuple[float, float], fills: list[Insertion]) -> float:
    """Area of the tube that holds the fills, or of the room between its planes, if the plate covers it [m^2]; else 0.

    span: heights between which the plate moves.
    """
    others, edges = [k for k in range(3) if "xyz"[k] != wall.axis], _edges(wall)
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
    slack = 1e-9 * (outer[1] - outer[0])
    return outer[0] - slack <= inner[0] and inner[1] <= outer[1] + slack
