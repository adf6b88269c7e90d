# SPDX-License-Identifier: GPL-2.0-or-later
"""Phases of a scene made of parts: how long, which walls move in them and how. SI."""

import math
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from .fields import Frozen, Quantity, Speed, Spin, nothing
from .walls import Direction, PartName, Vector

Time = Annotated[float, Quantity("s", above=0.0)]
Rate = Annotated[float, Quantity("Hz", above=0.0)]
Force = Annotated[float, Quantity("N", above=0.0)]
Speeds = Annotated[list[Annotated[float, Quantity("m/s")]], Field(min_length=3, max_length=3)]

Vector3 = tuple[float, float, float]


def unit(direction: list[float]) -> Vector3:
    """The direction with the length 1."""
    length = math.hypot(*direction)
    x, y, z = (value / length for value in direction)
    return (x, y, z)


class _Move(Frozen):
    wall: PartName


class LinearMove(_Move):
    """A constant velocity."""

    kind: Literal["linear"]
    velocity: Speeds


class RotateMove(_Move):
    """A turn about an axis through `origin`."""

    kind: Literal["rotate"]
    axis: Direction
    origin: Vector = Field(default_factory=nothing)
    rate: Spin

    @model_validator(mode="after")
    def _turns(self) -> Self:
        if not any(self.axis) or not self.rate:
            raise ValueError("axis or rate is zero, so nothing turns; give other values, or remove the motion")
        return self

    @property
    def unit_axis(self) -> Vector3:
        return unit(self.axis)


class VibrateMove(_Move):
    """A harmonic motion that begins in the middle: amplitude times sin(2 pi frequency t)."""

    kind: Literal["vibrate"]
    amplitude: Vector
    frequency: Rate

    @property
    def omega(self) -> float:
        """Angular frequency [rad/s]."""
        return 2 * math.pi * self.frequency


class PressMove(_Move):
    """A motion along `direction` that holds the force of the wall on the spheres at `force`."""

    kind: Literal["press"]
    direction: Direction
    force: Force
    highest_speed: Speed

    @model_validator(mode="after")
    def _direction(self) -> Self:
        if not any(self.direction):
            raise ValueError("direction = [0, 0, 0] has no direction; give another one")
        return self

    @property
    def unit_direction(self) -> Vector3:
        return unit(self.direction)


Move = Annotated[LinearMove | RotateMove | VibrateMove | PressMove, Field(discriminator="kind")]


class Until(Frozen):
    """What ends a phase before its duration, looked at in every row from `after` on (a tenth of the duration).

    kinetic_energy: of a sphere, the mean is below. count: so few spheres are in the room. force: mean force of a row on
    `wall` is reached. travel: way of `wall`, which moves with a constant velocity.
    """

    kinetic_energy: Annotated[float, Quantity("J", above=0.0)] | None = None
    count: Annotated[int, Field(ge=0)] | None = None
    wall: PartName | None = None
    force: Force | None = None
    travel: Annotated[float, Quantity("m", above=0.0)] | None = None
    after: Annotated[float, Quantity("s", ge=0.0)] | None = None

    @model_validator(mode="after")
    def _one(self) -> Self:
        if sum(x is not None for x in (self.kinetic_energy, self.count, self.force, self.travel)) != 1:
            raise ValueError("give one of kinetic_energy, count, force and travel")
        if (self.wall is None) != (self.force is None and self.travel is None):
            raise ValueError("'wall' belongs to force and travel, and only to them")
        return self

    @property
    def limit(self) -> float:
        """The value of the one condition: [J], number of spheres, [N] or [m]."""
        return float(next(x for x in (self.kinetic_energy, self.count, self.force, self.travel) if x is not None))


class Phase(Frozen):
    """A part of the run; with `until` at most for `duration`. time_step: its own. record: whether it has frames."""

    name: PartName
    duration: Time
    until: Until | None = None
    time_step: Time | None = None
    record: bool = True
    move: list[Move] = Field(default_factory=list, max_length=64)

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        walls = [m.wall for m in self.move]
        for wall in walls:
            if walls.count(wall) > 1:
                raise ValueError(f"two motions of wall {wall!r}; give one")
        if self.until and (self.until.after or 0.0) >= self.duration:
            raise ValueError("until.after must be below duration")
        linear = [m.wall for m in self.move if isinstance(m, LinearMove) and any(m.velocity)]
        if self.until and self.until.travel is not None and self.until.wall not in linear:
            raise ValueError(f"until.travel: wall {self.until.wall!r} has no linear motion in this phase")
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
        move = self.moves[self.until.wall or ""]
        assert isinstance(move, LinearMove)
        return self.until.travel / math.hypot(*move.velocity)

    @property
    def condition(self) -> Until | None:
        """What may end the phase at a step that is not known before the run."""
        return None if self.until is None or self.until.travel is not None else self.until

    @property
    def condition_from(self) -> float:
        """Time in the phase from which the condition is looked at [s]."""
        after = None if self.until is None else self.until.after
        return 0.1 * self.duration if after is None else after
