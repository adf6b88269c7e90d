# SPDX-License-Identifier: GPL-2.0-or-later
"""Motions of walls: where their points are and how fast they are. SI. Each host has a table of its words for them."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Annotated, Literal, Self

import numpy as np
import numpy.typing as npt
from pydantic import Field, PrivateAttr, model_validator

from .fields import Frozen, Quantity, Speed, Spin, zero_vector
from .places import Direction, PartName, Vector

Rate = Annotated[float, Quantity("Hz", above=0.0)]
Force = Annotated[float, Quantity("N", above=0.0)]
Speeds = Annotated[list[Annotated[float, Quantity("m/s")]], Field(min_length=3, max_length=3)]
FloatArray = npt.NDArray[np.float64]
SAMPLES = 129  # of a period: the extreme places within 3e-4 of the radius of a turn


class Motion(Frozen, ABC):
    """A motion of `wall`, which begins at the time 0."""

    wall: PartName

    @property
    def along(self) -> Sequence[float]:
        """A vector of any length along which the wall moves; zero of a wall that turns."""
        return zero_vector()

    @property
    def constant_velocity(self) -> Sequence[float] | None:
        """Velocity [m/s] of a wall with a constant one."""
        return None

    @property
    def rotation(self) -> "RotateMove | None":
        return None

    @property
    def press(self) -> "PressMove | None":
        """The motion of a wall that a force drives, so that its way is known in the run alone."""
        return None

    @property
    def period(self) -> float:
        """Time [s] after which the motion repeats; inf: it does not."""
        return math.inf

    @abstractmethod
    def top_speed(self, reach: float) -> float:
        """Highest speed [m/s] of a wall; reach: largest distance [m] from an axis."""

    @abstractmethod
    def point_at(self, t: npt.ArrayLike, x: FloatArray) -> FloatArray:
        """Places [m] at times t [s], shape () or (k, 1, 1), of points that begin at x, shape (n, 3); NaN: unknown."""

    def extent(self, seconds: float, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest coordinates [m] that points at x, shape (n, 3), reach in a time, each of shape (3,)."""
        times = np.append(np.linspace(0.0, min(seconds, self.period), SAMPLES), seconds)
        way = self.point_at(times[:, None, None], x)
        return way.min(axis=(0, 1)), way.max(axis=(0, 1))


class LinearMove(Motion):
    """A constant velocity."""

    kind: Literal["linear"]
    velocity: Speeds

    @property
    def along(self) -> Sequence[float]:
        return self.velocity

    @property
    def constant_velocity(self) -> Sequence[float]:
        return self.velocity

    def top_speed(self, reach: float) -> float:
        return math.hypot(*self.velocity)

    def point_at(self, t: npt.ArrayLike, x: FloatArray) -> FloatArray:
        return np.asarray(x + np.asarray(t) * np.array(self.velocity))


class RotateMove(Motion):
    """A turn about an axis through `origin`."""

    kind: Literal["rotate"]
    axis: Direction
    origin: Vector = Field(default_factory=zero_vector)
    rate: Spin

    @model_validator(mode="after")
    def _turns(self) -> Self:
        if not self.rate:
            raise ValueError("rate is zero, so nothing turns; give another one, or remove the motion")
        return self

    @property
    def rotation(self) -> "RotateMove":
        return self

    @property
    def period(self) -> float:
        return 2 * math.pi / abs(self.rate)

    def top_speed(self, reach: float) -> float:
        return abs(self.rate) * reach

    def point_at(self, t: npt.ArrayLike, x: FloatArray) -> FloatArray:
        angle, axis, arm = self.rate * np.asarray(t), np.array(self.axis), x - np.array(self.origin)
        across = arm - (arm @ axis)[:, None] * axis
        return np.asarray(x - across + across * np.cos(angle) + np.cross(axis, arm) * np.sin(angle))


class VibrateMove(Motion):
    """A harmonic motion that begins in the middle: amplitude times sin(2 pi frequency t)."""

    kind: Literal["vibrate"]
    amplitude: Vector
    frequency: Rate

    @property
    def omega(self) -> float:
        """Angular frequency [rad/s]."""
        return 2 * math.pi * self.frequency

    @property
    def along(self) -> Sequence[float]:
        return self.amplitude

    @property
    def period(self) -> float:
        return 2 * math.pi / self.omega

    def top_speed(self, reach: float) -> float:
        return self.omega * math.hypot(*self.amplitude)

    def point_at(self, t: npt.ArrayLike, x: FloatArray) -> FloatArray:
        return np.asarray(x + np.sin(self.omega * np.asarray(t)) * np.array(self.amplitude))


class PressMove(Motion):
    """A motion along `direction` that holds the force of the wall on the spheres at `force`."""

    kind: Literal["press"]
    direction: Direction
    force: Force
    highest_speed: Speed
    _stable: float = PrivateAttr(math.inf)

    @property
    def along(self) -> Sequence[float]:
        return self.direction

    @property
    def press(self) -> "PressMove":
        return self

    def top_speed(self, reach: float) -> float:
        return self.highest_speed

    def point_at(self, t: npt.ArrayLike, x: FloatArray) -> FloatArray:
        return np.full(np.broadcast(np.asarray(t), x).shape, math.nan)

    @property
    def speed_in_contact(self) -> float:
        """Highest speed [m/s] while spheres touch the wall: up to which dashpots leave the motion stable."""
        return min(self.highest_speed, self._stable)

    def limited(self, stable: float) -> Self:
        """The same motion with a stable speed [m/s]."""
        found = self.model_copy()
        found._stable = stable
        return found


Move = Annotated[LinearMove | RotateMove | VibrateMove | PressMove, Field(discriminator="kind")]
