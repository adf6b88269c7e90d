# SPDX-License-Identifier: GPL-2.0-or-later
"""What each kind of scene is made of: room, walls, meshes, what is filled where, phases."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..errors import CaseError
from . import meshes
from .case import Compaction, Drum, Hopper, Particles, Peening, SceneCase, Settle

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
    return Layout(
        limits, "p p f" if s.periodic else "f f f", (("floor", "zplane", 0.0), *sides), [fill], [("settle", s.duration)]
    )


def _hopper(s: Hopper) -> Layout:
    if not s.outlet < s.bin_diameter:
        raise CaseError(f"scene.outlet = {s.outlet:g} m must be below bin_diameter ({s.bin_diameter:g} m)")
    r, top = s.bin_diameter / 2, s.bin_height
    depth = (s.bin_diameter - s.outlet) / 2 / math.tan(s.half_angle)
    margin = 0.1 * r
    low = float(f"{-depth - s.drop:.10g}")
    depth = -low - s.drop
    box = (-r - margin, r + margin, -r - margin, r + margin, low, top)
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
    box = (-r - margin, r + margin, -half, half, -r - margin, r + margin)
    rim = r - big
    # a block inside the circle
    a = 0.7 * rim
    fill = Fill(s.particles, s.count, _block(-a, a, -half, half, -a, a), "scene.count", 4 * a * a * s.length)
    return Layout(
        box,
        "f f f",
        (("front", "yplane", -half), ("back", "yplane", half)),
        [fill],
        [("fill", s.fill), ("turn", s.duration)],
        {"drum": meshes.drum(s.diameter, s.length * 1.02)},
        {"period": 2 * math.pi / s.turn},
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
        {"plate": meshes.plate(1.2 * lx, 1.2 * ly, lz)},
        {"load": s.speed, "unload": s.release},
    )


def _peening(s: Peening) -> Layout:
    big = _largest(s.particles)
    height = 12 * big
    top = s.side  # of the bed's fill
    base = top if s.bed else 0.0
    a = s.side / 2
    box = (-a, a, -a, a, 0.0, base + height)
    stream = (-a, a, -a, a, base + 6 * big, base + height)
    # one lot leaves the region before the next comes
    fills = []
    if s.bed:
        fills.append(Fill(s.bed, s.bed_count, _block(-a, a, -a, a, 0.0, top), "scene.bed_count", s.side**3))
    pause = 6 * big / s.speed
    fills.append(Fill(s.particles, s.count, _block(*stream), "scene.count", None, s.rate, pause, s.speed, "peen"))
    phases = [("fill", s.bed_fill)] if s.bed else []
    return Layout(box, "p p f", (("floor", "zplane", 0.0),), fills, [*phases, ("peen", s.duration)], loses=True)


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
