# SPDX-License-Identifier: GPL-2.0-or-later
"""Filling a scene: the number of spheres of each size, and whether they fit into their region."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from ..case.measures import Region
from ..case.motions import Vector3
from ..case.scene import SceneCase
from ..case.sizes import Particles
from ..errors import CaseError


@dataclass(frozen=True)
class Insertion:
    """`count` spheres of `particles` put into a region in a phase: at once, or `rate` per second every `period` [s].

    key: of the number in the case. exact: `count` is the number of spheres beside those that are in the region before.
    """

    particles: list[Particles]
    count: int
    region: Region
    key: str
    phase: str
    velocity: Vector3 = (0.0, 0.0, 0.0)
    rate: float | None = None
    period: float = 0.0
    exact: bool = False


MOST_FILLED = 0.26  # volume share that random sequential placement reaches in reasonable time


def drawn(case: SceneCase, parts: list[Particles]) -> list[tuple[str, float, float]]:
    """(material, radius [m], weight) of each size: spheres drawn with these weights have the shares of the mass."""
    return [
        (p.material, radius, share / (case.materials[p.material].density * radius**3))
        for p in parts
        for radius, share in p.sizes()
    ]


def mean_volume(case: SceneCase, fill: Insertion) -> float:
    """Mean volume of the spheres of a fill [m^3]."""
    sizes = drawn(case, fill.particles)
    return float(np.average([4.0 / 3.0 * math.pi * r**3 for _, r, _ in sizes], weights=[w for _, _, w in sizes]))


def _volume(case: SceneCase, fill: Insertion) -> float:
    """Volume of the spheres that are inserted at once [m^3]: all spheres, or one interval of a stream."""
    return mean_volume(case, fill) * (fill.count if fill.rate is None else min(fill.rate * fill.period, fill.count))


def refuse_too_many(case: SceneCase, fills: Iterable[Insertion]) -> None:
    """Raise CaseError for fills with more spheres at once than their region takes."""
    for key, group in groupby(fills, key=lambda fill: fill.key):
        together = list(group)
        first, count = together[0], sum(fill.count for fill in together)
        share = sum(_volume(case, fill) for fill in together) / first.region.volume
        if share <= MOST_FILLED:
            continue
        if first.rate is not None:
            at_once = min(first.rate * first.period, first.count)
            raise CaseError(
                f"{key.removesuffix('.count')}.rate = {first.rate:g} Hz: the {at_once:.0f} spheres of "
                f"{first.period:.3g} s would fill {share:.0%} of the layer that they are poured into, "
                f"at most {MOST_FILLED:.0%} ({first.rate * MOST_FILLED / share:.3g} Hz); give a lower rate, or a "
                "larger box"
            )
        most = int(count * MOST_FILLED / share)
        raise CaseError(
            f"{key} = {count}: the spheres would fill {share:.0%} of the room that they are poured into, "
            f"at most {MOST_FILLED:.0%} ({most} spheres); enlarge the room"
        )
