# SPDX-License-Identifier: GPL-2.0-or-later
"""Words of pair_coeff and walls: LAW E nu PARAMETERS and the options of a contact."""

from ...base.declarations import declarations
from ...base.rendering import number
from ...laws.strengths import ADHESION
from ...scenes.plan.model import Model
from ..input_script import finite


def of_type(m: Model, i: int) -> str:
    """The material of type i, from 1: LAW E nu PARAMETERS, SI."""
    t, declared = m.types[i - 1], declarations()[m.law]
    values = m.parameters | ({declared.strength: finite(t.strength)} if declared.strength else {})
    values |= {ADHESION: m.adhesion[i - 1][i - 1]} if m.adheres else {}
    numbers = (finite(t.young_modulus), t.poisson_ratio, *(values[p.name] for p in declared.parameters))
    return " ".join([m.law, *map(number, numbers)])


def options(m: Model, i: int, j: int) -> str:
    """The options of contacts of types i and j, from 1; "" without any."""
    words = []
    if m.sliding:
        words += ["tangential", m.tangential, number(m.friction[i - 1][j - 1])]
    if m.viscous is not None:
        both = not m.sliding or m.tangential_restitution is not None
        words += ["restitution" if both else "normal_restitution", number(m.viscous[i - 1][j - 1])]
    elif m.tangential_restitution is not None:
        words += ["tangential_restitution", number(m.tangential_restitution)]
    if m.rolling:
        words += ["rolling", m.rolling.model, number(m.rolling.coefficient)]
    if m.attraction:
        words += ["cohesion", m.attraction[0], number(m.attraction[1])]
    if m.compaction:
        words += ["compaction", "on"]
    return " ".join(words)
