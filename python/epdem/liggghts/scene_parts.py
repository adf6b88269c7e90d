# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls, phases and the table of spheres of a scene in LIGGGHTS's words."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import zip_longest

from ..base import rendering as decks
from ..errors import CaseError
from ..scenes.layout import Body, Linear, Mesh, Move, Plane, Servo, Turn, Vector, Vibration
from ..scenes.plan import Phase, ScenePlan
from .wall_power import GAIN, power, wall_id


@dataclass(frozen=True)
class Motion:
    """What moves a mesh: `begin` and `end` are commands."""

    wall: str
    begin: str
    end: str


@dataclass(frozen=True)
class Wait:
    """How a phase ends early: after `first` steps at most `rows` times `every`, until the condition holds."""

    first: int
    rows: int
    formula: str
    condition: str


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
    """A wall of triangles of a file; `style`: with sums of forces, driven by one; `words`: what its surface does.

    waits: the force that drives it acts in later phases only."""

    id: str
    file: str
    type: int
    style: str
    words: str
    waits: bool


@dataclass(frozen=True)
class Part:
    """A phase and what begins with it; `ends`: commands at its end. held: all its gates and motions, for a run that
    continues in it. upto: whether the step at its end is known before the run. clocks: the walls whose power needs the
    step at which their vibration begins, here."""

    name: str
    end: int
    steps: int
    upto: bool
    time_step: float | None
    begins: tuple[str, ...]
    gates: tuple[Flat, ...]
    held_gates: tuple[Flat, ...]
    held: tuple[str, ...]
    ends: tuple[str, ...]
    late: tuple[Late, ...]
    record: bool
    power: str
    clocks: tuple[str, ...]
    wait: Wait | None

    def after(self, steps: int, every: int) -> "Part":
        """What is left of the phase after so many of its steps."""
        wait = self.wait
        if wait is not None:
            looked = max(0, steps - wait.first) // every
            wait = replace(wait, first=max(0, wait.first - steps), rows=wait.rows - looked)
        return replace(self, steps=self.steps - steps, wait=wait)


def _words(*vectors: tuple[float, ...]) -> str:
    return " ".join(decks.number(x) if x else "0" for vector in vectors for x in vector)


def plane(p: ScenePlan, w: Plane, *, force: bool = False) -> Flat:
    """A plane of the scene."""
    return Flat(wall_id(p, w.name), p.wall_types[w.name], f"{'xyz'[w.axis]}plane", w.place, force)


def planes(p: ScenePlan) -> tuple[Flat, ...]:
    """The planes that are always there."""
    stored = {"floor"} if p.floor_load else {*p.layout.loads}
    return tuple(plane(p, w, force=w.name in stored) for w in p.layout.planes)


def _origins(p: ScenePlan, name: str) -> Vector:
    """The place that torques on a mesh refer to [m]: on the axis of its turn."""
    origins = {turn.origin for turn in p.turns(name)}
    if len(origins) > 1:
        raise CaseError(f"scene.wall.{name}: it turns about several origins, LIGGGHTS refers torques to one; give one")
    return next(iter(origins), (0.0, 0.0, 0.0))


def _servo(p: ScenePlan, name: str) -> Servo | None:
    """The force that drives a mesh in some phases."""
    servos = {
        move for phase in p.phases for wall, move in phase.moves.items() if wall == name and isinstance(move, Servo)
    }
    if len(servos) > 1:
        raise CaseError(f"scene.wall.{name}: phases press with different forces or directions; press with one")
    return next(iter(servos), None)


def _middle(mesh: Mesh) -> Vector:
    corners = mesh.triangles.reshape(-1, 3)
    x, y, z = (float(v) for v in 0.5 * (corners.min(axis=0) + corners.max(axis=0)))
    return (x, y, z)


def surfaces(p: ScenePlan) -> tuple[Surface, ...]:
    """The walls of triangles."""
    force = p.plates or p.output.loads or p.output.energy
    found = []
    for name, mesh in p.layout.meshes.items():
        turn, words = mesh.turn, ""
        style = "/stress" if force or name in p.layout.loads or mesh.stress or mesh.wear else ""
        origins = _origins(p, name)
        if style and any(origins):
            words = f" reference_point {_words(origins)}"
        if mesh.wear:
            words += " wear finnie"
        if turn is not None:
            axis = " ".join(f"{x:g}" for x in turn.axis)
            words += f" surface_ang_vel origin {_words(turn.origin)} axis {axis} omega {decks.number(turn.rate)}"
        servo = _servo(p, name)
        if servo is not None:
            style = "/stress/servo"
            words += f" com {_words(_middle(mesh))} ctrlPV force axis {_words(servo.direction)}"
            words += f" target_val {decks.number(servo.force)} vel_max {decks.number(servo.highest_speed)} kp {GAIN}"
        waits = servo is not None and name not in p.phases[0].moves
        found.append(Surface(wall_id(p, name), f"{name}.stl", p.wall_types[name], style, words, waits))
    return tuple(found)


