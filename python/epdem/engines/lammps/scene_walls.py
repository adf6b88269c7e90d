# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls of a scene as fixes over planes and regions of LAMMPS, and the variables that move the regions."""

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ...base.declarations import declarations
from ...base.rendering import number, wall_id
from ...case.motions import LinearMove, Move, PressMove, RotateMove, VibrateMove
from ...case.walls import BoxWall, ConeWall, CylinderWall, MeshWall, PlaneWall, PlateWall, RevolvedWall, StlWall
from ...jobs.engine import Unsupported
from ...laws.strengths import ADHESION
from ...scenes.plan import placement
from ...scenes.plan.beds import PressedBed
from ...scenes.plan.meshes import spans, surface_rotation
from ...scenes.plan.model import Model
from ...scenes.plan.phases import Phase
from ...scenes.plan.plan import ScenePlan
from ..host import refuse, words_of_motion
from ..input_script import WRITE_RESTART, bed_height, finite, press_speed


def of_type(m: Model, i: int) -> str:
    """The material of type i, from 1: LAW E nu PARAMETERS, SI."""
    t, declared = m.types[i - 1], declarations()[m.law]
    values = m.parameters | ({declared.strength: finite(t.strength)} if declared.strength else {})
    values |= {ADHESION: m.adhesion[i - 1][i - 1]} if m.adheres else {}
    numbers = (finite(t.young_modulus), t.poisson_ratio, *(values[p.name] for p in declared.parameters))
    return " ".join([m.law, *map(number, numbers)])


def options(m: Model, i: int, j: int) -> str:
    """The options of contacts of types i and j, from 1; "" without any."""
    words = []
    if m.sliding:
        words += ["tangential", m.tangential, number(m.friction[i - 1][j - 1])]
    if m.viscous is not None:
        both = not m.sliding or m.tangential_restitution is not None
        words += ["restitution" if both else "normal_restitution", number(m.viscous[i - 1][j - 1])]
    elif m.tangential_restitution is not None:
        words += ["tangential_restitution", number(m.tangential_restitution)]
    if m.rolling:
        words += ["rolling", m.rolling.model, number(m.rolling.coefficient)]
    if m.attraction:
        words += ["cohesion", m.attraction[0], number(m.attraction[1])]
    if m.compaction:
        words += ["compaction", "on"]
    return " ".join(words)


@dataclass(frozen=True)
class DeckWall:
    """A wall. regions: commands before its fix. where: what the fix acts on. contact: material and options."""

    id: str
    regions: tuple[str, ...]
    where: str
    contact: str


def contact(p: ScenePlan, name: str) -> str:
    """Material and options of the contacts with a wall. Raises CaseError if they differ between types of spheres."""
    wall = p.wall_types[name]
    spheres = [i for i, t in enumerate(p.model.types, 1) if not t.wall]
    found = {options(p.model, i, wall) for i in spheres}
    if len(found) > 1:
        raise Unsupported(
            f"contact.pairs: a wall in LAMMPS has one contact with all spheres, wall {name} has {len(found)}",
            "give the wall the same friction and restitution with all materials",
        )
    return f"{of_type(p.model, wall)} {found.pop()}".rstrip()


def plane(p: ScenePlan, w: PlaneWall) -> DeckWall:
    """A plane, which acts on both sides."""
    at = number(w.at)
    return DeckWall(wall_id(w.name), (), f"wall/ep {w.axis}plane {at} {at}", contact(p, w.name))


def meshes(p: ScenePlan) -> tuple[DeckWall, ...]:
    """The walls that are no planes, as regions or triangles. Raises CaseError for what no wall of LAMMPS is."""
    found = []
    for name, mesh in p.scene.meshes.items():
        id, motion = wall_id(name), _motion_words(p, name)
        if isinstance(mesh, StlWall) or name in p.stress_walls:
            wear = f"wear {number(mesh.wear)}" if mesh.wear else ""
            where = " ".join(filter(None, [f"wall/ep mesh {name}.stl", motion, wear]))
            found.append(DeckWall(id, (), where, contact(p, name)))
            continue
        shapes = list(_shapes(p, mesh))
        ends = " ".join(filter(None, [motion, "units box"]))
        if len(shapes) == 1:
            regions = [f"region {id} {shapes[0]} {ends}"]
        else:
            names = [f"part{k}_{id}" for k in range(1, len(shapes) + 1)]  # the id of no wall begins with part
            regions = [f"region {part} {shape} units box" for part, shape in zip(names, shapes, strict=True)]
            regions.append(f"region {id} union {len(shapes)} {' '.join(names)} {ends}")
        found.append(DeckWall(id, tuple(regions), f"wall/ep/region {id}", contact(p, name)))
    return tuple(found)


