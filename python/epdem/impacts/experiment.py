# SPDX-License-Identifier: GPL-2.0-or-later
"""An impact: two bodies, the law with its numbers, the speeds; all SI.

A case file is one way to make an experiment; `sphere`, `plane` and `Experiment` itself are the other.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..case.fields import Material, Tangential
from ..case.impact import RIGID, Case, Check, Numerics, Rate, parse
from ..errors import CaseError
from ..laws import library
from ..laws.library import Law
from ..laws.strengths import LawNumbers, LawSpec, default_numbers, find_law
from ..theory import pair
from ..theory.backbone import Law as Theory
from ..theory.backbones import ADHESIVE, LAWS, Backbone
from ..theory.numerics import Real


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
    hardness: float | None = None  # [Pa]
    yield_ratio: float | None = None  # overlap at first yield of two of them over the diameter
    surface_energy: float | None = None  # [J/m^2]

    @property
    def rigid(self) -> bool:
        """Whether it does not deform."""
        return math.isinf(self.young_modulus)


RIGID_PLANE = Body(math.inf, math.inf, math.inf, math.inf, 0.0, math.inf, RIGID)


def sphere(material: Material, *, radius: float, name: str) -> Body:
    """A sphere of `radius` [m]; `name` is the material's."""
    mass = float(pair.sphere_mass(radius=radius, density=material.density))
    numbers = material.model_dump(include=set(Material.model_fields))
    return Body(radius=radius, mass=mass, material=name, **numbers)


def plane(material: Material, *, name: str) -> Body:
    """A half-space that does not move; `name` is the material's."""
    return replace(sphere(material, radius=1.0, name=name), radius=math.inf, mass=math.inf)


@dataclass(frozen=True)
class Oblique:
    """Angle [rad] from the normal and spin [rad/s] of the body before each impact, shape (n,), and their friction."""

    angle: np.ndarray
    spin: np.ndarray
    friction: float
    tangential: Tangential
    restitution: float | None = None  # of the dashpot beside the tangential spring; None: no dashpot


@dataclass(frozen=True)
class Experiment:
    """Impacts of `body` on `target` at `speed` [m/s] along the normal, shape (n,).

    Raises CaseError for two rigid bodies, and for parameters of the law that make no sense together.
    """

    law: LawSpec
    body: Body
    target: Body
    speed: np.ndarray
    viscous_restitution: float | None = None  # of impacts that do not yield; None: no dashpot
    oblique: Oblique | None = None
    numerics: Numerics = field(default_factory=Numerics)
    check: Check = field(default_factory=Check)
    name: str = "impact"
    title: str = "Impact"
    source: str = "made by a program"
    rated: bool = False  # the strengths are those at a strain rate

    def __post_init__(self) -> None:
        if self.body.rigid and self.target.rigid:
            raise CaseError("both bodies are rigid; at least one must deform")
        if self.law.adheres and self.viscous_restitution is not None:
            raise CaseError(
                f"viscous: no theory of impacts has both adhesion (law {self.law.name}) and a dashpot; remove one"
            )
        if self.law.adheres and self.oblique is not None:
            raise CaseError(f"impact: no theory of oblique impacts has adhesion (law {self.law.name}); remove one")
        try:
            self.theory()
        except (ValueError, ArithmeticError) as error:
            given = ", ".join(f"law.{name} = {value:g}" for name, value in self.law.shown().items())
            raise CaseError(f"{given}: {error}") from None

    def friction_of_oblique(self) -> Oblique:
        """Angles, spins and friction of oblique impacts. Raises CaseError for normal ones."""
        if self.oblique is None:
            raise CaseError("these impacts are normal; give impact.angles")
        return self.oblique

    @cached_property
    def E_star(self) -> float:
        """Effective modulus [Pa]."""
        return float(pair.E_star(*self._elastic))

    @cached_property
    def G_star(self) -> float:
        """Effective shear modulus [Pa]."""
        return float(pair.G_star(*self._elastic))

    @cached_property
    def R_star(self) -> float:
        """Effective radius [m]."""
        return float(pair.R_star(self.body.radius, self.target.radius))

    @cached_property
    def m_star(self) -> float:
        """Effective mass [kg]."""
        return float(pair.m_star(self.body.mass, self.target.mass))

    @property
    def _elastic(self) -> tuple[float, float, float, float]:
        body, target = self.body, self.target
        return body.young_modulus, body.poisson_ratio, target.young_modulus, target.poisson_ratio

    def theory(self) -> Theory:
        return self.law.theory(E_star=self.E_star, R_star=self.R_star, radius=self.body.radius)

    def backbone(self) -> Backbone:
        """The law in the theory, of impacts without adhesion. Raises KeyError for others."""
        return self.law.backbone(E_star=self.E_star, R_star=self.R_star, radius=self.body.radius)

    def native_law(self) -> Law:
        """The same law in C++."""
        return Law(self.law.name, E_star=self.E_star, share=self.curvature_share, **self.law.parameters)

    @property
    def curvature_share(self) -> float:
        """`theory.pair.curvature_share` of the pair: the share that the C++ laws take."""
        return float(self.law.curvature_share(self.R_star, self.body.radius))

    @property
    def viscous_number(self) -> float:
        """The dashpot as the C++ laws take it; 0: none."""
        return 0.0 if self.viscous_restitution is None else library.viscous_number(self.viscous_restitution)


