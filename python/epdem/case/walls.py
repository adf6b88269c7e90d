# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls of a scene made of parts (flat, round, boxes, STL files), and phases: how long, which walls move, how. SI."""

import itertools
import math
from abc import ABC, abstractmethod
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from .fields import Frozen, Interval, Length, Name, Quantity, Spin, Temperature, zero_vector
from .motions import Force, Move
from .places import Axis, Direction, Limits, Pair, PartName, Place, Side, Span, Vector
from .sizes import FileName


class Room(Frozen):
    """A room between planes, x, y, z from and to [m]."""

    x: Span
    y: Span
    z: Span

    @property
    def limits(self) -> Limits:
        """xlo xhi ylo yhi zlo zhi [m]."""
        return (self.x[0], self.x[1], self.y[0], self.y[1], self.z[0], self.z[1])

    @property
    def volume(self) -> float:
        xlo, xhi, ylo, yhi, zlo, zhi = self.limits
        return (xhi - xlo) * (yhi - ylo) * (zhi - zlo)


class Upright(Frozen):
    """An upright cylinder: a room that is filled."""

    diameter: Length
    z: Span
    center: Pair = Field(default_factory=lambda: [0.0, 0.0])

    @property
    def radius(self) -> float:
        return self.diameter / 2

    @property
    def limits(self) -> Limits:
        """xlo xhi ylo yhi zlo zhi [m] of the box around the cylinder."""
        (x, y), r = self.center, self.radius
        return (x - r, x + r, y - r, y + r, self.z[0], self.z[1])

    @property
    def volume(self) -> float:
        return math.pi * self.radius**2 * (self.z[1] - self.z[0])


class _Wall(Frozen):
    """temperature, potential: fixed; a wall without one takes no heat, or no current."""

    name: PartName
    material: Name
    temperature: Temperature | None = None
    potential: Annotated[float, Quantity("V")] | None = None


class PlaneWall(_Wall):
    """An infinite plane across an axis, at rest; in the named phases only, if there are any."""

    kind: Literal["plane"]
    axis: Axis
    at: Place
    phases: list[PartName] = Field(default_factory=list)


class MeshWall(_Wall):
    """A wall of triangles. stress: the frames have the pressure on each; wear: its constant of Finnie's law [m^2/N]."""

    stress: bool = False
    wear: Annotated[float, Quantity("m^2/N", above=0.0)] | None = None


class PlateWall(MeshWall):
    """A rectangle of two triangles across an axis; `size` along the two other axes, in the order x, y, z."""

    kind: Literal["plate"]
    axis: Axis
    center: Vector
    size: Annotated[list[Length], Field(min_length=2, max_length=2)]


class BoxWall(MeshWall):
    """The six faces of a room, without those that are `open` ("-z": the lower one)."""

    kind: Literal["box"]
    x: Span
    y: Span
    z: Span
    open: list[Side] = Field(default_factory=list)

    @model_validator(mode="after")
    def _faces(self) -> Self:
        if len(set(self.open)) == 6:
            raise ValueError("open: all six faces are open, so nothing is left; remove the wall")
        return self


class _Round(MeshWall, Interval[Place], ABC):
    """A wall about an axis, from one place along it to another; `center`: the two other coordinates.

    ends: the ends that a disc closes. angular_velocity: of the surface about the axis. The wall is a body of
    revolution, so that its triangles stay where they are.
    """

    axis: Axis = "z"
    center: Pair = Field(default_factory=lambda: [0.0, 0.0])
    ends: list[Literal["from", "to"]] = Field(default_factory=list)
    angular_velocity: Spin = 0.0

    @property
    def axis_point(self) -> list[float]:
        """A point on the axis, x y z [m]."""
        point = list(self.center)
        point.insert("xyz".index(self.axis), 0.0)
        return point

    @abstractmethod
    def diameters_of_ends(self) -> tuple[float, float]:
        """At `from` and at `to` [m]."""


class CylinderWall(_Round):
    """A round tube."""

    kind: Literal["cylinder"]
    diameter: Length

    def diameters_of_ends(self) -> tuple[float, float]:
        return self.diameter, self.diameter


class ConeWall(_Round):
    """A round tube whose diameter changes evenly from `from` to `to`."""

    kind: Literal["cone"]
    diameters: Annotated[list[Length], Field(min_length=2, max_length=2)]

    def diameters_of_ends(self) -> tuple[float, float]:
        return self.diameters[0], self.diameters[1]


class RevolvedWall(MeshWall):
    """A surface of revolution about an upright axis through `center`; `profile`: points (radius, z), from one end."""

    kind: Literal["revolved"]
    profile: Annotated[list[Annotated[tuple[Length, Place], Field(strict=False)]], Field(min_length=2, max_length=100)]
    center: Pair = Field(default_factory=lambda: [0.0, 0.0])

    @model_validator(mode="after")
    def _points(self) -> Self:
        for one, two in itertools.pairwise(self.profile):
            if one == two:
                raise ValueError(f"profile: two points in a row are the same, {list(one)} m; remove one")
        return self