def _shapes(p: ScenePlan, w: MeshWall) -> Iterator[str]:
    """Style and numbers of the regions of a wall."""
    match w:
        case PlateWall():
            yield f"block {' '.join(_plate(p, w))} side out"
        case BoxWall():
            faces = ["-x", "+x", "-y", "+y", "-z", "+z"]
            limits = _numbers((*w.x, *w.y, *w.z))
            yield f"block {limits}{_open(1 + faces.index(side) for side in w.open) or _side(p, w)}"
        case CylinderWall() | ConeWall():
            style = "cylinder" if isinstance(w, CylinderWall) else "cone"
            radii = sorted({d / 2 for d in w.diameters_of_ends()}) if style == "cylinder" else _halves(w)
            numbers = _numbers((*w.center, *radii, w.start, w.to))
            opened = _open(k for k, end in enumerate(("from", "to"), 1) if end not in w.ends)
            yield f"{style} {w.axis} {numbers}{opened or _side(p, w)}"
        case RevolvedWall():
            for one, two in itertools.pairwise(w.profile):
                (low_radius, low), (high_radius, high) = sorted((one, two), key=lambda point: point[1])
                refuse(f"scene.wall.{w.name}.profile", low == high, "a flat ring is no region of LAMMPS")
                round_ = (low_radius,) if low_radius == high_radius else (low_radius, high_radius)
                style = "cylinder" if len(round_) == 1 else "cone"
                yield f"{style} z {_numbers((*w.center, *round_, low, high))}{_open((1, 2))}"


def _halves(w: CylinderWall | ConeWall) -> tuple[float, ...]:
    return tuple(d / 2 for d in w.diameters_of_ends())


def _plate(p: ScenePlan, w: PlateWall) -> Iterator[str]:
    """The limits of a flat block; where the room repeats and the plate is as wide, it has no edges."""
    sizes = iter(w.size)
    for axis, center in zip("xyz", w.center, strict=True):
        half = 0.0 if axis == w.axis else next(sizes) / 2
        endless = p.scene.periods["xyz".index(axis)] and axis != w.axis and spans(w, axis, p.box)
        yield "INF INF" if endless else _numbers((center - half, center + half))


def _open(faces: Iterable[int]) -> str:
    return "".join(f" open {face}" for face in faces)


def _side(p: ScenePlan, w: BoxWall | CylinderWall | ConeWall) -> str:
    """Which side of a closed wall the spheres are on, because a region without openings acts on one side."""
    inside = {_holds(w, row[:3]) for phase in p.phases for row in placement.spheres(p, phase.name).tolist()}
    inside |= {_holds(w, list(b.position)) for b in p.scene.later}
    if len(inside) > 1:
        raise Unsupported(f"scene.wall.{w.name}: a closed wall in LAMMPS has spheres on one side, and this one on both")
    return " side in" if inside == {True} else " side out"


def _holds(w: BoxWall | CylinderWall | ConeWall, place: Sequence[float]) -> bool:
    if isinstance(w, BoxWall):
        return all(low < x < high for x, (low, high) in zip(place, (w.x, w.y, w.z), strict=True))
    along = "xyz".index(w.axis)
    share = (place[along] - w.start) / (w.to - w.start)
    first, last = _halves(w)
    off = [x - c for k, (x, c) in enumerate(zip(place, w.axis_point, strict=True)) if k != along]
    return 0 < share < 1 and off[0] ** 2 + off[1] ** 2 < (first + share * (last - first)) ** 2


def _numbers(values: Iterable[float]) -> str:
    return " ".join(map(number, values))


@dataclass(frozen=True)
class MotionWords:
    """The motion of a wall. way: formula of each component of its way [m]. T is the time of the motion [s], of a wall
    that slows as if it did not; of a wall that a force drives its way [m]. power: formula of the power [W]. servo:
    commands by which a force drives the wall."""

    way: dict[str, str]
    power: str
    servo: tuple[str, ...] = ()


def _along(vector: Sequence[float], formula: str) -> dict[str, str]:
    return {axis: f"{number(x)}*{formula}" for axis, x in zip("xyz", vector, strict=True) if x}


def _force_times(id: str, values: Sequence[float]) -> str:
    return "+".join(f"f_{id}[{k}]*{number(x)}" for k, x in enumerate(values, 1) if x)


