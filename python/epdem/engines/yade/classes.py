# SPDX-License-Identifier: GPL-2.0-or-later
"""Materials, bodies, values of pairs and the law in a deck of YADE, in words of epdem_yade."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import atan

from ...base.declarations import declarations
from ...scenes.plan.model import Model


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
class ContactClasses:
    """Law and materials of a deck. functors: of epdem_yade; None: the C library's law for `of_pair`, the numbers of the
    pair, or `native`, a law of YADE.
    """

    law: str
    functors: Functors | None
    materials: tuple[DeckMaterial, ...]
    of_pair: Mapping[str, float] | None = None
    native: bool = False


def materials(m: Model) -> tuple[DeckMaterial, ...]:
    """EpMat of each type, without the parameters of the law that have their default."""
    declared, found = declarations()[m.law], []
    for t in m.types:
        given = m.parameters | ({declared.strength: t.strength} if declared.strength else {})
        of_law = {
            p.property: given[p.name] for p in declared.parameters if not p.of_pair and given[p.name] != p.default
        }
        elastic = {"young": t.young_modulus, "poisson": t.poisson_ratio, "density": t.density}
        found.append(DeckMaterial(t.name, elastic | of_law))
    return tuple(found)


def functors(m: Model, shapes: Iterable[str], **settings: object) -> Functors:
    """The functors of a contact model. shapes: what spheres touch; settings: of the law's functor.

    Values of pairs as in LIGGGHTS: the restitution of [viscous] belongs to both dashpots.
    """
    pairs = [of_pairs("frictAngle", [[atan(mu) for mu in row] for row in m.friction])]
    pairs += [of_pairs("en", m.viscous)] if m.viscous else []
    if m.tangential_restitution is not None:
        pairs.append(of_pairs("es", m.viscous) if m.viscous else PairValue("es", m.tangential_restitution))
    pairs += [PairValue("rollingFriction", m.rolling.coefficient)] if m.rolling else []
    pairs += [PairValue("cohesionEnergyDensity", m.attraction[1])] if m.attraction else []
    pairs += [of_pairs("workOfAdhesion", m.adhesion)] if m.adheres else []
    models: dict[str, object] = {"tangential": repr(m.tangential)} if m.nodes else {}
    models |= {"rolling": repr(m.rolling.model)} if m.rolling else {}
    models |= {"cohesion": repr(m.attraction[0])} if m.attraction else {}
    models |= {"compaction": "True"} if m.compaction else {}
    title = m.law.title().replace("_", "")  # thornton_ning -> ThorntonNing
    return Functors(title, tuple(shapes), tuple(pairs), models | settings)


def of_pairs(name: str, rows: Iterable[Iterable[float]]) -> PairValue:
    """A value of each pair of types, from a symmetric matrix."""
    matches = tuple((a, b, x) for a, row in enumerate(rows) for b, x in enumerate(row) if a <= b)
    values = {x for *_, x in matches}
    return PairValue(name, values.pop()) if len(values) == 1 else PairValue(name, None, matches)
