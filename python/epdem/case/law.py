# SPDX-License-Identifier: GPL-2.0-or-later
"""The [law] of a case: its numbers in SI, each checked against the declaration of the law."""

from collections.abc import Mapping
from functools import cached_property
from typing import Annotated, Any, Self

from pydantic import BaseModel, ConfigDict, ValidationError

from ..base.declarations import Declaration, declarations
from ..errors import CaseError
from ..laws.strengths import ADHESION, LawNumbers, check_ratios, find_law
from ..theory.cavity import FINITE_STRAIN
from .fields import Frozen, Header, Material, Name, Quantity
from .messages import explain, nearest, shorten, shown_key
from .sizes import context
from .toml import with_library
from .units import read_number

EXPONENT, INDEX = "hardening_exponent", "meyer_index"


class LawChoice(BaseModel):
    """The law by name, with its parameters as written."""

    model_config = ConfigDict(frozen=True, extra="allow", strict=True)
    name: Name

    def parameters(self) -> dict[str, Any]:
        """The keys beside the name, as written."""
        return dict(self.model_extra or {})

    @cached_property
    def numbers(self) -> LawNumbers:
        """The law before its bodies. Raises CaseError."""
        return law_numbers(self.name, self.parameters())


class LawMaterial(Material):
    """A material that can have the strength of the law as a key (yield_pressure = "3 GPa"); scenes conduct."""

    model_config = ConfigDict(frozen=True, extra="allow", strict=True)
    thermal_conductivity: Annotated[float, Quantity("W/(m K)", above=0.0)] | None = None
    specific_heat: Annotated[float, Quantity("J/(kg K)", above=0.0)] | None = None
    electrical_conductivity: Annotated[float, Quantity("S/m", above=0.0)] | None = None

    def own_strength(self, name: str, law: str) -> float | None:
        """The strength [Pa] that the material `name` has as the key of this law. Raises CaseError for other keys."""
        extra, strength = dict(self.model_extra or {}), find_law(law).strength
        own = extra.pop(strength, None) if strength else None
        for key, value in extra.items():
            known = [*type(self).model_fields, *([strength] if strength else []), "from"]
            shown = f"materials.{name}.{shown_key(key)} = {shorten(repr(value))}"
            raise CaseError(f"{shown}, unknown key with law {law}; the nearest: {nearest(key, known)}")
        return None if own is None else read_number(f"materials.{name}.{strength}", own, "Pa")


class AnyCase(Frozen):
    """What impacts and scenes begin with: name and materials."""

    case: Header
    materials: dict[Name, LawMaterial]

    @property
    def name(self) -> str:
        return self.case.name

    @classmethod
    def read(cls, data: dict[str, Any], path: object, kind: str) -> Self:
        """A case from TOML data; `path` names the place in messages. Raises CaseError."""
        data = with_library(data, path)
        try:
            return cls.model_validate(data, context=context(path))
        except ValidationError as error:
            raise CaseError(explain(path, data, error, kind)) from None


def law_keys(law: Declaration) -> dict[str, str | None]:
    """The SI unit of each key that [law] can have beside its name; None for true or false."""
    keys: dict[str, str | None] = {}
    for p in law.parameters:
        keys |= dict.fromkeys(alternatives(law, p.name), "1") | {p.name: p.unit}
    return keys | ({"compaction": None} if law.growth else {})


def alternatives(law: Declaration, key: str) -> tuple[str, ...]:
    """The keys of which only one may be given, if `key` is one of them."""
    pairs = [(EXPONENT, INDEX)] if any(p.name == EXPONENT for p in law.parameters) else []
    pairs += [(law.strength, f"{law.strength}_ratio")] if law.strength else []
    return next((pair for pair in pairs if key in pair), ())


def law_numbers(name: str, given: dict[str, Any]) -> LawNumbers:
    """The law `name` with the numbers of a case; all others have the defaults of the law. Raises CaseError.

    A strength X [Pa] is given as `X = "2.8 GPa"` for all bodies or as `X_ratio = 2.8` of each body's yield stress, the
    work of adhesion as `work_of_adhesion = "0.1 J/m^2"` for all pairs or by the surface energies of the materials;
    finite_strain = true or false stands for its number, meyer_index = 2 + x for hardening_exponent = x.
    compaction = true or false belongs to the laws that declare it.
    """
    law = find_law(name)
    compaction = given.get("compaction", False)
    if not isinstance(compaction, bool):
        raise CaseError(f"law.compaction = {compaction!r}: it is true or false")
    if compaction and not law.growth:
        others = " or ".join(repr(n) for n, other in declarations().items() if other.growth)
        raise CaseError(f"law.compaction: law {name} has none; take law.name = {others}")
    given = {key: value for key, value in given.items() if key != "compaction"}
    none = next((p.default for p in law.parameters if p.name == "finite_strain"), None)
    if none is not None and isinstance(given.get("finite_strain"), bool):
        given = given | {"finite_strain": FINITE_STRAIN if given["finite_strain"] else none}
    known = law_keys(law)
    for key in given:
        if key not in known:
            has = ", ".join(known) or "none"
            raise CaseError(f"law.{key}: law {name} has no such parameter; it has {has}")
        if (both := alternatives(law, key)) and all(other in given for other in both):
            raise CaseError(f"law: both {' and '.join(both)} are given; keep one")
    if INDEX in given:
        given = _without_index(given)
    strength, ratio = law.strength, f"{law.strength}_ratio"
    numbers = LawNumbers(
        name,
        {
            p.name: read_number(f"law.{p.name}", given.get(p.name, p.default), p.unit, zero=p.may_vanish, below=p.below)
            for p in law.parameters
            if p.name not in (strength, ADHESION)
        },
        read_number(f"law.{strength}", given[strength], "Pa") if strength in given else None,
        read_number(f"law.{ratio}", given[ratio], "1") if ratio in given else law.default_ratio,
        read_number(f"law.{ADHESION}", given[ADHESION], "J/m^2", zero=True) if ADHESION in given else None,
        compaction,
    )
    check_ratios(numbers)
    return numbers


def check_law(law: LawChoice, materials: Mapping[str, LawMaterial]) -> None:
    """Raise CaseError for keys and values that the law does not have, and for a strength that the law gives all bodies
    beside a material's own hardness or yield_ratio."""
    numbers = law.numbers
    for name, m in materials.items():
        m.own_strength(name, law.name)
        own = "hardness" if m.hardness is not None else "yield_ratio" if m.yield_ratio is not None else ""
        if own and numbers.absolute is not None:
            key = find_law(law.name).strength
            raise CaseError(f"both law.{key} and materials.{name}.{own} are given, each the strength; keep one")


def _without_index(given: dict[str, Any]) -> dict[str, Any]:
    """The numbers of a law with hardening_exponent = meyer_index - 2 in place of meyer_index."""
    index = read_number(f"law.{INDEX}", given[INDEX], "1")
    if not 2.0 <= index < 3.0:
        raise CaseError(f"law.{INDEX} = {index:g}, must lie in [2, 3); 2 is a metal that does not harden")
    return {k: v for k, v in given.items() if k != INDEX} | {EXPONENT: index - 2.0}