def _linear(m: LinearMove, id: str, dt: float) -> MotionWords:
    return MotionWords(_along(m.velocity, "T"), f"f_{id}[7]")


def _rotate(m: RotateMove, id: str, dt: float) -> MotionWords:
    return MotionWords({}, f"f_{id}[7]")


def _vibrate(m: VibrateMove, id: str, dt: float) -> MotionWords:
    # (sin(wt + wdt) - 2 sin(wt) + sin(wt - wdt))/2 = (cos(wdt) - 1) sin(wt)
    change, omega = (math.cos(m.omega * dt) - 1.0) / dt, number(m.omega)
    force = _force_times(id, [a * change for a in m.amplitude])
    power = f"f_{id}[7]+({force})*sin({omega}*(time-v_{id}_begin))"
    return MotionWords(_along(m.amplitude, f"sin({omega}*T)"), power)


def _press(m: PressMove, id: str, dt: float) -> MotionWords:
    servo = (
        f"variable {id}_force equal {_force_times(id, m.direction)}",
        f"variable {id}_speed equal {press_speed(f'v_{id}_force', m)}",
        f"fix press_{id} all travel/ep {id}_speed {id}_way",
    )
    return MotionWords(_along(m.direction, "T"), f"0.5*(f_{id}[7]+v_{id}_force*v_{id}_speed)", servo)


MOTIONS: dict[type[Move], Callable[[Any, str, float], MotionWords]] = {
    LinearMove: _linear,
    RotateMove: _rotate,
    VibrateMove: _vibrate,
    PressMove: _press,
}


def _words(name: str, phase: Phase) -> MotionWords:
    """The motion of a wall in a phase; of a wall at rest nothing but its power, by the speed of its surface."""
    if name not in phase.moves:
        return MotionWords({}, f"f_{wall_id(name)}[7]")
    words = words_of_motion(MOTIONS, "LAMMPS", phase, name)
    return words(phase.moves[name], wall_id(name), phase.time_step)


def _rates(p: ScenePlan, name: str, phase: Phase) -> dict[str, str]:
    """Changes of a wall in a phase: component of the way [m] or turn [rad], and its formula of T."""
    own = phase.moves[name].rotation if name in phase.moves else None
    turns = filter(None, (surface_rotation(p.scene.meshes[name]), own))
    rate = sum(turn.rate for turn in turns)
    return _words(name, phase).way | ({"turn": f"{number(float(rate))}*T"} if rate else {})


def _changing(p: ScenePlan, name: str) -> list[str]:
    every = set().union(*(_rates(p, name, phase) for phase in p.phases))
    return [key for key in ("x", "y", "z", "turn") if key in every]


def _motion_words(p: ScenePlan, name: str) -> str:
    keys, id, found = _changing(p, name), wall_id(name), []
    if {*keys} & {*"xyz"}:
        found.append("move " + " ".join(f"v_{id}_{axis}" if axis in keys else "NULL" for axis in "xyz"))
    if "turn" in keys:
        axes = {(tuple(r.axis), tuple(r.origin)) for r in p.rotations(name)}
        refuse(f"scene.wall.{name}", len(axes) > 1 and "several axes", "a region of LAMMPS turns about one")
        axis, origin = axes.pop()
        shifted = False  # across the axis
        for phase in p.phases:
            turns = name in phase.moves and phase.moves[name].rotation
            reason = "a region of LAMMPS takes the axis along, and a motion before shifts the wall across it"
            refuse(f"scene.phase.{phase.name}.move", shifted and turns and "rotate", reason)
            rates = _rates(p, name, phase)
            shifted |= any(key in rates and abs(share) < 1 for key, share in zip("xyz", axis, strict=True))
        found.append(f"rotate v_{id}_turn {_numbers(origin)} {_numbers(axis)}")
    return " ".join(found)


def _begin(p: ScenePlan, name: str, number: int) -> int:
    """The number of the phase in which a wall got the motion that it has in the phase of a number."""
    moves = [phase.moves.get(name) for phase in p.phases]
    if moves[number] and p.phases[number].slows is not None:
        return number
    while number and moves[number] == moves[number - 1] and not (moves[number] and p.phases[number - 1].stops):
        number -= 1
    return number


