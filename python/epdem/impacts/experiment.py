# SPDX-License-Identifier: GPL-2.0-or-later
"""A case made ready for physics: two bodies, the pair's quantities and the law with its numbers, all SI."""

import math
from dataclasses import dataclass

import numpy as np

from ..case.impact import RIGID, Case, within_limits
from ..case.units import to_si
from ..errors import CaseError
from ..laws import library as claw
from ..theory import backbones, pair


@dataclass(frozen=True)
class Body:
    """A sphere, or a plane (radius and mass infinite); a rigid body has an infinite modulus and never yields."""

    radius: float  # [m]
    mass: float  # [kg]
    density: float  # [kg/m^3]
    young_modulus: float  # [Pa]
    poisson_ratio: float
    yield_stress: float | None  # [Pa]; inf for a rigid body
    material: str

    @property
    def rigid(self) -> bool:
        return math.isinf(self.young_modulus)


@dataclass(frozen=True)
class LawSpec:
    """A law and its parameters for one pair of bodies.

    `parameters` are those of the pair, by the law's own names; `strengths` is the law's strength [Pa] of body and
    target (inf: never yields), of which the smaller one is the pair's: the softer body yields first.
    """

    name: str
    parameters: dict[str, float]
    strengths: tuple[float, float]

    @property
    def strength_property(self) -> str | None:
        """LIGGGHTS's name of the strength, or None if the law has none."""
        return next((p.property for p in claw.laws()[self.name].parameters if p.unit == "Pa"), None)

    def ratios(self) -> dict[str, float]:
        """The dimensionless parameters that differ from the law's own defaults, by LIGGGHTS property name."""
        info = claw.laws()[self.name].parameters
        return {
            p.property: self.parameters[p.name] for p in info if p.unit == "1" and self.parameters[p.name] != p.default
        }


@dataclass(frozen=True)
class Experiment:
    """Impacts of `body` on `target` at `speed` [m/s], shape (n,)."""

    case: Case
    law: LawSpec
    body: Body
    target: Body
    speed: np.ndarray
    E_star: float
    G_star: float
    R_star: float
    m_star: float
    viscous_restitution: float | None = None  # of impacts that do not yield; None: no dashpot

    def theory(self):
        """The law's backbone as the theory knows it."""
        cls = backbones.LAWS[self.law.name]
        keywords = {cls.keywords[name]: value for name, value in self.law.parameters.items()}
        return cls(E_star=self.E_star, R_star=self.R_star, **keywords)

    def native_law(self) -> claw.Law:
        """The same law in C++."""
        return claw.Law(self.law.name, E_star=self.E_star, **self.law.parameters)

    @property
    def viscous_number(self) -> float:
        """The dashpot as the C++ laws take it; 0: none."""
        return 0.0 if self.viscous_restitution is None else claw.viscous_number(self.viscous_restitution)


def _body(case: Case, material: str, radius: float | None) -> Body:
    if material == RIGID:
        return Body(math.inf, math.inf, math.inf, math.inf, 0.0, math.inf, RIGID)
    m = case.materials[material]
    if radius is None:
        return Body(math.inf, math.inf, m.density, m.young_modulus, m.poisson_ratio, m.yield_stress, material)
    mass = float(pair.sphere_mass(radius=radius, density=m.density))
    return Body(radius, mass, m.density, m.young_modulus, m.poisson_ratio, m.yield_stress, material)


def _read(key: str, value: object, unit: str) -> float:
    try:
        x = within_limits(to_si(value, unit), unit)
    except ValueError as error:
        raise CaseError(f"law.{key} = {value!r}, {error}") from None
    if not x > 0:
        raise CaseError(f"law.{key} = {value!r}, must be > 0; leave it out for the default")
    return x


def choose_law(case: Case, bodies: tuple[Body, Body], name: str | None = None) -> LawSpec:
    """The case's law, or the law `name` with its default parameters. Raises CaseError.

    A strength X [Pa] is given as `X = "2.8 GPa"` for both bodies or as `X_ratio = 2.8` of each body's yield stress.
    """
    given = case.law.parameters() if name is None else {}
    name = name or case.law.name
    if name not in claw.laws() or name not in backbones.LAWS:
        raise CaseError(f"law.name = {name!r} does not exist; there are {', '.join(claw.laws())}")
    info, cls = claw.laws()[name], backbones.LAWS[name]
    parameters: dict[str, float] = {}
    strengths = (math.inf, math.inf)
    for p in info.parameters:
        if p.unit != "Pa":
            parameters[p.name] = _read(p.name, given.pop(p.name, p.default), p.unit)
            continue
        absolute, ratio = given.pop(p.name, None), given.pop(p.name + "_ratio", None)
        if absolute is not None and ratio is not None:
            raise CaseError(f"law: both {p.name} and {p.name}_ratio are given; keep one")
        if absolute is not None:
            value = _read(p.name, absolute, "Pa")
            strengths = tuple(math.inf if b.rigid else value for b in bodies)
        else:
            factor = cls.default_ratio if ratio is None else _read(p.name + "_ratio", ratio, "1")
            for b in bodies:
                if b.yield_stress is None:
                    raise CaseError(f"law {name} needs materials.{b.material}.yield_stress (or law.{p.name}); add it")
            strengths = tuple(factor * b.yield_stress for b in bodies)
        parameters[p.name] = min(strengths)
    if given:
        known = [n for p in info.parameters for n in ((p.name, p.name + "_ratio") if p.unit == "Pa" else (p.name,))]
        raise CaseError(
            f"law.{next(iter(given))}: law {name} has no such parameter; it has {', '.join(known) or 'none'}"
        )
    return LawSpec(name, parameters, strengths)


def experiment(case: Case, law: str | None = None) -> Experiment:
    """The case as physics; `law` replaces the case's law and drops its parameters. Raises CaseError."""
    body = _body(case, case.impact.body.material, case.impact.body.radius)
    target = _body(case, case.impact.target.material, case.impact.target.radius)
    spec = choose_law(case, (body, target), law)
    if math.isinf(min(spec.strengths)) and spec.parameters and spec.strength_property:
        raise CaseError("both bodies are rigid; at least one must deform")
    elastic = (body.young_modulus, body.poisson_ratio, target.young_modulus, target.poisson_ratio)
    e = Experiment(
        case=case,
        law=spec,
        body=body,
        target=target,
        speed=case.impact.speed_values(),
        E_star=float(pair.E_star(*elastic)),
        G_star=float(pair.G_star(*elastic)),
        R_star=float(pair.R_star(body.radius, target.radius)),
        m_star=float(pair.m_star(body.mass, target.mass)),
        viscous_restitution=case.viscous.restitution if case.viscous else None,
    )
    e.native_law()
    try:
        e.theory()  # parameters that make no sense together are refused here
    except (ValueError, ArithmeticError) as error:
        given = ", ".join(f"law.{name} = {value:g}" for name, value in spec.parameters.items())
        raise CaseError(f"{given}: {error}") from None
    return e
