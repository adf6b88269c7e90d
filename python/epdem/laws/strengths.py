# SPDX-License-Identifier: GPL-2.0-or-later
"""A law with its numbers, first for all bodies and then for a pair of them. SI throughout."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from ..base.declarations import Declaration, declarations
from ..errors import CaseError
from ..theory.backbones import ADHESIVE, JKR, LAWS, Backbone
from ..theory.numerics import Real
from ..theory.pair import HARDENING, strain_share

ADHESION = "work_of_adhesion"  # the parameter of laws with adhesion [J/m^2]


def law_named(name: str) -> Declaration:
    """What the law of that name declares. Raises CaseError."""
    if name not in declarations():
        raise CaseError(f"law.name = {name!r} does not exist; there are {', '.join(declarations())}")
    return declarations()[name]


def yields_by_stress(name: str) -> bool:
    """Whether the strength of a law is the yield stress itself, not a contact pressure. Raises CaseError."""
    return law_named(name).strength == "yield_stress"


@dataclass(frozen=True)
class Surface:
    """The surface of a material: its name and its surface energy gamma [J/m^2], None: not given."""

    material: str
    energy: float | None = None


def own_ratios(name: str, parameters: Mapping[str, float]) -> dict[str, float]:
    """The dimensionless ones of a law's parameters that differ from its defaults, by the law's own names."""
    known = law_named(name).parameters
    return {p.name: parameters[p.name] for p in known if p.unit == "1" and parameters[p.name] != p.default}


@dataclass(frozen=True)
class LawSpec:
    """A law and its parameters for one pair of bodies.

    `parameters` belong to the pair, by the names of the law; `strengths` is the law's strength [Pa] of body and
    target (inf: never yields), of which the smaller one is the pair's: the softer body yields first. `common`: both
    strengths are the one that the law gives for all bodies.
    """

    name: str
    parameters: dict[str, float]
    strengths: tuple[float, float]
    common: bool = False

    def theory(self, *, E_star: float, R_star: Real) -> Backbone | JKR:
        """The law in the theory for one R_star [m] or many, shape (n,).

        Raises ValueError for parameters that make no sense together.
        """
        symbols = law_named(self.name).symbols
        classes: dict[str, type[Backbone] | type[JKR]] = {**LAWS, **ADHESIVE}
        law, numbers = classes[self.name], {symbols[n]: x for n, x in self.parameters.items()}
        return law(E_star=E_star, R_star=R_star, **numbers, **({"share": self.share} if law.uses_share else {}))

    def of(self, body: float, target: float) -> "LawSpec":
        """The same law for two bodies of these strengths [Pa]."""
        strength = law_named(self.name).strength
        own = {} if strength is None else {strength: min(body, target)}
        return replace(self, parameters=self.parameters | own, strengths=(body, target))

    @property
    def share(self) -> float:
        """Share of the weaker body in the strain: 1/2 of bodies of equal strength, 1 if the other one never yields."""
        plastic, first = (self.parameters.get(name, 0.0) for name in ("plastic_ratio", "first_yield_ratio"))
        hardening = plastic / first if plastic > first else HARDENING  # the law refuses others
        one = float(strain_share(*self.strengths, hardening=hardening))
        return max(one, 1.0 - one)

    @property
    def adheres(self) -> bool:
        """Whether bodies attract each other."""
        return law_named(self.name).adheres

    def ratios(self) -> dict[str, float]:
        """The dimensionless parameters that differ from the law's defaults."""
        return own_ratios(self.name, self.parameters)


@dataclass(frozen=True)
class LawNumbers:
    """A law before its bodies: its dimensionless parameters, and the rules of its strength and its adhesion.

    The strength of a body is `absolute` [Pa], or `ratio` times the body's yield stress. The work of adhesion of a pair
    is `adhesion` [J/m^2], or 2 sqrt(gamma_i gamma_j) of the surface energies. compaction: spheres grow at each contact
    by the dents of their other contacts.
    """

    name: str
    ratios: dict[str, float]
    absolute: float | None
    ratio: float
    adhesion: float | None = None
    compaction: bool = False

    def strength(self, material: str, yield_stress: float | None, own: float | None = None) -> float:
        """Strength [Pa] of a body of `material`: its `own`, else by the law's rule; inf for a law without one.

        Raises CaseError if the rule needs a yield stress [Pa] that the material does not have.
        """
        name = law_named(self.name).strength
        if name is None or yield_stress == math.inf:
            return math.inf
        if own is not None:
            return own
        if self.absolute is not None:
            return self.absolute
        if yield_stress is None:
            raise CaseError(
                f"law {self.name} needs materials.{material}.yield_stress (or law.{name}, the same for all); add it"
            )
        return self.ratio * yield_stress

    def work_of_adhesion(self, body: Surface, target: Surface) -> float | None:
        """Gamma of two bodies [J/m^2]; None for a law without adhesion.

        Raises CaseError if it does not follow from what is given, or if more is given than the law takes.
        """
        given = [s for s in (body, target) if s.energy is not None]
        if not law_named(self.name).adheres:
            if wrong := next((s for s in given if s.energy), None):
                adhesive = [law for law in declarations().values() if law.adheres]
                own = [law.name for law in adhesive if law.without_adhesion == self.name]
                reason = "" if own else ", and no theory of adhesion exists for it"
                others = " or ".join(map(repr, own or [law.name for law in adhesive]))
                raise CaseError(
                    f"materials.{wrong.material}.surface_energy = {wrong.energy:g} J/m^2: law {self.name} has no "
                    f"adhesion{reason}; take law.name = {others}, or remove the surface energy"
                )
            return None
        if self.adhesion is not None:
            if given:
                raise CaseError(
                    f"both law.{ADHESION} and materials.{given[0].material}.surface_energy are given; keep one"
                )
            return self.adhesion
        if body.energy is None or target.energy is None:
            missing = body.material if body.energy is None else target.material
            raise CaseError(
                f"law {self.name} needs law.{ADHESION} (of all pairs), or the surface_energy of every material, which "
                f"{missing!r} has not; add it"
            )
        return 2.0 * math.sqrt(body.energy * target.energy)

    def pair(self, body: float, target: float, adhesion: float | None = None) -> LawSpec:
        """The law of two bodies of these strengths [Pa] and this work of adhesion [J/m^2] (None: without adhesion)."""
        own = {} if adhesion is None else {ADHESION: adhesion}
        return LawSpec(self.name, self.ratios | own, (body, target)).of(body, target)


def default_numbers(name: str) -> LawNumbers:
    """The law `name` with its default parameters. Raises CaseError for a law that does not exist."""
    law = law_named(name)
    ratios = {p.name: p.default for p in law.parameters if p.default is not None}
    return LawNumbers(name, ratios, None, law.default_ratio)
