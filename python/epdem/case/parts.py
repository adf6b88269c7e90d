# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene made of parts: walls, fills, single bodies, phases; named numbers and curves of its results. SI."""

import math
from collections import Counter
from collections.abc import Iterator
from functools import cached_property
from typing import Annotated, Literal, NamedTuple, Self

from pydantic import Field, Tag, model_validator

from ..base.tables import Column
from .fields import Frozen, Gravity, Length, Name, Quantity, Spin, Temperature, by_key, zero_vector
from .motions import Rate, Speeds
from .outputs import Check, Row, Stages
from .places import Axis, Pair, PartName, Place, Side, Vector
from .sizes import Count, FileName, Mixture, Particles, Share, csv_table, number_in, refuse_shares
from .walls import CasePhase, ConeWall, CylinderWall, MeshWall, PlaneWall, Room, Upright, Wall

Region = Annotated[
    Annotated[Upright, Tag("upright")] | Annotated[Room, Tag("room")], by_key("room", diameter="upright")
]
Bins = Annotated[int, Field(ge=2, le=1000)]


class _Measure(Frozen):
    name: PartName


class _OfSpheres(_Measure):
    """A measure of the spheres whose centres are in a region (everywhere), of one material (of all)."""

    region: Region | None = None
    material: Name | None = None


class Amount(_OfSpheres):
    """Number or mass [kg] of spheres."""

    kind: Literal["count", "mass"]


class Flow(_Measure):
    """Mass per time [kg/s] through a plane in a direction, between frames.

    A sphere that leaves the room passes the plane if its last place and velocity carry it through.
    """

    kind: Literal["flow"]
    direction: Side = "-z"
    at: Place
    material: Name | None = None


class Height(_OfSpheres):
    """Height [m] below which `share` of the mass has its centres."""

    kind: Literal["height"]
    share: Share = 0.95


class Repose(_OfSpheres):
    """Angle [rad] of the surface of a bed: its slope over the distance from an upright axis, or over x or y."""

    kind: Literal["repose"]
    over: Literal["distance", "x", "y"] = "distance"
    center: Pair = Field(default_factory=lambda: [0.0, 0.0])


class CenterOfMass(_OfSpheres):
    """A coordinate of the centre of mass [m]."""

    kind: Literal["center_of_mass"]
    axis: Axis = "z"


class Load(_Measure):
    """A component of the mean force [N], or of the torque [N m], on a wall in a row, or its magnitude."""

    kind: Literal["force", "torque"]
    wall: PartName
    component: Literal["x", "y", "z", "magnitude"] = "magnitude"


class Porosity(_Measure):
    """Share of a region's volume that no sphere takes."""

    kind: Literal["porosity"]
    region: Region


class Histogram(_Measure):
    """Distribution at the end: of the plastic work of each sphere [J], or of the impact speed [m/s] of each contact.

    The impact speed belongs to the head-on impact that gives the largest overlap of the contact.
    """

    kind: Literal["plastic_work", "impact_speed"]
    bins: Bins = 30


Measure = Annotated[
    Amount | Flow | Height | Repose | CenterOfMass | Load | Porosity | Histogram, Field(discriminator="kind")
]

MEASURES = {
    "count": Column("", "number of spheres"),
    "mass": Column("kg", "mass of the spheres"),
    "flow": Column("kg/s", "mass per time through a plane"),
    "height": Column("m", "height below which a share of the mass lies"),
    "repose": Column("rad", "angle of the surface of the bed"),
    "center_of_mass": Column("m", "coordinate of the centre of mass"),
    "force": Column("N", "force on a wall, mean over a row"),
    "torque": Column("N m", "torque on a wall, mean over a row"),
    "porosity": Column("", "void share of a region"),
    "plastic_work": Column("J", "plastic work of each sphere"),
    "impact_speed": Column("m/s", "speed of the head-on impact with the largest overlap of a contact"),
}


class Sphere(NamedTuple):
    """One sphere of a table: place [m], radius [m], material, velocity [m/s], spin [rad/s]."""

    place: tuple[float, float, float]
    radius: float
    material: str
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    spin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    frozen: bool = False
    temperature: float | None = None  # [K]


