# SPDX-License-Identifier: GPL-2.0-or-later
"""Words of pair_coeff and walls: LAW E nu PARAMETERS and the options of a contact."""

from collections.abc import Mapping

from ...base.declarations import declarations
from ...base.rendering import number
from ...laws.strengths import ADHESION
from ...scenes.plan import ScenePlan
from ..input_script import finite


def material(law: str, E: float, nu: float, strength: float, given: Mapping[str, float]) -> str:
    """LAW E nu PARAMETERS of a body [Pa]; given: the other parameters of the law, by name."""
    declared = declarations()[law]
    values = {**given, **({declared.strength: finite(strength)} if declared.strength else {})}
    words = [law, *map(number, (finite(E), nu)), *(number(values[p.name]) for p in declared.parameters)]
    return " ".join(words)


def of_type(p: ScenePlan, i: int) -> str:
    """The material of type i, from 1, of a scene."""
    t, m = p.model.types[i - 1], p.model
    x = p.case.materials[t.material]
    given = m.parameters | ({ADHESION: m.adhesion[i - 1][i - 1]} if m.adheres else {})
    return material(m.law, x.young_modulus, x.poisson_ratio, t.strength, given)


def options(p: ScenePlan, i: int, j: int) -> str:
    """The options of contacts of types i and j, from 1; "" without any."""
    m, words = p.model, []
    if m.sliding:
        words += ["tangential", m.tangential, number(m.friction[i - 1][j - 1])]
    if m.viscous is not None:
        both = not m.sliding or m.tangential_restitution is not None
        words += ["restitution" if both else "normal_restitution", number(m.viscous[i - 1][j - 1])]
    elif m.tangential_restitution is not None:
        words += ["tangential_restitution", number(m.tangential_restitution)]
    if m.rolling:
        words += ["rolling", m.rolling.model, number(m.rolling.coefficient)]
    if m.cohesion:
        words += ["cohesion", "sjkr", number(m.cohesion)]
    if m.compaction:
        words += ["compaction", "on"]
    return " ".join(words)
