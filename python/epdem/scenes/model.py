# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene made ready for a deck: atom types, properties, time step, row and frame intervals. All SI."""

import math
from dataclasses import dataclass

import numpy as np

from ..case import impact as impacts
from ..case.scene import SceneCase
from ..case.units import to_si
from ..errors import CaseError
from ..impacts.experiment import experiment
from ..impacts.prediction import predict
from ..impacts.timestep import search, stability_limit
from ..laws import library as claw
from ..laws.native import Law
from ..theory import backbones

WALL = "wall"
# A sphere in a bed has many contacts: velocity Verlet is stable below half of the step of one contact alone
# (dense packing, central springs); the rest is a margin for tangential springs.
BED_SHARE = 0.4


@dataclass(frozen=True)
class Type:
    """An atom type: a material, or the walls where they have values of their own."""

    name: str
    material: str
    strength: float | None


@dataclass(frozen=True)
class Row:
    """A property/global of the deck."""

    name: str
    style: str
    values: tuple[float, ...]
    comment: str


@dataclass(frozen=True)
class Model:
    """What the contact model of a scene consists of."""

    law: str
    walls: str
    types: tuple[Type, ...]
    rows: tuple[Row, ...]
    tangential: str
    rolling: str | None
    cohesion: str | None
    law_parameters: dict[str, float]

    def type_of(self, name: str) -> int:
        """The number of a type, from 1."""
        return next(i for i, t in enumerate(self.types, 1) if t.name == name)

    @property
    def wall_type(self) -> int:
        return self.type_of(WALL if self.types[-1].name == WALL else self.walls)

    @property
    def yields(self) -> bool:
        return any(t.strength is not None for t in self.types)


def _parameter(place: str, value: object, unit: str) -> float:
    try:
        x = to_si(value, unit)
    except ValueError as error:
        raise CaseError(f"{place} = {value!r}, {error}") from None
    if not x > 0:
        raise CaseError(f"{place} = {value!r}, must be > 0")
    return x


def strengths(case: SceneCase) -> dict[str, float | None]:
    """The law's strength [Pa] of every material, None for a law that never yields. Raises CaseError.

    A material's own key, else the law's absolute value, else the law's ratio times the material's yield stress.
    """
    info, cls = claw.laws()[case.law.name].parameters, backbones.LAWS[case.law.name]
    strong = next((p for p in info if p.unit == "Pa"), None)
    given = case.law.parameters()
    found: dict[str, float | None] = {}
    for name, material in case.materials.items():
        extra = dict(material.model_extra or {})
        for key in extra:
            if strong is None or key != strong.name:
                raise CaseError(f"materials.{name}.{key}: unknown key; remove it or correct its spelling")
        if strong is None:
            found[name] = None
        elif strong.name in extra:
            found[name] = _parameter(f"materials.{name}.{strong.name}", extra[strong.name], "Pa")
        elif strong.name in given:
            found[name] = _parameter(f"law.{strong.name}", given[strong.name], "Pa")
        elif material.yield_stress is None:
            raise CaseError(f"law {case.law.name} needs materials.{name}.yield_stress (or {strong.name}); add it")
        else:
            ratio = given.get(strong.name + "_ratio", cls.default_ratio)
            found[name] = _parameter(f"law.{strong.name}_ratio", ratio, "1") * material.yield_stress
    return found


def _ratios(case: SceneCase) -> dict[str, float]:
    """The law's dimensionless parameters, by the law's own names."""
    info, given = claw.laws()[case.law.name].parameters, case.law.parameters()
    known = {n for p in info for n in ((p.name, p.name + "_ratio") if p.unit == "Pa" else (p.name,))}
    for key in given:
        if key not in known:
            raise CaseError(f"law.{key}: law {case.law.name} has no such parameter; it has {', '.join(sorted(known))}")
    return {p.name: _parameter(f"law.{p.name}", given.get(p.name, p.default), "1") for p in info if p.unit == "1"}


def _materials_used(case: SceneCase) -> list[str]:
    # a bed comes first: while it alone is there, LIGGGHTS wants its types to begin at 1
    parts = [*getattr(case.scene, "bed", []), *case.scene.particles]
    return list(dict.fromkeys(p.material for p in parts))


