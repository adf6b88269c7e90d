# SPDX-License-Identifier: GPL-2.0-or-later
"""The C++ laws in Python: one table of signatures, one error function, one ABI check.

The library never sees units or case files: SI in, SI out. Arrays are numpy, float64, one-dimensional.
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

from .. import paths
from ..errors import CaseError, EngineError

ABI = 4
Array = npt.NDArray[Any]  # float64, or structured by IMPACT_OUTPUT
_D = POINTER(c_double)


class _StepResult(Structure):
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
    "epdem_law_parameter_count": (c_int, [c_int]),
    "epdem_law_parameter_name": (c_char_p, [c_int, c_int]),
    "epdem_law_parameter_property": (c_char_p, [c_int, c_int]),
    "epdem_law_parameter_unit": (c_char_p, [c_int, c_int]),
    "epdem_law_parameter_default": (c_double, [c_int, c_int]),
    "epdem_step": (c_int, [c_int, c_double, _D, c_double, c_size_t, _D, _D, POINTER(_StepResult)]),
    "epdem_backbone": (c_int, [c_int, c_double, _D, c_double, c_size_t, _D, _D, _D, _D, _D]),
    "epdem_impacts": (c_int, [c_int, c_double, _D, c_size_t, ctypes.c_void_p, ctypes.c_void_p, c_size_t, _D, _D, _D]),
}


@dataclass(frozen=True)
class Parameter:
    """A material parameter of a law; `default` is NaN where the user must give it."""

    name: str
    property: str
    unit: str
    default: float


@dataclass(frozen=True)
class LawInfo:
    """A law that the library knows, as its C++ struct declares it.

    `id` is that of the LIGGGHTS model "ep/" + name, kept in restart files; `strength` the parameter at which a body
    yields [Pa], None for a law without yield; `default_ratio` its value over the yield stress Y of the softer body,
    NaN without; `memory` the number of doubles that a contact keeps from step to step.
    """

    index: int
    name: str
    parameters: tuple[Parameter, ...]
    id: int
    strength: Parameter | None
    default_ratio: float
    memory: int


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
    for name, (restype, argtypes) in _SIGNATURES.items():
        function = getattr(lib, name)
        function.restype, function.argtypes = restype, argtypes
    if lib.epdem_abi() != ABI:
        raise EngineError(f"{path}: ABI {lib.epdem_abi()}, this package needs {ABI}; run 'make setup' again")
    sizes = {
        b"epdem_step_result": ctypes.sizeof(_StepResult),
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
    found = {}
    for i in range(lib.epdem_law_count()):
        parameters = tuple(
            Parameter(
                lib.epdem_law_parameter_name(i, k).decode(),
                lib.epdem_law_parameter_property(i, k).decode(),
                lib.epdem_law_parameter_unit(i, k).decode(),
                lib.epdem_law_parameter_default(i, k),
            )
            for k in range(lib.epdem_law_parameter_count(i))
        )
        name = lib.epdem_law_name(i).decode()
        at = lib.epdem_law_strength(i)
        strength = parameters[at] if at >= 0 else None
        ratio, memory = lib.epdem_law_default_ratio(i), lib.epdem_law_memory(i)
        found[name] = LawInfo(i, name, parameters, lib.epdem_law_id(i), strength, ratio, memory)
    return found


def viscous_number(restitution: float) -> float:
    """Dashpot number of a pair with that restitution at low speed; CaseError outside [0.14, 1]."""
    number: float = library().epdem_viscous_number(restitution)
    if math.isnan(number):
        raise CaseError(f"viscous.restitution = {restitution}, must lie in [0.14, 1]")
    return number


def _array(x: npt.ArrayLike) -> Array:
    return np.ascontiguousarray(np.atleast_1d(x), dtype=np.float64)


def _pointer(x: Array | None) -> Any:
    return None if x is None else x.ctypes.data_as(_D)


class Law:
    """One law with its constants: E_star [Pa] and the law's parameters by name, SI.

    Raises CaseError for an unknown law or parameter, or values outside the law's range.
    """

    def __init__(self, name: str, *, E_star: float, **parameters: float):
        if name not in laws():
            raise CaseError(f"law {name!r} does not exist; there are {', '.join(laws())}")
        self.info = laws()[name]
        known = [p.name for p in self.info.parameters]
        for key in parameters:
            if key not in known:
                raise CaseError(f"law {name} has no parameter {key!r}; it has {', '.join(known) or 'none'}")
        values = [parameters.get(p.name, p.default) for p in self.info.parameters]
        for p, value in zip(self.info.parameters, values, strict=True):
            if not (math.isfinite(value) and value > 0):
                raise CaseError(f"law {name}: {p.name} = {value}, must be a finite number > 0 [{p.unit}]")
        self.name, self.E_star = name, float(E_star)
        self._parameters = (c_double * max(len(values), 1))(*values)

    def _check(self, status: int) -> None:
        if status:
            raise CaseError(f"law {self.name}: {library().epdem_message(status).decode()}")

    def step(self, *, R_star: float, delta_max: npt.ArrayLike, delta: npt.ArrayLike) -> tuple[Array, Array, Array]:
        """(force [N], contact radius [m], new delta_max [m]) at overlap delta [m]; delta_max and delta broadcast."""
        before, now = np.broadcast_arrays(_array(delta_max), _array(delta))
        before, now = _array(before), _array(now)
        out = np.empty((now.size, 3))
        results = out.ctypes.data_as(POINTER(_StepResult))
        self._check(
            library().epdem_step(
                self.info.index,
                self.E_star,
                self._parameters,
                R_star,
                now.size,
                _pointer(before),
                _pointer(now),
                results,
            )
        )
        return out[:, 0], out[:, 1], out[:, 2]

    def backbone(self, *, R_star: float, delta: npt.ArrayLike) -> tuple[Array, Array, Array, Array]:
        """(force [N], radius [m], work [J], plastic work [J]) of first loading to delta [m], > 0."""
        at = _array(delta)
        force, radius, work, plastic = (np.empty(at.size) for _ in range(4))
        self._check(
            library().epdem_backbone(
                self.info.index,
                self.E_star,
                self._parameters,
                R_star,
                at.size,
                *map(_pointer, (at, force, radius, work, plastic)),
            )
        )
        return force, radius, work, plastic

    @staticmethod
    def _cases(
        R_star: npt.ArrayLike,
        m_star: npt.ArrayLike,
        speed: npt.ArrayLike,
        time_step: npt.ArrayLike,
        gap: npt.ArrayLike,
        steps: int,
        viscous: float = 0.0,
    ) -> Array:
        columns = np.broadcast_arrays(*map(_array, (R_star, m_star, speed, time_step, gap)))
        cases = np.empty(columns[0].shape, IMPACT_INPUT)
        for name, column in zip(("R_star", "m_star", "speed", "time_step", "gap"), columns, strict=True):
            cases[name] = column
        cases["steps"], cases["viscous"] = steps, viscous
        return cases

    def impacts(
        self,
        *,
        R_star: npt.ArrayLike,
        m_star: npt.ArrayLike,
        speed: npt.ArrayLike,
        time_step: npt.ArrayLike,
        gap: npt.ArrayLike = 0.0,
        steps: int,
        viscous: float = 0.0,
    ) -> Array:
        """Two-body impacts by velocity Verlet, as IMPACT_OUTPUT of shape (n,); all arguments but `steps` broadcast.

        gap [m] is the distance before first touch (negative: overlap at the start); viscous is a dashpot number
        (viscous_number, 0: none).
        """
        cases = self._cases(R_star, m_star, speed, time_step, gap, steps, viscous)
        return self._impacts(cases, steps, None, None, None)

    def impact_paths(
        self,
        *,
        R_star: npt.ArrayLike,
        m_star: npt.ArrayLike,
        speed: npt.ArrayLike,
        time_step: npt.ArrayLike,
        gap: npt.ArrayLike = 0.0,
        steps: int,
        viscous: float = 0.0,
    ) -> tuple[Array, Array, Array, Array]:
        """`impacts` with the way there: overlap [m], force [N] and approach velocity [m/s] of shape (n, steps + 1).

        They are NaN after the end of an impact.
        """
        cases = self._cases(R_star, m_star, speed, time_step, gap, steps, viscous)
        overlap, force, velocity = (np.full((cases.size, steps + 1), np.nan) for _ in range(3))
        return self._impacts(cases, steps, overlap, force, velocity), overlap, force, velocity

    def _impacts(self, cases: Array, steps: int, *samples: Array | None) -> Array:
        out = np.empty(cases.shape, IMPACT_OUTPUT)
        self._check(
            library().epdem_impacts(
                self.info.index,
                self.E_star,
                self._parameters,
                cases.size,
                cases.ctypes.data,
                out.ctypes.data,
                steps + 1,
                *map(_pointer, samples),
            )
        )
        return out

    def impacts_long_double(
        self,
        *,
        R_star: npt.ArrayLike,
        m_star: npt.ArrayLike,
        speed: npt.ArrayLike,
        time_step: npt.ArrayLike,
        gap: npt.ArrayLike = 0.0,
        steps: int,
    ) -> Array:
        """The same impacts computed in long double, IMPACT_OUTPUT rounded at the end: a reference for round-off."""
        cases = self._cases(R_star, m_star, speed, time_step, gap, steps)
        out = np.empty(cases.shape, IMPACT_OUTPUT)
        self._check(
            library().epdem_impacts_long_double(
                self.info.index, self.E_star, self._parameters, cases.size, cases.ctypes.data, out.ctypes.data
            )
        )
        return out

    def bounces(
        self, count: int, *, R_star: float, m_star: float, speed: float, time_step: float, steps: int
    ) -> tuple[np.void, Array]:
        """`count` impacts of one contact, each at the rebound speed of the one before, at most `steps` steps each.

        Returns the last impact (IMPACT_OUTPUT, its `steps` those of all impacts) and the rebound speeds [m/s].
        """
        first = self._cases(R_star, m_star, speed, time_step, 0.0, steps).ctypes.data
        out, speeds = np.empty(1, IMPACT_OUTPUT), np.full(count, np.nan)
        law = (self.info.index, self.E_star, self._parameters)
        self._check(library().epdem_bounces(*law, first, count, out.ctypes.data, _pointer(speeds)))
        return out[0], speeds
