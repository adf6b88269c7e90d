# SPDX-License-Identifier: GPL-2.0-or-later
"""Strengths and bodies of the decks of YADE."""

from dataclasses import dataclass
from math import inf

from ...errors import CaseError
from ...laws.strengths import law_named
from ...yade.deck_modules import cone
from ...yade.deck_modules.law import trigger_factor


def strength_values(
    law: str, ratios: dict[str, float], strength: float, young_modulus: float, material: str
) -> dict[str, float]:
    """The law's strength [Pa] by its name, nothing for a law without one. Raises CaseError where YADE's class ends."""
    name = law_named(law).strength
    if name is None:
        return {}
    limit = cone.strongest(young_modulus, trigger_factor(law, **ratios))
    if limit <= strength < inf:
        raise CaseError(
            f"materials.{material}: {name} = {strength:.6g} Pa, YADE's law takes less than "
            f"{limit:.6g} Pa at this young_modulus; use --engine liggghts"
        )
    return {name: strength}


@dataclass(frozen=True)
class Group:
    """The bodies of one kind; `data` holds x, y, z [m] and v_z [m/s] of each, if oblique v_x and omega_y [rad/s]."""

    data: str
    radius: float
    material: str