class Fill(Frozen):
    """Spheres put at random places of a region without overlap, by one of count, mass [kg] and volume share.

    rate: spheres per second, poured into the region; else all at the begin of `phase` (the first one).
    """

    name: PartName
    region: Region
    particles: Mixture
    count: Count | None = None
    mass: Annotated[float, Quantity("kg", above=0.0)] | None = None
    fraction: Share | None = None
    rate: Rate | None = None
    velocity: Speeds = Field(default_factory=zero_vector)
    phase: PartName | None = None
    temperature: Temperature | None = None
    exact: bool = True  # false: spheres that are in the region before count, too

    @model_validator(mode="after")
    def _amount(self) -> Self:
        if sum(x is not None for x in (self.count, self.mass, self.fraction)) != 1:
            raise ValueError("give one of count, mass and fraction")
        refuse_shares(self.particles)
        return self


class FileFill(Frozen):
    """Spheres of a CSV file at the start: x, y, z, radius [m]; optional material, vx, vy, vz [m/s]."""

    name: PartName
    file: FileName
    material: Name | None = None
    temperature: Temperature | None = None

    @cached_property
    def spheres(self) -> list[Sphere]:
        """Every sphere of the file. Raises ValueError that names the line."""
        units, rows = csv_table(self.file)
        known = ["x", "y", "z", "radius", "material", "vx", "vy", "vz"]
        for head, unit in units.items():
            if head not in known:
                raise ValueError(f"{self.file}: unknown column {head[:40]!r}; there are {', '.join(known)}")
            if unit:
                raise ValueError(
                    f"{self.file}: column '{head} [{unit[:20]}]': heads have no units; write {head!r} and SI numbers"
                )
        for head in known[:4]:
            if head not in units:
                raise ValueError(f"{self.file}: column {head!r} is missing")
        if ("material" in units) == (self.material is not None):
            raise ValueError(f"{self.file}: give the material in the file or in the case, in one of them")
        return [self._sphere(place, cells) for place, cells in rows]

    def _sphere(self, place: str, cells: dict[str, str]) -> Sphere:
        x, y, z, radius = (number_in(place, key, cells[key]) for key in ("x", "y", "z", "radius"))
        if not 1e-12 < radius < 1e6:
            raise ValueError(f"{place}: radius = {radius:g} m, must be above 0")
        vx, vy, vz = (number_in(place, key, cells.get(key, "0")) for key in ("vx", "vy", "vz"))
        material = cells.get("material", self.material or "")
        return Sphere((x, y, z), radius, material, (vx, vy, vz), temperature=self.temperature)

    @model_validator(mode="after")
    def _readable(self) -> Self:
        assert self.spheres
        return self


AnyFill = Annotated[Annotated[FileFill, Tag("file")] | Annotated[Fill, Tag("fill")], by_key("fill", file="file")]


class SingleSphere(Frozen):
    """A single sphere, which comes at the begin of `phase` (the first one); frozen: at rest, without motion."""

    name: PartName
    material: Name
    radius: Length
    position: Vector
    velocity: Speeds = Field(default_factory=zero_vector)
    spin: Annotated[list[Spin], Field(min_length=3, max_length=3)] = Field(default_factory=zero_vector)
    frozen: bool = False
    phase: PartName | None = None
    temperature: Temperature | None = None

    @model_validator(mode="after")
    def _at_rest(self) -> Self:
        if self.frozen and (any(self.velocity) or any(self.spin) or self.phase):
            raise ValueError(
                "a frozen body is there from the start and at rest; remove velocity, spin, phase or frozen"
            )
        return self

    @property
    def sphere(self) -> Sphere:
        (x, y, z), (vx, vy, vz), (wx, wy, wz) = self.position, self.velocity, self.spin
        return Sphere((x, y, z), self.radius, self.material, (vx, vy, vz), (wx, wy, wz), self.frozen, self.temperature)


