# SPDX-License-Identifier: GPL-2.0-or-later
"""What is filled into a scene: spheres by size and material, at once or as a stream, with their random numbers."""

import itertools
import math
from dataclasses import dataclass

import numpy as np

from ..case.scene import SceneCase
from ..errors import CaseError
from .model import Model

SMALL = 1e-12  # volume [m^3] below which LIGGGHTS refuses a template unless told
MOST_FILLED = 0.26  # volume share that LIGGGHTS's random insertion reaches with its own number of attempts


@dataclass(frozen=True)
class Template:
    """A particle template; `small`: LIGGGHTS wants to be told that its volume is meant."""

    id: str
    seed: int
    type: int
    density: float
    radius: float
    share: float
    small: bool


@dataclass(frozen=True)
class Insertion:
    """One `fix insert`: a distribution of templates, filled into a region at once or as a stream."""

    id: str
    seed: int
    distribution: str
    distribution_seed: int
    templates: tuple[Template, ...]
    region: str
    count: int
    rate: float | None = None
    every: int | None = None
    velocity: float = 0.0
    phase: str = ""


def primes():
    """Seeds as LIGGGHTS wants them: different primes above 10000."""
    n = 15485863
    while True:
        if all(n % k for k in range(3, math.isqrt(n) + 1, 2)):
            yield n
        n += 2


def _templates(parts, m: Model, case: SceneCase, first: int, seeds) -> tuple[Template, ...]:
    sizes = [(p, radius, share) for p in parts for radius, share in p.sizes()]
    return tuple(
        Template(
            f"template{i}",
            next(seeds),
            m.type_of(p.material),
            case.materials[p.material].density,
            radius,
            share,
            4.0 / 3.0 * math.pi * radius**3 < SMALL,
        )
        for i, (p, radius, share) in enumerate(sizes, first)
    )


def _mean_volume(parts, case: SceneCase) -> float:
    """Mean volume [m^3] of a sphere when the sizes are drawn by their share of the mass."""
    sizes = [(case.materials[p.material].density, radius, share) for p in parts for radius, share in p.sizes()]
    volumes = [4.0 / 3.0 * math.pi * radius**3 for _, radius, _ in sizes]
    weights = [share / (rho * v) for (rho, _, share), v in zip(sizes, volumes, strict=True)]
    return float(np.average(volumes, weights=weights))


def _fits(place: str, count: int, parts, case: SceneCase, volume: float, limit: float = MOST_FILLED) -> None:
    share = count * _mean_volume(parts, case) / volume
    if share > limit:
        most = int(count * limit / share)
        raise CaseError(
            f"{place} = {count}: the spheres would fill {share:.0%} of the room that they are poured into, "
            f"at most {limit:.0%} ({most} spheres); enlarge the room"
        )


def insertions(case: SceneCase, m: Model, fills, first_phase: str, dt: float) -> tuple[Insertion, ...]:
    """The insertions of a scene's fills. Raises CaseError for more spheres than their room takes."""
    seeds = itertools.islice(primes(), 100 * (case.numerics.seed - 1), None)
    found, first = [], 1
    for i, fill in enumerate(fills, 1):
        templates = _templates(fill.parts, m, case, first, seeds)
        first += len(templates)
        if fill.room is not None:
            _fits(fill.place, fill.count, fill.parts, case, fill.room)
        interval = None if fill.rate is None else max(1, math.ceil(fill.every / dt))
        found.append(
            Insertion(
                f"fill{i}",
                next(seeds),
                f"mix{i}",
                next(seeds),
                templates,
                fill.region,
                fill.count,
                fill.rate,
                interval,
                fill.velocity,
                fill.phase or first_phase,
            )
        )
    return tuple(found)
