# SPDX-License-Identifier: GPL-2.0-or-later
"""The law between two materials of a scene, and impacts of two bodies as models of its contacts. SI."""

from dataclasses import replace

import numpy as np

from ..case.law import law_numbers
from ..case.scene import SceneCase
from ..case.units import read_number
from ..errors import CaseError
from ..impacts.experiment import Body, Experiment, plane, sphere
from ..laws.strengths import LawNumbers, LawSpec, Surface, law_named
from ..theory import adhesion
from ..theory.backbones import JKR
from ..theory.pair import E_star


def numbers(case: SceneCase) -> LawNumbers:
    """The scene's law before its bodies. Raises CaseError."""
    return law_numbers(case.law.name, case.law.parameters())


def strengths(case: SceneCase) -> dict[str, float]:
    """The law's strength [Pa] of every material, inf for a law that never yields. Raises CaseError.

    The key of the material, else the value of the law for all.
    """
    law = numbers(case)
    strength = law_named(law.name).strength
    strengths = {}
    for name, material in case.materials.items():
        extra = dict(material.model_extra or {})
        own = None
        if strength in extra:
            own = read_number(f"materials.{name}.{strength}", extra.pop(strength), "Pa")
        for key in extra:
            raise CaseError(f"materials.{name}.{key}: unknown key; remove it or correct its spelling")
        strengths[name] = law.strength(name, material.yield_stress, own)
    return strengths


def work_of_adhesion(case: SceneCase, a: str, b: str) -> float | None:
    """Gamma of two materials [J/m^2]; None for a law without adhesion. Raises CaseError."""
    surfaces = [Surface(name, case.materials[name].surface_energy) for name in (a, b)]
    return numbers(case).work_of_adhesion(*surfaces)


def pair_law(case: SceneCase, a: str, b: str) -> tuple[LawSpec, float]:
    """(the law of a contact between two materials, its E* [Pa])."""
    strong, first, second = strengths(case), case.materials[a], case.materials[b]
    elastic = (first.young_modulus, first.poisson_ratio, second.young_modulus, second.poisson_ratio)
    return numbers(case).pair(strong[a], strong[b], work_of_adhesion(case, a, b)), float(E_star(*elastic))


def _impact(case: SceneCase, body: Body, target: Body, v: float) -> Experiment:
    law = pair_law(case, body.material, target.material)[0]
    viscous = case.viscous.restitution if case.viscous and not law.adheres else None  # no theory has both
    x = Experiment(law, body, target, np.geomspace(v / 100, v, 5), viscous_restitution=viscous, name=case.name)
    return replace(x, speed=_far_from_sticking(x))


def _far_from_sticking(x: Experiment) -> np.ndarray:
    """The speeds at which the error of e_n says something: near the sticking speed e_n falls to 0 as a root."""
    law, v = x.theory(), x.speed
    if not isinstance(law, JKR):
        return v
    share = v / max(float(adhesion.sticking_speed(law, m_star=x.m_star)), 1e-300)
    far = v[(share < 0.5) | (share > 2.0)]
    return far if far.size else v[-1:] * 2.0 / share[-1]


def sphere_impact(case: SceneCase, material: str, radius: float, other: str, v: float) -> Experiment:
    """The impact of a sphere on one of `other` of the same radius [m] at speeds up to v [m/s]: a scene's shortest."""
    body, target = (sphere(case.materials[name], radius=radius, name=name) for name in (material, other))
    return _impact(case, body, target, v)


def wall_impact(case: SceneCase, material: str, radius: float, other: str, v: float) -> Experiment:
    """The impact of a sphere of `radius` [m] on a flat wall of `other`, at speeds up to v [m/s]."""
    body = sphere(case.materials[material], radius=radius, name=material)
    return _impact(case, body, plane(case.materials[other], name=other), v)
