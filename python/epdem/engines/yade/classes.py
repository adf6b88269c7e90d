# SPDX-License-Identifier: GPL-2.0-or-later
"""Materials, bodies, values of pairs and the law in a deck of YADE: words of epdem_yade, numbers of the deck's laws."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import atan, inf

from ...base.declarations import Declaration, declarations
from ...case.fields import NODES, Tangential
from ...errors import CaseError
from ...laws.strengths import law_named
from ...yade.deck_modules import cone
from ...yade.deck_modules.law import trigger_factor


@dataclass(frozen=True)
class Material:
    """A material of a deck: keywords of `Contacts.material`, of EpMat or of a material of YADE's own, SI."""

    name: str
    values: Mapping[str, float]


@dataclass(frozen=True)
class PairValue:
    """A value of pairs of materials: one for all, or of each pair of materials, numbered from 0, that is given."""

    name: str
    common: float | None = None
    matches: tuple[tuple[int, int, float], ...] = ()


@dataclass(frozen=True)
class Functors:
    """Arguments of Ip2_EpMat_EpMat_EpPhys and Law2_ScGeom_EpPhys_<law>; shapes: what spheres touch, by YADE's names."""

    law: str
    shapes: tuple[str, ...]
    pairs: tuple[PairValue, ...]
    settings: Mapping[str, object]

    @property
    def grows(self) -> bool:
        """Whether the law has compaction, for which the functors of the geometry are those of grown spheres."""
        return "compaction" in self.settings


@dataclass(frozen=True)
class Group:
    """The bodies of one kind; `data` holds x, y, z [m] and v_z [m/s] of each, if oblique v_x and omega_y [rad/s]."""

    data: str
    radius: float
    material: str


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


def material(
    name: str,
    law: str,
    parameters: Mapping[str, float],
    *,
    strength: float,
    young_modulus: float,
    poisson_ratio: float,
    density: float,
    friction: float,
) -> Material:
    """EpMat of a body. parameters: of the law, by their names; strength: of the body [Pa], inf: it never yields."""
    declared = declarations()[law]
    values = {"young": young_modulus, "poisson": poisson_ratio, "density": density, "frictionAngle": atan(friction)}
    given = {**parameters} | ({declared.strength: strength} if declared.strength else {})
    return Material(name, values | _of_bodies(declared, given))


def _of_bodies(declared: Declaration, given: Mapping[str, float]) -> dict[str, float]:
    return {
        p.property: given[p.name]
        for p in declared.parameters
        if not p.of_pair and p.name in given and (given[p.name] != p.default or p.default is None)
    }


def title(law: str) -> str:
    """The C++ name of a law: thornton_ning -> ThorntonNing."""
    return law.title().replace("_", "")


def settings(tangential: Tangential | None, **more: object) -> dict[str, object]:
    """Settings of the law's functor; tangential: None without friction."""
    return ({"tangential": repr(tangential)} if tangential and NODES[tangential] else {}) | more


def of_pairs(name: str, rows: Iterable[Iterable[float]]) -> PairValue:
    """A value of each pair of types, from a symmetric matrix."""
    matches = tuple((a, b, x) for a, row in enumerate(rows) for b, x in enumerate(row) if a <= b)
    values = {x for *_, x in matches}
    return PairValue(name, values.pop()) if len(values) == 1 else PairValue(name, None, matches)
