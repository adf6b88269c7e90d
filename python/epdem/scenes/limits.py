# SPDX-License-Identifier: GPL-2.0-or-later
"""Limits of a scene: a scene beyond them is refused before anything starts."""

import math

import numpy as np

from ..case.motions import LinearMove, PressMove
from ..case.parts import Parts
from ..case.scene import SceneCase
from ..case.walls import ConeWall, CylinderWall, MeshWall
from ..errors import CaseError
from .meshes import FloatArray
from .timestep import highest_speed

MOST_STEPS = 2_000_000_000  # engines count steps in 32 bits


def refuse_faster_than_sound(case: SceneCase) -> None:
    """Raise CaseError for speeds above sqrt(E/rho) of a material: overlaps would exceed the radii."""
    v = highest_speed(case)
    names = {p.material for p in case.scene.filled}
    sounds = {name: math.sqrt(case.materials[name].young_modulus / case.materials[name].density) for name in names}
    name = min(sounds, key=lambda n: (sounds[n], n))
    if v > sounds[name]:
        raise CaseError(
            f"scene: speeds reach {v:.3g} m/s, faster than sound in {name} (sqrt(E/rho) = {sounds[name]:.3g} m/s); "
            "check the units of lengths, speeds, gravity and young_modulus, or give numerics.highest_speed"
        )


def refuse_steps(case: SceneCase, rows: int, duration: float, dt: float) -> None:
    """Raise CaseError for more steps than an engine counts, or fewer than rows."""
    steps = duration / dt
    if steps > MOST_STEPS:
        raise CaseError(
            f"scene: {duration:g} s are {steps:.3g} steps of {dt:g} s, at most {MOST_STEPS:g}; "
            "shorten the duration, or check its unit"
        )
    if rows > max(1.0, steps):
        raise CaseError(
            f"output.rows: {rows} rows (a multiple of output.particles), and the {duration:g} s of the run have only "
            f"{steps:.3g} steps of {dt:g} s; give fewer rows, or a longer duration"
        )


def refuse_outside(s: Parts, triangles: dict[str, FloatArray]) -> None:
    """Raise CaseError for regions and walls beyond the room."""
    low, high = np.array(s.room.limits[0::2]), np.array(s.room.limits[1::2])
    for f in s.random_fills:
        limits = np.array(f.region.limits)
        if (limits[0::2] < low).any() or (limits[1::2] > high).any():
            raise CaseError(
                f"scene.fill.{f.name}.region reaches beyond scene.room; make it smaller, or enlarge the room"
            )
    for name, corners in triangles.items():
        if (corners < low).any() or (corners > high).any():
            raise CaseError(f"scene.wall.{name}: reaches beyond scene.room; enlarge the room, or make the wall smaller")


def refuse_combinations(case: SceneCase, s: Parts) -> None:
    """Raise CaseError for parts that exclude each other."""
    gates = {w.name for w in s.gates}
    for phase in s.phase:
        if phase.until and phase.until.force is not None and phase.until.wall in gates:
            raise CaseError(
                f"scene.phase.{phase.name}.until.wall: {phase.until.wall} is a wall of some phases; name another one"
            )
    moves = [(name, move) for phase in s.phase for name, move in phase.moves.items()]
    pressed = {name for name, move in moves if isinstance(move, PressMove)}
    if both := {name for name, move in moves if name in pressed and not isinstance(move, PressMove)}:
        raise CaseError(f"scene.wall.{min(both)}: a wall that a force drives has no other motion; take a second wall")
    turning = {w.name for w in s.wall if isinstance(w, CylinderWall | ConeWall) and w.angular_velocity}
    if both := pressed & turning:
        raise CaseError(
            f"scene.wall.{min(both)}: a wall that a force drives has no angular_velocity; remove one of both"
        )
    if case.output.restarts and any(not isinstance(move, LinearMove) for _, move in moves):
        raise CaseError("output.restarts: only walls with linear motions go on where they were; remove it")
    for w in s.wall:
        if not isinstance(w, MeshWall):
            continue
        if (w.stress or w.wear) and not case.output.particles:
            raise CaseError(f"scene.wall.{w.name}: stress and wear are written with the frames; give output.particles")
        if w.wear and case.output.restarts:
            raise CaseError(
                f"output.restarts: a continued run does not know the wear of wall {w.name}; remove one of both"
            )
