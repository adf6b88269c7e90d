# SPDX-License-Identifier: GPL-2.0-or-later
"""One contact of YADE under one of our laws: the force of YADE, the numbers of its next step, the history.

All history lives in attributes of YADE's `phys` that its conical-damage law does not use, so that O.save keeps it:

    betan          R* [m]; 0: the contact is new
    maxBendPl      the pair's strength [Pa]
    adhesionForce  delta_max [m] once yielded, else 0
    kr, ktw        overlap [m] at the last visit, and where the branch touches the law's (cavity only)
"""

from math import inf
from typing import Any

from yade import O
from yade.wrapper import Facet, Sphere, Wall

from . import cone
from .law import Law

FAR = 1e99  # sigmaMax [Pa] of a contact that never yields
REACH = 1e-5  # how far a contact may move from its branch's touching point, over its elastic depth: 1e-10 of the force
PARTED = -1.0  # touching point of a contact that has parted inside its dent


def effective_radius(interaction: Any) -> float:
    """R* [m]. YADE gives walls and facets a large radius instead of none, which would cost 1e-8."""
    geom = interaction.geom
    radii = [
        inf if isinstance(O.bodies[k].shape, (Wall, Facet)) else r
        for k, r in ((interaction.id1, geom.refR1), (interaction.id2, geom.refR2))
    ]
    small, large = min(radii), max(radii)
    return small / (1.0 + small / large)


def trigger_pressure(material: Any) -> float:
    """Hertz pressure at which a material yields first [Pa]; inf: never."""
    return inf if material.sigmaMax >= cone.STRONGEST * material.young else material.sigmaMax


class Contact:
    """A contact that can yield. Overlaps u in m, forces in N."""

    def __init__(self, interaction: Any, law: Law, R_star: float):
        phys = interaction.phys
        self.interaction, self.geom, self.phys = interaction, interaction.geom, phys
        self.born, self.law, self.E, self.R_star = interaction.iterMadeReal, law, law.E_star, R_star
        self.radius, self.growth, self.place = phys.radius, phys.alphaFac, -1
        self.yield_overlap = law.yield_ratio * R_star
        # a normal force turns no sphere; the torque on other shapes is the sum that YADE keeps for them
        self.bodies = interaction.id1, interaction.id2
        self.levers = tuple(k for k in (0, 1) if not isinstance(O.bodies[self.bodies[k]].shape, Sphere))
        self.delta_max: float = phys.adhesionForce
        self.a_max = law.load(R_star, self.delta_max)[1] if self.delta_max > 0.0 else 0.0  # contact radius there

    @property
    def alive(self) -> bool:
        """False once YADE has dropped the contact, or made another one of the same interaction."""
        alive: bool = self.interaction.iterMadeReal == self.born
        return alive

    def computed(self, u: float) -> float:
        """What YADE has just applied at overlap u; its loop may have grown R."""
        return cone.force(self.E, self.phys.R, self.radius, self.growth, u)

    def _steer(self, R: float, dent: float, limit: float, step: float = 0.0, rise: float = 0.0) -> None:
        """Follow the branch (R, dent) up to overlap `limit`; beyond, F rises by the share `rise` over `step`."""
        phys = self.phys
        h, sigma = cone.damage_limit(self.E, R, dent, limit)
        self.growth = cone.growth_by_secant(R, h, step, rise)
        self.radius = R - dent / self.growth
        phys.R, phys.radius, phys.alphaFac, phys.sigmaMax = R, self.radius, self.growth, sigma

    def virgin(self, u: float) -> float:
        """Make a new, elastic contact exact; the law's force at u."""
        limit, step = self.yield_overlap, cone.SMALL * self.yield_overlap
        R, E = self.R_star, self.E
        if limit == inf:
            self.phys.R = self.phys.radius = self.radius = R
            self.phys.sigmaMax = FAR
            return cone.force(E, R, R, 0.0, u)
        at_limit = cone.force(E, R, R, 0.0, limit)
        self._steer(R, 0.0, limit, step, self.law.load(R, limit + step)[0] / at_limit - 1.0)
        return cone.force(E, R, R, 0.0, u)

    def load(self, u: float) -> float:
        """The contact is at its new maximum u: the law's force, and the course from here."""
        last = self.delta_max or self.yield_overlap
        force, radius = self.law.load(self.R_star, u)
        self.delta_max = self.phys.adhesionForce = u
        self.a_max = radius
        step = max(u - last, cone.SMALL * u)
        R, dent = cone.hertz_branch(self.E, force, radius, u)
        self._steer(R, dent, u, step, self.law.load(self.R_star, u + step)[0] / force - 1.0)
        if self.law.flattens:
            self.phys.kr = self.phys.ktw = u
        return force

    def unload(self, u: float) -> float:
        """The law's force at u <= delta_max; for a flattened contact also the branch that touches the law's where the
        next step is expected, in force and in slope (so in contact radius)."""
        force, radius = self.law.unload(self.R_star, self.delta_max, u)
        if not self.law.flattens:
            return force
        phys = self.phys
        ahead = min(2.0 * u - phys.kr, self.delta_max)
        there = self.law.unload(self.R_star, self.delta_max, ahead)
        if not there[0] > 0.0:
            ahead, there = u, (force, radius)
        phys.kr = u
        if there[0] > 0.0:
            phys.ktw = ahead
        else:  # parted: the branch of the first touch
            dent = self.law.dent(self.R_star, self.delta_max)
            phys.ktw, ahead = PARTED, dent + cone.SMALL * (self.delta_max - dent)
            there = self.law.unload(self.R_star, self.delta_max, ahead)
        self._steer(*cone.hertz_branch(self.E, *there, ahead), self.delta_max)
        return force

    def bounds(self) -> tuple[float, float]:
        """Overlaps between which the branch stands for the law's (flattened contacts), from what YADE saves alone."""
        touch, dent = self.phys.ktw, (self.phys.R - self.radius) * self.growth
        if touch == PARTED:
            return -inf, min(dent, self.law.dent(self.R_star, self.delta_max))
        reach = REACH * (touch - dent)
        return touch - reach, min(touch + reach, self.delta_max)

    def correct(self, force: float, difference: float) -> None:
        """Make `force` of what YADE applied in this step, which was less by `difference`."""
        normal, (first, second) = self.geom.normal, self.bodies
        vector = normal * difference
        O.forces.addF(first, -vector)
        O.forces.addF(second, vector)
        for k in self.levers:
            arm = self.geom.contactPoint - O.bodies[self.bodies[k]].state.pos
            O.forces.addT(self.bodies[k], arm.cross(vector if k else -vector))
        self.phys.normalForce = normal * force
