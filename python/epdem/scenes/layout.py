# SPDX-License-Identifier: GPL-2.0-or-later
"""What a scene consists of, neutral of engines: room, walls, fillings, motions, stages. SI."""

import math
from dataclasses import dataclass, field

from ..case.parts import Sphere
from ..case.sizes import Particles
from ..case.walls import Limits
from .meshes import FloatArray

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Plane:
    """A flat wall across an axis (0, 1, 2) at a place [m]; `material`: its own, if walls have several."""

    name: str
    axis: int
    place: float
    material: str = ""


@dataclass(frozen=True)
class Turn:
    """A turn about an axis through `origin` [m] with so many rad/s."""

    origin: Vector
    axis: Vector
    rate: float


@dataclass(frozen=True)
class Linear:
    """A constant velocity [m/s]."""

    velocity: Vector


@dataclass(frozen=True)
class Vibration:
    """The displacement amplitude [m] times sin(omega t) since its begin; omega in rad/s."""

    amplitude: Vector
    omega: float


@dataclass(frozen=True)
class Servo:
    """A motion along a direction, at most so fast [m/s], that holds the wall's force on the spheres [N]."""

    direction: Vector
    force: float
    highest_speed: float


Move = Linear | Turn | Vibration | Servo


@dataclass(frozen=True)
class Until:
    """What ends a stage early, looked at from `after` [s] on: what is measured is below `limit`, or above, of a force.

    quantity: "kinetic_energy" of a sphere [J], "count" of spheres in the room, "force" on `wall` [N].
    """

    quantity: str
    limit: float
    after: float
    wall: str = ""


@dataclass(frozen=True)
class Mesh:
    """A wall of triangles, shape (n, 3 corners, 3 coordinates) [m]; `turn`: of its surface, while they stay.

    stress: whether the frames have the pressure on each; wear: its constant of Finnie's law [m^2/N], 0: none.
    """

    triangles: FloatArray
    material: str = ""
    turn: Turn | None = None
    stress: bool = False
    wear: float = 0.0


@dataclass(frozen=True)
class Block:
    """A room between planes: xlo xhi ylo yhi zlo zhi [m]."""

    limits: Limits

    @property
    def volume(self) -> float:
        """[m^3]."""
        x, y, z = (self.limits[k + 1] - self.limits[k] for k in (0, 2, 4))
        return x * y * z


@dataclass(frozen=True)
class Cylinder:
    """An upright room, about the z axis if its `center` is not elsewhere [m]."""

    radius: float
    low: float
    high: float
    center: tuple[float, float] = (0.0, 0.0)

    @property
    def volume(self) -> float:
        """[m^3]."""
        return math.pi * self.radius**2 * (self.high - self.low)


@dataclass(frozen=True)
class Fill:
    """Spheres put into a region: all at once, or `rate` per second every `every` seconds; they begin with `velocity`.

    `place` is the key of `count` in the case file; `phase` that in which it begins, the first one if empty. exact: so
    many spheres beside those that are in the region before it.
    """

    parts: list[Particles]
    count: int
    region: Block | Cylinder
    place: str = "scene.count"
    rate: float | None = None
    every: float = 0.0
    velocity: Vector = (0.0, 0.0, 0.0)
    phase: str = ""
    exact: bool = False


@dataclass(frozen=True)
class Stage:
    """A part of the scene: which meshes move in it and how, which gates are there, what ends it early, whether it has
    frames."""

    name: str
    seconds: float
    moves: dict[str, Move] = field(default_factory=dict)
    gates: tuple[str, ...] = ()
    until: Until | None = None
    time_step: float | None = None
    record: bool = True


@dataclass(frozen=True)
class Body:
    """A single sphere that comes at the begin of a phase."""

    name: str
    sphere: Sphere
    phase: str


@dataclass(frozen=True)
class Layout:
    """Lengths in m; `box` is xlo xhi ylo yhi zlo zhi of the simulated room.

    periodic: in x and y. count: spheres that the room gets, without a bed. gates: planes that are there in some stages
    only, and in no table of contacts. loses: spheres may leave the room. table: spheres at the start with places of
    their own. loads: walls whose force, and if they are meshes torque, is in the rows with all components.
    """

    box: Limits
    periodic: bool
    planes: tuple[Plane, ...]
    fills: tuple[Fill, ...]
    stages: tuple[Stage, ...]
    count: int
    meshes: dict[str, Mesh] = field(default_factory=dict)
    gates: tuple[Plane, ...] = ()
    loses: bool = False
    table: tuple[Sphere, ...] = ()
    bodies: tuple[Body, ...] = ()
    loads: tuple[str, ...] = ()

    @property
    def duration(self) -> float:
        """[s]."""
        return sum(s.seconds for s in self.stages)
