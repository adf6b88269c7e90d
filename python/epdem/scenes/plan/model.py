# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact model of a scene, neutral of engines: the law of each pair, types, friction, sub-models."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from ...base.declarations import declarations
from ...case.fields import NODES, Tangential
from ...case.scene import Rolling, SceneCase
from ...errors import CaseError
from ...laws.strengths import LawSpec, own_ratios
from ...theory.pair import E_star

WALL = "wall"


@dataclass(frozen=True)
class Type:
    """A material, or walls where they have their own values; SI, `strength` is inf if it never yields."""

    name: str
    material: str
    strength: float
    young_modulus: float
    poisson_ratio: float
    density: float
    wall: bool = False


@dataclass(frozen=True)
class Model:
    """Contact model; numbers of types begin at 1.

    parameters: dimensionless parameters of the law. wall_types: the type of each wall material; the key "" stands for
    the material of the scene's walls. friction: of each pair of types, by the model `tangential`. viscous: restitution
    of elastic impacts of each pair; tangential_restitution: of the dashpot beside the tangential spring. cohesion:
    energy density [J/m^3]. bond: strength [Pa] of bonds. adhesion: work of adhesion of each pair of types [J/m^2], of
    laws with adhesion. compaction: spheres grow at each contact by the dents of their other contacts.
    """

    law: str
    parameters: dict[str, float]
    types: tuple[Type, ...]
    wall_types: dict[str, int]
    friction: tuple[tuple[float, ...], ...]
    tangential: Tangential
    viscous: tuple[tuple[float, ...], ...] | None
    tangential_restitution: float | None
    rolling: Rolling | None
    cohesion: float | None
    adhesion: tuple[tuple[float, ...], ...] = ()
    compaction: bool = False
    bond: float | None = None

    def type_of(self, name: str) -> int:
        return next(i for i, t in enumerate(self.types, 1) if t.name == name)

    def ratios(self) -> dict[str, float]:
        """The law's parameters that differ from its defaults."""
        return own_ratios(self.law, self.parameters)

    def shares(self) -> list[list[float]]:
        """Share of the weaker body in the strain of contacts of each pair of types."""
        law = LawSpec(self.law, self.parameters, (math.inf, math.inf))
        return [[law.of(a.strength, b.strength).share for b in self.types] for a in self.types]

    @property
    def attraction(self) -> tuple[str, float] | None:
        """Name and number of the model of cohesion; None: none."""
        return ("sjkr", self.cohesion) if self.cohesion else ("bond", self.bond) if self.bond else None

    @property
    def yields(self) -> bool:
        """Whether the law has a strength."""
        return any(t.strength < math.inf for t in self.types)

    @property
    def adheres(self) -> bool:
        """Whether bodies attract each other by the law."""
        return declarations()[self.law].adheres

    @property
    def sliding(self) -> bool:
        return any(mu > 0 for row in self.friction for mu in row)

    @property
    def nodes(self) -> int:
        """Nodes of partial slip in each contact; 0: none."""
        return NODES[self.tangential] if self.sliding else 0

    @property
    def spins(self) -> bool:
        """Whether contacts turn spheres."""
        return self.sliding or self.rolling is not None

    @property
    def loses_energy(self) -> bool:
        """Whether contacts lose energy that no table holds: to one spring's friction, to rolling or to dashpots."""
        return (self.sliding and not self.nodes) or self.rolling is not None or self.viscous is not None


def model(case: SceneCase) -> Model:
    """The contacts of a scene: only the types and sub-models that it uses. Raises CaseError."""
    strong, used, contact = strengths(case), _materials_used(case), case.contact

    def type_of(name: str, material: str, *, wall: bool = False) -> Type:
        x = case.materials[material]
        return Type(name, material, strong[material], x.young_modulus, x.poisson_ratio, x.density, wall)

    types = [type_of(m, m) for m in used]
    pairs_with_wall = any(WALL in p.between for p in contact.pairs)
    own_friction = contact.wall_friction is not None and contact.wall_friction != contact.friction
    walls = case.parts.wall_materials
    wall_types = {}
    for material in walls:
        wall_types[material] = 1 + used.index(material) if material in used else 0
        if material not in used or own_friction or pairs_with_wall:
            types.append(type_of(WALL if len(walls) == 1 else f"{WALL} of {material}", material, wall=True))
            wall_types[material] = len(types)
    wall_types[""] = wall_types[walls[0]] if walls else 1
    dashpot = case.viscous

    def of_pairs(value: Callable[[Type, Type], float | None]) -> tuple[tuple[float, ...], ...]:
        rows = (tuple(x for b in types if (x := value(a, b)) is not None) for a in types)
        return tuple(row for row in rows if row)  # none without adhesion

    result = Model(
        law=case.law.name,
        parameters=case.law.numbers.ratios,
        types=tuple(types),
        wall_types=wall_types,
        friction=of_pairs(lambda a, b: _friction(case, a, b)),
        tangential=contact.tangential,
        viscous=of_pairs(lambda a, b: _own(case, a, b, "restitution") or dashpot.restitution) if dashpot else None,
        tangential_restitution=contact.tangential_restitution,
        rolling=contact.rolling,
        cohesion=contact.cohesion,
        adhesion=of_pairs(lambda a, b: work_of_adhesion(case, a.material, b.material)),
        compaction=case.law.numbers.compaction,
        bond=contact.bond_strength,
    )
    if result.compaction and contact.cohesion is not None:
        raise CaseError("contact.cohesion: contacts with law.compaction have no cohesion; remove one of them")
    if result.bond and not (result.compaction and contact.cohesion is None and NODES[contact.tangential] == 0):
        raise CaseError(
            "contact.bond_strength: bonds hold contacts with law.compaction = true, without contact.cohesion and with "
            "contact.tangential = 'history'; change these"
        )
    for key, given in {"cohesion": contact.cohesion, "bond_strength": contact.bond_strength}.items():
        if result.adheres and given is not None:
            raise CaseError(f"contact.{key}: law {result.law} has its attraction already; remove one of them")
    if result.adheres and NODES[contact.tangential]:
        raise CaseError(f"contact.tangential = {contact.tangential!r}: laws with adhesion have 'history' only; take it")
    if not result.sliding and contact.tangential_restitution is not None:
        raise CaseError("contact.tangential_restitution: there is no friction, so no tangential dashpot; remove it")
    if not result.sliding and contact.tangential != "history":
        raise CaseError(f"contact.tangential = {contact.tangential!r}: there is no friction; give contact.friction")
    return result


