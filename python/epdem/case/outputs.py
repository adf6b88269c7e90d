# SPDX-License-Identifier: GPL-2.0-or-later
"""Columns of the rows, checks and the key figure that a scene of parts names, beside those that every scene has. SI."""

import math
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from .fields import Frozen, Length, Line, Name, Pressure, Quantity, Speed
from .places import Axis, PartName, Place, Side

UNITS = {"force": "N", "torque": "N m", "position": "m", "heat_flow": "W"}


class Row(Frozen):
    """A column of the rows: a component of the force or torque of the spheres on a wall, mean over a row, the place
    of a wall with constant velocities in the middle of the row, or the heat flow into a wall with a temperature, mean
    over a row. area: the force is divided by it.
    """

    name: PartName
    wall: PartName
    force: Side | None = None
    torque: Side | None = None
    position: Axis | None = None
    heat_flow: Literal[True] | None = None
    area: Annotated[float, Quantity("m^2", above=0.0)] | None = None
    title: Line

    @model_validator(mode="after")
    def _one(self) -> Self:
        if sum(x is not None for x in (self.force, self.torque, self.position, self.heat_flow)) != 1:
            raise ValueError("give one of force, torque, position and heat_flow")
        if self.area is not None and self.force is None:
            raise ValueError("'area' belongs to force, and only to it")
        return self

    @property
    def quantity(self) -> str:
        return next(name for name in UNITS if getattr(self, name))

    @property
    def unit(self) -> str:
        return "Pa" if self.area else UNITS[self.quantity]

    @property
    def sign(self) -> float:
        return -1.0 if "-" in (self.force or self.torque or "") else 1.0

    @property
    def axis(self) -> int:
        return "xyz".index((self.force or self.torque or self.position or "")[-1])


class FloorLoad(Frozen):
    """The column `row` is the weight of the spheres at the end."""

    kind: Literal["floor_load"]
    row: PartName


class BedRebound(Frozen):
    """A bed rises by at most e_n^2 times its fall."""

    kind: Literal["rebound_of_the_bed"]


class AtRest(Frozen):
    """The spheres rest at the end of `phase`, in which they fall; a warning says if they move."""

    kind: Literal["at_rest"]
    phase: PartName


class MassFlow(Frozen):
    """The mass flow through a round outlet at the height `at` of a round bin agrees with Beverloo's formula.

    cone: height at which a cone that begins at the outlet reaches the bin; without it the bin begins at the outlet.
    """

    kind: Literal["mass_flow"]
    outlet: Length
    bin: Length
    at: Place
    cone: Place | None = None

    @property
    def steepness(self) -> float:
        """Factor of a cone steeper than the stagnant zone (45 degrees) on Beverloo's rate: tan(half angle)^-0.35.

        Rose and Tanaka 1959, The Engineer 208, 465.
        """
        tangent = (self.bin - self.outlet) / 2 / (self.cone - self.at) if self.cone is not None else 1.0
        return float(min(tangent, 1.0) ** -0.35)

    def volume(self, height: float) -> float:
        """Volume [m^3] of the vessel from the outlet up to a height [m]."""
        above = max(height - self.at, 0.0)
        cone = 0.0 if self.cone is None else self.cone - self.at
        r, R, part = self.outlet / 2, self.bin / 2, min(above, cone)
        end = r + (R - r) * part / cone if cone else r
        return math.pi * (part / 3 * (r * r + r * end + end * end) + R * R * (above - part))


class ReboundSpeed(Frozen):
    """Spheres of `fill` with this speed that meet a flat target alone leave it with e_n v."""

    kind: Literal["rebound_speed"]
    fill: PartName
    target: Name
    speed: Speed


class Unloading(Frozen):
    """Loading is at most as stiff as unloading, and returns no more work: of the rows `force` and `position`."""

    kind: Literal["unloading"]
    force: PartName
    position: PartName


class TorqueOfBed(Frozen):
    """The torque `row` on a drum that is all the walls of its bed, about the y axis, is that of the bed's weight."""

    kind: Literal["torque_of_the_bed"]
    row: PartName


class Stages(Frozen):
    """The table of a press has the end of each phase from the first in which `wall` moves towards `against`, a plane or
    a plate.

    area: of the bed across. pressure, opposite: rows of the pressure on both. sides: walls around the bed, whose length
    around is `perimeter`.
    """

    wall: PartName
    against: PartName
    area: Annotated[float, Quantity("m^2", above=0.0)]
    pressure: PartName
    opposite: PartName
    sides: list[PartName] = Field(default_factory=list, max_length=8)
    perimeter: Length | None = None


class MeasuredDensities(Frozen):
    """Measured relative densities of a powder under pressure, in figure and page beside the computed; no check uses
    them."""

    source: Line
    pressures: Annotated[list[Pressure], Field(min_length=1, max_length=1000)]
    relative_densities: list[Annotated[float, Quantity("1", above=0.0, le=1.0, hint="percent?")]]

    @model_validator(mode="after")
    def _pairs(self) -> Self:
        n, m = len(self.pressures), len(self.relative_densities)
        if n != m:
            raise ValueError(f"pressures: {n}, relative_densities: {m}; give one density for each pressure")
        return self


Check = Annotated[
    FloorLoad | BedRebound | AtRest | MassFlow | ReboundSpeed | Unloading | TorqueOfBed, Field(discriminator="kind")
]
