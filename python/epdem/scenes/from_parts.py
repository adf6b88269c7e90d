# SPDX-License-Identifier: GPL-2.0-or-later
"""The layout of a scene that is made of parts."""

import math

import numpy as np

from ..case.measures import Load
from ..case.motions import LinearMove, Phase, PressMove, RotateMove, VibrateMove
from ..case.motions import Move as CaseMove
from ..case.parts import Fill as CaseFill
from ..case.parts import Parts
from ..case.scene import SceneCase
from ..case.sizes import Particles
from ..case.walls import BoxWall, ConeWall, CylinderWall, Limits, PlaneWall, PlateWall, StlWall, Upright, Wall
from ..errors import CaseError
from . import meshes, shares, stl_files
from .layout import (
    Block,
    Body,
    Cylinder,
    Fill,
    Layout,
    Linear,
    Mesh,
    Move,
    Plane,
    Servo,
    Stage,
    Turn,
    Until,
    Vector,
    Vibration,
)


def _vector(values: list[float]) -> Vector:
    x, y, z = values
    return (x, y, z)


def _triangles(w: Wall, room: Limits, largest: float) -> meshes.FloatArray:
    match w:
        case PlateWall():
            first, second = w.size
            return meshes.rectangle("xyz".index(w.axis), np.array(w.center), (first, second))
        case BoxWall():
            faces = {sign + axis for sign in "-+" for axis in "xyz"} - set(w.open)
            return meshes.box((*w.x, *w.y, *w.z), faces)
        case CylinderWall() | ConeWall():
            closed = ("from" in w.ends, "to" in w.ends)
            tube = meshes.tube(w.diameters_of_ends(), w.start, w.to, closed=closed)
            turned: meshes.FloatArray = meshes.along("xyz".index(w.axis), tube) + np.array(_origin(w))
            return turned
        case StlWall():
            return stl_files.placed(w, room, largest)
    raise AssertionError(w)


def _origin(w: CylinderWall | ConeWall) -> Vector:
    """A place on the axis of a round wall [m]."""
    origin = [0.0, 0.0, 0.0]
    axis = "xyz".index(w.axis)
    for k, value in zip((k for k in range(3) if k != axis), w.center, strict=True):
        origin[k] = value
    return _vector(origin)


def _turn(w: Wall) -> Turn | None:
    if not isinstance(w, CylinderWall | ConeWall) or not w.angular_velocity:
        return None
    return Turn(_origin(w), _vector([float(axis == w.axis) for axis in "xyz"]), w.angular_velocity)


def _meshes(s: Parts, largest: float) -> dict[str, Mesh]:
    room = s.room.limits
    found = {}
    for w in s.wall:
        if isinstance(w, PlaneWall):
            continue
        triangles = _triangles(w, room, largest)
        corners = triangles.reshape(-1, 3)
        if (corners.min(axis=0) < room[0::2]).any() or (corners.max(axis=0) > room[1::2]).any():
            raise CaseError(
                f"scene.wall.{w.name}: reaches beyond scene.room; enlarge the room, or make the wall smaller"
            )
        found[w.name] = Mesh(triangles, w.material, _turn(w), w.stress, w.wear or 0.0)
    return found


def _planes(s: Parts) -> tuple[tuple[Plane, ...], tuple[Plane, ...]]:
    """(planes that are always there, planes of some phases)."""
    always: list[Plane] = []
    sometimes: list[Plane] = []
    for w in s.wall:
        if isinstance(w, PlaneWall):
            plane = Plane(w.name, "xyz".index(w.axis), w.at, w.material)
            (sometimes if w.phases else always).append(plane)
    return tuple(always), tuple(sometimes)


def _region(f: CaseFill) -> Block | Cylinder:
    r = f.region
    if isinstance(r, Upright):
        return Cylinder(r.diameter / 2, r.z[0], r.z[1], (r.center[0], r.center[1]))
    return Block(r.limits)


def _fills(case: SceneCase, s: Parts) -> list[Fill]:
    """A fill at once is one of exactly so many spheres for each size, the largest first; a stream is drawn from all."""
    found = []
    first = s.phase[0].name
    for f in s.random_fills:
        place, region, phase = f"scene.fill.{f.name}", _region(f), f.phase or first
        kinds = [(x.material, x.radius, x.placed) for x in shares.counted(case, f, region.volume) if x.placed]
        kinds.sort(key=lambda kind: -kind[1])
        number, velocity = sum(n for *_, n in kinds), _vector(f.velocity)
        if not number:
            raise CaseError(f"{place}: not one sphere; give more, or smaller ones")
        if f.rate is None:
            found += [
                Fill([Particles.of(m, r)], n, region, place, velocity=velocity, phase=phase, exact=True)
                for m, r, n in kinds
            ]
            continue
        down = -velocity[2]
        depth = region.limits[5] - region.limits[4] if isinstance(region, Block) else region.high - region.low
        pause = 2 * depth / (down + math.sqrt(down**2 + 2 * s.gravity * depth)) if down > 0 or s.gravity else 0.0
        if not pause:
            raise CaseError(f"{place}.rate: nothing falls out of the region; give gravity, or a velocity along -z")
        seconds = next(p.duration for p in s.phase if p.name == phase)
        if number / f.rate > seconds:
            raise CaseError(
                f"{place}.rate = {f.rate:g} Hz: {number} spheres take longer than phase {phase}; pour faster"
            )
        found.append(Fill(f.particles, number, region, place, f.rate, pause, velocity, phase))
    return found


