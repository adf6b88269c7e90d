# SPDX-License-Identifier: GPL-2.0-or-later
"""Initial positions of the spheres of a scene: random, without overlap, for engines that do not insert them."""

import math
import random
from itertools import product

import numpy as np

from ..case.scene import SceneCase
from ..errors import CaseError
from .filling import drawn
from .layout import Block
from .meshes import FloatArray
from .model import Model

ATTEMPTS = 10_000  # of one sphere; at the densest filling that a scene allows some hundred are needed


def sizes(case: SceneCase, m: Model, rng: random.Random) -> list[tuple[float, int]]:
    """(radius [m], number of its type) of every sphere, drawn by their share of the mass, the largest first."""
    classes = drawn(case, case.scene.particles)
    kinds = [(radius, m.type_of(material)) for material, radius, _ in classes]
    return sorted(rng.choices(kinds, [weight for *_, weight in classes], k=case.scene.count), reverse=True)


def spheres(case: SceneCase, m: Model, room: Block) -> FloatArray:
    """(count, 5) x, y, z, radius [m], type: random sequential placement, every sphere wholly in `room`.

    The same case has the same places everywhere. Raises CaseError when full.
    """
    rng = random.Random(case.numerics.seed)
    low, high = room.limits[0::2], room.limits[1::2]
    placed: list[tuple[float, ...]] = []
    cells: dict[tuple[int, ...], list[int]] = {}
    drawn = sizes(case, m, rng)
    edge = 2.0 * drawn[0][0]  # no sphere touches one beyond the next cell
    for radius, kind in drawn:
        for _ in range(ATTEMPTS):
            place = tuple(rng.uniform(a + radius, b - radius) for a, b in zip(low, high, strict=True))
            cell = tuple(math.floor(x / edge) for x in place)
            near = (
                k
                for shift in product((-1, 0, 1), repeat=3)
                for k in cells.get(tuple(c + d for c, d in zip(cell, shift, strict=True)), ())
            )
            if all(math.dist(place, placed[k][:3]) > radius + placed[k][3] for k in near):
                cells.setdefault(cell, []).append(len(placed))
                placed.append((*place, radius, kind))
                break
        else:
            raise CaseError(
                f"scene.count = {case.scene.count}: no room is left for sphere {len(placed) + 1} without overlap "
                f"after {ATTEMPTS} attempts; enlarge the box"
            )
    return np.array(placed)
