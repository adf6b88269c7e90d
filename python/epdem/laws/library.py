# SPDX-License-Identifier: GPL-2.0-or-later
"""The C++ laws in Python: one table of signatures, one error function, and a law with its numbers: steps, impacts.

All values are SI. Arrays are numpy, float64, one-dimensional.
"""

import ctypes
import math
from ctypes import POINTER, c_char_p, c_double, c_int, c_size_t
from functools import cache
from typing import Any, NotRequired, TypedDict, Unpack

import numpy as np
import numpy.typing as npt

from ..base.declarations import load_library
from ..errors import CaseError
from .strengths import find_law

Array = npt.NDArray[Any]  # float64, or structured by IMPACT_OUTPUT
_D = POINTER(c_double)

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
    "epdem_oblique": (
        c_int,
        [c_int, c_double, _D, c_double, c_double, c_int, c_size_t, ctypes.c_void_p, _D, _D],
    ),
    "epdem_version": (c_char_p, []),
    "epdem_message": (c_char_p, [c_int]),
    "epdem_viscous_number": (c_double, [c_double]),
    "epdem_step": (c_int, [c_int, c_double, _D, c_size_t, _D, _D, _D, _D]),
    "epdem_backbone": (c_int, [c_int, c_double, _D, c_size_t, _D, _D, _D, _D, _D, _D]),
    "epdem_impacts": (c_int, [c_int, c_double, _D, c_size_t, ctypes.c_void_p, ctypes.c_void_p, c_size_t, _D, _D, _D]),
}


@cache
def library() -> ctypes.CDLL:
    """The loaded library, its signatures declared and its ABI checked."""
    lib = load_library()
    for name, (restype, argtypes) in _SIGNATURES.items():
        function = getattr(lib, name)
        function.restype, function.argtypes = restype, argtypes
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


def _array(x: npt.ArrayLike) -> Array:
    return np.ascontiguousarray(np.atleast_1d(x), dtype=np.float64)


def _columns(*values: npt.ArrayLike) -> list[Array]:
    return [_array(x) for x in np.broadcast_arrays(*map(_array, values))]


def pointer(x: Array | None) -> Any:
    """`x` as the C interface takes an array; None stays None."""
    return None if x is None else x.ctypes.data_as(_D)


class ImpactNumbers(TypedDict):
    """Impacts: reduced radius [m] and mass [kg], approach speed [m/s] and time step [s], broadcast to shape (n,).

    `gap` [m] is the distance before first touch (default 0; negative: overlap at the start), `viscous` the number of
    a dashpot (viscous_number; default 0: none).
    """

    R_star: npt.ArrayLike
    m_star: npt.ArrayLike
    speed: npt.ArrayLike
    time_step: npt.ArrayLike
    gap: NotRequired[npt.ArrayLike]
    viscous: NotRequired[float]


def cases(*, steps: int, **numbers: Unpack[ImpactNumbers]) -> Array:
    """IMPACT_INPUT of impacts of at most `steps` steps, shape (n,)."""
    values: dict[str, Any] = {"gap": 0.0, "viscous": 0.0, **numbers}
    found = np.zeros(np.broadcast_shapes((1,), *map(np.shape, values.values())), IMPACT_INPUT)
    for name, value in values.items():
        found[name] = value
    found["steps"] = steps
    return found


