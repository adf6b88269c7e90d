# SPDX-License-Identifier: GPL-2.0-or-later
"""Filling a scene: number of spheres of each size, whether they fit into their region, and what whole numbers miss."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import groupby
from typing import NamedTuple

import numpy as np

from ...case.parts import Fill, Parts, Region
from ...case.places import Vector3
from ...case.scene import SceneCase
from ...case.sizes import Particles
from ...errors import CaseError

MOST_FILLED = 0.26  # volume share that random sequential placement reaches in reasonable time
LARGEST_ERROR = 0.01  # of the mass of a component, as a share of the mass of its fill


@dataclass(frozen=True)
class Insertion:
    """`count` spheres of `particles` put into a region in a phase: at once, or `rate` per second every `period` [s].

    key: place of the number in the case. exact: `count` is the number of spheres beside those that are in the region
    before.
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
    temperature: float | None = None  # [K]


def size_weights(case: SceneCase, parts: list[Particles]) -> list[tuple[str, float, float]]:
    """(material, radius [m], weight) of each size: spheres drawn with these weights have the shares of the mass."""
    return [(size.material, size.radius, size.share / size.mass) for size in _sizes(case, parts)]


def mean_volume(case: SceneCase, fill: Insertion) -> float:
    """Mean volume of the spheres of a fill [m^3]."""
    sizes = size_weights(case, fill.particles)
    return float(np.average([4.0 / 3.0 * math.pi * r**3 for _, r, _ in sizes], weights=[w for _, _, w in sizes]))


def refuse_too_many(case: SceneCase, fills: Iterable[Insertion]) -> None:
    """Raise CaseError for fills with more spheres at once than their region takes: all, or an interval of a stream."""
    for key, group in groupby(fills, key=lambda fill: fill.key):
        together = list(group)
        first, count = together[0], sum(fill.count for fill in together)
        at_once = count if first.rate is None else min(first.rate * first.period, count)
        mean = sum(mean_volume(case, fill) * fill.count for fill in together) / count
        share = at_once * mean / first.region.volume
        if share <= MOST_FILLED:
            continue
        if first.rate is not None:
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


class Size(NamedTuple):
    """Spheres of one size: number of the component, radius [m], mass of a sphere [kg], share of the mass of the fill,
    requested and placed number.

    placed: None where the engine draws each sphere at random.
    """

    component: int
    material: str
    radius: float
    mass: float
    share: float
    requested: float = 0.0
    placed: int | None = None

    @property
    def missing(self) -> bool:
        """Whether the fill has no sphere of this size; of random draws, whether the mean number is below one half."""
        return self.requested < 0.5 if self.placed is None else self.placed == 0


def _round_to_sum(exact: list[float]) -> list[int]:
    """Whole numbers with the sum of the exact ones, rounded: the largest remainders go up, of equal ones the first."""
    exact = [round(x, 9) for x in exact]  # round-off, as of other units, decides nothing
    result = [math.floor(x) for x in exact]
    order = sorted(range(len(exact)), key=lambda k: round(result[k] - exact[k], 9))
    for k in order[: round(sum(exact)) - sum(result)]:
        result[k] += 1
    return result


def _sizes(case: SceneCase, particles: list[Particles]) -> list[Size]:
    """The sizes of a fill, before their numbers are known."""
    return [
        Size(n, p.material, r, case.materials[p.material].density * 4.0 / 3.0 * math.pi * r**3, share)
        for n, p in enumerate(particles)
        for r, share in p.sizes()
    ]


def count_sizes(case: SceneCase, f: Fill) -> list[Size]:
    """The sizes of a fill by count, mass or fraction, in whole numbers."""
    sizes = _sizes(case, f.particles)
    if f.count is not None:
        total = f.count / sum(x.share / x.mass for x in sizes)
    elif f.mass is not None:
        total = f.mass
    else:
        assert f.fraction is not None
        total = f.fraction * f.region.volume / sum(x.share / case.materials[x.material].density for x in sizes)
    requested = [total * x.share / x.mass for x in sizes]
    numbers = zip(sizes, requested, _round_to_sum(requested), strict=True)
    return [size._replace(requested=x, placed=n) for size, x, n in numbers]