class Rotation(Frozen):
    """A turn about an axis through the origin."""

    axis: Direction
    angle: Annotated[float, Quantity("rad")]


class StlWall(MeshWall):
    """The triangles of an STL file, multiplied by `scale` (1e-3 if the file is in mm), rotated, then moved.

    closed: whether it must be watertight.
    """

    kind: Literal["stl"]
    file: FileName
    scale: Annotated[float, Quantity("1", above=0.0)] = 1.0
    rotate: Rotation | None = None
    position: Vector = Field(default_factory=zero_vector)
    closed: bool = False


AnyWall = PlaneWall | PlateWall | BoxWall | CylinderWall | ConeWall | RevolvedWall | StlWall
Wall = Annotated[AnyWall, Field(discriminator="kind")]


Time = Annotated[float, Quantity("s", above=0.0)]
OF_WALL = ("force", "force_below", "travel", "height", "density")
CONDITIONS = ("kinetic_energy", "count", *OF_WALL)


class Until(Frozen):
    """Condition that ends a phase before its duration, tested from `after` on (a tenth of the duration; of a height or
    density 0).

    kinetic_energy: of a sphere, the mean is below; a room without spheres waits for them. count: so few spheres are in
    the room. force: the force on `wall` is reached; force_below: the force has fallen to it. travel: way of `wall`,
    which moves with a constant velocity. height, density: of the bed that `wall` presses.
    """

    kinetic_energy: Annotated[float, Quantity("J", above=0.0)] | None = None
    count: Annotated[int, Field(ge=0)] | None = None
    wall: PartName | None = None
    force: Force | None = None
    force_below: Force | None = None
    travel: Annotated[float, Quantity("m", above=0.0)] | None = None
    height: Annotated[float, Quantity("m", above=0.0)] | None = None
    density: Annotated[float, Quantity("1", above=0.0, le=1.0)] | None = None
    after: Annotated[float, Quantity("s", ge=0.0)] | None = None

    @model_validator(mode="after")
    def _one(self) -> Self:
        given = [key for key in CONDITIONS if getattr(self, key) is not None]
        if len(given) != 1:
            raise ValueError(f"give one of {', '.join(CONDITIONS[:-1])} and {CONDITIONS[-1]}")
        if (self.wall is None) == (given[0] in OF_WALL):
            raise ValueError(f"'wall' belongs to {', '.join(OF_WALL[:-1])} and {OF_WALL[-1]}, and only to them")
        return self

    @property
    def of_bed(self) -> bool:
        return self.height is not None or self.density is not None

    @property
    def limit(self) -> float:
        """The value of the one condition: [J], number of spheres, [N], [m] or a relative density."""
        return float(next(x for key in CONDITIONS if (x := getattr(self, key)) is not None))


class CasePhase(Frozen):
    """A part of the run; with `until` at most for `duration`. time_step: its own. record: whether it has frames."""

    name: PartName
    duration: Time
    until: Until | None = None
    time_step: Time | None = None
    record: bool = True
    move: list[Move] = Field(default_factory=list, max_length=64)

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if len(self.moves) < len(self.move):
            wall = max(walls := [m.wall for m in self.move], key=walls.count)
            raise ValueError(f"two motions of wall {wall!r}; give one")
        if self.until and (self.until.after or 0.0) >= self.duration:
            raise ValueError("until.after must be below duration")
        linear = [m.wall for m in self.move if any(m.constant_velocity or ())]
        for key in ("travel", "height", "density"):
            if self.until and getattr(self.until, key) is not None and self.until.wall not in linear:
                raise ValueError(f"until.{key}: wall {self.until.wall!r} has no linear motion in this phase")
        return self

    @property
    def moves(self) -> dict[str, Move]:
        return {m.wall: m for m in self.move}

    @property
    def seconds(self) -> float:
        """The duration, shorter where a wall with a constant velocity has made its travel [s]."""
        return min(self.duration, self._travel_time)

    @property
    def travels(self) -> bool | None:
        """Whether the duration is long enough for the travel that ends the phase; None: no travel does."""
        return self._travel_time <= self.duration * (1.0 + 1e-9) if self.until and self.until.travel else None

    @property
    def _travel_time(self) -> float:
        """[s]; inf: no travel ends the phase."""
        if self.until is None or self.until.travel is None:
            return math.inf
        return self.until.travel / math.hypot(*(self.moves[self.until.wall or ""].constant_velocity or ()))

    @property
    def condition(self) -> Until | None:
        """Condition that ends the phase at a step known in the run alone."""
        return None if self.until is None or self.until.travel is not None else self.until

    @property
    def condition_from(self) -> float:
        """Time in the phase from which the condition is evaluated [s]."""
        if self.until and self.until.after is not None:
            return self.until.after
        return 0.0 if self.until and self.until.of_bed else 0.1 * self.duration
