# SPDX-License-Identifier: GPL-2.0-or-later
"""What each law declares, from its class in the theory: the compiled library is not needed.

A test compares every entry with what the C++ struct of the law declares.
"""

import inspect
import math
from dataclasses import dataclass
from functools import cache

from ..errors import CaseError
from ..theory import backbones


@dataclass(frozen=True)
class Parameter:
    """A parameter of a law by its name in case files; `default` is NaN where the user must give it."""

    name: str
    unit: str
    default: float


@dataclass(frozen=True)
class Declaration:
    """A law: its parameters, which of them is its strength [Pa], and the strength's default over the yield stress."""

    name: str
    parameters: tuple[Parameter, ...]
    strength: str | None
    default_ratio: float  # NaN for a law without strength

    @property
    def case_keys(self) -> list[str]:
        """What a case file may say of the law beside its name."""
        both = [(p.name, p.name + "_ratio") if p.name == self.strength else (p.name,) for p in self.parameters]
        return [key for keys in both for key in keys]

    def backbone(self, *, E_star: float, R_star: float, parameters: dict[str, float]) -> backbones.Backbone:
        """The law as the theory knows it. Raises ValueError for parameters that make no sense together."""
        cls = backbones.LAWS[self.name]
        return cls(E_star=E_star, R_star=R_star, **{cls.keywords[name]: value for name, value in parameters.items()})


@cache
def declarations() -> dict[str, Declaration]:
    """Every law of the theory by name."""
    return {name: _declaration(name, cls) for name, cls in backbones.LAWS.items()}


def _declaration(name: str, cls: type[backbones.Backbone]) -> Declaration:
    arguments = inspect.signature(cls).parameters
    found, strength = [], None
    for key, argument in cls.keywords.items():
        default = arguments[argument].default
        if default is inspect.Parameter.empty:  # the one number of a law that nobody can guess is its strength
            strength = key
            found.append(Parameter(key, "Pa", math.nan))
        else:
            found.append(Parameter(key, "1", float(default)))
    return Declaration(name, tuple(found), strength, cls.default_ratio if strength else math.nan)


def declaration(name: str, place: str = "law.name") -> Declaration:
    """The law of that name; `place` names where it was written. Raises CaseError."""
    if name not in declarations():
        raise CaseError(f"{place} = {name!r} does not exist; there are {', '.join(declarations())}")
    return declarations()[name]
