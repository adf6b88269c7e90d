# SPDX-License-Identifier: GPL-2.0-or-later
"""Initial positions of the spheres of a scene: random, without overlap, for engines that do not insert them."""

import math
import random
from itertools import product

import numpy as np

from ...case.motions import FloatArray
from ...case.parts import Region, Sphere
from ...case.scene import SceneCase
from ...case.walls import Upright
from ...errors import CaseError
from .filling import Insertion, size_weights
from .model import Model
from .plan import ScenePlan

ATTEMPTS = 10_000  # of one sphere; at the densest filling that a scene allows some hundred are needed


def sizes(case: SceneCase, m: Model, fill: Insertion, rng: random.Random) -> list[tuple[float, int]]:
    """(radius [m], number of its type) of every sphere, size_weights by their share of the mass, the largest first."""
    classes = size_weights(case, fill.particles)
    kinds = [(radius, m.type_of(material)) for material, radius, _ in classes]
    return sorted(rng.choices(kinds, [weight for *_, weight in classes], k=fill.count), reverse=True)


def _somewhere(region: Region, radius: float, rng: random.Random) -> tuple[float, ...] | None:
    low, high = region.limits[0::2], region.limits[1::2]
    place = tuple(rng.uniform(a + radius, b - radius) for a, b in zip(low, high, strict=True))
    if isinstance(region, Upright) and math.dist(place[:2], region.center) > region.radius - radius:
        return None
    return place


def _at_once(p: ScenePlan, phase: str) -> list[Insertion]:
    return [f for f in p.insertions if f.phase == phase and f.rate is None]


def spheres(p: ScenePlan, phase: str = "") -> FloatArray:
    """(n, 12) x y z radius [m], type, velocity [m/s], spin [rad/s], 1 if frozen, of all spheres that come at the begin
    of a phase: the table, then each fill but streams.

    phase: its name, "": the first one, with which the table comes; bodies of later phases are not in here, but their
    places are free. Random sequential placement, every sphere wholly in the region of its fill. The same case has the
    same places everywhere. Raises CaseError when full.
    """
    first = p.phases[0].name
    rng = random.Random(p.case.numerics.seed)
    placed: list[tuple[float, ...]] = []
    cells: dict[tuple[int, ...], list[tuple[FloatArray, float]]] = {}
    edge = 2.0 * p.largest  # no sphere touches one beyond the next cell

    def put(row: tuple[float, ...]) -> None:
        for shift in p.scene.images:
            image = np.add(row[:3], shift)
            cells.setdefault(tuple(math.floor(x / edge) for x in image), []).append((image, row[3]))
        placed.append(row)

    def is_free(place: tuple[float, ...], radius: float) -> bool:
        cell = tuple(math.floor(x / edge) for x in place)
        near = (
            other
            for shift in product((-1, 0, 1), repeat=3)
            for other in cells.get(tuple(c + d for c, d in zip(cell, shift, strict=True)), ())
        )
        return all(math.dist(place, image) > radius + own for image, own in near)

    bodies = later_bodies(p, phase)
    for row in [*bodies, *(of_sphere(p, s) for s in p.scene.table if phase in ("", first))]:
        put(row)
    for fill in _at_once(p, phase or first):
        for radius, kind in sizes(p.case, p.model, fill, rng):
            for _ in range(ATTEMPTS):
                place = _somewhere(fill.region, radius, rng)
                if place is not None and is_free(place, radius):
                    put((*place, radius, kind, *fill.velocity, 0.0, 0.0, 0.0, 0.0))
                    break
            else:
                raise CaseError(
                    f"{fill.key} = {fill.count}: no room is left for sphere {len(placed) - len(bodies) + 1} "
                    f"without overlap after {ATTEMPTS} attempts; enlarge the box"
                )
    return np.array(placed[len(bodies) :]).reshape(-1, 12)


def later_bodies(p: ScenePlan, phase: str) -> list[tuple[float, ...]]:
    """The single spheres that come with a phase but the first, in the form of `spheres`."""
    return [of_sphere(p, b.sphere) for b in p.scene.later if b.phase == phase]


def temperatures(p: ScenePlan, phase: str) -> list[tuple[int, float | None]]:
    """(number, temperature [K] or None) of spheres that come together with a phase, in the order of their ids."""
    first = p.phases[0].name
    table = [s.temperature for s in p.scene.table] if phase == first else []
    fills = [(f.count, f.temperature) for f in _at_once(p, phase)]
    bodies = [b.temperature for b in p.scene.later if b.phase == phase]
    return [*((1, T) for T in table), *fills, *((1, T) for T in bodies)]


def of_sphere(p: ScenePlan, s: Sphere) -> tuple[float, ...]:
    """A single sphere in the form of `spheres`."""
    return (*s.place, s.radius, float(p.model.type_of(s.material)), *s.velocity, *s.spin, float(s.frozen))
