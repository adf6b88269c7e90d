# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts of unequal spheres side by side, tilted against the axes and drifting, for variants of one scene.

The contact point crosses x = 0 and z = 0 in mid-contact, each pair at a moment of its own, so that some of them unload:
there an engine puts a border of ranks, and one of bins.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...impacts.experiment import Body, Experiment
from ...impacts.plan import Group, Plan
from ...theory.pair import sphere_mass

VARIANTS: tuple[str, ...] = ("swap", "sort", "migration", "restart")
# From target to body. Bins are sorted by z first, then y: with this tilt the lower body in z is the upper one in y, and
# the order of the two changes twice as they drift across the border of bins at z = 0.
# With the tilt in x they change their rank one after the other.
AXIS = np.array([0.03, 1.0, -0.03]) / np.linalg.norm([0.03, 1.0, -0.03])
OTHER_RADIUS, OTHER_MODULUS = 0.6, 0.7  # of the target, in units of those of the case
FIRST, LAST, STOP = 0.2, 0.9, 0.8  # crossings, and the stop of a run, in contact times
DRIFT = 0.2  # larger radii per contact time


@dataclass(frozen=True)
class Pairs:
    """All pairs of a plan: the moving side, the side that is hit, and the numbers that an engine needs for the run."""

    plan: Plan
    sides: tuple[Group, Group]
    stop: int  # a step in mid-contact, where a run may be stopped
    drift: np.ndarray  # velocity of the centre of mass of all [m/s]
    spread: float  # how far a pair reaches around its first place [m]

    def ordered(self, swap: bool) -> tuple[Group, ...]:
        """The sides in the order in which an engine adds them: `swap` puts the targets first."""
        return self.sides[:: -1 if swap else 1]

    def runs(self, variant: str, file: str) -> list[dict[str, Any]]:
        """The runs of a variant, one after the other: their steps, and what they `load` before and `save` after."""
        whole: dict[str, Any] = {"variant": variant, "steps": self.plan.steps, "load": None, "save": None}
        if variant != "restart":
            return [whole]
        return [whole | {"steps": self.stop, "save": file}, whole | {"steps": whole["steps"] - self.stop, "load": file}]


def unequal_spheres(x: Experiment) -> Experiment:
    """The experiment's body against a smaller sphere of the target's material, made softer, at the middle speed."""
    material, strength = (x.body, x.law.strengths[0]) if x.target.rigid else (x.target, x.law.strengths[1])
    radius = OTHER_RADIUS * x.body.radius
    other = Body(
        radius,
        float(sphere_mass(radius=radius, density=material.density)),
        material.density,
        OTHER_MODULUS * material.young_modulus,
        material.poisson_ratio,
        material.yield_stress,
        material.material + "_softer",
    )
    law = x.law.of(x.law.strengths[0], strength)
    return replace(x, law=law, target=other, speed=x.speed[x.speed.size // 2 :][:1], oblique=None)


def pairs(p: Plan, contact_time: float) -> Pairs:
    """The pairs of a plan of sphere on sphere; contact_time [s] is the theory's."""
    x = p.experiment
    n, reach = p.n, max(x.body.radius, x.target.radius)
    drift = DRIFT * reach / contact_time * np.array([1.0, 0.0, 1.0])
    crossing = np.linspace(FIRST, LAST, n)[:, None] * contact_time
    y = 5.2 * reach * np.arange(n)[:, None] * np.array([0.0, 1.0, 0.0])
    share = x.m_star / x.body.mass  # of the speed, in the centre-of-mass frame
    rest = 1 - share
    start = y - drift * crossing
    gap, v = p.gap[:, None], p.speed[:, None]
    body = Group(x.body, start + AXIS * (x.body.radius + share * gap), drift - share * v * AXIS)
    target = Group(x.target, start - AXIS * (x.target.radius + rest * gap), drift + rest * v * AXIS)
    spread = p.steps * p.time_step * (p.speed.max() + drift[0]) + 4 * reach
    return Pairs(p, (body, target), int(STOP * contact_time / p.time_step), drift, spread)
