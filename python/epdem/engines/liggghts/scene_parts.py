# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls, phases and the table of spheres of a scene in LIGGGHTS's words."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest

from ...base import rendering as decks
from ...case.motions import LinearMove, Move, PressMove, RotateMove, VibrateMove
from ...case.parts import Body
from ...case.walls import PlaneWall
from ...errors import CaseError
from ...scenes.plan import Phase, ScenePlan
from ...scenes.walls import surface_rotation
from ..input_script import StopCondition, stop_condition, torque_origin, wall_id
from .wall_power import GAIN, power


@dataclass(frozen=True)
class PhaseParticle:
    """A sphere that comes with a phase; place and velocity in words; no other centre is as `near` to its place [m]."""

    name: str
    type: int
    diameter: float
    density: float
    place: str
    near: float
    velocity: str


@dataclass(frozen=True)
class DeckPlane:
    """A plane of LIGGGHTS's kind `axis` ("zplane"); `force`: LIGGGHTS stores the force of each sphere on it."""

    id: str
    type: int
    axis: str
    place: float
    force: bool


@dataclass(frozen=True)
class DeckMesh:
    """A wall of triangles of a file; `style`: with sums of forces, driven by one; `keywords`: what its surface does.

    pressed_later: the force that drives it acts in later phases only."""

    id: str
    file: str
    type: int
    style: str
    keywords: str
    pressed_later: bool


@dataclass(frozen=True)
class DeckPhase:
    """A phase: commands at its start and end, and commands of a run that continues in it.

    gates: planes that come with the phase. upto: whether the step at its end is known before the run. particles:
    spheres that come with it. vibrations: walls whose power needs the step at which their vibration begins.
    """

    name: str
    end: int
    steps: int
    upto: bool
    time_step: float | None
    start_commands: tuple[str, ...]
    gates: tuple[DeckPlane, ...]
    resume_gates: tuple[DeckPlane, ...]
    resume_commands: tuple[str, ...]
    end_commands: tuple[str, ...]
    particles: tuple[PhaseParticle, ...]
    record: bool
    power: str
    vibrations: tuple[str, ...]
    stop: StopCondition | None

    def after(self, steps: int, every: int) -> "DeckPhase":
        """Remaining phase after `steps` of its steps have run."""
        stop = self.stop
        if stop is not None:
            looked = max(0, steps - stop.first) // every
            stop = replace(stop, first=max(0, stop.first - steps), rows=stop.rows - looked)
        return replace(self, steps=self.steps - steps, stop=stop)


def _words(*vectors: Sequence[float]) -> str:
    return " ".join(decks.number(x) if x else "0" for vector in vectors for x in vector)


def plane(p: ScenePlan, w: PlaneWall, *, force: bool = False) -> DeckPlane:
    """A plane of the scene."""
    return DeckPlane(wall_id(p, w.name), p.wall_types[w.name], f"{w.axis}plane", w.at, force)


def planes(p: ScenePlan) -> tuple[DeckPlane, ...]:
    """The planes that are always there."""
    stored = {"floor"} if p.floor_load else {*p.loads}
    return tuple(plane(p, w, force=w.name in stored) for w in p.scene.planes)


def _press(p: ScenePlan, name: str) -> PressMove | None:
    """The force that drives a mesh in some phases."""
    moves = [phase.moves[name] for phase in p.phases if name in phase.moves]
    presses = [move for move in moves if isinstance(move, PressMove)]
    if any(press != presses[0] for press in presses):
        raise CaseError(f"scene.wall.{name}: phases press with different forces or directions; press with one")
    return next(iter(presses), None)


def surfaces(p: ScenePlan) -> tuple[DeckMesh, ...]:
    """The walls of triangles."""
    force = p.plates or p.torque or p.writes_wall_power
    pressed = {bed.wall for bed in p.pressed}
    found = []
    for name, mesh in p.scene.meshes.items():
        rotation, words = surface_rotation(mesh), ""
        style = "/stress" if force or name in p.loads or name in pressed or mesh.stress or mesh.wear else ""
        origin = torque_origin(p, name)
        if rotation is not None:  # LIGGGHTS takes the words in this order only
            axis, omega = " ".join(f"{x:g}" for x in rotation.axis), decks.number(rotation.rate)
            words = f" surface_ang_vel origin {_words(rotation.origin)} axis {axis} omega {omega}"
        if style and any(origin):
            words += f" reference_point {_words(origin)}"
        if mesh.wear:
            words += " wear finnie"
        press = _press(p, name)
        if press is not None:
            style = "/stress/servo"
            corners = p.triangles[name].reshape(-1, 3)
            middle = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
            words += f" com {_words(middle.tolist())} ctrlPV force axis {_words(press.unit_direction)}"
            words += f" target_val {decks.number(press.force)} vel_max {decks.number(press.highest_speed)} kp {GAIN}"
        waits = press is not None and name not in p.phases[0].moves
        found.append(DeckMesh(wall_id(p, name), f"{name}.stl", p.wall_types[name], style, words, waits))
    return tuple(found)


