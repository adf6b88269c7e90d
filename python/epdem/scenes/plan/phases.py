# SPDX-License-Identifier: GPL-2.0-or-later
"""Phases of a scene in steps, and how their walls slow and rest at a condition. SI."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...case.motions import FloatArray, Move, PressMove
from ...case.parts import Parts
from ...case.places import Vector3
from ...case.walls import CasePhase
from ...theory.pair import E_star
from ...theory.viscous import damping_ratio
from .model import Model

REACHED, NOT_REACHED = "reached", "not reached"  # of a phase with `until`
NO_VOID = "no void"  # of a phase at whose end a pressed bed was solid, which ends the run
LOOKED = ("held", "value", "opposite", "force")  # what a look at a condition has found
MISS = 2e-3  # of a limit, by which a force that comes near it may fall short of it
# of a limit: a wall whose force comes so near slows in proportion to what is left; beyond the limit it goes back, ten
# times slower, so that it does not swing where a step alone changes the force by as much
SLOWING = 0.1
LAG = 20  # steps within which the share of its speed follows, so that dashpots do not make it swing


@dataclass(frozen=True)
class Phase:
    """A phase of the case. end: its last step, or an earlier one if its condition is met. time_step [s]: the given one,
    or one with which the duration is a whole number of rows.

    held: the step at which `until` held, from which on its walls rest; None: before a run, or without. value, opposite:
    what was awaited at that step, and of a press the force [N] on the wall against the punch; force: on the punch,
    where a height or density was awaited. slowed: of a phase whose walls a condition stops, steps of rows, and how long
    [s] its walls would have moved at full speed to come as far; before a run empty.
    gates: walls that are present in some phases, this one among them. reached: whether `until` ended the phase, REACHED
    or NOT_REACHED; "" without `until`, or before a run; NO_VOID: a solid bed ended the run.
    """

    case: CasePhase
    end: int
    time_step: float
    gates: tuple[str, ...] = ()
    reached: str = ""
    held: int | None = None
    value: float = math.nan
    opposite: float = math.nan
    force: float = math.nan
    slowed: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())

    @property
    def slows(self) -> int | None:
        """Axis of the largest velocity of the wall whose force ends the phase: all its walls slow as the force comes
        near, see SLOWING; None: no such wall moves, or not all motions are linear."""
        return None if self.case.condition and self.case.condition.of_bed else self.measured

    @property
    def measured(self) -> int | None:
        """The same of a wall whose force, height or density ends the phase: its way is known in the run alone."""
        condition = self.case.condition
        velocity = np.abs(self.velocity(condition.wall or "")) if condition and self.stops else np.zeros(3)
        return int(velocity.argmax()) if velocity.any() else None

    @property
    def stops(self) -> bool:
        """Whether the walls rest from the step on at which a force, height or density is reached; the phase ends with
        the row."""
        condition = self.case.condition
        of_wall = condition is not None and condition.wall is not None
        return of_wall and all(move.constant_velocity for move in self.moves.values())

    @property
    def name(self) -> str:
        return self.case.name

    @property
    def moves(self) -> dict[str, Move]:
        return self.case.moves

    def velocity(self, wall: str) -> Vector3:
        """The constant velocity of a wall [m/s]."""
        move = self.moves.get(wall)
        x, y, z = (move and move.constant_velocity) or (0.0, 0.0, 0.0)
        return x, y, z


@dataclass(frozen=True, kw_only=True)
class PhaseSteps(Phase):
    """A phase between its neighbours. upto: whether its last step is known before the run. end_frames: kinds of frames
    that are due at its end beside those every N steps.
    """

    before: Phase | None
    after: Phase | None
    upto: bool
    end_frames: tuple[str, ...]

    @property
    def record(self) -> bool:
        return self.case.record

    @property
    def goes_on(self) -> bool:
        """Whether frames follow in the next phase."""
        return self.after is not None and self.after.case.record

    @property
    def steps(self) -> int:
        return self.end - (self.before.end if self.before else 0)

    @property
    def own_time_step(self) -> float | None:
        """The time step [s]; None: the time step of the phase before."""
        return self.time_step if self.before and self.before.time_step != self.time_step else None

    @property
    def added(self) -> list[str]:
        return [name for name in self.gates if self.before is None or name not in self.before.gates]

    @property
    def removed(self) -> list[str]:
        return [name for name in self.gates if self.after and name not in self.after.gates]


GAIN = 0.5  # largest n c v/F_0
COVER = 0.4  # share of a wall that the circles of the spheres in contact with it cover


def stable_speed(m: Model, scene: Parts, triangles: Mapping[str, FloatArray], count: int, move: PressMove) -> float:
    """Highest speed [m/s] of a wall with gain GAIN, if as many of `count` spheres touch it as have room; inf without
    dashpots. Each contact has its share of the force and c = 2 sqrt(5/6) zeta sqrt(2 E* a m)."""
    a, b, c = np.moveaxis(triangles[move.wall], 1, 0)
    area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    wall = m.wall_types[scene.meshes[move.wall].material] - 1
    found = math.inf
    for particles in scene.filled:
        one = m.type_of(particles.material) - 1
        sphere, other = m.types[one], m.types[wall]
        E = float(E_star(sphere.young_modulus, sphere.poisson_ratio, other.young_modulus, other.poisson_ratio))
        zeta = float(damping_ratio(m.viscous[one][wall])) if m.viscous else 0.0
        for radius in particles.radii():
            n = max(1.0, min(count, COVER * area / (math.pi * radius**2)))
            contact = (0.75 * move.force / n * radius / E) ** (1 / 3)
            mass = sphere.density * 4 / 3 * math.pi * radius**3
            damping = n * 2 * math.sqrt(5 / 6) * zeta * math.sqrt(2 * E * contact * mass)
            found = min(found, GAIN * move.force / damping if damping else math.inf)
    return found


def limited(
    m: Model, scene: Parts, triangles: Mapping[str, FloatArray], count: int, phases: Iterable[Phase]
) -> Iterator[Phase]:
    """The phases, in which no wall that a force drives touches spheres at more than its stable speed."""

    def slow(move: Move) -> Move:
        if move.press is None:
            return move
        return move.press.limited(float(f"{stable_speed(m, scene, triangles, count, move.press):.3g}"))

    for phase in phases:
        yield replace(phase, case=phase.case.model_copy(update={"move": [slow(move) for move in phase.case.move]}))
