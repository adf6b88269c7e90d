# SPDX-License-Identifier: GPL-2.0-or-later
"""The parts of each kind of scene: box, walls, meshes, fillings, phases."""

import math
from collections.abc import Callable

from ..case.kinds import Compaction, Drum, Hopper, Kinds, Peening, Settle
from ..case.parts import Parts
from ..case.scene import SceneCase
from ..case.sizes import Particles
from ..errors import CaseError
from . import meshes
from .from_parts import from_parts
from .layout import Block, Cylinder, Fill, Layout, Linear, Mesh, Plane, Stage, Turn


def _largest(parts: list[Particles]) -> float:
    return max(p.radii()[1] for p in parts)


def _floor(z: float = 0.0) -> Plane:
    return Plane("floor", 2, z)


def _sides(lx: float, ly: float) -> tuple[Plane, ...]:
    return (
        Plane("left", 0, -lx / 2),
        Plane("right", 0, lx / 2),
        Plane("front", 1, -ly / 2),
        Plane("back", 1, ly / 2),
    )


def _settle(s: Settle) -> Layout:
    lx, ly, lz = s.box
    x, y = lx / 2, ly / 2
    if s.rate is None:
        fill = Fill(s.particles, s.count, Block((-x, x, -y, y, 0.0, lz)))
    else:
        # a layer at the top; what fell out of it makes room for the next lot
        depth = min(lz / 4, 8 * _largest(s.particles))
        layer = Block((-x, x, -y, y, lz - depth, lz))
        pause = math.sqrt(2 * depth / s.gravity) if s.gravity else s.duration
        fill = Fill(s.particles, s.count, layer, rate=s.rate, every=pause)
        if s.count / s.rate > s.duration:
            raise CaseError(f"scene.duration = {s.duration:g} s ends before all are poured ({s.count / s.rate:g} s)")
    room = (-x, x, -y, y, 0.0, 1.5 * lz)  # the walls go on above the box: what bounces high falls back
    planes = (_floor(), *(() if s.periodic else _sides(lx, ly)))
    return Layout(room, s.periodic, planes, (fill,), (Stage("settle", s.duration),), s.count)


def _hopper(s: Hopper) -> Layout:
    r, top = s.bin_diameter / 2, s.bin_height
    margin = 0.1 * r
    low = float(f"{-s.cone_depth - s.outlet_height:.10g}")
    depth = -low - s.outlet_height
    box = (-r - margin, r + margin, -r - margin, r + margin, low, 1.5 * top)  # what bounces high stays in the room
    fill = Fill(s.particles, s.count, Cylinder(r - _largest(s.particles), 0.0, top))
    return Layout(
        box,
        False,
        (_floor(low), *_sides(box[1] - box[0], box[3] - box[2])),
        (fill,),
        (Stage("fill", s.fill_time, gates=("shutter",)), Stage("discharge", s.duration)),
        s.count,
        {"hopper": Mesh(meshes.hopper(s.bin_diameter, s.bin_height, s.outlet, depth))},
        gates=(Plane("shutter", 2, -depth),),
    )


def _drum(s: Drum) -> Layout:
    r, half = s.diameter / 2, s.length / 2
    margin = 0.05 * r
    a = 0.7 * (r - _largest(s.particles))  # a block inside the circle
    return Layout(
        (-r - margin, r + margin, -half - margin, half + margin, -r - margin, r + margin),
        False,
        (Plane("front", 1, -half), Plane("back", 1, half)),
        (Fill(s.particles, s.count, Block((-a, a, -half, half, -a, a))),),
        (Stage("turn", s.duration),),
        s.count,
        {
            "drum": Mesh(
                meshes.drum(s.diameter, s.length * 1.02),
                turn=Turn((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), s.angular_velocity),
            )
        },
    )


def _compaction(s: Compaction) -> Layout:
    lx, ly, lz = s.box
    x, y = lx / 2, ly / 2
    load = Stage("load", (lz - s.height) / s.speed, {"plate": Linear((0.0, 0.0, -s.speed))})
    unload = Stage("unload", s.unload_stroke / s.release, {"plate": Linear((0.0, 0.0, s.release))})
    return Layout(
        (-x, x, -y, y, 0.0, 1.05 * lz),
        True,
        (_floor(),),
        (Fill(s.particles, s.count, Block((-x, x, -y, y, 0.0, lz))),),
        (*([Stage("fall", s.settle_time)] if s.settle_time else []), load, unload),
        s.count,
        {"plate": Mesh(meshes.rectangle(2, (0.0, 0.0, lz), (lx, ly)))},
    )


def _peening(s: Peening) -> Layout:
    """The stream is a column of shot above the target: a sphere that hits at time t starts speed * t above it.

    So its places are known at the start, and a continued run has no other ones.
    """
    gap = 4 * _largest(s.particles)
    base = s.width if s.bed else 0.0
    foot, a = base + gap, s.width / 2
    top = foot + s.speed * s.count / s.rate
    fills = [Fill(s.particles, s.count, Block((-a, a, -a, a, foot, top)), velocity=(0.0, 0.0, -s.speed), phase="peen")]
    stages = [Stage("peen", s.duration)]
    if s.bed_settle_time is not None:
        fills.insert(0, Fill(s.bed, s.bed_count, Block((-a, a, -a, a, 0.0, base)), "scene.bed_count"))
        stages.insert(0, Stage("fill", s.bed_settle_time))
    box = (-a, a, -a, a, 0.0, float(f"{top + gap:.10g}"))
    return Layout(box, True, (_floor(),), tuple(fills), tuple(stages), s.count, loses=True)


_KINDS: dict[type[Kinds], Callable[..., Layout]] = {
    Settle: _settle,
    Hopper: _hopper,
    Drum: _drum,
    Compaction: _compaction,
    Peening: _peening,
}


def layout(case: SceneCase) -> Layout:
    """The layout of a scene. Raises CaseError for lengths that do not fit together."""
    if isinstance(case.scene, Parts):
        return from_parts(case, case.scene)
    return _KINDS[type(case.scene)](case.scene)
