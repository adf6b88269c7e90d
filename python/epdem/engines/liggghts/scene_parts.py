# SPDX-License-Identifier: GPL-2.0-or-later
"""Parts of a scene in words of LIGGGHTS: walls with files and power, phases, the table of spheres, fills."""

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from ...base import rendering as decks
from ...base.rendering import number, wall_id
from ...case.motions import LinearMove, Move, PressMove, RotateMove, VibrateMove
from ...case.parts import Sphere
from ...case.walls import Room
from ...scenes.plan import filling
from ...scenes.plan.beds import PressedBed
from ...scenes.plan.meshes import surface_rotation
from ...scenes.plan.phases import Phase, PhaseSteps
from ...scenes.plan.plan import ScenePlan
from ..host import words_of_motion
from ..input_script import (
    WRITE_RESTART,
    StopCondition,
    bed_height,
    data_text,
    press_speed,
    stop_condition,
    taken_places,
    temperature_words,
    torque_origin,
)
from .primitives import Primitive, primitive, torque, tubes

Variables = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class MotionWords:
    """A motion in a phase. words: of `fix move/mesh`. variables: (name, formula), which the words read. power: terms of
    the power of the wall by its forces [W]."""

    words: str
    variables: Variables = ()
    power: tuple[str, ...] = ()


@dataclass(frozen=True)
class Start:
    """Where a motion stands: phase and wall, the phase before, whether the motion begins anew."""

    phase: Phase
    wall: str
    before: Phase | None = None
    new: bool = True

    @property
    def words(self) -> str:
        """Words of a motion whose speeds are variables."""
        return "linear/variable " + " ".join(f"v_speed_{axis}_{self.wall}" for axis in "xyz")

    def speeds(self, values: Sequence[float], formula: Callable[[str], str]) -> Variables:
        """The variables of the speeds along x, y, z, each the formula of a value; 0 stays."""
        named = zip("xyz", values, strict=True)
        return tuple((f"speed_{axis}_{self.wall}", formula(number(v)) if v else "0.0") for axis, v in named)


def vector_words(*vectors: Sequence[float]) -> str:
    """The components of vectors in a row."""
    return " ".join(number(x) if x else "0" for vector in vectors for x in vector)


def _force_times(fix: str, values: Sequence[float]) -> list[str]:
    """Products of the components of the force of a fix and values."""
    return [f"f_{fix}[{k}]*{number(v)}" for k, v in enumerate(values, 1) if v]


def _linear(m: LinearMove, start: Start) -> MotionWords:
    power = tuple(_force_times(wall_id(start.wall), m.velocity))
    if start.phase.slows is None:
        return MotionWords(f"linear {vector_words(m.velocity)}", power=power)
    return MotionWords(start.words, start.speeds(m.velocity, "{}*v_share".format), power)


def _rotate(m: RotateMove, start: Start) -> MotionWords:
    axis = vector_words(tuple(math.copysign(1.0, m.rate) * x for x in m.axis))
    period = number(2 * math.pi / abs(m.rate))
    return MotionWords(f"rotate origin {vector_words(m.origin)} axis {axis} period {period}")


def _vibrate(m: VibrateMove, start: Start) -> MotionWords:
    """variables: angle [rad] and step at the begin, and the speeds [m/s] with which each step ends where the vibration
    is (LIGGGHTS's `wiggle` adds up speeds, which is off at first order)."""
    angle, begin, dt = f"angle_{start.wall}", f"begin_{start.wall}", start.phase.time_step
    so_far = f"${{{angle}}}+(${{now}}-${{{begin}}})*{number(m.omega * start.before.time_step)}" if start.before else ""
    turn = m.omega * dt
    mean, now = 2.0 * math.sin(0.5 * turn) / dt, f"cos(${{{angle}}}+(step-${{{begin}}}"
    speeds = start.speeds([mean * a for a in m.amplitude], lambda v: f"{v}*{now}-0.5)*{number(turn)})")
    power = "+".join(_force_times(wall_id(start.wall), [m.omega * a for a in m.amplitude]))
    return MotionWords(
        start.words,
        ((angle, "0.0" if start.new else so_far), (begin, "${now}"), *speeds),
        (f"({power})*{now})*{number(turn)})",),
    )


