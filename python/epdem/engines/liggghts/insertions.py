# SPDX-License-Identifier: GPL-2.0-or-later
"""Fills of a scene in LIGGGHTS: templates of spheres, their distribution, one `fix insert`, with random numbers."""

import itertools
import math
from collections.abc import Iterator

from ...base.rendering import Deck
from ...case.walls import Room
from ...scenes import filling
from ...scenes.plan import ScenePlan

# Volumes [m^3] of a template and of a region below which LIGGGHTS refuses them without a keyword for a smaller limit.
SMALL, SMALL_ROOM, MEANT = 1e-12, 1e-10, 1e-20


def primes() -> Iterator[int]:
    """Seeds that LIGGGHTS accepts: different primes above 10000."""
    n = 15485863
    while True:
        if all(n % k for k in range(3, math.isqrt(n) + 1, 2)):
            yield n
        n += 2


def _limit(volume: float, least: float) -> str:
    """The words that let LIGGGHTS take a volume [m^3] below its least one."""
    return f" volume_limit {min(MEANT, volume / 2):.3g}" if 0 < volume < least else ""


def _region(fill: filling.Insertion) -> str:
    """The region of a fill; one with little room for the centres of its spheres has to be meant."""
    largest = max(part.radii()[1] for part in fill.particles)
    if isinstance(fill.region, Room):
        x = fill.region.limits
        style = "block " + " ".join(f"{v:.10g}" for v in x)
        centres = math.prod(max(0.0, x[k + 1] - x[k] - 2.0 * largest) for k in (0, 2, 4))
    else:
        c = fill.region
        style = f"cylinder z {c.center[0]:g} {c.center[1]:g} {c.radius:.10g} {c.z[0]:.10g} {c.z[1]:.10g}"
        centres = math.pi * (c.radius - largest) ** 2 * (c.z[1] - c.z[0] - 2.0 * largest)
    return style + _limit(centres, SMALL_ROOM)


def _templates(p: ScenePlan, fill: filling.Insertion, first: int, seeds: Iterator[int]) -> list[Deck]:
    """A template of each size of a fill. limit: the words for a tiny volume, if the template has one."""
    sizes = [(part, radius, share) for part in fill.particles for radius, share in part.sizes()]
    return [
        Deck(
            part,
            id=f"template{i}",
            seed=next(seeds),
            type=p.model.type_of(part.material),
            density=p.case.materials[part.material].density,
            radius=radius,
            share=share,
            limit=_limit(4.0 / 3.0 * math.pi * radius**3, SMALL),
        )
        for i, (part, radius, share) in enumerate(sizes, first)
    ]


def insertions(p: ScenePlan) -> tuple[Deck, ...]:
    """One `fix insert` for each fill of a scene: a distribution of templates, at once or as a stream.

    once: in one step, so that a continued run has it behind it.
    """
    seeds = itertools.islice(primes(), 100 * (p.case.numerics.seed - 1), None)
    result: list[Deck] = []
    first = 1
    steps = {phase.name: phase.case.time_step or p.time_step for phase in p.phases}
    for i, fill in enumerate(p.insertions, 1):
        templates = _templates(p, fill, first, seeds)
        first += len(templates)
        step = steps[fill.phase]
        result.append(
            Deck(
                fill,
                id=f"fill{i}",
                seed=next(seeds),
                distribution=f"mix{i}",
                distribution_seed=next(seeds),
                templates=templates,
                region=_region(fill),
                # insert/pack counts what is in the region before it; a stream faster than a step does not
                rate=float(f"{2 * fill.count / step:.2g}") if fill.exact else fill.rate,
                every=None if fill.rate is None and not fill.exact else max(1, math.ceil(fill.period / step)),
                once=fill.rate is None,
            )
        )
    return tuple(result)
