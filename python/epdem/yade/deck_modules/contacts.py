# SPDX-License-Identifier: GPL-2.0-or-later
"""Elastic-plastic contacts in a YADE script:

    from epdem.yade.deck_modules.contacts import Contacts

    contacts = Contacts("thornton")
    steel = contacts.material("steel", young_modulus=208e9, poisson_ratio=0.3, density=7850, friction=0.3,
                              yield_pressure=2.8e9)
    O.bodies.append([wall(0, axis=2, material=steel), sphere((0, 0, 0.02), 0.01, material=steel)])
    O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
                 *contacts.engines(), NewtonIntegrator(damping=0)]

YADE's own C++ (see cone.py) computes every contact. Between its interaction loop and the integrator `visit` looks for
contacts that have just yielded, adds the difference to the law's force and steers their next step. Of a law whose
elastic branch is not Hertz's once it has yielded (`cavity`) it also visits those that have moved.

O.save keeps all history (see contact.py) and the law's name; a loaded scene continues wherever this module
can be imported. As everywhere in YADE the history of a contact ends when the bodies separate (overlap < 0).
"""

import builtins
from itertools import compress
from math import asin, inf, isfinite, pi
from operator import attrgetter
from typing import Any

import numpy as np
from yade import O
from yade.wrapper import (
    FrictMatCDM,
    Ig2_Facet_Sphere_ScGeom,
    Ig2_Sphere_Sphere_ScGeom,
    Ig2_Wall_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMatCDM_FrictMatCDM_MindlinPhysCDM,
    Law2_ScGeom_MindlinPhysCDM_HertzMindlinCDM,
    PyRunner,
)

from . import cone
from .contact import FAR, Contact, effective_radius, trigger_pressure
from .law import Law, larger_share, trigger_factor

LABEL = "epdem_visit"  # of our PyRunner: YADE binds it anew whenever a scene is loaded
RIGID = 1e30  # modulus [Pa] of a rigid body; YADE cannot take infinity

_yielding, _depth, _real, _birth = map(attrgetter, ("isYielding", "penetrationDepth", "isReal", "iterMadeReal"))
_managers: dict[tuple[object, ...], "Contacts"] = {}


def visit(*key: Any) -> None:
    """What our PyRunner calls every step; `key` is enough to go on with a loaded scene."""
    manager = _managers.get(key)
    if manager is None:
        law, *ratios = key
        manager = Contacts(law, **dict(ratios))
        _managers[key] = manager
    manager.visit()