def model(case: SceneCase) -> Model:
    """The contact model of a scene: only the types, sub-models and properties that it uses. Raises CaseError."""
    if case.law.name not in claw.laws() or case.law.name not in backbones.LAWS:
        raise CaseError(f"law.name = {case.law.name!r} does not exist; there are {', '.join(claw.laws())}")
    strong, used, contact = strengths(case), _materials_used(case), case.contact
    types = [Type(m, m, strong[m]) for m in used]
    pairs_with_wall = any(WALL in p.between for p in contact.pairs)
    own_friction = contact.wall_friction is not None and contact.wall_friction != contact.friction
    if case.scene.walls not in used or own_friction or pairs_with_wall:
        types.append(Type(WALL, case.scene.walls, strong[case.scene.walls]))
    n, ratios = len(types), _ratios(case)
    m = [case.materials[t.material] for t in types]
    for t, x in zip(types, m, strict=True):
        if x.poisson_ratio < 0:
            raise CaseError(f"materials.{t.material}.poisson_ratio = {x.poisson_ratio}, LIGGGHTS takes [0, 0.5] only")
    rows = [
        Row("youngsModulus", "peratomtype", tuple(x.young_modulus for x in m), "Pa"),
        Row("poissonsRatio", "peratomtype", tuple(x.poisson_ratio for x in m), "1"),
    ]
    info = claw.laws()[case.law.name].parameters
    if strength := next((p.property for p in info if p.unit == "Pa"), None):
        values = tuple(t.strength for t in types)
        rows.append(Row(strength, "peratomtype", values, "Pa" if n == 1 else "Pa, the softer body's counts"))
    rows += [
        Row(p.property, "scalar", (ratios[p.name],), "1") for p in info if p.unit == "1" and ratios[p.name] != p.default
    ]

    def square(f) -> tuple[float, ...]:
        return (n, *(f(a, b) for a in types for b in types))

    friction = square(lambda a, b: _friction(case, a, b))
    sliding = any(x > 0 for x in friction[1:])
    if sliding:
        rows.append(Row("coefficientFriction", "peratomtypepair", friction, "1"))
    if case.viscous:
        e = square(lambda a, b: case.viscous.restitution)
        rows.append(Row("coefficientRestitution", "peratomtypepair", e, "1, of impacts that do not yield"))
    elif sliding and contact.tangential_restitution is not None:
        e = square(lambda a, b: contact.tangential_restitution)
        rows.append(Row("coefficientRestitution", "peratomtypepair", e, "1, of the tangential dashpot only"))
    if not sliding and contact.tangential_restitution is not None:
        raise CaseError("contact.tangential_restitution: there is no friction, so no tangential dashpot; remove it")
    if contact.rolling:
        mu = square(lambda a, b: contact.rolling.coefficient)
        rows.append(Row("coefficientRollingFriction", "peratomtypepair", mu, "1"))
        if contact.rolling.damping is not None:
            eta = square(lambda a, b: contact.rolling.damping)
            rows.append(Row("coefficientRollingViscousDamping", "peratomtypepair", eta, "1"))
    if contact.cohesion:
        density = square(lambda a, b: contact.cohesion)
        rows.append(Row("cohesionEnergyDensity", "peratomtypepair", density, "J/m^3"))
    return Model(
        case.law.name,
        case.scene.walls,
        tuple(types),
        tuple(rows),
        "history" if sliding else "off",
        contact.rolling.model if contact.rolling else None,
        "sjkr" if contact.cohesion else None,
        ratios,
    )


def _friction(case: SceneCase, a: Type, b: Type) -> float:
    contact, names = case.contact, {a.name, b.name}
    for pair in contact.pairs:
        if names == set(pair.between):
            return pair.friction
    if WALL in names and contact.wall_friction is not None:
        return contact.wall_friction
    return contact.friction