def _press(m: PressMove, start: Start) -> MotionWords:
    force, speed = f"force_{start.wall}", f"speed_{start.wall}"

    def on_spheres(fix: str) -> str:
        return f"-({'+'.join(_force_times(fix, m.direction))})"

    before = press_speed(f"({on_spheres(f'before_{start.wall}')})", m)  # the speed of the last step
    speeds = start.speeds(m.direction, lambda u: f"v_{speed}*{u}")
    return MotionWords(
        start.words,
        ((force, on_spheres(wall_id(start.wall))), (speed, press_speed(f"v_{force}", m)), *speeds),
        (f"v_{force}*-0.5*(v_{speed}+{before})",),
    )


MOTIONS: dict[type[Move], Callable[[Any, Start], MotionWords]] = {
    LinearMove: _linear,
    RotateMove: _rotate,
    VibrateMove: _vibrate,
    PressMove: _press,
}


def motions(phase: Phase, before: Phase | None = None, new: Sequence[str] = ()) -> dict[str, MotionWords]:
    """The motion of each wall that moves in a phase; new: walls whose motions begin with it."""
    starts = {name: Start(phase, name, before, name in new) for name in phase.moves}
    return {name: words_of_motion(MOTIONS, "LIGGGHTS", phase, name)(phase.moves[name], x) for name, x in starts.items()}


def power(p: ScenePlan, phase: Phase) -> str:
    """The power of all that moves in a phase, as LIGGGHTS's formula: force and torque are those on the walls."""
    terms, moving = [], motions(phase)
    for name, mesh in p.scene.meshes.items():
        own = phase.moves[name].rotation if name in phase.moves else None
        for rotation in filter(None, (surface_rotation(mesh), own)):
            of_axis = zip(torque(p, name), rotation.axis, strict=True)
            terms += [f"({words})*{number(rotation.rate * x)}" for words, x in of_axis if x]
        terms += moving[name].power if name in moving else ()
    share = "*v_share" if phase.slows is not None and terms else ""
    return f"-({'+'.join(terms)}){share}" if terms else "0.0"


# Volumes [m^3] of a template and of a region below which LIGGGHTS refuses them without a keyword for a smaller limit.
SMALL, SMALL_ROOM, MEANT = 1e-12, 1e-10, 1e-20


@dataclass(frozen=True)
class Template:
    """A size of a fill. limit: keyword and value for a volume below LIGGGHTS's least one."""

    id: str
    seed: int
    type: int
    density: float
    radius: float
    share: float
    limit: str


@dataclass(frozen=True)
class InsertFix:
    """A `fix insert`: templates by their shares, at once or as a stream. every: steps between two; None: it is one."""

    number: int
    fill: filling.Insertion
    seed: int
    distribution_seed: int
    templates: tuple[Template, ...]
    region: str
    rate: float | None
    every: int | None


@dataclass(frozen=True)
class SurfaceMesh:
    """A wall of triangles.

    style: suffix of mesh/surface: with sums of forces. keywords: rotation and wear of the wall.
    """

    id: str
    file: str
    type: int
    style: str
    keywords: str


@dataclass(frozen=True)
class DeckPhase:
    """A phase: commands at its start and its end, and commands of a run that continues in it.

    steps: remaining ones. gates: planes that come with the phase. bodies: file of the single spheres that come with it,
    "": none do; places: formulas of the spheres that lie in their places; driven: walls that a force drives, words of
    their ways. power: formula of the power of what moves.
    speeds: (variable, formula) of walls that vibrate, that a force drives, or that slow near a force.
    restart_commands: where a restart file is due.
    """

    run: PhaseSteps
    steps: int
    start_commands: tuple[str, ...]
    gates: tuple[Primitive, ...]
    resume_gates: tuple[Primitive, ...]
    resume_commands: tuple[str, ...]
    end_commands: tuple[str, ...]
    temperatures: tuple[str, ...]
    bodies: str
    places: tuple[tuple[str, str], ...]
    driven: tuple[tuple[str, list[str]], ...]
    power: str
    speeds: tuple[tuple[str, str], ...]
    stop: StopCondition | None
    restart_commands: tuple[str, ...] = WRITE_RESTART