class Contacts:
    """All contacts of a scene under one law without adhesion; ratios: its dimensionless parameters."""

    columns = 4  # of the table

    def __init__(self, law: str, **ratios: float):
        self.law = law
        self.strength_name = Law(law, 1.0, **ratios).strength_name
        self.factor = trigger_factor(law, **ratios)  # refuses ratios that do not fit together
        self.ratios, self.key = ratios, (law, *sorted(ratios.items()))
        self.visits = 0  # of contacts, by Python
        self._strain: list[float] | None = None  # see `strain`
        self._laws: dict[tuple[float, float, float], Law] = {}
        self._runner: object = None

    def material(
        self,
        label: str,
        *,
        young_modulus: float,
        poisson_ratio: float,
        density: float,
        friction: float = 0.0,
        **strength: float,
    ) -> FrictMatCDM:
        """Add a material, SI; `strength` is the law's yield_pressure or yield_stress (inf: never yields).

        young_modulus = inf is a rigid body. Of two materials the weaker one's strength counts.
        """
        name = self.strength_name
        if set(strength) != ({name} - {None}):
            given = ", ".join(strength) or "none"
            raise TypeError(f"law {self.law} needs {name or 'no strength'}, given: {given}")
        young, value = min(young_modulus, RIGID), strength.get(name or "", inf)
        like = 0.5 * young / (1.0 - poisson_ratio**2)  # E* of two bodies of this material
        trigger, alpha = cone.NEVER * young, 0.5
        if name and isfinite(value):
            trigger, limit = self.factor * value, cone.strongest(young, self.factor)
            if not value < limit:
                raise ValueError(f"{label}: {name} = {value!r} Pa, YADE's law needs less than {limit:.4g} Pa")
            # tangent at first yield, so that a contact that yields before its first visit starts on course
            h = (0.5 * pi * trigger / like) ** 2
            law = self._law(like, value, 0.5)
            rise = law.load(1.0, h * (1.0 + cone.SMALL))[0] / cone.force(like, 1.0, 1.0, 0.0, h) - 1.0
            alpha = asin(1.0 / (1.0 + cone.growth_by_secant(1.0, h, cone.SMALL * h, rise)))
        material = FrictMatCDM(
            label=label,
            young=young,
            poisson=poisson_ratio,
            density=density,
            sigmaMax=trigger,
            alpha=alpha,
            frictionAngle=cone.friction_angle(friction),
        )
        O.materials.append(material)
        return material

    def engines(self) -> list[Any]:
        """YADE's interaction loop and our runner, to stand in this order before the integrator."""
        _managers[self.key] = self
        command = f"from {__name__} import visit; visit{self.key!r}"
        return [
            InteractionLoop(
                [
                    Ig2_Sphere_Sphere_ScGeom(),
                    Ig2_Wall_Sphere_ScGeom(hertzian=True),  # else R* = R/2
                    Ig2_Facet_Sphere_ScGeom(hertzian=True),
                ],
                [Ip2_FrictMatCDM_FrictMatCDM_MindlinPhysCDM()],
                [Law2_ScGeom_MindlinPhysCDM_HertzMindlinCDM()],
            ),
            PyRunner(command=command, iterPeriod=1, initRun=True, label=LABEL),
        ]

    def strain(self) -> tuple[float, float]:
        """Largest contact radius and overlap over R*, times the share of the weaker body, since the first call."""
        self._strain = self._strain or [0.0, 0.0]
        return self._strain[0], self._strain[1]

    def table(self) -> list[tuple[float, ...]]:
        """Sphere, other body (from 0), overlap, largest overlap [m] (0: never yielded) of every contact."""
        return [
            (*sorted((i.id1, i.id2)), i.geom.penetrationDepth, i.phys.adhesionForce) for i in O.interactions if i.isReal
        ]

    def visit(self) -> None:
        """Between forces and motion of one step: make the forces the law's."""
        runner = builtins.__dict__.get(LABEL)
        if runner is not self._runner:
            self._begin(runner)
        self._search()
        for contact in list(compress(self._watched, map(_yielding, self._phys))):
            if contact.place < 0 and contact.alive:  # a contact that ended keeps its last flag
                self._move(contact, contact.geom.penetrationDepth)
        if self._flat:
            self._follow()
        if self._strain and self._contacts:
            self._record(self._strain)

    def _record(self, strain: list[float]) -> None:
        """Keep the largest strains after the contacts that yield in this step have moved.

        An elastic contact has the radius of Hertz; one that has yielded has a larger one at the same overlap.
        """
        u = np.fromiter(map(_depth, self._geometries), float, len(self._contacts)) / self._R_star
        strain[0] = max(strain[0], float((self._share * np.sqrt(np.maximum(u, 0.0))).max()))
        strain[1] = max(strain[1], float((self._share * u).max()))

    def _begin(self, runner: object) -> None:
        """Another scene than in the last visit: only what YADE saves counts."""
        self._runner = runner
        self._collider = next((e for e in O.engines if isinstance(e, InsertionSortCollider)), None)
        self._state: object = None
        self._contacts: list[Contact] = []
        self._apart: list[Any] = []  # pairs of the collider that do not touch
        self._sort()

    def _search(self) -> None:
        """Meet new contacts and drop old ones. While the collider rests the pairs are the same: then there is something
        new only if the number of contacts is not that of the known ones, or one of these has ended."""
        state = self._collider and (self._collider.numAction, len(O.interactions))
        renewed = state is None or state != self._state
        same = not renewed and O.interactions.countReal() == len(self._contacts)
        if same and sum(map(_birth, self._interactions)) == self._births:
            return
        if renewed:
            pairs = O.interactions.all()
            present = {(i.id1, i.id2): i.iterMadeReal for i in pairs}  # a body may have been erased with its contacts
            self._contacts = [c for c in self._contacts if present.get(c.bodies) == c.born]
            known = {c.bodies for c in self._contacts}
            self._state, self._apart = state, [i for i in pairs if (i.id1, i.id2) not in known]
            self._sort()
        else:  # those that have ended stay where they are looked at until the next sorting, and do no harm
            births = list(map(_birth, self._interactions))
            self._apart += [c.interaction for c, born in zip(self._contacts, births, strict=True) if born != c.born]
            self._contacts = [c for c, born in zip(self._contacts, births, strict=True) if born == c.born]
            self._list()
        for interaction in list(compress(self._apart, map(_real, self._apart))):
            self._meet(interaction)
        self._apart = [i for i in self._apart if not i.isReal]

    def _list(self) -> None:
        self._interactions = [c.interaction for c in self._contacts]
        self._births = sum(c.born for c in self._contacts)  # YADE sets it to -1 where a contact ends
        self._geometries = [c.geom for c in self._contacts]
        self._R_star = np.array([c.R_star for c in self._contacts])
        self._share = np.array([c.law.share for c in self._contacts])

    def _sort(self) -> None:
        """The contacts by the way they are looked at: by YADE's flag, or (flattened ones) by their overlap."""
        self._watched, self._flat = list[Contact](), list[Contact]()
        self._phys, self._geoms = list[Any](), list[Any]()
        self._list()
        bounds = [b for c in self._contacts if (b := self._enter(c))]
        self._low, self._high = np.array(bounds).reshape(-1, 2).T.copy()

    def _law(self, E_star: float, strength: float, share: float) -> Law:
        key = E_star, strength, share
        if key not in self._laws:
            self._laws[key] = Law(self.law, *key, **self.ratios)
        return self._laws[key]

    def _enter(self, contact: Contact) -> tuple[float, float] | None:
        """Put a contact where it is looked at; of a flattened one the bounds of its branch."""
        if contact.yield_overlap == inf:
            return None
        if contact.law.flattens and contact.delta_max > 0.0:
            contact.place = len(self._flat)
            self._flat.append(contact)
            self._geoms.append(contact.geom)
            return contact.bounds()
        self._watched.append(contact)
        self._phys.append(contact.phys)
        return None

    def _add(self, contact: Contact) -> None:
        if bounds := self._enter(contact):
            self._low, self._high = np.append(self._low, bounds[0]), np.append(self._high, bounds[1])

    def _meet(self, interaction: Any) -> None:
        phys, new = interaction.phys, not interaction.phys.betan > 0.0
        triggers = [trigger_pressure(O.bodies[k].material) for k in (interaction.id1, interaction.id2)]
        if new:
            trigger = min(triggers)
            phys.betan = effective_radius(interaction)
            phys.maxBendPl = trigger / self.factor if trigger < inf else FAR
        strength = phys.maxBendPl if phys.maxBendPl < FAR else inf
        share = larger_share(self.law, *triggers, **self.ratios)
        contact = Contact(interaction, self._law(phys.E, strength, share), phys.betan)
        if new:
            self._start(contact)
        self._contacts.append(contact)
        self._interactions.append(interaction)
        self._geometries.append(contact.geom)
        self._R_star = np.append(self._R_star, contact.R_star)
        self._share = np.append(self._share, contact.law.share)
        self._births += contact.born
        self._add(contact)

    def _start(self, contact: Contact) -> None:
        """The first visit: the force of this step, and the course from here."""
        u = contact.geom.penetrationDepth
        computed = contact.computed(u)
        force = contact.load(u) if u > contact.yield_overlap else contact.virgin(u)
        self._correct(contact, force, computed)

    def _correct(self, contact: Contact, force: float, computed: float) -> None:
        self.visits += 1
        if self._strain and contact.delta_max > 0.0:
            share = contact.law.share
            self._strain[0] = max(self._strain[0], share * contact.a_max / contact.R_star)
            self._strain[1] = max(self._strain[1], share * contact.delta_max / contact.R_star)
        contact.correct(force, force - computed)

    def _move(self, contact: Contact, u: float) -> None:
        """A contact that has yielded in this step, or a flattened one that has left its branch."""
        computed = contact.computed(u)
        if u > max(contact.delta_max, contact.yield_overlap):
            force = contact.load(u)
        elif contact.place >= 0:
            force = contact.unload(u)
        else:
            return  # within round-off of its limit
        self._correct(contact, force, computed)
        if contact.law.flattens:
            if contact.place < 0:
                self._add(contact)  # it leaves the watched ones when they are sorted
            else:
                self._low[contact.place], self._high[contact.place] = contact.bounds()

    def _follow(self) -> None:
        """Visit the flattened contacts that have left the overlaps for which their branch is good."""
        u = np.fromiter(map(_depth, self._geoms), float, len(self._geoms))
        for k in np.flatnonzero((u < self._low) | (u > self._high)).tolist():
            contact = self._flat[k]
            if contact.alive:
                self._move(contact, float(u[k]))
            else:  # its numbers stay as they were until the next search
                self._low[k], self._high[k] = -inf, inf


class Remembering(Contacts):
    """Keeps every contact that has yielded until its end is written: YADE deletes it when the bodies separate."""

    def __init__(self, law: str, **ratios: float):
        super().__init__(law, **ratios)
        self.dented: dict[Contact, bool] = {}  # in the order in which they yielded

    def _correct(self, contact: Contact, force: float, computed: float) -> None:
        super()._correct(contact, force, computed)
        if contact.delta_max > 0.0:
            self.dented[contact] = True

    def table(self) -> list[tuple[float, ...]]:
        """As above, with overlap 0 of bodies that have separated since the last table."""
        rows = super().table()
        for contact in [c for c in self.dented if not c.alive]:
            rows.append((*sorted(contact.bodies), 0.0, contact.delta_max))
            del self.dented[contact]
        return rows
