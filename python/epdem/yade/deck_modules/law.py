# SPDX-License-Identifier: GPL-2.0-or-later
"""The laws of the C library for one contact at a time, by the standard library alone.

A YADE deck contains a copy of this module with `libepdem.so` beside it. A law holds the constants of a pair of
materials; R_star [m] comes apart because it changes from contact to contact. Overlaps delta in m, forces in N,
pressures in Pa.
"""

import ctypes
import json
import sysconfig
from functools import cache, partial
from math import inf, pi, sqrt
from pathlib import Path
from typing import Any

LIBRARY = "libepdem.so"
HARDENING = 1.75  # contact pressure of full plasticity over that of first yield, of laws that do not say it


class _Result(ctypes.Structure):
    _fields_ = [("force", ctypes.c_double), ("radius", ctypes.c_double), ("delta_max", ctypes.c_double)]


def library_path() -> Path:
    """The C library, in a deck beside this module, else of the installed epdem. FileNotFoundError without it."""
    places = [Path(__file__).with_name(LIBRARY), Path(__file__).parents[2] / "native" / LIBRARY]
    places.append(Path(sysconfig.get_path("platlib")) / "epdem" / "native" / LIBRARY)
    for place in places:
        if place.exists():
            return place
    raise FileNotFoundError(f"{places[0]}: not there; copy the folder epdem of a YADE deck, which has it")


@cache
def _library() -> ctypes.CDLL:
    lib = ctypes.CDLL(str(library_path()))
    lib.epdem_declarations.restype = lib.epdem_message.restype = ctypes.c_char_p
    return lib


@cache
def declarations() -> dict[str, dict[str, Any]]:
    """What the laws that YADE's contacts can follow declare of themselves, by name: all without adhesion."""
    laws = [law | {"index": k} for k, law in enumerate(json.loads(_library().epdem_declarations()))]
    return {law["name"]: law for law in laws if not law["adheres"]}


def larger_share(name: str, strength: float, other: float, **ratios: float) -> float:
    """Share in the strain of the weaker of two bodies of these strengths [Pa] (inf: never yields), 1/2 to 1."""
    given = {p["name"]: p["default"] for p in declarations()[name]["parameters"]} | ratios
    hardening = given["plastic_ratio"] / given["first_yield_ratio"] if "plastic_ratio" in given else HARDENING
    low, high = min(strength, other), max(strength, other)
    return 0.5 + 0.5 * min((high / low - 1.0) / (hardening - 1.0), 1.0) if low < inf else 0.5


class Law:
    """A law with the constants of a pair: E_star [Pa], its strength [Pa] (inf: never yields), its other parameters.

    share: of the weaker body in the strain (`larger_share`), 1 of a sphere on a rigid wall. Raises ValueError for a law
    that does not exist or numbers out of its range.
    """

    def __init__(self, name: str, E_star: float, strength: float = inf, share: float = 1.0, **ratios: float):
        if name not in declarations():
            raise ValueError(f"law {name!r} does not exist; there are {', '.join(declarations())}")
        self.declared = declared = declarations()[name]
        self.name, self.E_star, self.share, self.flattens = name, E_star, share, bool(declared["flattens"])
        self.strength_name: str | None = declared["strength"]
        self.ratios = tuple(p["name"] for p in declared["parameters"] if p["name"] != self.strength_name)
        for key in ratios:
            if key not in self.ratios:
                raise ValueError(f"law {name} has no parameter {key!r}; it has {', '.join(self.ratios) or 'none'}")
        self.yield_ratio = inf  # overlap of first yield over R*
        if self.strength_name and strength == inf:
            return
        given = {self.strength_name: strength, **ratios}
        values = [given.get(p["name"], p["default"]) for p in declared["parameters"]]
        self._parameters = (ctypes.c_double * (len(values) + 1))(*values, share)
        self._R, self._before, self._now, self._first, self._dent = (ctypes.c_double() for _ in range(5))
        self._result = _Result()
        # arguments are converted once, for a call is shorter than their conversion
        constants = ctypes.c_int(declared["index"]), ctypes.c_double(E_star), self._parameters, ctypes.c_size_t(1)
        places = map(ctypes.byref, (self._R, self._before, self._now, self._result))
        self._step = partial(_library().epdem_step, *constants, *places)
        places = map(ctypes.byref, (self._R, self._before, self._first, self._dent))
        self._yield = partial(_library().epdem_yield, *constants, *places)
        self._R.value, self._before.value = 1.0, 0.0
        self._check(self._yield())
        self.yield_ratio = self._first.value

    def _check(self, status: int) -> None:
        if status:
            numbers = ", ".join(
                f"{p['name']} = {x!r}" for p, x in zip(self.declared["parameters"], self._parameters, strict=False)
            )
            condition = f" ({self.declared['condition']})" if self.declared["condition"] else ""
            reason = _library().epdem_message(status).decode() + condition
            raise ValueError(f"law {self.name}: E_star = {self.E_star!r}, {numbers}: {reason}")

    def step(self, R_star: float, delta_max: float, delta: float) -> tuple[float, float, float]:
        """(force [N], contact radius [m], new delta_max [m]) at overlap delta of a contact with history delta_max."""
        self._R.value, self._before.value, self._now.value = R_star, delta_max, delta
        self._check(self._step())
        result = self._result
        return result.force, result.radius, result.delta_max

    def load(self, R_star: float, delta: float) -> tuple[float, float]:
        """(force [N], contact radius [m]) of first loading to delta."""
        return self.step(R_star, 0.0, delta)[:2]

    def unload(self, R_star: float, delta_max: float, delta: float) -> tuple[float, float]:
        """(force [N], contact radius [m]) below delta_max; zeros where the bodies have parted inside the dent."""
        return self.step(R_star, delta_max, delta)[:2]

    def dent(self, R_star: float, delta_max: float) -> float:
        """Overlap [m] at which the force returns to 0."""
        self._R.value, self._before.value = R_star, delta_max
        self._check(self._yield())
        return self._dent.value


def trigger_factor(name: str, **ratios: float) -> float:
    """Largest pressure of Hertz's contact at which a law yields first, over its strength; inf: it never yields."""
    strength = 1e-3  # of E*
    law = Law(name, 1.0, strength, **ratios)
    return 2.0 / pi * sqrt(law.yield_ratio) / strength
