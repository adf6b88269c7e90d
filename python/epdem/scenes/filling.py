# SPDX-License-Identifier: GPL-2.0-or-later
"""Filling a scene: the number of spheres of each size, and whether they fit into their region."""

import math
from collections.abc import Iterable
from itertools import groupby

import numpy as np

from ..case.scene import SceneCase
from ..case.sizes import Particles
from ..errors import CaseError
from .layout import Fill

MOST_FILLED = 0.26  # volume share that random sequential placement reaches in reasonable time


def drawn(case: SceneCase, parts: list[Particles]) -> list[tuple[str, float, float]]:
    """(material, radius [m], weight) of each size: spheres drawn with these weights have the shares of the mass."""
    return [
        (p.material, radius, share / (case.materials[p.material].density * radius**3))
        for p in parts
        for radius, share in p.sizes()
    ]


def _volume(case: SceneCase, fill: Fill) -> float:
    """Of the spheres that are there at once [m^3]: all, or those of one interval of a stream."""
    sizes = drawn(case, fill.parts)
    one = np.average([4.0 / 3.0 * math.pi * r**3 for _, r, _ in sizes], weights=[w for _, _, w in sizes])
    return float(one) * (fill.count if fill.rate is None else min(fill.rate * fill.every, fill.count))


def refuse_too_many(case: SceneCase, fills: Iterable[Fill]) -> None:
    """Raises CaseError for more spheres at once than the room takes that they are put into."""
    for place, group in groupby(fills, key=lambda fill: fill.place):
        together = list(group)
        first, count = together[0], sum(fill.count for fill in together)
        share = sum(_volume(case, fill) for fill in together) / first.region.volume
        if share <= MOST_FILLED:
            continue
        if first.rate is not None:
            key, at_once = place.removesuffix(".count") + ".rate", min(first.rate * first.every, first.count)
            raise CaseError(
                f"{key} = {first.rate:g} Hz: the {at_once:.0f} spheres of {first.every:.3g} s would fill {share:.0%} "
                f"of the layer that they are poured into, at most {MOST_FILLED:.0%} "
                f"({first.rate * MOST_FILLED / share:.3g} Hz); give a lower rate, or a larger box"
            )
        most = int(count * MOST_FILLED / share)
        raise CaseError(
            f"{place} = {count}: the spheres would fill {share:.0%} of the room that they are poured into, "
            f"at most {MOST_FILLED:.0%} ({most} spheres); enlarge the room"
        )