class Law:
    """One law with its constants: E_star [Pa] and the law's parameters by name, SI.

    share: `pair.curvature_share` of the contact, on which finite strain depends.
    Raises CaseError for an unknown law or parameter, or values outside the law's range.
    """

    def __init__(self, name: str, *, E_star: float, share: float = 1.0, **parameters: float):
        self.info = find_law(name)
        known = [p.name for p in self.info.parameters]
        for key in parameters:
            if key not in known:
                raise CaseError(f"law {name} has no parameter {key!r}; it has {', '.join(known) or 'none'}")
        values = []
        for p in self.info.parameters:
            value = parameters.get(p.name, p.default)
            if value is None or not p.holds(value):
                raise CaseError(f"law {name}: {p.name} = {value}, must be a finite number in {p.limits()} [{p.unit}]")
            values.append(value)
        self.name, self.E_star = name, float(E_star)
        self._parameters = (c_double * (len(values) + 1))(*values, share)

    def call(self, function: str, *arguments: object) -> None:
        """Call a function of the C interface with this law and its numbers before `arguments`. Raises CaseError."""
        status = getattr(library(), function)(self.info.index, c_double(self.E_star), self._parameters, *arguments)
        if status:
            condition = f" ({self.info.condition})" if self.info.condition else ""
            raise CaseError(f"law {self.name}: {library().epdem_message(status).decode()}{condition}")

    def step(
        self, *, R_star: npt.ArrayLike, delta_max: npt.ArrayLike, delta: npt.ArrayLike
    ) -> tuple[Array, Array, Array]:
        """(force [N], contact radius [m], new delta_max [m]) at overlap delta [m]; R_star, delta_max, delta broadcast.

        Each result has the shape (n,).
        """
        contacts = _columns(R_star, delta_max, delta)
        n = contacts[0].size
        out = np.empty((n, 3))
        self.call("epdem_step", n, *map(pointer, (*contacts, out)))
        return out[:, 0], out[:, 1], out[:, 2]

    def backbone(self, *, R_star: npt.ArrayLike, delta: npt.ArrayLike) -> tuple[Array, Array, Array, Array]:
        """(force [N], radius [m], work [J], plastic work [J]) of first loading to delta [m], > 0; arrays broadcast."""
        contacts = _columns(R_star, delta)
        n = contacts[0].size
        force, radius, work, plastic = (np.empty(n) for _ in range(4))
        self.call("epdem_backbone", n, *map(pointer, (*contacts, force, radius, work, plastic)))
        return force, radius, work, plastic

    def impacts(self, *, steps: int, **numbers: Unpack[ImpactNumbers]) -> Array:
        """Two-body impacts by velocity Verlet, at most `steps` steps each: IMPACT_OUTPUT of shape (n,)."""
        return self._impacts(cases(steps=steps, **numbers), steps)

    def impact_paths(self, *, steps: int, **numbers: Unpack[ImpactNumbers]) -> tuple[Array, Array, Array, Array]:
        """`impacts` with their paths: overlap [m], force [N] and approach velocity [m/s] of shape (n, steps + 1).

        They are NaN after the end of an impact.
        """
        given = cases(steps=steps, **numbers)
        overlap, force, velocity = (np.full((given.size, steps + 1), np.nan) for _ in range(3))
        return self._impacts(given, steps, overlap, force, velocity), overlap, force, velocity

    def _impacts(self, given: Array, steps: int, *samples: Array) -> Array:
        out = np.empty(given.shape, IMPACT_OUTPUT)
        samples_or_none = map(pointer, samples or (None, None, None))
        self.call("epdem_impacts", given.size, given.ctypes.data, out.ctypes.data, steps + 1, *samples_or_none)
        return out

    def oblique(
        self,
        slip: npt.ArrayLike,
        *,
        G_star: float,
        mu: float,
        nodes: int,
        steps: int,
        **numbers: Unpack[ImpactNumbers],
    ) -> Array:
        """Velocities [m/s] of the surfaces against each other after impacts of solid spheres with `slip` before, (n,).

        G_star [Pa] of the pair; nodes: 2 or 3 of partial slip, 0 for one spring.
        """
        given = cases(steps=steps, **numbers)
        before, after = _array(np.broadcast_to(slip, given.shape)), np.empty(given.shape)
        places = (given.size, given.ctypes.data, pointer(before), pointer(after))
        self.call("epdem_oblique", c_double(G_star), c_double(mu), nodes, *places)
        return after
