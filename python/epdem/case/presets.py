# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of each kind as a scene of parts: one function for each kind, from its keys to room, walls, fills, phases."""

import math
from collections.abc import Callable, Sequence
from typing import Any

from ..errors import CaseError
from .kinds import Compaction, Drum, Hopper, Kinds, Peening, Settle
from .motions import LinearMove, Phase
from .parts import Fill, Parts
from .sizes import Particles
from .walls import AnyWall, CylinderWall, PlaneWall, PlateWall, RevolvedWall, Room, Upright


class DrawnFill(Fill):
    """A fill whose spheres are drawn at random from all sizes at once; `key`: the key of its count in the case."""

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


def _fill(particles: list[Particles], count: int, region: Room | Upright, **more: Any) -> DrawnFill:
    values = {"name": "spheres", "key": "scene.count", **more}
    return DrawnFill.model_construct(particles=particles, count=count, region=region, **values)


def _preset(
    s: Any, room: Room, wall: Sequence[AnyWall], fill: list[DrawnFill], phase: list[Phase], **more: Any
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