def primes() -> Iterator[int]:
    """Seeds that LIGGGHTS accepts: different primes above 10000."""
    n = 15485863
    while True:
        if all(n % k for k in range(3, math.isqrt(n) + 1, 2)):
            yield n
        n += 2


def _limit(volume: float, least: float) -> str:
    """Keyword and value with which LIGGGHTS takes a volume [m^3] below its least one."""
    return f" volume_limit {min(MEANT, volume / 2):.3g}" if 0 < volume < least else ""


def _region(fill: filling.Insertion) -> str:
    """The region of a fill; one with little room for the centres of its spheres has to be meant."""
    largest = max(part.radii()[1] for part in fill.particles)
    if isinstance(fill.region, Room):
        x = fill.region.limits
        style = "block " + " ".join(f"{v:.10g}" for v in x)
        centres = math.prod(max(0.0, x[k + 1] - x[k] - 2.0 * largest) for k in (0, 2, 4))
    else:
        c = fill.region
        style = f"cylinder z {c.center[0]:g} {c.center[1]:g} {c.radius:.10g} {c.z[0]:.10g} {c.z[1]:.10g}"
        centres = math.pi * (c.radius - largest) ** 2 * (c.z[1] - c.z[0] - 2.0 * largest)
    return style + _limit(centres, SMALL_ROOM)


def _templates(p: ScenePlan, fill: filling.Insertion, first: int, seeds: Iterator[int]) -> tuple[Template, ...]:
    """A template of each size of a fill."""
    sizes = [(part, radius, share) for part in fill.particles for radius, share in part.sizes()]
    return tuple(
        Template(
            id=f"template{i}",
            seed=next(seeds),
            type=p.model.type_of(part.material),
            density=p.case.materials[part.material].density,
            radius=radius,
            share=share,
            limit=_limit(4.0 / 3.0 * math.pi * radius**3, SMALL),
        )
        for i, (part, radius, share) in enumerate(sizes, first)
    )


def insertions(p: ScenePlan) -> tuple[InsertFix, ...]:
    """One `fix insert` for each fill of a scene."""
    seeds = itertools.islice(primes(), 100 * (p.case.numerics.seed - 1), None)
    result: list[InsertFix] = []
    first = 1
    steps = {phase.name: phase.time_step for phase in p.phases}
    for i, fill in enumerate(p.insertions, 1):
        templates = _templates(p, fill, first, seeds)
        first += len(templates)
        step = steps[fill.phase]
        result.append(
            InsertFix(
                number=i,
                fill=fill,
                seed=next(seeds),
                distribution_seed=next(seeds),
                templates=templates,
                region=_region(fill),
                # insert/pack counts what is in the region before it; a stream faster than a step does not
                rate=float(f"{2 * fill.count / step:.2g}") if fill.exact else fill.rate,
                every=None if fill.rate is None and not fill.exact else max(1, math.ceil(fill.period / step)),
            )
        )
    return tuple(result)


def _way(p: ScenePlan, name: str) -> list[str]:
    """The way of a wall, with which LIGGGHTS moves the point of its torque."""
    return [f"$(f_{decks.wall_id(name)}[{k}]-({decks.number(x)}))" for k, x in enumerate(torque_origin(p, name), 7)]


def surface_meshes(p: ScenePlan) -> tuple[SurfaceMesh, ...]:
    """The walls of triangles."""
    pressed, formulas = {name for bed in p.pressed for name in (bed.wall, bed.against)}, tubes(p)
    found = []
    for name, mesh in p.scene.meshes.items():
        if name in formulas:
            continue
        rotation, words = surface_rotation(mesh), ""
        measured = p.row_columns or name in p.measured_walls or name in pressed
        style = "/stress" if measured or mesh.stress or mesh.wear else ""
        origin = torque_origin(p, name)
        if rotation is not None:  # LIGGGHTS takes the words in this order only
            axis, omega = " ".join(f"{x:g}" for x in rotation.axis), decks.number(rotation.rate)
            words = f" surface_ang_vel origin {vector_words(rotation.origin)} axis {axis} omega {omega}"
        if style and any(origin):
            words += f" reference_point {vector_words(origin)}"
        if mesh.wear:
            words += " wear finnie"
        found.append(SurfaceMesh(decks.wall_id(name), f"{name}.stl", p.wall_types[name], style, words))
    return tuple(found)


