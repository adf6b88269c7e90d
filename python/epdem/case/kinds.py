# SPDX-License-Identifier: GPL-2.0-or-later
"""The kinds of scenes: keys, and a function for each kind from its keys to room, walls, fills and phases. SI."""

import math
from collections.abc import Callable, Sequence
from typing import Annotated, Any, Literal, Self, get_args

from pydantic import Field, model_validator

from ..errors import CaseError
from .fields import Frozen, Gravity, Length, Name, Quantity, Speed
from .parts import Fill, Measure, Parts
from .sizes import Count, Mixture, Particles, refuse_shares
from .walls import (
    AnyWall,
    CylinderWall,
    LinearMove,
    Phase,
    PlaneWall,
    PlateWall,
    Rate,
    RevolvedWall,
    Room,
    Time,
    Upright,
)


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


class KindFill(Fill):
    """A fill of a kind of scene; `key`: the key of its count in the case."""

    key: str


class Preset(Parts):
    """The parts of a kind of scene; bounds: fall_height [m] and drive [m/s], below the bounds of Parts."""

    bounds: tuple[float, float]

    @property
    def fall_height(self) -> float:
        return self.bounds[0]

    @property
    def drive(self) -> float:
        return self.bounds[1]


def _plane(name: str, axis: str, at: float, material: str, phases: tuple[str, ...] = ()) -> PlaneWall:
    return PlaneWall.model_construct(name=name, kind="plane", axis=axis, at=at, material=material, phases=list(phases))


def _sides(x: float, y: float, material: str) -> list[PlaneWall]:
    """Four upright walls at +-x and +-y."""
    ends = (("left", "x", -x), ("right", "x", x), ("front", "y", -y), ("back", "y", y))
    return [_plane(name, axis, at, material) for name, axis, at in ends]


def _room(*limits: float) -> Room:
    xlo, xhi, ylo, yhi, zlo, zhi = limits
    return Room.model_construct(x=[xlo, xhi], y=[ylo, yhi], z=[zlo, zhi])


def _phase(name: str, duration: float, *moves: LinearMove) -> Phase:
    return Phase.model_construct(name=name, duration=duration, move=list(moves))


def _largest(particles: list[Particles]) -> float:
    return max(p.radii()[1] for p in particles)


def _fill(particles: list[Particles], count: int, region: Room | Upright, **more: Any) -> KindFill:
    values = {"name": "spheres", "key": "scene.count", **more}
    return KindFill.model_construct(particles=particles, count=count, region=region, **values)


def _preset(
    s: Any, room: Room, wall: Sequence[AnyWall], fill: list[KindFill], phase: list[Phase], **more: Any
) -> Preset:
    values = {"kind": "parts", "gravity": s.gravity, "measure": s.measure, **more}
    return Preset.model_construct(room=room, wall=list(wall), fill=fill, phase=phase, **values)


def _settle(s: Settle) -> Preset:
    lx, ly, lz = s.box
    x, y = lx / 2, ly / 2
    if s.rate is None:
        fill = _fill(s.particles, s.count, _room(-x, x, -y, y, 0.0, lz))
    else:
        # a layer at the top; what fell out of the layer makes room for the next spheres
        depth = min(lz / 4, 8 * _largest(s.particles))
        fill = _fill(s.particles, s.count, _room(-x, x, -y, y, lz - depth, lz), rate=s.rate)
        if s.count / s.rate > s.duration:
            raise CaseError(f"scene.duration = {s.duration:g} s ends before all are poured ({s.count / s.rate:g} s)")
    room = _room(-x, x, -y, y, 0.0, 1.5 * lz)  # the walls go on above the box: what bounces high falls back
    walls = [_plane("floor", "z", 0.0, s.walls), *([] if s.periodic else _sides(x, y, s.walls))]
    return _preset(s, room, walls, [fill], [_phase("settle", s.duration)], periodic=s.periodic, bounds=(lz, 0.0))


