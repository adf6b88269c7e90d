# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls, phases and the table of spheres of a scene in LIGGGHTS's words."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest

from ..base import rendering as decks
from ..case.parts import Parts
from ..scenes.layout import Body, Plane
from ..scenes.plan import Phase, ScenePlan


@dataclass(frozen=True)
class Motion:
    """What moves a mesh: `fix id all move/mesh mesh wall words`."""

    id: str
    wall: str
    words: str


@dataclass(frozen=True)
class Late:
    """A sphere that comes with a phase; place and velocity in words; no other centre is as `near` to its place [m]."""

    name: str
    type: int
    diameter: float
    density: float
    place: str
    near: float
    velocity: str


@dataclass(frozen=True)
class Flat:
    """A plane of LIGGGHTS's kind `axis` ("zplane"); `force`: LIGGGHTS stores that of each sphere on it."""

    id: str
    type: int
    axis: str
    place: float
    force: bool


@dataclass(frozen=True)
class Surface:
    """A wall of triangles of a file; `force`: LIGGGHTS sums its force; `words`: what its surface does."""

    id: str
    file: str
    type: int
    force: bool
    words: str


@dataclass(frozen=True)
class Part:
    """A phase and what begins with it; `opens`, `stops`: what ends with it."""

    name: str
    end: int
    motions: tuple[Motion, ...]
    gates: tuple[Flat, ...]
    opens: tuple[str, ...]
    stops: tuple[str, ...]
    late: tuple[Late, ...]
    power: str


def _words(*vectors: tuple[float, ...]) -> str:
    return " ".join(decks.number(x) if x else "0" for vector in vectors for x in vector)


def wall_id(p: ScenePlan, name: str) -> str:
    """The id of a wall's fix: names that a user gave to parts cannot be those of other fixes."""
    return f"wall_{name}" if isinstance(p.case.scene, Parts) else name


def plane(p: ScenePlan, w: Plane, *, force: bool = False) -> Flat:
    """A plane of the scene."""
    return Flat(wall_id(p, w.name), p.wall_types[w.name], f"{'xyz'[w.axis]}plane", w.place, force)


def planes(p: ScenePlan) -> tuple[Flat, ...]:
    """The planes that are always there."""
    stored = {"floor"} if p.floor_load else {*p.layout.loads}
    return tuple(plane(p, w, force=w.name in stored) for w in p.layout.planes)


def surfaces(p: ScenePlan) -> tuple[Surface, ...]:
    """The walls of triangles."""
    force = p.plates or p.output.loads or p.output.energy
    found = []
    for name, mesh in p.layout.meshes.items():
        turn, words = mesh.turn, ""
        if turn is not None:
            axis = " ".join(f"{x:g}" for x in turn.axis)
            words = f" reference_point {_words(turn.origin)}" if force and any(turn.origin) else ""
            words += f" surface_ang_vel origin {_words(turn.origin)} axis {axis} omega {decks.number(turn.rate)}"
        found.append(Surface(wall_id(p, name), f"{name}.stl", p.wall_types[name], force, words))
    return tuple(found)


def _power(p: ScenePlan, phase: Phase) -> str:
    """The power of all that moves in a phase, as LIGGGHTS's formula: force and torque are those on the walls."""
    terms = []
    for name, mesh in p.layout.meshes.items():
        f = f"f_{wall_id(p, name)}"
        if mesh.turn is not None:
            terms += [f"{f}[{4 + k}]*{decks.number(mesh.turn.rate * a)}" for k, a in enumerate(mesh.turn.axis) if a]
        if name in phase.moves:
            velocity = phase.moves[name].velocity
            terms += [f"{f}[{1 + k}]*{decks.number(v)}" for k, v in enumerate(velocity) if v]
    return f"-({'+'.join(terms)})" if terms else "0.0"


def _late(p: ScenePlan, b: Body) -> Late:
    s = b.sphere
    density, velocity = p.case.materials[s.material].density, _words(s.velocity) if any(s.velocity) else ""
    return Late(
        f"body_{b.name}", p.model.type_of(s.material), 2 * s.radius, density, _words(s.place), 1e-3 * s.radius, velocity
    )


def parts(p: ScenePlan) -> tuple[Part, ...]:
    """The phases of a scene."""
    gates = {w.name: plane(p, w) for w in p.layout.gates}
    parts: list[Part] = []
    before: tuple[str, ...] = ()
    for phase, after in zip_longest(p.phases, p.phases[1:]):
        motions = {
            name: Motion(
                "press" if name == "plate" else f"move_{name}", wall_id(p, name), f"linear {_words(m.velocity)}"
            )
            for name, m in phase.moves.items()
        }
        part = Part(
            phase.name,
            phase.end,
            motions=tuple(motions.values()),
            gates=tuple(gates[name] for name in phase.gates if name not in before),
            opens=tuple(wall_id(p, name) for name in phase.gates if after and name not in after.gates),
            stops=tuple(m.id for name, m in motions.items() if after and name not in after.moves),
            late=tuple(_late(p, b) for b in p.layout.bodies if b.phase == phase.name),
            power=_power(p, phase) if p.powered else "",
        )
        parts.append(part)
        before = phase.gates
    return tuple(parts)


def load_words(p: ScenePlan) -> Iterator[str]:
    """What the rows hold of the forces on walls: three components, of meshes six."""
    for n, name in enumerate(p.layout.loads, 1):
        yield from (f"f_load{n}[{k}]" for k in range(1, 7 if name in p.layout.meshes else 4))


def table(p: ScenePlan) -> list[tuple[str, str]]:
    """The lines of each sphere of the table: id, type, diameter, density, place; id, velocity, spin."""
    rows = []
    for n, s in enumerate(p.layout.table, 1):
        density = p.case.materials[s.material].density
        body = f"{n} {p.model.type_of(s.material)} {_words((2 * s.radius, density), s.place)}"
        rows.append((body, f"{n} {_words(s.velocity, s.spin)}"))
    return rows