class Parts(Frozen):
    """A scene of any parts, in a room beyond whose limits spheres are lost.

    periodic: in x and y, or in one of them. open_boundary: spheres may leave the room. Gravity acts along -z.
    highest_fall, highest_drive: of a kind, in place of those that follow from the parts. places: keys of a kind by the
    places of the parts that follow from them, for messages.
    """

    kind: Literal["parts"]
    room: Room
    periodic: bool | Literal["x", "y"] = False
    open_boundary: bool = False
    gravity: Gravity = 9.81
    wall: list[Wall] = Field(default_factory=list, max_length=64)
    fill: list[AnyFill] = Field(default_factory=list, max_length=64)
    body: list[SingleSphere] = Field(default_factory=list, max_length=1000)
    phase: Annotated[list[CasePhase], Field(min_length=1, max_length=64)]
    measure: list[Measure] = Field(default_factory=list, max_length=64)
    row: list[Row] = Field(default_factory=list, max_length=64)
    check: list[Check] = Field(default_factory=list, max_length=64)
    stages: Stages | None = None
    key_figure: list[Name] = Field(default_factory=list, max_length=8)
    highest_fall: Annotated[float, Quantity("m", ge=0.0)] | None = None
    highest_drive: Annotated[float, Quantity("m/s", ge=0.0)] | None = None
    places: dict[str, str] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _parts(self) -> Self:
        if not self.fill and not self.body:
            raise ValueError("no spheres; add [[scene.fill]] or [[scene.body]]")
        for kind in ("wall", "fill", "body", "phase"):
            for name, parts in Counter(part.name for part in getattr(self, kind)).items():
                if parts > 1:
                    raise ValueError(f"{kind}.{name}: two parts of {kind} have the name {name!r}; give each its own")
        if not self.phase[-1].record:
            raise ValueError(
                f"phase.{self.phase[-1].name}.record = false: the last phase is recorded, for its end is the result"
            )
        for place, name, what, known in self._references():
            if name not in known:
                raise ValueError(f"{place} = {name!r} is no {what}; there are {', '.join(known) or 'none'}")
        phases = [p.name for p in self.phase]
        for w in self.gates:
            places = sorted(phases.index(name) for name in w.phases)
            if places != list(range(places[0], places[-1] + 1)):
                raise ValueError(f"wall.{w.name}.phases: a wall that went does not come back; name phases in a row")
        return self

    def _references(self) -> Iterator[tuple[str, str, str, list[str]]]:
        """(place, name, what it must be, the names of all such parts) of each name of another part."""
        phases, walls, moving = [p.name for p in self.phase], [w.name for w in self.wall], [*self.meshes]
        yield from ((f"fill.{f.name}.phase", f.phase, "phase", phases) for f in self.random_fills if f.phase)
        yield from ((f"body.{b.name}.phase", b.phase, "phase", phases) for b in self.body if b.phase)
        yield from ((f"wall.{w.name}.phases", name, "phase", phases) for w in self.gates for name in w.phases)
        for p in self.phase:
            yield from ((f"phase.{p.name}.move", m.wall, "wall of triangles, which can move", moving) for m in p.move)
            if p.until and p.until.wall:
                yield f"phase.{p.name}.until.wall", p.until.wall, "wall", walls
        rows, fills = [r.name for r in self.row], [f.name for f in self.random_fills]
        materials = list(dict.fromkeys(material for _, material in self.named_materials))
        for check in self.check:
            for key, what, known in (
                *((key, "row", rows) for key in ("row", "force", "position")),
                ("fill", "fill at random places", fills),
                ("phase", "phase", phases),
                ("target", "material", materials),
            ):
                if name := getattr(check, key, None):
                    yield f"check.{check.kind}.{key}", name, what, known
        if s := self.stages:
            yield from ((f"stages.{key}", getattr(s, key), "row", rows) for key in ("pressure", "opposite"))
            yield from (("stages.sides", name, "wall", walls) for name in s.sides)
            yield "stages.wall", s.wall, "wall of triangles, which can move", moving
            yield "stages.against", s.against, "wall", walls
        for row in self.row:
            has_it = moving if row.position or row.torque else walls
            yield f"row.{row.name}.wall", row.wall, f"wall that has a {row.quantity}", has_it

    def place(self, name: str) -> str:
        """The place of a part in the case: for a part of a kind its key."""
        return self.places.get(name, name)

    @cached_property
    def table(self) -> list[Sphere]:
        """The spheres with given places that are there from the start: spheres of files, then single spheres."""
        first = self.phase[0].name
        of_files = [s for f in self.fill if isinstance(f, FileFill) for s in f.spheres]
        return [*of_files, *(b.sphere for b in self.body if b.phase in (None, first))]

    @property
    def periods(self) -> tuple[float, float, float]:
        """Lengths after which the room repeats along x, y and z [m]; 0: it does not."""
        sides = {"x": self.room.x, "y": self.room.y}
        x, y = (high - low if self.periodic in (True, axis) else 0.0 for axis, (low, high) in sides.items())
        return x, y, 0.0

    @property
    def images(self) -> list[tuple[float, float, float]]:
        """Shifts [m] from a sphere to itself and, in a periodic room, to its nearest images."""
        along_x, along_y = ((-period, 0.0, period) if period else (0.0,) for period in self.periods[:2])
        return [(x, y, 0.0) for x in along_x for y in along_y]

    @property
    def planes(self) -> list[PlaneWall]:
        """The planes of every phase."""
        return [w for w in self.wall if isinstance(w, PlaneWall) and not w.phases]

    @property
    def gates(self) -> list[PlaneWall]:
        """The planes of some phases only."""
        return [w for w in self.wall if isinstance(w, PlaneWall) and w.phases]

    @property
    def meshes(self) -> dict[str, MeshWall]:
        return {w.name: w for w in self.wall if isinstance(w, MeshWall)}

    @property
    def later(self) -> list[SingleSphere]:
        """The single spheres that come at the begin of another phase than the first."""
        return [b for b in self.body if b.phase not in (None, self.phase[0].name)]

    @property
    def random_fills(self) -> list[Fill]:
        return [f for f in self.fill if isinstance(f, Fill)]

    @cached_property
    def filled(self) -> list[Particles]:
        """Everything that is filled in, in the order in which it comes; of a table the smallest and largest spheres."""
        order = {p.name: n for n, p in enumerate(self.phase)}
        fills = sorted(self.random_fills, key=lambda f: order[f.phase] if f.phase else 0)
        alone: dict[str, list[float]] = {}
        for sphere in [*self.table, *(b.sphere for b in self.later)]:
            alone.setdefault(sphere.material, []).append(sphere.radius)
        known = [*(p for f in fills if not f.phase or order[f.phase] == 0 for p in f.particles)]
        known += [Particles.of(m, r) for m, radii in alone.items() for r in sorted({min(radii), max(radii)})]
        return [*known, *(p for f in fills if f.phase and order[f.phase] > 0 for p in f.particles)]

    @property
    def leading(self) -> Particles:
        return self.filled[0]

    @property
    def fall_height(self) -> float:
        """The height of the highest free fall [m]."""
        return self.room.z[1] - self.room.z[0] if self.highest_fall is None else self.highest_fall

    @property
    def drive(self) -> float:
        """The highest imposed speed [m/s]: of spheres that come, and of walls."""
        if self.highest_drive is not None:
            return self.highest_drive
        velocities = [*(s.velocity for s in self.table), *(b.velocity for b in self.body)]
        speeds = [math.hypot(*v) for v in (*velocities, *(f.velocity for f in self.random_fills))]
        turns = (w for w in self.wall if isinstance(w, CylinderWall | ConeWall))
        speeds += [abs(w.angular_velocity) * max(w.diameters_of_ends()) / 2 for w in turns]
        limits = self.room.limits
        across = math.dist(limits[0::2], limits[1::2])
        speeds += [move.top_speed(across) for p in self.phase for move in p.move]
        return max([*speeds, 0.0])

    @property
    def wall_materials(self) -> list[str]:
        return list(dict.fromkeys(w.material for w in self.wall))

    @property
    def named_materials(self) -> list[tuple[str, str]]:
        found = [(f"scene.wall.{w.name}.material", w.material) for w in self.wall]
        found += [(f"scene.fill.{f.name}", p.material) for f in self.random_fills for p in f.particles]
        files = (f for f in self.fill if isinstance(f, FileFill))
        found += [(f"scene.fill.{f.name}", m) for f in files for m in dict.fromkeys(s.material for s in f.spheres)]
        return [*found, *((f"scene.body.{b.name}.material", b.material) for b in self.body)]
