# SPDX-License-Identifier: GPL-2.0-or-later
"""Filling a scene: the number of spheres of each size, and whether they fit into their region."""

import math

import numpy as np

from ..case.scene import Particles, SceneCase
from ..errors import CaseError
from .kinds import Fill

MOST_FILLED = 0.26  # volume share that random sequential placement reaches in reasonable time


def drawn(case: SceneCase, parts: list[Particles]) -> list[tuple[str, float, float]]:
    """(material, radius [m], weight) of each size: spheres drawn with these weights have the shares of the mass."""
    return [
        (p.material, radius, share / (case.materials[p.material].density * radius**3))
        for p in parts
        for radius, share in p.sizes()
    ]


def refuse_too_many(case: SceneCase, fill: Fill) -> None:
    """Raises CaseError for more spheres at once, all or those of one interval of a stream, than their room takes."""
    sizes = drawn(case, fill.parts)
    volume = np.average([4.0 / 3.0 * math.pi * r**3 for _, r, _ in sizes], weights=[w for _, _, w in sizes])
    count = fill.count if fill.rate is None else min(fill.rate * fill.every, fill.count)
    share = count * float(volume) / fill.region.volume
    if share > MOST_FILLED and fill.rate is not None:
        raise CaseError(
            f"scene.rate = {fill.rate:g} Hz: the {count:.0f} spheres of {fill.every:.3g} s would fill {share:.0%} of "
            f"the layer that they are poured into, at most {MOST_FILLED:.0%} "
            f"({fill.rate * MOST_FILLED / share:.3g} Hz); give a lower rate, or a larger box"
        )
    if share > MOST_FILLED:
        most = int(fill.count * MOST_FILLED / share)
        raise CaseError(
            f"{fill.place} = {fill.count}: the spheres would fill {share:.0%} of the room that they are poured into, "
            f"at most {MOST_FILLED:.0%} ({most} spheres); enlarge the room"
        )