def _motion(p: ScenePlan, name: str, move: Move) -> tuple[str, str]:
    """The commands at the begin and at the end of the motion of a mesh."""
    wall = wall_id(p, name)
    fix = "press" if name == "plate" else f"move_{name}"
    match move:
        case LinearMove():
            words = f"linear {_words(move.velocity)}"
        case RotateMove():
            axis = _words(tuple(math.copysign(1.0, move.rate) * x for x in move.unit_axis))
            period = decks.number(2 * math.pi / abs(move.rate))
            words = f"rotate origin {_words(move.origin)} axis {axis} period {period}"
        case VibrateMove():
            words = f"wiggle amplitude {_words(move.amplitude)} period {decks.number(2 * math.pi / move.omega)}"
        case PressMove():
            return f"fix_modify {wall} servo/integrate start", f"fix_modify {wall} servo/integrate stop"
    return f"fix {fix} all move/mesh mesh {wall} {words}", f"unfix {fix}"


def _pressing(p: ScenePlan, phase: Phase, steps: int) -> StopCondition | None:
    """How a phase ends early in LIGGGHTS: also by a bed without void."""
    stop = stop_condition(p, phase, steps)
    for bed in p.pressed:
        if bed.phase == phase.name:
            k, begin = bed.axis, p.triangles[bed.wall][0, 0, bed.axis]
            reference = (
                begin if _press(p, bed.wall) else torque_origin(p, bed.wall)[k]
            )  # LIGGGHTS moves it with the wall
            place = f"(f_{wall_id(p, bed.wall)}[{7 + k}]+{decks.number(begin - reference)})"
            height = f"({decks.number(bed.stop)}-{place})" if bed.sign > 0 else f"({place}-{decks.number(bed.stop)})"
            void = f"{height}-{decks.number(bed.solid_height)}"
            return replace(stop or StopCondition(0, steps // p.every, "", ""), void=void)
    return stop


def _phase_particle(p: ScenePlan, b: Body) -> PhaseParticle:
    s = b.sphere
    density, velocity = p.case.materials[s.material].density, _words(s.velocity) if any(s.velocity) else ""
    return PhaseParticle(
        f"body_{b.name}", p.model.type_of(s.material), 2 * s.radius, density, _words(s.place), 1e-3 * s.radius, velocity
    )


def parts(p: ScenePlan) -> tuple[DeckPhase, ...]:
    """The phases of a scene."""
    gates = {w.name: plane(p, w) for w in p.scene.gates}
    own_steps = any(phase.case.time_step for phase in p.phases)
    found: list[DeckPhase] = []
    begin, upto = 0, True
    before: Phase | None = None
    for phase, after in zip_longest(p.phases, p.phases[1:]):
        motions = {name: _motion(p, name, move) for name, move in phase.moves.items()}
        new = [name for name, move in phase.moves.items() if before is None or before.moves.get(name) != move]
        _refuse_other_step(p, before, phase)
        ends = [f"unfix {wall_id(p, name)}" for name in phase.gates if after and name not in after.gates]
        upto = upto and phase.case.condition is None
        part = DeckPhase(
            phase.name,
            phase.end,
            phase.end - begin,
            upto=upto,
            time_step=phase.case.time_step or p.time_step if own_steps else None,
            start_commands=tuple(motions[name][0] for name in new),
            gates=tuple(gates[name] for name in phase.gates if before is None or name not in before.gates),
            resume_gates=tuple(gates[name] for name in phase.gates),
            resume_commands=tuple(begin for begin, _ in motions.values()),
            end_commands=(
                *ends,
                *(end for name, (_, end) in motions.items() if after and not _goes_on(name, phase, after)),
            ),
            record=phase.case.record,
            particles=tuple(_phase_particle(p, b) for b in p.scene.later if b.phase == phase.name),
            power=power(p, phase) if p.writes_wall_power else "",
            vibrations=tuple(
                name for name in new if p.writes_wall_power and isinstance(phase.moves[name], VibrateMove)
            ),
            stop=_pressing(p, phase, phase.end - begin),
        )
        found.append(part)
        begin, before = phase.end, phase
    return tuple(found)


def _refuse_other_step(p: ScenePlan, before: Phase | None, phase: Phase) -> None:
    """Raise CaseError for a vibration that goes on with another time step: its power is counted in steps."""
    if before is None or not p.writes_wall_power or before.case.time_step == phase.case.time_step:
        return
    for name, move in phase.moves.items():
        if isinstance(move, VibrateMove) and before.moves.get(name) == move:
            raise CaseError(
                f"scene.phase.{phase.name}.time_step: wall {name} vibrates on from the phase before, and its work is "
                "known with one step of time only; give both phases the same one, or remove output.energy"
            )


def _goes_on(name: str, phase: Phase, after: Phase) -> bool:
    """Whether a wall needs no command at the end of a phase: the motion goes on, or another `move/mesh` replaces it."""
    one, next_one = phase.moves[name], after.moves.get(name)
    return next_one is not None and isinstance(one, PressMove) == isinstance(next_one, PressMove)


def table(p: ScenePlan) -> list[tuple[str, str]]:
    """The lines of each sphere of the table: id, type, diameter, density, place; id, velocity, spin."""
    rows = []
    for n, s in enumerate(p.scene.table, 1):
        density = p.case.materials[s.material].density
        body = f"{n} {p.model.type_of(s.material)} {_words((2 * s.radius, density), s.place)}"
        rows.append((body, f"{n} {_words(s.velocity, s.spin)}"))
    return rows
