# SPDX-License-Identifier: GPL-2.0-or-later
"""The kinds of scenes and their keys. SI."""

import math
from typing import Annotated, Literal, Self, get_args

from pydantic import Field, model_validator

from .fields import Frozen, Gravity, Length, Name, Quantity, Speed
from .measures import Measure
from .motions import Rate, Time
from .parts import Parts
from .sizes import Count, Mixture, Particles, refuse_shares


class Common(Frozen):
    """The keys of every kind of scene."""

    particles: Mixture
    count: Count
    walls: Name  # material of the walls
    gravity: Gravity = 9.81
    measure: list[Measure] = Field(default_factory=list, max_length=64)

    @model_validator(mode="after")
    def _shares(self) -> Self:
        refuse_shares(self.particles)
        return self

    @property
    def named_materials(self) -> list[tuple[str, str]]:
        """(place, material) of every name of a material."""
        return [("scene.walls", self.walls), *(("scene.particles.material", p.material) for p in self.particles)]


class Settle(Common):
    """Spheres poured into a box (x, y, z inside) with its floor at z = 0."""

    kind: Literal["settle"]
    duration: Time
    box: Annotated[list[Length], Field(min_length=3, max_length=3)]
    periodic: bool = False  # in x and y, instead of side walls
    rate: Rate | None = None  # spheres per second; none: all at once


class Hopper(Common):
    """Discharge of a round bin with a conical hopper of triangles; `fill_time` is the time before the outlet opens."""

    kind: Literal["hopper"]
    duration: Time
    bin_diameter: Length
    bin_height: Length
    outlet: Length
    half_angle: Annotated[float, Quantity("rad", above=0.0, le=1.5707963267948966)]
    outlet_height: Length  # from the outlet to the floor
    fill_time: Time

    @property
    def cone_depth(self) -> float:
        """Height of the cone [m]."""
        return (self.bin_diameter - self.outlet) / 2 / math.tan(self.half_angle)

    @model_validator(mode="after")
    def _narrows(self) -> Self:
        if not self.outlet < self.bin_diameter:
            raise ValueError(f"outlet ({self.outlet:g} m) must be below bin_diameter ({self.bin_diameter:g} m)")
        return self


class Drum(Common):
    """A drum of triangles turning about y, with flat ends.

    It is round, so its surface moves and its triangles stay: the same to a sphere, without rebuilding lists, and a
    continued run meets the wall's velocity at its first step, which LIGGGHTS's move/mesh has only a step later.
    """

    kind: Literal["drum"]
    duration: Time
    diameter: Length
    length: Length
    angular_velocity: Annotated[float, Quantity("rad/s", above=0.0)]  # "20 rpm"


class Compaction(Common):
    """Uniaxial loading and unloading between plates; sides periodic. No `duration`: strokes and speed give it."""

    kind: Literal["compaction"]
    gravity: Gravity = 0.0
    duration: Time | None = None
    box: Annotated[list[Length], Field(min_length=3, max_length=3)]
    height: Length  # of the gap between the plates at the end of loading
    unload_stroke: Length  # stroke of unloading
    settle_time: Time | None = None  # before loading: the spheres fall on the lower plate
    speed: Speed  # of the upper plate, loading
    unload_speed: Speed | None = None  # unloading; default: a tenth, because it ends within a short stroke

    @property
    def release(self) -> float:
        """Speed of the upper plate while unloading [m/s]."""
        return self.unload_speed or 0.1 * self.speed

    @model_validator(mode="after")
    def _order(self) -> Self:
        if not self.height < self.box[2]:
            raise ValueError(f"height ({self.height:g} m) must be below the box's height ({self.box[2]:g} m)")
        if self.settle_time is not None and not self.gravity:
            raise ValueError("spheres fall under gravity; give gravity, or remove settle_time")
        if self.duration is not None:
            raise ValueError("duration: loading and unloading follow from height, unload_stroke and speed; remove it")
        return self


class Peening(Common):
    """A stream of shot along -z on a plate of the walls' material, or on a bed of spheres that lies on it."""

    kind: Literal["peening"]
    duration: Time
    gravity: Gravity = 0.0
    width: Length  # of the square that the stream hits
    speed: Speed
    rate: Rate  # spheres per second
    bed: list[Particles] = Field(default_factory=list)
    bed_count: Annotated[int, Field(ge=0, le=10_000_000)] = 0
    bed_settle_time: Time | None = None

    @property
    def named_materials(self) -> list[tuple[str, str]]:
        return [*super().named_materials, *(("scene.bed.material", p.material) for p in self.bed)]

    @model_validator(mode="after")
    def _bed(self) -> Self:
        if bool(self.bed) != bool(self.bed_count) or bool(self.bed) != (self.bed_settle_time is not None):
            raise ValueError("a bed needs 'bed', 'bed_count' and 'bed_settle_time'; give all three or none")
        if self.bed and not self.gravity:
            raise ValueError("a bed settles under gravity; give gravity")
        return self


Kinds = Settle | Hopper | Drum | Compaction | Peening | Parts
KINDS: tuple[str, ...] = tuple(get_args(kind.model_fields["kind"].annotation)[0] for kind in get_args(Kinds))
