# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes that no engine runs as they are meant, refused before anything starts."""

import math

from ..case.scene import SceneCase
from ..errors import CaseError
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
