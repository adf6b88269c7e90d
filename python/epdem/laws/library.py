# SPDX-License-Identifier: GPL-2.0-or-later
"""The C++ laws in Python: one table of signatures, one error function.

All values are SI. Arrays are numpy, float64, one-dimensional.
"""

import ctypes
import math
from ctypes import POINTER, Structure, c_char_p, c_double, c_int, c_size_t
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from ..base.declarations import declarations as laws
from ..base.declarations import library_path, loaded
from ..errors import CaseError, EngineError

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

__all__ = ["IMPACT_INPUT", "IMPACT_OUTPUT", "Array", "StepResult", "laws", "library", "library_path", "viscous_number"]

_SIGNATURES = {
    "epdem_oblique": (
        c_int,
        [c_int, c_double, _D, c_double, c_double, c_int, c_size_t, ctypes.c_void_p, _D, _D],
    ),
    "epdem_version": (c_char_p, []),
    "epdem_message": (c_char_p, [c_int]),
    "epdem_size_of": (c_size_t, [c_char_p]),
    "epdem_viscous_number": (c_double, [c_double]),
    "epdem_step": (c_int, [c_int, c_double, _D, c_size_t, _D, _D, _D, POINTER(StepResult)]),
    "epdem_backbone": (c_int, [c_int, c_double, _D, c_size_t, _D, _D, _D, _D, _D, _D]),
    "epdem_impacts": (c_int, [c_int, c_double, _D, c_size_t, ctypes.c_void_p, ctypes.c_void_p, c_size_t, _D, _D, _D]),
}


@cache
def library() -> ctypes.CDLL:
    """The loaded library, its signatures declared and its ABI checked."""
    lib = loaded()
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
            found = lib.epdem_size_of(struct)
            raise EngineError(f"{library_path()}: {struct.decode()} has {found} bytes, expected {size}")
    return lib


def version() -> str:
    """Version of the C library."""
    return str(library().epdem_version().decode())


def viscous_number(restitution: float) -> float:
    """Dashpot number of a pair with that restitution at low speed; CaseError outside [0.14, 1]."""
    number: float = library().epdem_viscous_number(restitution)
    if math.isnan(number):
        raise CaseError(f"viscous.restitution = {restitution}, must lie in [0.14, 1]")
    return number
