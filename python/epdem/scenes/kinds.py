# SPDX-License-Identifier: GPL-2.0-or-later
"""What each kind of scene is made of: room, walls, meshes, what is filled where, phases."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..case.scene import Compaction, Drum, Hopper, Particles, Peening, SceneCase, Settle
from ..errors import CaseError
from . import meshes

Plane = tuple[str, str, float]  # fix id, LIGGGHTS's style, coordinate [m]


@dataclass(frozen=True)
class Fill:
    """Spheres put into a region: all at once, or `rate` per second every `every` seconds with velocity -z."""

    parts: list[Particles]
    count: int
    region: str
    place: str
    room: float | None = None  # volume [m^3] of the region
    rate: float | None = None
    every: float = 0.0
    velocity: float = 0.0
    phase: str = ""  # in which it begins; the first if empty


@dataclass(frozen=True)
class Layout:
    """Lengths in m, durations in s; `box` is xlo xhi ylo yhi zlo zhi of the simulated room."""

    box: tuple[float, ...]
    boundary: str
    planes: tuple[Plane, ...]
    fills: list[Fill]
    phases: list[tuple[str, float]]
    meshes: dict[str, np.ndarray] = field(default_factory=dict)
    motion: dict[str, float] = field(default_factory=dict)
    loses: bool = False

    @property
    def duration(self) -> float:
        return sum(seconds for _, seconds in self.phases)


def _largest(parts) -> float:
    return max(p.radii()[1] for p in parts)


def _block(*limits: float) -> str:
    return "block " + " ".join(f"{x:.10g}" for x in limits)


def _sides(lx: float, ly: float) -> tuple[Plane, ...]:
    return (
        ("left", "xplane", -lx / 2),
        ("right", "xplane", lx / 2),
        ("front", "yplane", -ly / 2),
        ("back", "yplane", ly / 2),
    )


def _settle(s: Settle) -> Layout:
    lx, ly, lz = s.box
    limits = (-lx / 2, lx / 2, -ly / 2, ly / 2, 0.0, lz)
    if s.rate is None:
        fill = Fill(s.particles, s.count, _block(*limits), "scene.count", lx * ly * lz)
    else:
        # a layer at the top; what fell out of it makes room for the next lot
        depth = min(lz / 4, 8 * _largest(s.particles))
        region = (*limits[:4], lz - depth, lz)
        pause = math.sqrt(2 * depth / s.gravity) if s.gravity else s.duration
        fill = Fill(s.particles, s.count, _block(*region), "scene.count", None, s.rate, pause)
        if s.count / s.rate > s.duration:
            raise CaseError(f"scene.duration = {s.duration:g} s ends before all are poured ({s.count / s.rate:g} s)")
    sides = () if s.periodic else _sides(lx, ly)
    room = (*limits[:5], 1.5 * lz)  # the walls go on above the box: what bounces high falls back
    boundary, planes = "p p f" if s.periodic else "f f f", (("floor", "zplane", 0.0), *sides)
    return Layout(room, boundary, planes, [fill], [("settle", s.duration)])


def _hopper(s: Hopper) -> Layout:
    if not s.outlet < s.bin_diameter:
        raise CaseError(f"scene.outlet = {s.outlet:g} m must be below bin_diameter ({s.bin_diameter:g} m)")
    r, top = s.bin_diameter / 2, s.bin_height
    depth = (s.bin_diameter - s.outlet) / 2 / math.tan(s.half_angle)
    margin = 0.1 * r
    low = float(f"{-depth - s.drop:.10g}")
    depth = -low - s.drop
    box = (-r - margin, r + margin, -r - margin, r + margin, low, 1.5 * top)  # what bounces high stays in the room
    rim = r - _largest(s.particles)
    fill = Fill(s.particles, s.count, f"cylinder z 0 0 {rim:.10g} 0 {top:.10g}", "scene.count", math.pi * rim**2 * top)
    sides = _sides(box[1] - box[0], box[3] - box[2])
    return Layout(
        box,
        "f f f",
        (("floor", "zplane", low), *sides),
        [fill],
        [("fill", s.fill), ("discharge", s.duration)],
        {"hopper": meshes.hopper(s.bin_diameter, s.bin_height, s.outlet, depth)},
        {"outlet": -depth},
    )


def _drum(s: Drum) -> Layout:
    r, half, big = s.diameter / 2, s.length / 2, _largest(s.particles)
    margin = 0.05 * r
    box = (-r - margin, r + margin, -half - margin, half + margin, -r - margin, r + margin)
    rim = r - big
    # a block inside the circle
    a = 0.7 * rim
    fill = Fill(s.particles, s.count, _block(-a, a, -half, half, -a, a), "scene.count", 4 * a * a * s.length)
    return Layout(
        box,
        "f f f",
        (("front", "yplane", -half), ("back", "yplane", half)),
        [fill],
        [("turn", s.duration)],
        {"drum": meshes.drum(s.diameter, s.length * 1.02)},
        {"omega": s.turn},
    )


def _compaction(s: Compaction) -> Layout:
    lx, ly, lz = s.box
    limits = (-lx / 2, lx / 2, -ly / 2, ly / 2, 0.0, lz)
    fill = Fill(s.particles, s.count, _block(*limits), "scene.count", lx * ly * lz)
    return Layout(
        (*limits[:5], 1.05 * lz),
        "p p f",
        (("floor", "zplane", 0.0),),
        [fill],
        [("load", (lz - s.height) / s.speed), ("unload", s.back / s.release)],
        {"plate": meshes.plate(lx, ly, lz)},
        {"load": s.speed, "unload": s.release},
    )


def _peening(s: Peening) -> Layout:
    """The stream is a column of shot on its way: what hits at time t starts speed * t above the target.

    LIGGGHTS's own streams place spheres by random numbers that a restart file does not hold.
    """
    gap = 4 * _largest(s.particles)
    base = s.side if s.bed else 0.0
    foot, a = base + gap, s.side / 2
    top = foot + s.speed * s.count / s.rate
    column = (-a, a, -a, a, foot, top)
    room = s.side**2 * (top - foot)
    stream = Fill(s.particles, s.count, _block(*column), "scene.count", room, velocity=s.speed, phase="peen")
    if not s.bed:
        fills, phases = [stream], []
    else:
        fills = [Fill(s.bed, s.bed_count, _block(-a, a, -a, a, 0.0, base), "scene.bed_count", s.side**3), stream]
        phases = [("fill", s.bed_fill)]
    box = (-a, a, -a, a, 0.0, float(f"{top + gap:.10g}"))
    phases.append(("peen", s.duration))
    return Layout(box, "p p f", (("floor", "zplane", 0.0),), fills, phases, loses=True)


_KINDS: dict[type, Callable[..., Layout]] = {
    Settle: _settle,
    Hopper: _hopper,
    Drum: _drum,
    Compaction: _compaction,
    Peening: _peening,
}


def layout(case: SceneCase) -> Layout:
    """The layout of a scene. Raises CaseError for lengths that do not fit together."""
    return _KINDS[type(case.scene)](case.scene)
