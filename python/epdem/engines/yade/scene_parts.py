# SPDX-License-Identifier: GPL-2.0-or-later
"""The parts of a scene in YADE: walls, their motions, spheres of later phases, and what YADE cannot have."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base import rendering as decks
from ...case.motions import LinearMove, Move, RotateMove, VibrateMove
from ...case.walls import BoxWall, PlaneWall, PlateWall
from ...jobs.engine import Unsupported
from ...scenes.plan import placement
from ...scenes.plan.meshes import spans, surface_rotation
from ...scenes.plan.phases import Phase, PhaseSteps
from ...scenes.plan.plan import ScenePlan
from ..host import words_of_motion
from ..input_script import first_look, torque_origin

EDGES = (
    "walls of triangles ({}): YADE counts a sphere that touches an edge once for each triangle there, so that its "
    "force is twice as large within sqrt(2 R overlap) of an edge between flat neighbours, and n times at a corner of n "
    "triangles, such as the middle of the end of a cylinder (48)"
)


LEG, LEG_OF_PERIOD = (0.2, 1.9), (0.5, 6.0)  # begin before the room and length of a triangle across it, in its sizes
HEAD = "# x y z radius [m], type, velocity [m/s], spin [rad/s], 1: frozen"  # of a table of spheres


@dataclass(frozen=True)
class Wall:
    """A wall by the `shape` of its bodies in YADE: an infinite plane (wall) across `axis` at `place` [m], rectangles
    (box) or triangles (facet) that are in `file`.

    material: its number; number: of the wall in contact tables.
    """

    name: str
    number: int
    material: int
    shape: str = "wall"
    axis: int = 0
    place: float = 0.0
    file: str = ""


def check_walls(p: ScenePlan) -> None:
    """Raise Unsupported for walls and motions of walls that YADE does not have."""
    for phase in p.phases:
        until = phase.case.condition
        if (until and until.wall) or any(move.press for move in phase.moves.values()):
            raise Unsupported(
                f"scene.phase.{phase.name}: walls move at given velocities in YADE, and no force, height or density "
                "drives them or ends a phase",
                "give a linear motion and a duration",
            )
    for name, mesh in p.scene.meshes.items():
        if surface_rotation(mesh) and any(name in phase.moves for phase in p.phases):
            raise Unsupported(
                f"scene.wall.{name}.angular_velocity: YADE turns the wall itself, which moves otherwise", "remove one"
            )


def is_flat(p: ScenePlan, name: str) -> bool:
    """Whether each rectangle of a wall, two triangles of its mesh, is one body in YADE, which counts a sphere on an
    edge between two bodies twice. YADE's box, a flat one, misses spheres beyond the sides of a periodic cell."""
    return is_endless(p, name) or (not p.scene.periodic and isinstance(p.scene.meshes[name], PlateWall | BoxWall))


def edges(p: ScenePlan) -> list[str]:
    """The warning about walls that have edges between triangles."""
    names = [name for name in p.scene.meshes if not is_flat(p, name)]
    return [EDGES.format(", ".join(names))] if names else []


def is_endless(p: ScenePlan, name: str) -> bool:
    """Whether a wall of triangles is a plane without edges: a plate as wide as the periodic cell that moves across
    itself."""
    mesh = p.scene.meshes[name]
    if not (p.scene.periodic and isinstance(mesh, PlateWall)):
        return False
    flat = [k for k in range(3) if "xyz"[k] != mesh.axis]
    moves = [phase.moves[name] for phase in p.phases if name in phase.moves]
    across = not any(move.rotation or any(move.along[k] for k in flat) for move in moves)
    return across and all(spans(mesh, "xyz"[k], p.box) for k in flat)


def walls(p: ScenePlan) -> dict[str, Wall]:
    """All walls by name. YADE's infinite walls do not work in a periodic cell: there they are triangles."""
    found, planes = {}, _planes(p)
    for number, name in enumerate(wall_names(p), p.count):
        material = p.wall_types[name] - 1
        if name in planes and not p.scene.periodic:
            found[name] = Wall(name, number, material, "wall", "xyz".index(planes[name].axis), planes[name].at)
        else:
            flat = name not in planes and is_flat(p, name) and not is_endless(p, name)
            found[name] = Wall(name, number, material, "box" if flat else "facet", file=f"wall_{name}.txt")
    return found


def wall_names(p: ScenePlan) -> list[str]:
    """The walls in the order of their numbers in contact tables."""
    return [*_planes(p), *p.scene.meshes]


def _planes(p: ScenePlan) -> dict[str, PlaneWall]:
    return {w.name: w for w in (*p.scene.planes, *p.scene.gates)}


@dataclass(frozen=True)
class DeckMotion:
    """Lines of a script that begin and end the motion of a wall."""

    wall: str
    kind: str
    begin: tuple[str, ...]
    end: tuple[str, ...] = ()


def _numbers(values: Sequence[float]) -> str:
    return f"({', '.join(map(decks.number, values))})"


def _linear(m: LinearMove) -> DeckMotion:
    lines = f'for k in walls["{m.wall}"]:', f"    O.bodies[k].state.vel = {_numbers(m.velocity)}"
    return DeckMotion(m.wall, m.kind, lines)


def _rotate(m: RotateMove) -> DeckMotion:
    values = {"rotationAxis": _numbers(m.axis), "zeroPoint": _numbers(m.origin)}
    values |= {"angularVelocity": decks.number(m.rate), "dead": "False"}
    lines = tuple(f'turns["{m.wall}"].{name} = {value}' for name, value in values.items())
    return DeckMotion(m.wall, m.kind, lines, (f'turns["{m.wall}"].dead = True',))


