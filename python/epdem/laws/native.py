# SPDX-License-Identifier: GPL-2.0-or-later
"""One C++ law with its numbers: steps, backbone, impacts. SI in, SI out; arrays are numpy, float64."""

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
            if value is None or not p.holds(value):
                raise CaseError(f"law {name}: {p.name} = {value}, must be a finite number in {p.limits()} [{p.unit}]")
            values.append(value)
        self.name, self.E_star = name, float(E_star)
        self._parameters = (c_double * max(len(values), 1))(*values)

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
        self.call("epdem_step", n, *map(pointer, contacts), out.ctypes.data_as(POINTER(StepResult)))
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
