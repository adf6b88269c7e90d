# SPDX-License-Identifier: GPL-2.0-or-later
"""Materials, bodies, values of pairs and the law in a deck of YADE, in words of epdem_yade."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import atan

from ...base.declarations import Declaration, declarations
from ...case.fields import NODES, Tangential


@dataclass(frozen=True)
class DeckMaterial:
    """A material of a deck: keywords of EpMat or of a material of YADE's own, SI."""

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
class BodyTable:
    """The bodies of one kind; `data` holds x, y, z [m] and v_z [m/s] of each, if oblique v_x and omega_y [rad/s]."""

    data: str
    radius: float
    material: str


@dataclass(frozen=True)
class ContactClasses:
    """Law and materials of a deck. functors: of epdem_yade; None: the C library's law for `of_pair`, the numbers of the
    pair, or `native`, a law of YADE.
    """

    law: str
    functors: Functors | None
    materials: tuple[DeckMaterial, ...]
    of_pair: Mapping[str, float] | None = None
    native: bool = False


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
) -> DeckMaterial:
    """EpMat of a body. parameters: of the law, by their names; strength: of the body [Pa], inf: it never yields."""
    declared = declarations()[law]
    values = {"young": young_modulus, "poisson": poisson_ratio, "density": density, "frictionAngle": atan(friction)}
    given = {**parameters} | ({declared.strength: strength} if declared.strength else {})
    return DeckMaterial(name, values | _of_bodies(declared, given))


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