def _motion(p: ScenePlan, name: str, move: Move) -> Motion:
    wall = wall_id(p, name)
    fix = "press" if name == "plate" else f"move_{name}"
    match move:
        case Linear():
            words = f"linear {_words(move.velocity)}"
        case Turn():
            axis = _words(tuple(math.copysign(1.0, move.rate) * x for x in move.axis))
            period = decks.number(2 * math.pi / abs(move.rate))
            words = f"rotate origin {_words(move.origin)} axis {axis} period {period}"
        case Vibration():
            words = f"wiggle amplitude {_words(move.amplitude)} period {decks.number(2 * math.pi / move.omega)}"
        case Servo():
            return Motion(wall, f"fix_modify {wall} servo/integrate start", f"fix_modify {wall} servo/integrate stop")
    return Motion(wall, f"fix {fix} all move/mesh mesh {wall} {words}", f"unfix {fix}")


def _wait(p: ScenePlan, phase: Phase, steps: int) -> Wait | None:
    until = phase.until
    if until is None:
        return None
    first = min(steps, p.every * max(1, math.ceil(until.after / (phase.time_step or p.time_step) / p.every)))
    sign = "<"
    match until.quantity:
        case "kinetic_energy":
            formula = "ke/atoms"
        case "count":
            formula, sign = "atoms", "<="
        case _:
            load = f"f_load{1 + p.layout.loads.index(until.wall)}"
            formula, sign = "sqrt(" + "+".join(f"{load}[{k}]*{load}[{k}]" for k in (1, 2, 3)) + ")", ">="
    return Wait(first, (steps - first) // p.every, formula, f"{sign} {decks.number(until.limit)}")


def _late(p: ScenePlan, b: Body) -> Late:
    s = b.sphere
    density, velocity = p.case.materials[s.material].density, _words(s.velocity) if any(s.velocity) else ""
    return Late(
        f"body_{b.name}", p.model.type_of(s.material), 2 * s.radius, density, _words(s.place), 1e-3 * s.radius, velocity
    )


def parts(p: ScenePlan) -> tuple[Part, ...]:
    """The phases of a scene."""
    gates = {w.name: plane(p, w) for w in p.layout.gates}
    own_steps = any(phase.time_step for phase in p.phases)
    found: list[Part] = []
    begin, upto = 0, True
    before: Phase | None = None
    for phase, after in zip_longest(p.phases, p.phases[1:]):
        motions = {name: _motion(p, name, move) for name, move in phase.moves.items()}
        new = [name for name, move in phase.moves.items() if before is None or before.moves.get(name) != move]
        _refuse_other_step(p, before, phase)
        ends = [f"unfix {wall_id(p, name)}" for name in phase.gates if after and name not in after.gates]
        upto = upto and phase.until is None
        part = Part(
            phase.name,
            phase.end,
            phase.end - begin,
            upto=upto,
            time_step=phase.time_step or p.time_step if own_steps else None,
            begins=tuple(motions[name].begin for name in new),
            gates=tuple(gates[name] for name in phase.gates if before is None or name not in before.gates),
            held_gates=tuple(gates[name] for name in phase.gates),
            held=tuple(m.begin for m in motions.values()),
            ends=(*ends, *(m.end for name, m in motions.items() if after and not _goes_on(name, phase, after))),
            record=phase.record,
            late=tuple(_late(p, b) for b in p.layout.bodies if b.phase == phase.name),
            power=power(p, phase) if p.powered else "",
            clocks=tuple(name for name in new if p.powered and isinstance(phase.moves[name], Vibration)),
            wait=_wait(p, phase, phase.end - begin),
        )
        found.append(part)
        begin, before = phase.end, phase
    return tuple(found)


def _refuse_other_step(p: ScenePlan, before: Phase | None, phase: Phase) -> None:
    """Raise CaseError for a vibration that goes on with another time step: its power is counted in steps."""
    if before is None or not p.powered or before.time_step == phase.time_step:
        return
    for name, move in phase.moves.items():
        if isinstance(move, Vibration) and before.moves.get(name) == move:
            raise CaseError(
                f"scene.phase.{phase.name}.time_step: wall {name} vibrates on from the phase before, and its work is "
                "known with one step of time only; give both phases the same one, or remove output.energy"
            )


def _goes_on(name: str, phase: Phase, after: Phase) -> bool:
    """Whether a wall needs no command at the end of a phase: the motion goes on, or another `move/mesh` replaces it."""
    one, next_one = phase.moves[name], after.moves.get(name)
    return next_one is not None and isinstance(one, Servo) == isinstance(next_one, Servo)


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
