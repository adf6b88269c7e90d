# SPDX-License-Identifier: GPL-2.0-or-later
"""One C++ law with its numbers: steps, backbone, impacts. SI in, SI out; arrays are numpy, float64."""

import math
from ctypes import POINTER, c_double
from typing import Any, NotRequired, TypedDict, Unpack

import numpy as np
import numpy.typing as npt

from ..errors import CaseError
from .library import IMPACT_INPUT, IMPACT_OUTPUT, Array, StepResult, laws, library

_D = POINTER(c_double)


def _array(x: npt.ArrayLike) -> Array:
    return np.ascontiguousarray(np.atleast_1d(x), dtype=np.float64)


def _columns(*values: npt.ArrayLike) -> list[Array]:
    """The values broadcast to one shape (n,)."""
    return [_array(x) for x in np.broadcast_arrays(*map(_array, values))]


def _pointer(x: Array | None) -> Any:
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
        values = []
        for p in self.info.parameters:
            value = parameters.get(p.name, p.default)
            if value is None or not (math.isfinite(value) and (value > 0 or (value == 0 and p.may_vanish))):
                raise CaseError(f"law {name}: {p.name} = {value}, must be a finite number > 0 [{p.unit}]")
            values.append(value)
        self.name, self.E_star = name, float(E_star)
        self._parameters = (c_double * max(len(values), 1))(*values)

    def _call(self, function: str, *arguments: object) -> None:
        status = getattr(library(), function)(self.info.index, self.E_star, self._parameters, *arguments)
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
        self._call("epdem_step", n, *map(_pointer, contacts), out.ctypes.data_as(POINTER(StepResult)))
        return out[:, 0], out[:, 1], out[:, 2]

    def backbone(self, *, R_star: npt.ArrayLike, delta: npt.ArrayLike) -> tuple[Array, Array, Array, Array]:
        """(force [N], radius [m], work [J], plastic work [J]) of first loading to delta [m], > 0; arrays broadcast."""
        contacts = _columns(R_star, delta)
        n = contacts[0].size
        force, radius, work, plastic = (np.empty(n) for _ in range(4))
        self._call("epdem_backbone", n, *map(_pointer, (*contacts, force, radius, work, plastic)))
        return force, radius, work, plastic

    @staticmethod
    def _cases(
        steps: int,
        R_star: npt.ArrayLike,
        m_star: npt.ArrayLike,
        speed: npt.ArrayLike,
        time_step: npt.ArrayLike,
        gap: npt.ArrayLike = 0.0,
        viscous: float = 0.0,
    ) -> Array:
        columns = np.broadcast_arrays(*map(_array, (R_star, m_star, speed, time_step, gap)))
        cases = np.empty(columns[0].shape, IMPACT_INPUT)
        for name, column in zip(("R_star", "m_star", "speed", "time_step", "gap"), columns, strict=True):
            cases[name] = column
        cases["steps"], cases["viscous"] = steps, viscous
        return cases

    def _impacts(self, cases: Array, steps: int, *samples: Array | None) -> Array:
        out = np.empty(cases.shape, IMPACT_OUTPUT)
        places = (cases.size, cases.ctypes.data, out.ctypes.data)
        self._call("epdem_impacts", *places, steps + 1, *map(_pointer, samples))
        return out

    def impacts(self, *, steps: int, **numbers: Unpack[ImpactNumbers]) -> Array:
        """Two-body impacts by velocity Verlet, at most `steps` steps each: IMPACT_OUTPUT of shape (n,)."""
        return self._impacts(self._cases(steps, **numbers), steps, None, None, None)

    def impact_paths(self, *, steps: int, **numbers: Unpack[ImpactNumbers]) -> tuple[Array, Array, Array, Array]:
        """`impacts` with their paths: overlap [m], force [N] and approach velocity [m/s] of shape (n, steps + 1).

        They are NaN after the end of an impact.
        """
        cases = self._cases(steps, **numbers)
        overlap, force, velocity = (np.full((cases.size, steps + 1), np.nan) for _ in range(3))
        return self._impacts(cases, steps, overlap, force, velocity), overlap, force, velocity

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
        cases = self._cases(steps, **numbers)
        before = _array(np.broadcast_to(slip, cases.shape))
        after = np.empty(cases.shape)
        places = (cases.size, cases.ctypes.data, _pointer(before), _pointer(after))
        self._call("epdem_oblique", c_double(G_star), c_double(mu), nodes, *places)
        return after

    def motion(self, steps: npt.ArrayLike, *, R_star: float, G_star: float, mu: float, nodes: int) -> Array:
        """Normal force and friction (3) [N] of one contact, (n, 4), in a prescribed motion, (n, 9).

        A step is overlap, closing speed times time step [m], unit normal (3), slip in the step (3) [m], rotation about
        the normal in it, mean of both bodies [rad]. The normal points to the body that the forces act on. nodes as in
        `oblique`.
        """
        motion = np.ascontiguousarray(steps, dtype=np.float64)
        out = np.empty((len(motion), 4))
        numbers = (c_double(R_star), c_double(G_star), c_double(mu), nodes)
        self._call("epdem_motion", *numbers, len(motion), _pointer(motion), _pointer(out))
        return out

    def impacts_long_double(self, *, steps: int, **numbers: Unpack[ImpactNumbers]) -> Array:
        """The same impacts computed in long double, IMPACT_OUTPUT rounded at the end: a reference for round-off."""
        cases = self._cases(steps, **numbers)
        out = np.empty(cases.shape, IMPACT_OUTPUT)
        self._call("epdem_impacts_long_double", cases.size, cases.ctypes.data, out.ctypes.data)
        return out

    def bounces(self, count: int, *, steps: int, **numbers: Unpack[ImpactNumbers]) -> tuple[np.void, Array]:
        """`count` impacts of one contact, each at the rebound speed of the one before, at most `steps` steps each.

        Returns the last impact (IMPACT_OUTPUT, its `steps` those of all impacts) and the rebound speeds [m/s].
        """
        first = self._cases(steps, **numbers)
        out, speeds = np.empty(1, IMPACT_OUTPUT), np.full(count, np.nan)
        self._call("epdem_bounces", first.ctypes.data, count, out.ctypes.data, _pointer(speeds))
        return out[0], speeds