def _vibrate(m: VibrateMove) -> DeckMotion:
    line = f'shaken["{m.wall}"] = {_numbers(m.amplitude)}, {decks.number(m.omega)}, O.time'
    return DeckMotion(m.wall, m.kind, (line,), (f'del shaken["{m.wall}"]',))


MOTIONS: dict[type[Move], Callable[[Any], DeckMotion]] = {
    LinearMove: _linear,
    RotateMove: _rotate,
    VibrateMove: _vibrate,
}


def motions(p: ScenePlan, phase: Phase) -> tuple[DeckMotion, ...]:
    """Motions of a phase. A surface that turns is a wall of revolution that turns."""
    turning = {name: rotation for name, mesh in p.scene.meshes.items() if (rotation := surface_rotation(mesh))}
    found = {name: _rotate(rotation) for name, rotation in turning.items()}
    own = {name: words_of_motion(MOTIONS, "YADE", phase, name)(move) for name, move in phase.moves.items()}
    return tuple((found | own).values())


def loads(p: ScenePlan) -> list[tuple[str, Sequence[float] | None]]:
    """The walls whose forces are in the rows; where a place [m] is given the torque about it, too: on the axis of a
    wall's turn, else 0."""
    return [(name, torque_origin(p, name) if name in p.scene.meshes else None) for name in p.measured_walls]


@dataclass(frozen=True)
class LateSpheres:
    """Spheres that come with a phase but the first, drawn before the run: the file with their table.

    keys: place in the case, number and what to change if another sphere is there, of each fill and body.
    """

    file: str
    keys: tuple[tuple[str, int, str], ...]


def late_spheres(p: ScenePlan, phase: str) -> LateSpheres | None:
    """The spheres that come with a phase but the first; None: none do."""
    if phase == p.phases[0].name:
        return None
    fills = dict[str, int]()
    for f in (f for f in p.insertions if f.phase == phase):
        fills[f.key] = fills.get(f.key, 0) + f.count
    keys = [(key, count, "raise the region, or use --engine liggghts") for key, count in fills.items()]
    advice = "move the body, or give it another phase"
    keys += [(f"scene.body.{b.name}.position", 1, advice) for b in p.scene.later if b.phase == phase]
    return LateSpheres(f"spheres_{phase}.txt", tuple(keys)) if keys else None


@dataclass(frozen=True)
class Stop:
    """A condition on a row that may end a phase early, from `after` steps on: formula of its value."""

    value: str
    condition: str
    after: int


def stop(p: ScenePlan, run: PhaseSteps) -> Stop | None:
    """The condition that may end a phase early: a kinetic energy, or a number of spheres."""
    until = run.case.condition
    if until is None:
        return None
    limit, after = decks.number(until.limit), first_look(p, run)
    if until.kinetic_energy is not None:
        energy = 'row["kinetic_energy"] / row["particles"] if row["particles"] else np.inf'
        return Stop(energy, f"< {limit}", after)
    return Stop('row["particles"]', f"<= {limit}", after)


def files(p: ScenePlan) -> dict[str, str]:
    """The rectangles or triangles of each wall and the spheres of later phases, by file."""
    texts = {}
    for wall in (w for w in walls(p).values() if w.file):
        head = "# corners of a triangle, x y z of each [m]"
        if wall.shape == "box":
            head, corners = "# a rectangle: x y z of its centre, half of its size [m]", p.triangles[wall.name]
            low, high = (f(corners.reshape(-1, 6, 3), axis=1) for f in (np.min, np.max))
            rows = np.hstack([(low + high) / 2, (high - low) / 2]).tolist()
        elif wall.name in p.triangles and not is_endless(p, wall.name):
            rows = p.triangles[wall.name].reshape(-1, 9).tolist()
        else:
            rows = [_large_triangle(p, wall.name)]
        texts[wall.file] = table_text(head, rows)
    for phase in p.phases:
        if late := late_spheres(p, phase.name):
            rows = [*placement.spheres(p, phase.name).tolist(), *placement.later_bodies(p, phase.name)]
            texts[late.file] = table_text(HEAD, rows)
    return texts


def table_text(head: str, rows: Sequence[Sequence[float]]) -> str:
    """A table of numbers below a comment."""
    return "\n".join([head, *(" ".join(map(decks.number, row)) for row in rows), ""])


def _large_triangle(p: ScenePlan, name: str) -> list[float]:
    """Corners of a triangle whose edges no sphere meets: larger than the room, where this repeats than the cell."""
    if name in (planes := _planes(p)):
        axis, at = "xyz".index(planes[name].axis), planes[name].at
    else:
        points = p.triangles[name].reshape(-1, 3)
        axis = int(np.ptp(points, axis=0).argmin())
        at = float(points[0, axis])
    legs = [LEG_OF_PERIOD if period else LEG for period in p.scene.periods]
    corners = [[p.box[2 * k] - begin * _size(p, k) for k, (begin, _) in enumerate(legs)] for _ in range(3)]
    first, second = (k for k in range(3) if k != axis)
    corners[1][first] += legs[first][1] * _size(p, first)
    corners[2][second] += legs[second][1] * _size(p, second)
    for corner in corners:
        corner[axis] = at
    return [x for corner in corners for x in corner]


def _size(p: ScenePlan, k: int) -> float:
    return p.box[2 * k + 1] - p.box[2 * k]
