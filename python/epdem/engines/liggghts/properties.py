# SPDX-License-Identifier: GPL-2.0-or-later
"""Material properties of LIGGGHTS's decks: `fix property/global`, named after the property."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...base.declarations import declarations
from ...errors import CaseError
from ...jobs.engine import Unsupported
from ...scenes.plan.model import Model
from ...scenes.plan.plan import ScenePlan
from ..input_script import finite

Rows = Sequence[Sequence[float]]  # of a matrix
HARD, SOFT = 1e9, 5e6  # LIGGGHTS refuses moduli [Pa] outside these without a keyword


@dataclass(frozen=True)
class Property:
    """A property: LIGGGHTS's name and style, its numbers, their unit ("-": none), a note if the name needs one, and why
    a deck has it."""

    name: str
    style: str
    values: tuple[float, ...]
    unit: str
    note: str = ""
    reason: str = ""

    @property
    def comment(self) -> str:
        """Unit and note, as they stand in a deck."""
        return f"[{self.unit}] {self.note}".rstrip()


def per_type(name: str, values: Sequence[float], unit: str, note: str = "", reason: str = "") -> Property:
    """A property of every atom type."""
    return Property(name, "peratomtype", tuple(values), unit, note, reason)


def per_pair(name: str, types: int, value: float | Rows, unit: str, note: str = "", reason: str = "") -> Property:
    """A value for every pair of `types` atom types: one for all, or a row for each type."""
    values = np.broadcast_to(value, (types, types)).ravel().tolist()
    return Property(name, "peratomtypepair", (types, *values), unit, note, reason)


def scalar(name: str, value: float, unit: str, note: str = "", reason: str = "") -> Property:
    """A property of the whole model."""
    return Property(name, "scalar", (value,), unit, note, reason)


def elastic(m: Model) -> tuple[Property, ...]:
    """Young's moduli [Pa] and Poisson's ratios of the atom types. Raises CaseError for a ratio beyond LIGGGHTS's."""
    for t in m.types:
        if t.poisson_ratio < 0:
            raise Unsupported(f"materials.{t.material}.poisson_ratio = {t.poisson_ratio}, LIGGGHTS takes [0, 0.5] only")
    moduli, ratios = [finite(t.young_modulus) for t in m.types], [t.poisson_ratio for t in m.types]
    return (
        per_type("youngsModulus", moduli, "Pa", reason="stiffness of every contact"),
        per_type("poissonsRatio", ratios, "-", reason="E* and G* follow from E and Poisson's ratio"),
    )


def of_model(m: Model) -> tuple[Property, ...]:
    """The properties of a contact model with a law of epdem. Raises CaseError."""
    found, types, declared = [*elastic(m)], len(m.types), declarations()[m.law]
    if declared.strength:
        parameter, softer = declared.parameter(declared.strength), "the softer body's counts"
        strengths, reason = [finite(t.strength) for t in m.types], f"the law yields at this strength; {softer}"
        found.append(per_type(parameter.property, strengths, parameter.unit, softer * (types > 1), reason))
    for name, ratio in m.ratios().items():
        reason = "a parameter of the law that differs from its default"
        found.append(scalar(declared.parameter(name).property, ratio, "-", reason=reason))

    def add(name: str, value: float | Rows | None, reason: str, unit: str = "-", note: str = "") -> None:
        if value is not None:
            found.append(per_pair(name, types, value, unit, note, reason))

    friction = m.friction if m.sliding else None
    add("coefficientFriction", friction, "contact.friction: limit of the tangential force")
    if m.viscous:
        add("coefficientRestitution", m.viscous, "viscous.restitution: a dashpot", note="of impacts that do not yield")
    else:
        reason, note = "contact.tangential_restitution: a dashpot", "of the tangential dashpot only"
        add("coefficientRestitution", m.tangential_restitution, reason, note=note)
    if m.rolling:
        of_moment = "contact.rolling.damping: dashpot of the rolling moment"
        add(
            "coefficientRollingFriction",
            m.rolling.coefficient,
            "contact.rolling.coefficient: limit of the rolling moment",
        )
        add("coefficientRollingViscousDamping", m.rolling.damping, of_moment)
    reason = "work of adhesion Gamma of the law: the bodies attract each other"
    add("workOfAdhesion", m.adhesion or None, reason, "J/m^2")
    add("cohesionEnergyDensity", m.cohesion or None, "contact.cohesion: attraction over the contact area", "J/m^3")
    add("cohesionEnergyDensity", m.bond, "contact.bond_strength: largest pull over the contact area", "Pa")
    return tuple(found)


def tangential(m: Model) -> str:
    """LIGGGHTS's word for the tangential model."""
    if not m.sliding:
        return "off"
    return f"ep/{m.tangential}" if m.nodes else m.tangential


def wear(p: ScenePlan) -> tuple[Property, ...]:
    """Finnie's constant [m^2/N] of each pair of a sphere's type and a wall's, the same in both orders.

    Raises CaseError for two values of one pair.
    """
    spheres = {p.model.type_of(particles.material) for particles in p.scene.filled}
    of_pair = dict[frozenset[int], tuple[str, float]]()  # the wall that gives the value, the value
    for name, mesh in p.scene.meshes.items():
        if not mesh.wear:
            continue
        for sphere in spheres:
            other, wear = of_pair.setdefault(frozenset((sphere, p.wall_types[name])), (name, mesh.wear))
            if wear != mesh.wear:
                raise CaseError(
                    f"scene.wall.{name}.wear = {mesh.wear:g} m^2/N: wall {other} has {wear:g} m^2/N, and LIGGGHTS has "
                    "one value for each pair of materials; give both walls one value, or each its own material"
                )
    if not of_pair:
        return ()
    types = range(1, len(p.model.types) + 1)
    values = [[of_pair.get(frozenset((a, b)), ("", 0.0))[1] for b in types] for a in types]
    reason = "scene.wall.wear: Finnie's constant of pairs with this wall"
    return (per_pair("k_finnie", len(types), values, "m^2/N", reason=reason),)
