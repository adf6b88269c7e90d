# SPDX-License-Identifier: GPL-2.0-or-later
"""The C++ laws in Python: one table of signatures, one error function, one ABI check.

All values are SI. Arrays are numpy, float64, one-dimensional.
"""

import ctypes
import math
from ctypes import POINTER, Structure, c_char_p, c_double, c_int, c_size_t
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..base import paths
from ..errors import CaseError, EngineError

ABI = 7
Array = npt.NDArray[Any]  # float64, or structured by IMPACT_OUTPUT
_D = POINTER(c_double)


class StepResult(Structure):
    """`epdem_step_result` of the C interface."""

    _fields_ = [("force", c_double), ("radius", c_double), ("delta_max", c_double)]


IMPACT_INPUT = np.dtype(
    [(n, "f8") for n in ("R_star", "m_star", "speed", "time_step", "gap")] + [("steps", "i8"), ("viscous", "f8")],
    align=True,
)
IMPACT_OUTPUT = np.dtype(
    [(n, "f8") for n in ("rebound_speed", "force_max", "overlap_max", "last_overlap")]
    + [(n, "i8") for n in ("first", "last", "steps")],
    align=True,
)

_SIGNATURES = {
    "epdem_impacts_long_double": (c_int, [c_int, c_double, _D, c_size_t, ctypes.c_void_p, ctypes.c_void_p]),
    "epdem_bounces": (c_int, [c_int, c_double, _D, ctypes.c_void_p, ctypes.c_int64, ctypes.c_void_p, _D]),
    "epdem_oblique": (
        c_int,
        [c_int, c_double, _D, c_double, c_double, c_int, c_size_t, ctypes.c_void_p, _D, _D],
    ),
    "epdem_abi": (c_int, []),
    "epdem_version": (c_char_p, []),
    "epdem_message": (c_char_p, [c_int]),
    "epdem_size_of": (c_size_t, [c_char_p]),
    "epdem_viscous_number": (c_double, [c_double]),
    "epdem_law_count": (c_int, []),
    "epdem_law_name": (c_char_p, [c_int]),
    "epdem_law_id": (c_int, [c_int]),
    "epdem_law_strength": (c_int, [c_int]),
    "epdem_law_default_ratio": (c_double, [c_int]),
    "epdem_law_memory": (c_int, [c_int]),
    "epdem_law_adheres": (c_int, [c_int]),
    "epdem_law_parameter_count": (c_int, [c_int]),
    "epdem_law_parameter_name": (c_char_p, [c_int, c_int]),
    "epdem_law_parameter_property": (c_char_p, [c_int, c_int]),
    "epdem_law_parameter_unit": (c_char_p, [c_int, c_int]),
    "epdem_law_parameter_default": (c_double, [c_int, c_int]),
    "epdem_law_parameter_may_vanish": (c_int, [c_int, c_int]),
    "epdem_step": (c_int, [c_int, c_double, _D, c_size_t, _D, _D, _D, POINTER(StepResult)]),
    "epdem_motion": (c_int, [c_int, c_double, _D, c_double, c_double, c_double, c_int, c_size_t, _D, _D]),
    "epdem_backbone": (c_int, [c_int, c_double, _D, c_size_t, _D, _D, _D, _D, _D, _D]),
    "epdem_impacts": (c_int, [c_int, c_double, _D, c_size_t, ctypes.c_void_p, ctypes.c_void_p, c_size_t, _D, _D, _D]),
}


@dataclass(frozen=True)
class Parameter:
    """A material parameter of a law; `default` is NaN where the user must give it, `may_vanish` lets 0 pass."""

    name: str
    property: str
    unit: str
    default: float
    may_vanish: bool


@dataclass(frozen=True)
class LawInfo:
    """A law of the library, as its C++ struct declares it.

    `id` is that of the LIGGGHTS model "ep/" + name, kept in restart files; `strength` the parameter at which a body
    yields [Pa], None for a law without yield; `default_ratio` its value over the yield stress Y of the softer body,
    NaN without; `memory` the number of doubles that a contact keeps from step to step; `adheres` whether bodies
    attract each other.
    """

    index: int
    name: str
    parameters: tuple[Parameter, ...]
    id: int
    strength: Parameter | None
    default_ratio: float
    memory: int
    adheres: bool


def library_path() -> Path:
    """The C library; EngineError if it was not built."""
    path = paths.native("libepdem.so")
    if path is None:
        raise EngineError("the C library libepdem.so is not built; run 'make setup' (or 'pip install .')")
    return path


@cache
def library() -> ctypes.CDLL:
    """The loaded library, its signatures declared and its ABI checked."""
    path = library_path()
    lib = ctypes.CDLL(str(path))
    if lib.epdem_abi() != ABI:
        raise EngineError(f"{path}: ABI {lib.epdem_abi()}, this package needs {ABI}; run 'make setup' again")
    for name, (restype, argtypes) in _SIGNATURES.items():
        function = getattr(lib, name)
        function.restype, function.argtypes = restype, argtypes
    sizes = {
        b"epdem_step_result": ctypes.sizeof(StepResult),
        b"epdem_impact_input": IMPACT_INPUT.itemsize,
        b"epdem_impact_output": IMPACT_OUTPUT.itemsize,
    }
    for struct, size in sizes.items():
        if lib.epdem_size_of(struct) != size:
            raise EngineError(f"{path}: {struct.decode()} has {lib.epdem_size_of(struct)} bytes, expected {size}")
    return lib


def version() -> str:
    """Version of the C library."""
    return str(library().epdem_version().decode())


@cache
def laws() -> dict[str, LawInfo]:
    """Every law of the library by name."""
    lib = library()
    infos = {}
    for i in range(lib.epdem_law_count()):
        parameters = tuple(
            Parameter(
                lib.epdem_law_parameter_name(i, k).decode(),
                lib.epdem_law_parameter_property(i, k).decode(),
                lib.epdem_law_parameter_unit(i, k).decode(),
                lib.epdem_law_parameter_default(i, k),
                bool(lib.epdem_law_parameter_may_vanish(i, k)),
            )
            for k in range(lib.epdem_law_parameter_count(i))
        )
        name = lib.epdem_law_name(i).decode()
        at = lib.epdem_law_strength(i)
        strength = parameters[at] if at >= 0 else None
        ratio, memory = lib.epdem_law_default_ratio(i), lib.epdem_law_memory(i)
        adheres = bool(lib.epdem_law_adheres(i))
        infos[name] = LawInfo(i, name, parameters, lib.epdem_law_id(i), strength, ratio, memory, adheres)
    return infos


def viscous_number(restitution: float) -> float:
    """Dashpot number of a pair with that restitution at low speed; CaseError outside [0.14, 1]."""
    number: float = library().epdem_viscous_number(restitution)
    if math.isnan(number):
        raise CaseError(f"viscous.restitution = {restitution}, must lie in [0.14, 1]")
    return number
