# SPDX-License-Identifier: GPL-2.0-or-later
"""The power of walls that move, as LIGGGHTS's formula."""

from collections.abc import Sequence

from ...base import rendering as decks
from ...case.motions import LinearMove, PressMove, RotateMove, VibrateMove
from ...scenes.plan import Phase, ScenePlan
from ...scenes.walls import surface_rotation
from ..input_script import wall_id

GAIN = 1.0  # of a wall that a force drives: its speed over the highest is the relative error of the force


def _times(name: str, first: int, values: Sequence[float]) -> list[str]:
    """Products of components of a fix, from number `first` on, and values."""
    return [f"f_{name}[{first + k}]*{decks.number(v)}" for k, v in enumerate(values) if v]


def _of_servo(id: str, press: PressMove) -> str:
    """The force on a wall that a force drives, along its direction, times its speed: see GAIN; at most the highest."""
    force = f"({'+'.join(_times(id, 1, press.unit_direction))})"
    error = f"(1+{force}/{decks.number(press.force)})"
    share = f"({error}*({error}<=1)*({error}>=-1)+({error}>1)-({error}<-1))"
    return f"{force}*{share}*{decks.number(press.highest_speed)}"


def power(p: ScenePlan, phase: Phase) -> str:
    """The power of all that moves in a phase, as LIGGGHTS's formula: force and torque are those on the walls."""
    terms = []
    for name, mesh in p.scene.meshes.items():
        id, move = wall_id(p, name), phase.moves.get(name)
        for rotation in (surface_rotation(mesh), move):
            if isinstance(rotation, RotateMove):
                terms += _times(id, 4, [rotation.rate * x for x in rotation.unit_axis])
        if isinstance(move, LinearMove):
            terms += _times(id, 1, move.velocity)
        if isinstance(move, PressMove):
            terms.append(_of_servo(id, move))
        if isinstance(move, VibrateMove):
            omega = decks.number(move.omega * (phase.case.time_step or p.time_step))
            force_times_speed = "+".join(_times(id, 1, [move.omega * a for a in move.amplitude]))
            terms.append(f"({force_times_speed})*cos((step-${{begin_{name}}})*{omega})")
    return f"-({'+'.join(terms)})" if terms else "0.0"