def pair_of(numbers: LawNumbers, body: Body, target: Body, own: Mapping[str, float | None] | None = None) -> LawSpec:
    """The law of two bodies; own: strengths [Pa] by material that materials have themselves.

    Raises CaseError where a yield stress or surface energy is missing.
    """
    strong = [numbers.strength(b.material, b, (own or {}).get(b.material)) for b in (body, target)]
    adhesion = numbers.work_of_adhesion({b.material: b.surface_energy for b in (body, target)})
    spec = numbers.pair(strong[0], strong[1], adhesion)
    return replace(spec, common=numbers.absolute is not None)


def strain_rate(speed: Real, a: Real, *, share: float) -> Real:
    """Mean strain rate [1/s] of the weaker body, whose `share` of the strain is w: 0.2 w speed/a.

    speed [m/s] of the impact, a [m] its largest contact radius. The strain is 0.2 w a/R* (Johnson 1985, section 11.5,
    for w = 1), the time a^2/(R* speed).
    """
    return 0.2 * share * speed / a


def at_rate(x: Experiment, rate: Rate | None) -> Experiment:
    """The experiment with the strengths at the strain rate of its median speed, `strain_rate` at its largest a.

    One strength serves all speeds: a tenfold speed changes the factor by 3 % at a sensitivity of 0.012.
    """
    if rate is None or find_law(x.law.name).strength is None:
        return x
    factor, found, speed = 1.0, x, float(np.sort(x.speed)[x.speed.size // 2])
    for _ in range(20):  # the factor hardly changes the radius: three digits a turn
        found = replace(x, law=x.law.of(*(factor * s for s in x.law.strengths)), rated=True)
        a = float(found.theory().radius_of_work(0.5 * x.m_star * speed**2))
        ratio = float(strain_rate(speed, a, share=found.law.share)) / rate.reference
        factor = 1.0 + rate.sensitivity * math.log(max(ratio, 1.0))
    return found


def _body(case: Case, material: str, radius: float | None) -> Body:
    if material == RIGID:
        return RIGID_PLANE
    m = case.materials[material]
    return plane(m, name=material) if radius is None else sphere(m, radius=radius, name=material)


def bodies(case: Case) -> tuple[Body, Body]:
    """Body and target of a case."""
    body, target = case.impact.body, case.impact.target
    return _body(case, body.material, body.radius), _body(case, target.material, target.radius)


def experiment(case: Case, law: str | None = None) -> Experiment:
    """A case as physics; another `law` than the case's has its default numbers. Raises CaseError."""
    body, target = bodies(case)
    speed, angle, spin = case.impact.rows()
    numbers, own = case.law.numbers, {n: m.own_strength(n, case.law.name) for n, m in case.materials.items()}
    if law not in (None, case.law.name):  # the attraction of the surfaces is not a matter of the law
        numbers = replace(default_numbers(law), adhesion=numbers.adhesion if find_law(law).adheres else None)
        own = {}
    c = case.contact
    x = Experiment(
        law=pair_of(numbers, body, target, own),
        body=body,
        target=target,
        speed=speed,
        viscous_restitution=case.viscous.restitution if case.viscous else None,
        oblique=Oblique(angle, spin, c.friction, c.tangential, c.tangential_restitution) if c else None,
        numerics=case.numerics,
        check=case.tolerances,
        name=case.name,
        title=case.case.title,
        source=case.case.source,
    )
    return at_rate(x, case.rate)


def one_impact(material: str, radius: str, speed: str, adhesion: str | None) -> list[Experiment]:
    """One impact of a sphere on a wall of the same material of the materials file, by every law.

    The numbers are texts with units; with a work of `adhesion` the laws with adhesion come, too. Raises CaseError.
    """
    data = {
        "case": {"name": "one_impact", "title": f"{material} on {material}", "source": "materials file"},
        "materials": {material: {"from": material}},
        "impact": {
            "kind": "sphere-wall",
            "body": {"radius": radius, "material": material},
            "target": {"material": material},
            "speeds": [speed],
        },
        "law": {"name": "jkr", "work_of_adhesion": adhesion} if adhesion else {"name": "hertz"},
    }
    case = parse(data, "epdem predict")
    return [experiment(case, name) for name in [*LAWS, *(ADHESIVE if adhesion else [])]]
