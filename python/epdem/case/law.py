# SPDX-License-Identifier: GPL-2.0-or-later
"""The [law] of a case: its numbers in SI, each checked against the declaration of the law."""

from typing import Any

from ..errors import CaseError
from ..laws.strengths import ADHESION, LawNumbers, law_named
from ..theory.cavity import FINITE_STRAIN
from .units import read_number


def law_numbers(name: str, given: dict[str, Any]) -> LawNumbers:
    """The law `name` with the numbers of a case; all others have the defaults of the law. Raises CaseError.

    A strength X [Pa] is given as `X = "2.8 GPa"` for all bodies or as `X_ratio = 2.8` of each body's yield stress, the
    work of adhesion as `work_of_adhesion = "0.1 J/m^2"` for all pairs or by the surface energies of the materials;
    finite_strain = true or false stands for its number.
    """
    law = law_named(name)
    none = next((p.default for p in law.parameters if p.name == "finite_strain"), None)
    if none is not None and isinstance(given.get("finite_strain"), bool):
        given = given | {"finite_strain": FINITE_STRAIN if given["finite_strain"] else none}
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
    )