def _refuse_outside(s: Parts) -> None:
    """Raise CaseError for spheres and regions beyond the room."""
    low, high = s.room.limits[0::2], s.room.limits[1::2]
    places = [(f"sphere {n} of scene.fill and scene.body", x.place) for n, x in enumerate(s.table, 1)]
    places += [(f"scene.body.{b.name}.position", _vector(b.position)) for b in s.later]
    for name, place in places:
        if not all(a <= x <= b for a, x, b in zip(low, place, high, strict=True)):
            raise CaseError(f"{name}: {tuple(place)} m lies beyond scene.room; move it, or enlarge the room")
    for f in s.random_fills:
        r = _region(f)
        if isinstance(r, Block):
            limits = r.limits
        else:
            (a, b), c = r.center, r.radius
            limits = (a - c, a + c, b - c, b + c, r.low, r.high)
        if any(x < a for x, a in zip(limits[0::2], low, strict=True)) or any(
            x > b for x, b in zip(limits[1::2], high, strict=True)
        ):
            raise CaseError(
                f"scene.fill.{f.name}.region reaches beyond scene.room; make it smaller, or enlarge the room"
            )


def _move(m: CaseMove) -> Move:
    match m:
        case LinearMove():
            return Linear(_vector(m.velocity))
        case RotateMove():
            length = math.hypot(*m.axis)
            return Turn(_vector(m.origin), _vector([x / length for x in m.axis]), m.rate)
        case VibrateMove():
            return Vibration(_vector(m.amplitude), 2 * math.pi * m.frequency)
        case PressMove():
            length = math.hypot(*m.direction)
            return Servo(_vector([x / length for x in m.direction]), m.force, m.highest_speed)


def _stage(s: Parts, p: Phase) -> Stage:
    gates = tuple(w.name for w in s.wall if isinstance(w, PlaneWall) and p.name in w.phases)
    moves = {m.wall: _move(m) for m in p.move}
    seconds, until = p.duration, None
    if u := p.until:
        after = 0.1 * p.duration if u.after is None else u.after
        if u.kinetic_energy is not None:
            until = Until("kinetic_energy", u.kinetic_energy, after)
        elif u.count is not None:
            until = Until("count", float(u.count), after)
        elif u.force is not None:
            if u.wall in {w.name for w in s.wall if isinstance(w, PlaneWall) and w.phases}:
                raise CaseError(f"scene.phase.{p.name}.until.wall: {u.wall} is a wall of some phases; name another one")
            until = Until("force", u.force, after, u.wall or "")
        elif u.travel is not None:
            move = moves[u.wall or ""]
            assert isinstance(move, Linear)
            seconds = min(seconds, u.travel / math.hypot(*move.velocity))
    return Stage(p.name, seconds, moves, gates, until, p.time_step, p.record)


def _refuse_leaving(stages: tuple[Stage, ...], walls: dict[str, Mesh], room: Limits) -> None:
    """Raise CaseError for a wall whose linear motions take it out of the room, up to a phase that may end early."""
    place = {name: mesh.triangles.mean(axis=1) for name, mesh in walls.items()}
    for stage in stages:
        if stage.until:
            return
        for name, move in stage.moves.items():
            if name in place and isinstance(move, Linear):
                place[name] = place[name] + stage.seconds * np.array(move.velocity)
                if (place[name] < room[0::2]).any() or (place[name] > room[1::2]).any():
                    where = f"scene.phase.{stage.name}.move"
                    raise CaseError(f"{where}: wall {name} leaves scene.room; shorten its way, or enlarge the room")
            else:
                place.pop(name, None)


def from_parts(case: SceneCase, s: Parts) -> Layout:
    """The layout of a scene of parts. Raises CaseError for what does not fit together."""
    _refuse_outside(s)
    largest = max(p.radii()[1] for p in s.filled)
    walls = _meshes(s, largest)
    planes, gates = _planes(s)
    stages = tuple(_stage(s, p) for p in s.phase)
    _refuse_leaving(stages, walls, s.room.limits)
    loads = {w.name for w in s.wall} - {g.name for g in gates} if case.output.loads else set()
    loads |= {stage.until.wall for stage in stages if stage.until and stage.until.wall}
    loads |= {m.wall for m in s.measure if isinstance(m, Load)} & {w.name for w in s.wall}
    moves = [(name, move) for stage in stages for name, move in stage.moves.items()]
    served = {name for name, move in moves if isinstance(move, Servo)}
    if both := {name for name, move in moves if name in served and not isinstance(move, Servo)}:
        raise CaseError(f"scene.wall.{min(both)}: a wall that a force drives has no other motion; take a second wall")
    if case.output.restarts and any(not isinstance(move, Linear) for _, move in moves):
        raise CaseError("output.restarts: only walls with linear motions go on where they were; remove it")
    for name, mesh in walls.items():
        if (mesh.stress or mesh.wear) and not case.output.particles:
            raise CaseError(f"scene.wall.{name}: stress and wear are written with the frames; give output.particles")
        if mesh.wear and case.output.restarts:
            raise CaseError(
                f"output.restarts: a continued run does not know the wear of wall {name}; remove one of both"
            )
    fills = _fills(case, s)
    bodies = tuple(Body(b.name, b.sphere, b.phase or "") for b in s.later)
    return Layout(
        s.room.limits,
        s.periodic,
        planes,
        tuple(fills),
        stages,
        sum(f.count for f in fills) + len(s.table) + len(bodies),
        walls,
        gates,
        loses=s.open_boundary,
        table=tuple(s.table),
        bodies=bodies,
        loads=tuple(w.name for w in s.wall if w.name in loads),
    )