def _height(p: ScenePlan, bed: PressedBed) -> str:
    k = bed.axis

    def place(name: str) -> str:
        begin, reference = p.triangles[name][0, 0, k], torque_origin(p, name)[k]  # LIGGGHTS moves it with the wall
        return f"(f_{decks.wall_id(name)}[{7 + k}]+{decks.number(begin - reference)})"

    return bed_height(bed, place)


def _force(p: ScenePlan, name: str, k: int) -> str:
    """A component of the force on a wall at a step; of a primitive one as rows have it."""
    if name in p.scene.meshes and name not in tubes(p):
        return f"f_{decks.wall_id(name)}[{k}]"
    return f"c_load{1 + p.measured_walls.index(name)}[{k}]"


def phases(p: ScenePlan) -> tuple[DeckPhase, ...]:
    """The phases of a scene."""
    gates = {w.name: primitive(p, w, force=bool(p.contacts)) for w in p.scene.gates}
    found: list[DeckPhase] = []
    with_power = "wall_power" in p.row_columns
    for run in p.phase_steps:
        before, after = run.before, run.after
        rests = before is not None and before.stops  # all walls
        anew = before is None or rests or run.slows is not None
        new = [name for name, x in run.moves.items() if anew or (before and before.moves.get(name) != x)]
        words = motions(run, before, new)
        start = {
            name: f"fix move_{name} all move/mesh mesh {decks.wall_id(name)} {x.words}" for name, x in words.items()
        }
        stop = [f"unfix move_{name}" for name in words] if run.stops else []
        if stop and with_power:
            still = replace(run, case=run.case.model_copy(update={"move": []}))
            stop.append(f"variable power equal {power(p, still)}")
        part = DeckPhase(
            run=run,
            steps=run.steps,
            start_commands=tuple(start[name] for name in new),
            gates=tuple(gates[name] for name in run.added),
            resume_gates=tuple(gates[name] for name in run.gates),
            resume_commands=tuple(start.values()),
            end_commands=(
                *(f"unfix {decks.wall_id(name)}" for name in run.removed),
                *(f"unfix move_{name}" for name in words if after and not (run.stops or name in after.moves)),
            ),
            temperatures=temperature_words(p, run.name, ((1, s.temperature) for s in _given(p, run.name))),
            bodies=bodies_file(run.name) if any(b.phase == run.name for b in p.scene.later) else "",
            places=taken_places(p, run.name, "r"),
            driven=tuple((name, _way(p, name)) for name in p.driven_before(run.name)),
            power=power(p, run) if with_power else "",
            speeds=(*[("share", "1.0")] * (run.slows is not None), *(v for x in words.values() for v in x.variables)),
            stop=stop_condition(p, run, partial(_height, p), partial(_force, p), stop),
            restart_commands=WRITE_RESTART,
        )
        found.append(part)
    return tuple(found)


def bodies_file(phase: str) -> str:
    """Name of the data file of the spheres with given places that come with a phase but the first."""
    return f"phase_{phase}.data"


def data(p: ScenePlan) -> dict[str, str]:
    """The data files of the spheres with given places: those of the table, and those that come with each phase.

    Ids of later ones follow those of all earlier spheres, also of lost ones.
    """
    names = [phase.name for phase in p.phases]
    given = {bodies_file(name): (_given(p, name), p.count_before(name)) for name in names[1:]}
    given = {"spheres.data": (_given(p, names[0]), 0)} | given
    return {name: _data(p, spheres, before) for name, (spheres, before) in given.items() if spheres}


def _given(p: ScenePlan, phase: str) -> Sequence[Sphere]:
    """The spheres with given places that come with a phase."""
    first = phase == p.phases[0].name
    return p.scene.table if first else [b.sphere for b in p.scene.later if b.phase == phase]


def _data(p: ScenePlan, spheres: Sequence[Sphere], before: int) -> str:
    typed = ((p.model.type_of(s.material), s) for s in spheres)
    rows = [(k, 2 * s.radius, p.model.types[k - 1].density, *s.place, *s.velocity, *s.spin) for k, s in typed]
    return data_text(f"spheres of {p.case.case.title}", len(p.model.types), p.box, rows, before + 1)
