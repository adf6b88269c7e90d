# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls that a force drives: the speed up to which dashpots leave the servo stable.

The speed of the wall is v (1 - F/F_0), and v is the stable one where spheres touch the wall. The force F of a step has
the dashpots' part n c times the speed of the step before, so that the speed alternates with growing amplitude where
n c v/F_0 > 1.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from ...case.motions import FloatArray, Move, PressMove
from ...case.parts import Parts
from ...theory.pair import E_star
from ...theory.viscous import damping_ratio
from .model import Model
from .phases import Phase

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