def _state(p: ScenePlan, name: str, number: int) -> dict[str, str]:
    """Variables, and their styles, that hold where and when the motion of a wall in a phase began, and its way."""
    keys, id = _changing(p, name), wall_id(name)
    places = [f"{id}_{key}0" for key in keys] if _begin(p, name, number) else []
    found = dict.fromkeys([f"{id}_begin", *places] if keys else [], "equal")
    return found | ({f"{id}_way": "internal"} if _controlled(p.phases[number], name) else {})


def _controlled(phase: Phase, name: str) -> bool:
    """Whether a force controls the speed of a wall: that drives it, or near which it slows."""
    return name in phase.moves and (phase.slows is not None or phase.moves[name].press is not None)


def _formulas(p: ScenePlan, name: str, number: int) -> Iterator[str]:
    """Commands that tie a wall to its motion in a phase."""
    id, phase = wall_id(name), p.phases[number]
    servo, rates = _words(name, phase).servo, _rates(p, name, phase)
    time = f"(time-v_{id}_begin)"
    way = f"v_{id}_way" if _controlled(phase, name) else time
    for key in _changing(p, name):
        formula = rates[key].replace("T", time if key == "turn" else way) if key in rates else ""
        terms = [f"v_{id}_{key}0"] * (_begin(p, name, number) > 0) + [formula] * bool(formula)
        yield f"variable {id}_{key} equal {'+'.join(terms) or '0.0'}"
    yield from servo
    if _controlled(phase, name) and not servo:
        yield "variable share equal 1.0"
        yield f"fix press_{id} all travel/ep share {id}_way"


def motions(p: ScenePlan, number: int) -> list[str]:
    """Commands that set the walls of triangles in motion at the begin of the phase of a number, or stop them."""
    found = []
    for name in p.scene.meshes:
        keys, id = _changing(p, name), wall_id(name)
        if not keys or _begin(p, name, number) != number:
            continue
        if number and _controlled(p.phases[number - 1], name):
            found.append(f"unfix press_{id}")
        if number:  # the place so far, before the time of the motion begins anew
            found += [f"variable {id}_{key}0 equal $(v_{id}_{key}:%.17g)" for key in keys]
        found.append(f"variable {id}_begin equal $(time:%.17g)")
        if _controlled(p.phases[number], name):
            found.append(f"variable {id}_way internal 0.0")
        found += _formulas(p, name, number)
    return found


def power(p: ScenePlan, phase: Phase) -> str:
    """Formula of the power of all that moves in a phase: forces times the speeds at their time.

    Number 7 of a wall is its power by the speed of the last step; half of the change to the speed of the next is added.
    """
    return "+".join(_words(name, phase).power for name in p.scene.meshes)


def motions_again(p: ScenePlan, number: int, values: Mapping[str, str]) -> list[str]:
    """Commands that continue the motions of a phase from the values of their variables."""
    found = []
    for name in p.scene.meshes:
        styles = _state(p, name, number)
        found += [f"variable {variable} {style} {values[variable]}" for variable, style in styles.items()]
        found += _formulas(p, name, number) if styles else []
    return found


def restart_commands(p: ScenePlan, number: int) -> tuple[str, ...]:
    """Commands where a restart file is due in a phase: they print the variables of motions, which the file lacks."""
    names = [variable for name in p.scene.meshes for variable in _state(p, name, number)]
    values = " ".join(f"{name}=$(v_{name}:%.17g)" for name in names)
    return (f"print 'motions at step $(step): {values}'",) * bool(names) + WRITE_RESTART


def height(p: ScenePlan, bed: PressedBed) -> str:
    """Formula of the height of a bed between plates."""
    begin = {w.name: w.center[bed.axis] for w in p.scene.wall if isinstance(w, PlateWall)}
    key = "xyz"[bed.axis]

    def place(name: str) -> str:
        moved = f"v_{wall_id(name)}_{key}+" if key in _changing(p, name) else ""
        return f"({moved}{number(begin[name])})"

    return bed_height(bed, place)


def way(p: ScenePlan, name: str) -> list[str]:
    """The way of a wall along x, y and z between two runs."""
    keys = _changing(p, name)
    return [f"$(v_{wall_id(name)}_{axis}:%.17g)" if axis in keys else "0" for axis in "xyz"]


def stop_commands(p: ScenePlan, phase: Phase) -> list[str]:
    """Commands that leave the walls that move in a phase where they are."""
    names = [f"{wall_id(name)}_{key}" for name in phase.moves for key in _changing(p, name)]
    return [f"variable {name} equal $(v_{name}:%.17g)" for name in names]


def force(name: str, k: int) -> str:
    """A component of the force on a wall at a step."""
    return f"f_{wall_id(name)}[{k}]"
