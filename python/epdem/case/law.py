# SPDX-License-Identifier: GPL-2.0-or-later
"""The [law] of a case: its numbers in SI, each checked against the declaration of the law."""

from collections.abc import Mapping
from typing import Any

from ..base.declarations import Declaration, declarations
from ..errors import CaseError
from ..laws.strengths import ADHESION, LawNumbers, find_law
from ..theory.cavity import FINITE_STRAIN
from .fields import LawChoice, Material
from .messages import cut_quotes
from .units import read_number


def law_keys(law: Declaration) -> dict[str, str | None]:
    """The SI unit of each key that [law] can have beside its name; None for true or false."""
    keys: dict[str, str | None] = {}
    for p in law.parameters:
        keys |= dict.fromkeys(alternatives(law, p.name), "1") | {p.name: p.unit}
    return keys | ({"compaction": None} if law.growth else {})


def alternatives(law: Declaration, key: str) -> tuple[str, ...]:
    """The keys of which only one may be given, if `key` is one of them."""
    pair = (law.strength, f"{law.strength}_ratio") if law.strength else ()
    return pair if key in pair else ()


def law_numbers(name: str, given: dict[str, Any]) -> LawNumbers:
    """The law `name` with the numbers of a case; all others have the defaults of the law. Raises CaseError.

    A strength X [Pa] is given as `X = "2.8 GPa"` for all bodies or as `X_ratio = 2.8` of each body's yield stress, the
    work of adhesion as `work_of_adhesion = "0.1 J/m^2"` for all pairs or by the surface energies of the materials;
    finite_strain = true or false stands for its number.
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
    strength, ratio = law.strength, f"{law.strength}_ratio"
    return LawNumbers(
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


def check_law(law: LawChoice, materials: Mapping[str, Material], place: object) -> None:
    """Raise CaseError, which begins with `place`, for keys and values that the law does not have, and for a strength
    that the law gives all bodies beside a material's own hardness or yield_ratio."""
    try:
        numbers = law_numbers(law.name, law.parameters())
        for name, m in materials.items():
            own = "hardness" if m.hardness is not None else "yield_ratio" if m.yield_ratio is not None else ""
            if own and numbers.absolute is not None:
                key = find_law(law.name).strength
                raise CaseError(f"both law.{key} and materials.{name}.{own} are given, each the strength; keep one")
    except CaseError as error:
        raise CaseError(f"{place}: {cut_quotes(str(error))}") from None
