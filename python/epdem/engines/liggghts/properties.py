# SPDX-License-Identifier: GPL-2.0-or-later
"""Material properties of LIGGGHTS's decks: `fix property/global`, named after the property."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...base.declarations import declarations
from ...case.fields import NODES
from ...errors import CaseError
from ...impacts.plan import Plan
from ...laws.strengths import ADHESION
from ...scenes.plan import ScenePlan
from ..input_script import atom_types, finite

HARD, SOFT = 1e9, 5e6  # LIGGGHTS refuses moduli [Pa] outside these without a keyword


# The reason of a property in a deck; the law's own parameters are in the register.
_REASONS = {
    "youngsModulus": "stiffness of every contact",
    "poissonsRatio": "E* and G* follow from E and Poisson's ratio",
    "coefficientFriction": "contact.friction: limit of the tangential force",
    "coefficientRestitution": "viscous.restitution or contact.tangential_restitution: a dashpot",
    "coefficientRollingFriction": "contact.rolling.coefficient: limit of the rolling moment",
    "coefficientRollingViscousDamping": "contact.rolling.damping: dashpot of the rolling moment",
    "workOfAdhesion": "work of adhesion Gamma of the law: the bodies attract each other",
    "k_finnie": "scene.wall.wear: Finnie's constant of pairs with this wall",
    "cohesionEnergyDensity": "contact.cohesion: attraction over the contact area",
}


@dataclass(frozen=True)
class Property:
    """A property: LIGGGHTS's name and style, its numbers, their unit ("-": none), and a note if the name needs one."""

    name: str
    style: str
    values: tuple[float, ...]
    unit: str
    note: str = ""

    @property
    def comment(self) -> str:
        """Unit and note, as they stand in a deck."""
        return f"[{self.unit}] {self.note}".rstrip()

    @property
    def reason(self) -> str:
        """Reason of the property in a deck; '' if it has none."""
        laws = declarations().values()
        if any(p.property == self.name for law in laws for p in law.parameters if p.name == law.strength):
            return "the law yields at this strength; the softer body's counts"
        if self.name not in _REASONS and any(p.property == self.name for law in laws for p in law.parameters):
            return "a parameter of the law that differs from its default"
        return "; ".join(filter(None, [_REASONS.get(self.name, ""), self.note]))


def per_type(name: str, values: Sequence[float], unit: str, note: str = "") -> Property:
    """A property of every atom type."""
    return Property(name, "peratomtype", tuple(values), unit, note)


def per_pair(name: str, types: int, value: float | Sequence[float], unit: str, note: str = "") -> Property:
    """A value for every pair of `types` atom types: one for all, or row by row."""
    values = [value] * types**2 if isinstance(value, float) else value
    return Property(name, "peratomtypepair", (types, *values), unit, note)


def scalar(name: str, value: float, unit: str, note: str = "") -> Property:
    """A property of the whole model."""
    return Property(name, "scalar", (value,), unit, note)


def elastic(moduli: Sequence[float], ratios: Sequence[float]) -> tuple[Property, ...]:
    """Young's moduli [Pa] and Poisson's ratios of the atom types."""
    return per_type("youngsModulus", moduli, "Pa"), per_type("poissonsRatio", ratios, "-")


def strength(law: str, values: Sequence[float]) -> tuple[Property, ...]:
    """The law's strength [Pa] of the atom types; nothing for a law that has none."""
    declared = declarations()[law]
    if declared.strength is None:
        return ()
    parameter = declared.parameter(declared.strength)
    return (per_type(parameter.property, values, parameter.unit, "the softer body's counts" * (len(values) > 1)),)


def work_of_adhesion(types: int, values: float | Sequence[float]) -> Property:
    """Work of adhesion [J/m^2] of every pair of atom types."""
    return per_pair("workOfAdhesion", types, values, "J/m^2")


def tangential(name: str | None) -> str:
    """LIGGGHTS's word for the tangential model of a case; None: no friction."""
    if name is None:
        return "off"
    return f"ep/{name}" if NODES[name] else name


def ratios(law: str, values: dict[str, float]) -> tuple[Property, ...]:
    """Dimensionless parameters of a law."""
    return tuple(scalar(p.property, values[p.name], "-") for p in declarations()[law].parameters if p.name in values)


def of_impacts(plan: Plan) -> tuple[Property, ...]:
    """Elastic properties of the plan's atom types, for any model."""
    bodies = [body for body, _ in atom_types(plan)]
    return elastic([finite(b.young_modulus) for b in bodies], [b.poisson_ratio for b in bodies])


def of_friction(plan: Plan, types: int) -> tuple[Property, ...]:
    """The coefficient of friction of oblique impacts."""
    o = plan.experiment.oblique
    return () if o is None else (per_pair("coefficientFriction", types, o.friction, "-"),)


def of_law(plan: Plan) -> tuple[Property, ...]:
    """The properties that a law of epdem needs."""
    x, types = plan.experiment, atom_types(plan)
    properties = [*of_impacts(plan), *strength(x.law.name, [finite(s) for _, s in types])]
    properties += ratios(x.law.name, x.law.ratios())
    if x.law.adheres:
        properties.append(work_of_adhesion(len(types), x.law.parameters[ADHESION]))
    properties += of_friction(plan, len(types))
    if x.viscous_restitution is not None:
        note = "of impacts that do not yield"
        properties.append(per_pair("coefficientRestitution", len(types), x.viscous_restitution, "-", note))
    return tuple(properties)


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
    values = [of_pair.get(frozenset((a, b)), ("", 0.0))[1] for a in types for b in types]
    return (per_pair("k_finnie", len(types), values, "m^2/N"),)