def _materials_used(case: SceneCase) -> list[str]:
    return list(dict.fromkeys(p.material for p in case.parts.filled))


def _friction(case: SceneCase, a: Type, b: Type) -> float:
    own = _own(case, a, b, "friction")
    if own is not None:
        return own
    if (a.wall or b.wall) and case.contact.wall_friction is not None:
        return case.contact.wall_friction
    return case.contact.friction


def _own(case: SceneCase, a: Type, b: Type, value: str) -> float | None:
    """Friction of a pair of types by [contact] pairs; a wall goes by "wall", or by a material that is of walls only."""
    spheres = _materials_used(case)

    def names(t: Type) -> set[str]:
        return {t.material} if not t.wall else {WALL} if t.material in spheres else {WALL, t.material}

    for pair in case.contact.pairs:
        one, other = pair.between
        both = (one in names(a) and other in names(b)) or (one in names(b) and other in names(a))
        if both and getattr(pair, value) is not None:
            return float(getattr(pair, value))
    return None


def strengths(case: SceneCase) -> dict[str, float]:
    """The law's strength [Pa] of every material, inf for a law that never yields. Raises CaseError.

    The key of the material, else the value of the law for all.
    """
    return {
        name: case.law.numbers.strength(name, material, material.own_strength(name, case.law.name))
        for name, material in case.materials.items()
    }


def work_of_adhesion(case: SceneCase, a: str, b: str) -> float | None:
    """Gamma of two materials [J/m^2]; None for a law without adhesion. Raises CaseError."""
    return case.law.numbers.work_of_adhesion({name: case.materials[name].surface_energy for name in (a, b)})


def pair_law(case: SceneCase, a: str, b: str) -> tuple[LawSpec, float]:
    """(the law of a contact between two materials, its E* [Pa])."""
    strong, first, second = strengths(case), case.materials[a], case.materials[b]
    elastic = (first.young_modulus, first.poisson_ratio, second.young_modulus, second.poisson_ratio)
    return case.law.numbers.pair(strong[a], strong[b], work_of_adhesion(case, a, b)), float(E_star(*elastic))


@dataclass(frozen=True)
class Heat:
    """share: of the plastic and frictional work that becomes heat. conductivities [W/(m K)], capacities [J/(kg K)]: of
    the types of spheres and walls, 1 where no heat passes. walls: temperatures [K] of walls that have one."""

    share: float
    conductivities: tuple[float, ...]
    capacities: tuple[float, ...]
    walls: dict[str, float]


def heat(case: SceneCase, m: Model) -> Heat | None:
    """The heat of a scene; None: no part has a temperature. Raises CaseError for what lacks one."""
    parts = case.parts
    walls = {w.name: w.temperature for w in parts.wall if w.temperature is not None}
    comes = {f"scene.{kind}.{x.name}": x.temperature for kind in ("fill", "body") for x in getattr(parts, kind)}
    warm = [*(f"scene.wall.{name}" for name in walls), *(place for place, T in comes.items() if T is not None)]
    for row in parts.row:
        if row.heat_flow and row.wall not in walls:
            raise CaseError(
                f"scene.row.{row.name}: wall {row.wall} has no temperature, so no heat flows into it; give it one"
            )
    if not warm:
        return None
    given = f"{parts.place(f'{warm[0]}.temperature')} is given"
    for place, T in comes.items():
        if T is None:
            raise CaseError(f"{parts.place(f'{place}.temperature')} is missing: {given}, and every sphere needs one")
    conducting = {w.material for w in parts.wall if w.name in walls}
    conductivities, capacities = [], []
    for t in m.types:
        x = case.materials[t.material]
        for key in ("thermal_conductivity", "specific_heat"):
            needed = not t.wall or (key == "thermal_conductivity" and t.material in conducting)
            if needed and getattr(x, key) is None:
                raise CaseError(f"materials.{t.material}.{key} is missing: {given}")
        conductivities.append(x.thermal_conductivity or 1.0)
        capacities.append(x.specific_heat or 1.0)
    return Heat(case.contact.heat_share, tuple(conductivities), tuple(capacities), walls)
