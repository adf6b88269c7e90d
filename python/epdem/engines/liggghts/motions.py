# SPDX-License-Identifier: GPL-2.0-or-later
"""Motions of walls in words of LIGGGHTS: `fix move/mesh`, the variables that it reads, the power of the wall."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ...base.rendering import number, wall_id
from ...case.motions import LinearMove, Move, PressMove, RotateMove, VibrateMove
from ...scenes.plan.meshes import surface_rotation
from ...scenes.plan.phases import Phase
from ...scenes.plan.plan import ScenePlan
from ..host import words_of_motion
from ..input_script import press_speed
from .primitives import torque

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
