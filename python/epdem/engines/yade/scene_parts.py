# SPDX-License-Identifier: GPL-2.0-or-later
"""What scenes of parts have in YADE: facets, motions of walls, spheres of a table; and what they cannot have."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from ...base import rendering as decks
from ...case.motions import LinearMove, Move, PressMove, RotateMove, VibrateMove
from ...case.parts import Parts
from ...errors import CaseError
from ...scenes.plan import Phase, ScenePlan
from ...scenes.walls import surface_rotation
from ..host import refuse as refuse_value

EDGES = (
    "walls of triangles: YADE counts a sphere that touches an edge once for each triangle there, so that its force is "
    "up to twice as large near the inner edges of flat walls"
)


@dataclass(frozen=True)
class Facets:
    """A wall of triangles: `file` holds their corners; material: its number."""

    name: str
    file: str
    material: int


@dataclass(frozen=True)
class Motion:
    """What moves a wall in a phase: a velocity [m/s], an amplitude [m] with omega [rad/s], or a turn."""

    wall: str
    velocity: Sequence[float] | None = None
    amplitude: Sequence[float] | None = None
    omega: float = 0.0
    axis: Sequence[float] | None = None
    origin: Sequence[float] | None = None
    rate: float = 0.0


@dataclass(frozen=True)
class Load:
    """A wall whose mean force is in the rows; of facets the torque about `origin` [m], too."""

    name: str
    origin: Sequence[float] | None


def refuse(p: ScenePlan, s: Parts) -> None:
    """Raise CaseError for what a scene of parts has in LIGGGHTS only."""
    first = p.phases[0].name
    unknown: dict[str, object] = {
        "scene.periodic": s.periodic,
        "scene.open_boundary": s.open_boundary,
        **{f"{f.key}.rate": f.rate for f in p.insertions},
        **{f"{f.key}.phase": f.phase != first and f.phase for f in p.insertions},
        **{f"scene.body.{b.name}.phase": b.phase for b in p.scene.later},
        **{f"scene.wall.{w.name}.phases": _comes(p, w.name) and w.phases for w in p.scene.gates},
        **{f"scene.phase.{phase.name}.until": phase.case.condition is not None for phase in p.phases},
        **{f"scene.wall.{name}.stress": mesh.stress for name, mesh in p.scene.meshes.items()},
        **{f"scene.wall.{name}.wear": mesh.wear for name, mesh in p.scene.meshes.items()},
    }
    for phase in p.phases:
        for name, move in phase.moves.items():
            unknown[f"scene.phase.{phase.name}.move of {name}"] = "press" if isinstance(move, PressMove) else None
            if surface_rotation(p.scene.meshes[name]):
                raise CaseError(
                    f"scene.wall.{name}.angular_velocity: YADE turns the wall itself, which moves otherwise; remove one"
                )
    for place, value in unknown.items():
        refuse_value(place, value, "a scene in YADE does not have it")


def _comes(p: ScenePlan, gate: str) -> bool:
    """Whether a wall that is present in some phases is absent before one of them."""
    present = [gate in phase.gates for phase in p.phases]
    return present != sorted(present, reverse=True)


def removed(p: ScenePlan) -> list[list[str]]:
    """The walls that disappear at the begin of each phase."""
    gates = [(), *(phase.gates for phase in p.phases)]
    return [[name for name in old if name not in new] for old, new in pairwise(gates)]


def unrecorded(p: ScenePlan) -> list[tuple[int, int]]:
    """(step, step) between which no frames are written."""
    found: list[tuple[int, int]] = []
    for begin, phase in zip([0, *(phase.end for phase in p.phases)], p.phases, strict=False):
        if not phase.case.record:
            found.append((found.pop()[0] if found and found[-1][1] == begin else begin, phase.end))
    return found


def _file(name: str) -> str:
    return f"wall_{name}.txt"


def facets(p: ScenePlan) -> tuple[Facets, ...]:
    """The walls of triangles."""
    return tuple(Facets(name, _file(name), p.wall_types[name] - 1) for name in p.scene.meshes)


def _motion(name: str, move: Move) -> Motion:
    match move:
        case LinearMove():
            return Motion(name, velocity=move.velocity)
        case VibrateMove():
            return Motion(name, amplitude=move.amplitude, omega=move.omega)
        case RotateMove():
            return Motion(name, axis=move.unit_axis, origin=move.origin, rate=move.rate)
    raise AssertionError(move)  # a press is refused


def motions(p: ScenePlan, phase: Phase) -> tuple[Motion, ...]:
    """What moves in a phase. A surface that turns is a wall of revolution that turns."""
    found = {name: rotation for name, mesh in p.scene.meshes.items() if (rotation := surface_rotation(mesh))}
    return tuple(_motion(name, move) for name, move in (found | phase.moves).items())


def loads(p: ScenePlan) -> tuple[Load, ...]:
    """The walls whose forces are in the rows; torques are about the axis of a wall's turn, else about 0."""
    origins = {name: [rotation.origin for rotation in p.rotations(name)] for name in p.scene.meshes}
    return tuple(Load(name, [*origins[name], (0.0, 0.0, 0.0)][0] if name in origins else None) for name in p.loads)


def files(p: ScenePlan) -> dict[str, str]:
    """The corners of each wall's triangles by file."""
    texts = {}
    for name, triangles in p.triangles.items():
        lines = [" ".join(map(decks.number, row)) for row in triangles.reshape(-1, 9).tolist()]
        texts[_file(name)] = "\n".join(["# corners of a triangle, x y z of each [m]", *lines, ""])
    return texts