def _hopper(s: Hopper) -> Preset:
    r, top = s.bin_diameter / 2, s.bin_height
    low = float(f"{-s.cone_depth - s.outlet_height:.10g}")
    outlet = low + s.outlet_height
    a = r + 0.1 * r
    profile = [(s.outlet / 2, outlet), (r, 0.0), (r, top)]
    walls: list[AnyWall] = [
        _plane("floor", "z", low, s.walls),
        *_sides(a, a, s.walls),
        RevolvedWall.model_construct(name="hopper", kind="revolved", material=s.walls, profile=profile),
        _plane("shutter", "z", outlet, s.walls, ("fill",)),
    ]
    bin_ = Upright.model_construct(diameter=2 * (r - _largest(s.particles)), z=[0.0, top])
    return _preset(
        s,
        _room(-a, a, -a, a, low, 1.5 * top),  # what bounces high stays in the room
        walls,
        [_fill(s.particles, s.count, bin_)],
        [_phase("fill", s.fill_time), _phase("discharge", s.duration)],
        bounds=(s.bin_height + s.cone_depth + s.outlet_height, 0.0),
    )


def _drum(s: Drum) -> Preset:
    r, half = s.diameter / 2, s.length / 2
    side, end = r + 0.05 * r, half + 0.05 * r
    a = 0.7 * (r - _largest(s.particles))  # a block inside the circle
    tube = CylinderWall.model_construct(
        name="drum",
        kind="cylinder",
        material=s.walls,
        axis="y",
        start=-s.length * 1.02 / 2,
        to=s.length * 1.02 / 2,
        diameter=s.diameter,
        angular_velocity=s.angular_velocity,
    )
    return _preset(
        s,
        _room(-side, side, -end, end, -side, side),
        [_plane("front", "y", -half, s.walls), _plane("back", "y", half, s.walls), tube],
        [_fill(s.particles, s.count, _room(-a, a, -half, half, -a, a))],
        [_phase("turn", s.duration)],
        bounds=(s.diameter, s.angular_velocity * s.diameter / 2),
    )


def _compaction(s: Compaction) -> Preset:
    lx, ly, lz = s.box
    x, y = lx / 2, ly / 2

    def plate(speed: float) -> LinearMove:
        return LinearMove.model_construct(wall="plate", kind="linear", velocity=[0.0, 0.0, speed])

    phases = [
        *([_phase("fall", s.settle_time)] if s.settle_time else []),
        _phase("load", (lz - s.height) / s.speed, plate(-s.speed)),
        _phase("unload", s.unload_stroke / s.release, plate(s.release)),
    ]
    upper: AnyWall = PlateWall.model_construct(
        name="plate", kind="plate", material=s.walls, axis="z", center=[0.0, 0.0, lz], size=[lx, ly]
    )
    return _preset(
        s,
        _room(-x, x, -y, y, 0.0, 1.05 * lz),
        [_plane("floor", "z", 0.0, s.walls), upper],
        [_fill(s.particles, s.count, _room(-x, x, -y, y, 0.0, lz))],
        phases,
        periodic=True,
        bounds=(lz, 2.0 * s.speed),
    )


def _peening(s: Peening) -> Preset:
    """The stream is a column of shot above the target: a sphere that hits at time t starts speed * t above it.

    All places are therefore known at the start, and a continued run has the same ones.
    """
    gap = 4 * _largest(s.particles)
    base = s.width if s.bed else 0.0
    foot, a = base + gap, s.width / 2
    top = foot + s.speed * s.count / s.rate
    stream = _room(-a, a, -a, a, foot, top)
    fills = [_fill(s.particles, s.count, stream, velocity=[0.0, 0.0, -s.speed], phase="peen")]
    phases = [_phase("peen", s.duration)]
    if s.bed_settle_time is not None:
        bed = _room(-a, a, -a, a, 0.0, base)
        fills.insert(0, _fill(s.bed, s.bed_count, bed, name="bed", key="scene.bed_count"))
        phases.insert(0, _phase("fill", s.bed_settle_time))
    return _preset(
        s,
        _room(-a, a, -a, a, 0.0, float(f"{top + gap:.10g}")),
        [_plane("floor", "z", 0.0, s.walls)],
        fills,
        phases,
        periodic=True,
        open_boundary=True,
        bounds=(0.0, math.hypot(s.speed, math.sqrt(2.0 * s.gravity * top))),  # the last shot falls from the top
    )


_PRESETS: dict[type[Kinds], Callable[..., Preset]] = {
    Settle: _settle,
    Hopper: _hopper,
    Drum: _drum,
    Compaction: _compaction,
    Peening: _peening,
}


def parts(scene: Kinds) -> Parts:
    """The scene as a scene of parts. Raises CaseError for lengths that do not fit together."""
    return scene if isinstance(scene, Parts) else _PRESETS[type(scene)](scene)
