# SPDX-License-Identifier: GPL-2.0-or-later
"""The law between two materials of a scene, and the impacts of one pair of bodies that stand for it."""

import numpy as np

from ..case import impact as impacts
from ..case.scene import SceneCase
from ..case.units import to_si
from ..errors import CaseError
from ..impacts.experiment import Experiment, experiment
from ..laws import library as claw
from ..theory import backbones, pair


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


def ratios(case: SceneCase) -> dict[str, float]:
    """The law's dimensionless parameters, by the law's own names."""
    info, given = claw.laws()[case.law.name].parameters, case.law.parameters()
    known = {n for p in info for n in ((p.name, p.name + "_ratio") if p.unit == "Pa" else (p.name,))}
    for key in given:
        if key not in known:
            raise CaseError(f"law.{key}: law {case.law.name} has no such parameter; it has {', '.join(sorted(known))}")
    return {p.name: _parameter(f"law.{p.name}", given.get(p.name, p.default), "1") for p in info if p.unit == "1"}


def pair_law(case: SceneCase, a: str, b: str) -> claw.Law:
    """The law of a contact between two materials."""
    first, second = case.materials[a], case.materials[b]
    E_star = float(pair.E_star(first.young_modulus, first.poisson_ratio, second.young_modulus, second.poisson_ratio))
    strong, parameters = strengths(case), ratios(case)
    name = next((p.name for p in claw.laws()[case.law.name].parameters if p.unit == "Pa"), None)
    if name:
        parameters[name] = min(strong[a], strong[b])
    return claw.Law(case.law.name, E_star=E_star, **parameters)


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

    law, strong = {"name": case.law.name, **ratios(case)}, strengths(case)
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


