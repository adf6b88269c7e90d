# SPDX-License-Identifier: GPL-2.0-or-later
"""Declarations of the laws in C++: names, units, ranges and defaults, for theory, input, engines and pages.

The declarations are one text in the C library; no number comes from a computation of a law.
"""

import ctypes
import json
import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ..errors import EngineError
from . import paths

ABI = 10


@dataclass(frozen=True)
class Parameter:
    """A material parameter of a law, in (0, below), or [0, below) if it `may_vanish`; `default` None: no default.

    `property` is its LIGGGHTS property/global, `symbol` its name in formulas and in the theory's constructor; a value
    `of_pair` belongs to two surfaces, not to a body.
    """

    name: str
    property: str
    symbol: str
    unit: str
    default: float | None
    may_vanish: bool
    of_pair: bool
    below: float

    def holds(self, value: float) -> bool:
        """Whether the value is finite and in the range."""
        return math.isfinite(value) and (0 < value < self.below or (value == 0 and self.may_vanish))

    def limits(self) -> str:
        """The range, as in (0, inf)."""
        return f"{'[' if self.may_vanish else '('}0, {self.below:g})"


@dataclass(frozen=True)
class Declaration:
    """A law as its C++ struct declares it.

    `index` is its place in the C interface, `id` the number of the LIGGGHTS model "ep/" + name in restart files;
    `sources` are short names of publications; `condition` is what the parameters must fulfil together; `strength` the
    parameter at which a body yields [Pa], None for a law without yield; `default_ratio` its value over the yield stress
    Y of the softer body, 1 without; `memory` the number of doubles that a contact keeps from step to step; `growth`
    names those that it keeps for compaction, none of a law without; `flattens` whether unloading differs from Hertz's;
    `adheres` whether bodies attract each other, and `without_adhesion` the law for a work of adhesion of 0.
    """

    index: int
    name: str
    id: int
    title: str
    sources: tuple[str, ...]
    condition: str | None
    parameters: tuple[Parameter, ...]
    strength: str | None
    default_ratio: float
    memory: int
    growth: tuple[str, ...]
    yields: bool
    flattens: bool
    adheres: bool
    without_adhesion: str | None

    @property
    def symbols(self) -> dict[str, str]:
        return {p.name: p.symbol for p in self.parameters}

    def parameter(self, name: str | None) -> Parameter:
        return next(p for p in self.parameters if p.name == name)


def library_path() -> Path:
    """The C library; EngineError if it was not built."""
    path = paths.native("libepdem.so")
    if path is None:
        raise EngineError("the C library libepdem.so is not built; run 'make setup' (or 'pip install .')")
    return path


@cache
def load_library() -> ctypes.CDLL:
    """The C library, its ABI checked. Raises EngineError."""
    path = library_path()
    lib = ctypes.CDLL(str(path))
    if lib.epdem_abi() != ABI:
        raise EngineError(f"{path}: ABI {lib.epdem_abi()}, this package needs {ABI}; run 'make setup' again")
    return lib


@cache
def declarations() -> dict[str, Declaration]:
    """Every law by name, in the order of the register. Raises EngineError without the C library."""
    text = load_library().epdem_declarations
    text.restype = ctypes.c_char_p
    laws = {}
    for index, law in enumerate(json.loads(text())):
        for p in law["parameters"]:
            p["below"] = math.inf if p["below"] is None else p["below"]
        law["parameters"] = tuple(Parameter(**p) for p in law["parameters"])
        law["growth"] = tuple(law["growth"])
        law["sources"] = tuple(law["sources"].split("; "))
        law["default_ratio"] = 1.0 if law["default_ratio"] is None else law["default_ratio"]
        laws[law["name"]] = Declaration(index=index, **law)
    return laws
