# SPDX-License-Identifier: GPL-2.0-or-later
"""A law with its numbers, first for all bodies and then for a pair of them. SI throughout."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Protocol

from ..base.declarations import Declaration, declarations
from ..errors import CaseError
from ..theory.backbone import Law
from ..theory.backbones import ADHESIVE, JKR, LAWS, Backbone
from ..theory.indentation import PYRAMID, Indentation, mean_pressure
from ..theory.indentation import yield_stress as yield_stress_of
from ..theory.numerics import Array, Real, bisect
from ..theory.pair import HARDENING, E_star, curvature_share, strain_share

ADHESION = "work_of_adhesion"  # the parameter of laws with adhesion [J/m^2]
LEAST_STRENGTH = 1e-8  # of E*; the largest is E* itself


def find_law(name: str) -> Declaration:
    """Declaration of the law of that name. Raises CaseError."""
    if name not in declarations():
        raise CaseError(f"law.name = {name!r} does not exist; there are {', '.join(declarations())}")
    return declarations()[name]


def yields_by_stress(name: str) -> bool:
    """Whether the strength of a law is the yield stress itself, not a contact pressure. Raises CaseError."""
    return find_law(name).strength == "yield_stress"


class Solid(Protocol):
    """Elastic constants of a material and what is known of its strength: yield_stress, hardness [Pa], yield_ratio."""

    @property
    def young_modulus(self) -> float: ...
    @property
    def poisson_ratio(self) -> float: ...
    @property
    def yield_stress(self) -> float | None: ...
    @property
    def hardness(self) -> float | None: ...
    @property
    def yield_ratio(self) -> float | None: ...


def own_ratios(name: str, parameters: Mapping[str, float]) -> dict[str, float]:
    """The dimensionless ones of a law's parameters that differ from its defaults, by the law's own names."""
    known = find_law(name).parameters
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

    def theory(self, *, E_star: float, R_star: Real, radius: Real) -> Law:
        """The law in the theory for one R_star and radius of the first body [m] or many, shape (n,).

        Raises ValueError for parameters that make no sense together.
        """
        if self.adheres:
            return self.adhesive(E_star=E_star, R_star=R_star, radius=radius)
        return self.backbone(E_star=E_star, R_star=R_star, radius=radius)

    def backbone(self, *, E_star: float, R_star: Real, radius: Real) -> Backbone:
        """`theory` of a law without adhesion. Raises KeyError for another one."""
        law = LAWS[self.name]
        return law(E_star=E_star, R_star=R_star, **self._numbers(law.uses_share, R_star, radius))

    def adhesive(self, *, E_star: float, R_star: Real, radius: Real) -> JKR:
        """`theory` of a law with adhesion. Raises KeyError for another one."""
        law = ADHESIVE[self.name]
        return law(E_star=E_star, R_star=R_star, **self._numbers(law.uses_share, R_star, radius))

    def _numbers(self, uses_share: bool, R_star: Real, radius: Real) -> dict[str, Any]:
        symbols = find_law(self.name).symbols
        share = {"share": self.curvature_share(R_star, radius)} if uses_share else {}
        return {symbols[name]: x for name, x in self.parameters.items()} | share

    def of(self, body: float, target: float) -> "LawSpec":
        """The same law for two bodies of these strengths [Pa]."""
        strength = find_law(self.name).strength
        own = {} if strength is None else {strength: min(body, target)}
        return replace(self, parameters=self.parameters | own, strengths=(body, target))

    def shown(self) -> dict[str, float]:
        """The parameters for readers: without finite_strain where it is off."""
        hidden = {"finite_strain"} - {*self.ratios()}
        return {name: value for name, value in self.parameters.items() if name not in hidden}

    @property
    def share(self) -> float:
        """Share of the weaker body in the strain: 1/2 of bodies of equal strength, 1 if the other one never yields."""
        return max(self._first_share, 1.0 - self._first_share)

    def curvature_share(self, R_star: Real, radius: Real) -> Array:
        """`pair.curvature_share` of contacts of these R_star and radii of body i [m]; 1/2 without finite strain.

        Only finite strain depends on it.
        """
        one = self._first_share if "finite_strain" in self.ratios() else 0.5
        return curvature_share(one, R_star=R_star, R1=radius)

    def strain_curvature(self, R_star: Real, radius: Real) -> Array:
        """l of the strain l a/R* of contacts of these R_star and radii of body i [m] (`pair.curvature_share`)."""
        return curvature_share(self._first_share, R_star=R_star, R1=radius)

    @property
    def _first_share(self) -> float:
        plastic, first = (self.parameters.get(name, 0.0) for name in ("plastic_ratio", "first_yield_ratio"))
        hardening = plastic / first if plastic > first else HARDENING  # the law refuses others
        return float(strain_share(*self.strengths, hardening=hardening))

    @property
    def adheres(self) -> bool:
        return find_law(self.name).adheres

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

    def strength(self, material: str, solid: Solid, own: float | None = None) -> float:
        """Strength [Pa] of a body of `material`: its `own`, else by the law's rule; inf for a law without one.

        The rule is the strength for all bodies, else what the hardness, the overlap of first yield or the yield stress
        of the material gives. Raises CaseError if the material has none of them.
        """
        yield_stress = solid.yield_stress
        name = find_law(self.name).strength
        if name is None or yield_stress == math.inf:
            return math.inf
        if own is not None:
            return own
        if self.absolute is not None:
            return self.absolute
        if solid.hardness is not None:
            place = f"materials.{material}.hardness"
            return strength_of_hardness(self, Indentation(solid.hardness, PYRAMID), solid, place)
        if solid.yield_ratio is not None:
            return strength_of_yield_ratio(self, solid.yield_ratio, solid)
        if yield_stress is None:
            raise CaseError(
                f"law {self.name} needs the yield_stress, hardness or yield_ratio of materials.{material} "
                f"(or law.{name}, the same for all); add it, or yield_stress = 'inf Pa' if the material never yields"
            )
        return self.ratio * yield_stress

    def work_of_adhesion(self, energies: Mapping[str, float | None]) -> float | None:
        """Gamma of two bodies [J/m^2] from the surface energies of their materials (None: not given), by name.

        None for a law without adhesion. Raises CaseError if it does not follow from what is given, or if more is given
        than the law takes.
        """
        given = {name: energy for name, energy in energies.items() if energy is not None}
        if not find_law(self.name).adheres:
            if wrong := next((name for name, energy in given.items() if energy), None):
                adhesive = [law for law in declarations().values() if law.adheres]
                own = [law.name for law in adhesive if law.without_adhesion == self.name]
                reason = "" if own else ", and no theory of adhesion exists for it"
                others = " or ".join(map(repr, own or [law.name for law in adhesive]))
                raise CaseError(
                    f"materials.{wrong}.surface_energy = {given[wrong]:g} J/m^2: law {self.name} has no adhesion"
                    f"{reason}; take law.name = {others}, or remove the surface energy"
                )
            return None
        if self.adhesion is not None:
            for name in given:
                raise CaseError(f"both law.{ADHESION} and materials.{name}.surface_energy are given; keep one")
            return self.adhesion
        if missing := [name for name in energies if name not in given]:
            raise CaseError(
                f"law {self.name} needs law.{ADHESION} (of all pairs), or the surface_energy of every material, which "
                f"{missing[0]!r} has not; add it"
            )
        gammas = list(given.values())  # one, if both bodies are of one material
        return 2.0 * math.sqrt(gammas[0] * gammas[-1])

    def pair(self, body: float, target: float, adhesion: float | None = None) -> LawSpec:
        """The law of two bodies of these strengths [Pa] and this work of adhesion [J/m^2] (None: without adhesion)."""
        own = {} if adhesion is None else {ADHESION: adhesion}
        return LawSpec(self.name, self.ratios | own, (body, target)).of(body, target)


def default_numbers(name: str) -> LawNumbers:
    """The law `name` with its default parameters. Raises CaseError for a law that does not exist."""
    law = find_law(name)
    ratios = {p.name: p.default for p in law.parameters if p.default is not None}
    return LawNumbers(name, ratios, None, law.default_ratio)


def strength_of_hardness(law: LawNumbers, test: Indentation, solid: Solid, source: str) -> float:
    """Strength [Pa] with which `solid` has the mean pressure of a hardness test with a rigid indenter.

    A yield stress follows from the constraint of an expanding cavity, a contact pressure from the law's own mean
    pressure at a/R of the test. Raises CaseError, which begins with `source`, for pressures that no strength gives.
    """
    E, nu = solid.young_modulus, solid.poisson_ratio
    plane = float(E_star(E, nu, math.inf, 0.0))
    elastic = 4 / (3 * math.pi) * test.slope  # p_m/E* of Hertz at this a/R
    unit = "a hardness is in kgf/mm^2 (HV, for steel 100 to 1000) or in Pa"
    if not LEAST_STRENGTH <= test.pressure / plane < elastic:
        raise CaseError(
            f"{source}: its mean pressure {test.pressure:.3g} Pa must lie between {LEAST_STRENGTH:g} and {elastic:.2g} "
            f"of E* = {plane:.3g} Pa; {unit}"
        )
    if yields_by_stress(law.name):
        try:
            return yield_stress_of(test, young_modulus=E, poisson_ratio=nu, most=law.ratios["plastic_ratio"])
        except ValueError as error:
            raise CaseError(f"{source}: {error}; {unit}") from None

    def too_soft(p_y: float) -> bool:
        return mean_pressure(_alone(law, p_y, plane), test.slope) < test.pressure

    if not too_soft(LEAST_STRENGTH * plane):
        raise CaseError(
            f"{source}: no {find_law(law.name).strength} above {LEAST_STRENGTH:g} of E* = {plane:.3g} Pa gives "
            f"{test.pressure:.3g} Pa with these parameters of {law.name}; lower law.hardening_exponent"
        )
    return float(bisect(too_soft, LEAST_STRENGTH * plane, 2.0 * test.pressure, steps=80)[1])


def strength_of_yield_ratio(law: LawNumbers, ratio: float, solid: Solid) -> float:
    """Strength [Pa] with which two like spheres first yield at an overlap of `ratio` times their diameter.

    The overlap at first yield goes as the square of the strength, alpha_y/R* = 4 ratio.
    """
    like = float(E_star(*(solid.young_modulus, solid.poisson_ratio) * 2))
    unit = 1e-3 * like
    return unit * math.sqrt(4.0 * ratio / float(_alone(law, unit, like).yield_overlap))


def check_ratios(law: LawNumbers) -> None:
    """Raise CaseError for dimensionless parameters that make no sense together."""
    try:
        _alone(law, 1e-3, 1.0)
    except ValueError as error:
        given = ", ".join(f"law.{name} = {value:g}" for name, value in own_ratios(law.name, law.ratios).items())
        raise CaseError(f"{given}: {error}") from None


def yield_ratio_of(law: LawNumbers, strength: float, solid: Solid) -> float:
    """The inverse of `strength_of_yield_ratio`."""
    like = float(E_star(*(solid.young_modulus, solid.poisson_ratio) * 2))
    return float(_alone(law, strength, like).yield_overlap) / 4.0


def _alone(law: LawNumbers, strength: float, modulus: float) -> Backbone:
    """The law without adhesion at R* = 1, of two bodies of this strength [Pa] and E* = `modulus` [Pa]."""
    dry = find_law(law.name).without_adhesion or law.name  # attraction plays no part in the strength
    return (
        replace(law, name=dry, ratios=default_numbers(dry).ratios | law.ratios, absolute=strength)
        .pair(strength, strength)
        .backbone(E_star=modulus, R_star=1.0, radius=2.0)
    )