def _insertion(scene: Parts, f: Fill, key: str, count: int) -> Insertion:
    phase, (vx, vy, vz) = next(p for p in scene.phase if f.phase in (None, p.name)), f.velocity
    at_once = Insertion(f.particles, count, f.region, key, phase.name, (vx, vy, vz), temperature=f.temperature)
    if f.rate is None:
        return at_once
    down, depth = -vz, f.region.z[1] - f.region.z[0]
    if not (down > 0 or scene.gravity):
        raise CaseError(f"{key}.rate: nothing falls out of the region; give gravity, or a velocity along -z")
    period = 2 * depth / (down + math.sqrt(down**2 + 2 * scene.gravity * depth))
    if count / f.rate > phase.duration:
        raise CaseError(f"{key}.rate = {f.rate:g} Hz: {count} spheres take longer than phase {phase.name}; pour faster")
    return replace(at_once, rate=f.rate, period=period)


def insertions(case: SceneCase, scene: Parts) -> tuple[Insertion, ...]:
    """The insertions of a scene's fills: one for each size of a fill at once, the largest first; one of a stream.

    Raises CaseError for a fill without a sphere, and for a stream that does not flow or takes too long.
    """
    found: list[Insertion] = []
    for f in scene.random_fills:
        key = scene.place(f"scene.fill.{f.name}")
        sizes = sorted((size for size in count_sizes(case, f) if size.placed), key=lambda size: -size.radius)
        if not sizes:
            raise CaseError(f"{key}: not one sphere; give more, or smaller ones")
        all_sizes = _insertion(scene, f, key, sum(size.placed or 0 for size in sizes))
        if f.rate is not None or (len(sizes) == 1 and not f.exact):
            found.append(all_sizes)
            continue
        found += [
            replace(all_sizes, particles=[Particles.of(x.material, x.radius)], count=x.placed or 0, exact=True)
            for x in sizes
        ]
    return tuple(found)


def _components(case: SceneCase) -> Iterator[tuple[str, list[Size], float, float]]:
    """(place, sizes, requested mass [kg], mass of the fill [kg]) of each component of each fill; a number of spheres
    requests no mass, so that the mass of the fill is the mass of the placed spheres."""
    for f in case.parts.random_fills:
        sizes, place = count_sizes(case, f), case.parts.place(f"scene.fill.{f.name}.particles")
        whole = sum(x.mass * ((x.placed or 0) if f.count else x.requested) for x in sizes)
        ideal = sum(x.mass * x.requested for x in sizes)
        for n, group in groupby(sizes, key=lambda size: size.component):
            own = [x if f.rate is None else x._replace(placed=None) for x in group]
            yield f"{place}.{n}", own, whole / ideal * sum(x.mass * x.requested for x in own), whole


def refuse_missing(case: SceneCase) -> None:
    """Raise CaseError for a component without a sphere."""
    for place, own, _, _ in _components(case):
        if all(size.missing for size in own):
            raise CaseError(
                f"{place}: its share of the mass is {sum(size.requested for size in own):.2g} of one sphere of "
                f"{own[0].material}, so that the fill has none; give more or smaller spheres, or remove the component"
            )


def warnings(case: SceneCase) -> list[str]:
    """A sentence for each size without spheres, and for each component whose mass differs from the requested one."""
    found = []
    for place, own, requested, whole in _components(case):
        found += [
            f"{place}: 0 spheres with radius {size.radius:g} m, for its share of the mass is {size.requested:.2g} of "
            "one sphere; give more spheres, or other sizes"
            for size in own
            if size.missing
        ]
        mass = sum(size.mass * (size.placed or 0) for size in own)
        if own[0].placed is not None and abs(mass - requested) > LARGEST_ERROR * whole:
            found.append(
                f"{place}: whole spheres of {own[0].material} have {mass:.4g} kg, requested are {requested:.4g} kg; "
                "give more or smaller spheres"
            )
    return found