def pair_law(case: SceneCase, a: str, b: str) -> Law:
    """The law of a contact between two materials."""
    from ..theory import pair

    first, second = case.materials[a], case.materials[b]
    E_star = float(pair.E_star(first.young_modulus, first.poisson_ratio, second.young_modulus, second.poisson_ratio))
    strong, parameters = strengths(case), _ratios(case)
    name = next((p.name for p in claw.laws()[case.law.name].parameters if p.unit == "Pa"), None)
    if name:
        parameters[name] = min(strong[a], strong[b])
    return Law(case.law.name, E_star=E_star, **parameters)


def highest_speed(case: SceneCase) -> float:
    """The highest speed [m/s] that the scene can reach: free fall, the stream, the moving wall; or what it says."""
    if case.numerics.highest_speed is not None:
        return case.numerics.highest_speed
    s = case.scene
    fall = {
        "settle": lambda: s.box[2],
        "hopper": lambda: s.bin_height + s.drop + s.bin_diameter,
        "drum": lambda: s.diameter,
        "compaction": lambda: s.box[2],
        "peening": lambda: 0.0,
    }[s.kind]()
    v = math.sqrt(2.0 * s.gravity * fall)
    if s.kind == "drum":
        v += s.turn * s.diameter / 2
    if s.kind in ("compaction", "peening"):
        v += s.speed if s.kind == "peening" else 2.0 * s.speed
    return v


def time_step(case: SceneCase) -> float:
    """The step [s] of a scene: the target error of e_n at its speeds, below the stable step of a bed."""
    if case.numerics.time_step is not None:
        return case.numerics.time_step
    v = highest_speed(case)
    best = math.inf
    parts = [*case.scene.particles, *getattr(case.scene, "bed", [])]
    bodies = {(p.material, p.radii()[0]) for p in parts}
    for material, radius in sorted(bodies):
        for other in sorted({m for m, _ in bodies} | {case.scene.walls}):
            x = sphere_impact(case, material, radius, other, v)
            prediction = predict(x)
            found = search(x, prediction, case.numerics.error).time_step
            best = min(best, found, BED_SHARE * stability_limit(x, float(prediction.overlap_max.max())))
    return _round_down(best)


def sphere_impact(case: SceneCase, material: str, radius: float, other: str, v: float):
    """The impact of a sphere on one of `other` of the same radius, at speeds up to v: the shortest of a scene."""
    return _impact(
        case,
        material,
        other,
        v,
        {
            "kind": "sphere-sphere",
            "body": {"radius": f"{radius!r} m", "material": material},
            "target": {"radius": f"{radius!r} m", "material": other},
        },
    )


def wall_impact(case: SceneCase, material: str, radius: float, other: str, v: float):
    """The impact of a sphere on a flat wall of `other`, at speeds up to v."""
    return _impact(
        case,
        material,
        other,
        v,
        {
            "kind": "sphere-wall",
            "body": {"radius": f"{radius!r} m", "material": material},
            "target": {"material": other},
        },
    )


def _impact(case: SceneCase, material: str, other: str, v: float, bodies: dict):
    def table(name):
        m = case.materials[name]
        return {
            "young_modulus": f"{m.young_modulus!r} Pa",
            "poisson_ratio": float(m.poisson_ratio),
            "density": f"{m.density!r} kg/m^3",
        }

    law, strong = {"name": case.law.name, **_ratios(case)}, strengths(case)
    if strength := next((p.name for p in claw.laws()[case.law.name].parameters if p.unit == "Pa"), None):
        law[strength] = f"{min(strong[material], strong[other])!r} Pa"
    data = {
        "case": {"name": "step", "title": "step", "source": "scene"},
        "materials": {name: table(name) for name in {material, other}},
        "law": law,
        **({"viscous": {"restitution": case.viscous.restitution}} if case.viscous else {}),
        "impact": bodies | {"speeds": {"from": f"{v / 100!r} m/s", "to": f"{v!r} m/s", "count": 5}},
    }
    return experiment(impacts.parse(data, case.name))


def _round_down(x: float) -> float:
    """Two significant digits, so that the deck is readable."""
    power = 10.0 ** (math.floor(math.log10(x)) - 1)
    return float(np.float64(f"{math.floor(x / power) * power:.1e}"))
