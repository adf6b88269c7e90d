# SPDX-License-Identifier: GPL-2.0-or-later
"""The [law] of a case: its numbers in SI, each checked against the declaration of the law."""

from typing import Any

from ..errors import CaseError
from ..laws.strengths import ADHESION, LawNumbers, law_named
from ..theory.cavity import FINITE_STRAIN
from .units import read_number

COMPACTS = ("cavity",)  # the laws that have compaction


def law_numbers(name: str, given: dict[str, Any]) -> LawNumbers:
    """The law `name` with the numbers of a case; all others have the defaults of the law. Raises CaseError.

    A strength X [Pa] is given as `X = "2.8 GPa"` for all bodies or as `X_ratio = 2.8` of each body's yield stress, the
    work of adhesion as `work_of_adhesion = "0.1 J/m^2"` for all pairs or by the surface energies of the materials;
    finite_strain = true or false stands for its number, meyer_index = 2 + x for hardening_exponent = x.
    compaction = true or false belongs to the laws of COMPACTS.
    """
    law = law_named(name)
    compaction = given.get("compaction", False)
    if not isinstance(compaction, bool):
        raise CaseError(f"law.compaction = {compaction!r}: it is true or false")
    if compaction and name not in COMPACTS:
        raise CaseError(f"law.compaction: law {name} has none; take law.name = {COMPACTS[0]!r}")
    given = {key: value for key, value in given.items() if key != "compaction"}
    none = next((p.default for p in law.parameters if p.name == "finite_strain"), None)
    if none is not None and isinstance(given.get("finite_strain"), bool):
        given = given | {"finite_strain": FINITE_STRAIN if given["finite_strain"] else none}
    if "meyer_index" in given and any(p.name == "hardening_exponent" for p in law.parameters):
        given = _without_index(given)
    strength, ratio = law.strength, f"{law.strength}_ratio"
    known = [key for p in law.parameters for key in ((p.name, ratio) if p.name == strength else (p.name,))]
    for key in given:
        if key not in known:
            has = ", ".join(known) or "none"
            raise CaseError(f"law.{key}: law {name} has no such parameter; it has {has}")
    if strength in given and ratio in given:
        raise CaseError(f"law: both {strength} and {ratio} are given; keep one")
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


def _without_index(given: dict[str, Any]) -> dict[str, Any]:
    """The numbers of a law with hardening_exponent = meyer_index - 2 in place of meyer_index."""
    if "hardening_exponent" in given:
        raise CaseError("law: both hardening_exponent and meyer_index are given; keep one")
    index = read_number("law.meyer_index", given["meyer_index"], "1")
    if not 2.0 <= index < 3.0:
        raise CaseError(f"law.meyer_index = {index:g}, must lie in [2, 3); 2 is a metal that does not harden")
    return {k: v for k, v in given.items() if k != "meyer_index"} | {"hardening_exponent": index - 2.0}
