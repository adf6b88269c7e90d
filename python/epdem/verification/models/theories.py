# SPDX-License-Identifier: GPL-2.0-or-later
"""Laws of other codes without adhesion and damping; theory of their impacts is the motion under them.

luding     k_1 = F_max/alpha_max of the case's own law at its middle speed; k_p/k_1 = 5 and phi_f = 0.05 (Luding 2008)
edinburgh  k_1 = 4/3 E* sqrt(R*), Hertz's, to which the model is tied; k_2/k_1 = 5, n = 1.5, no adhesion
mdr        a sphere on a rigid flat: the modulus that makes E/(1-nu^2) the case's E*, the smaller yield stress
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
from scipy.integrate import solve_ivp

from ...errors import CaseError
from ...impacts.experiment import Experiment
from ...impacts.prediction import Prediction, predict
from ...theory.numerics import bisect, segment

STIFFENING, DEPTH, EXPONENT = 5.0, 0.05, 1.5  # k_p/k_1 and k_2/k_1; phi_f; n
TIGHT: dict[str, Any] = {"method": "DOP853", "rtol": 1e-10}


class OtherLaw(ABC):
    """A law that unloads along another line than it loads: forces [N] at overlaps x [m] that reached `top`."""

    note: str  # the rule for its numbers

    @classmethod
    @abstractmethod
    def of(cls, x: Experiment) -> Self:
        """With the numbers for a case. Raises CaseError for a case that the model cannot represent."""

    @abstractmethod
    def load(self, x: float) -> float:
        """Force while the overlap grows."""

    @abstractmethod
    def dent(self, top: float) -> float:
        """Overlap at which the force ends."""

    @abstractmethod
    def unload(self, x: float, top: float) -> float:
        """Force on the way from `top` to the dent."""

    def impact(self, *, m_star: float, speed: float, size: float) -> dict[str, float]:
        """An impact at `speed` [m/s] with effective mass m_star [kg]; size [m] of the bodies, for the tolerance."""
        tight = TIGHT | {"atol": (1e-17 * size, 1e-14 * speed)}

        def move(force: Callable[[float], float], start: tuple[float, float], left: Callable[[Any], Any]) -> Any:
            """(time, overlap, velocity) where `left` of overlap and velocity falls to 0."""

            def ended(t: float, y: Any) -> Any:
                return left(y)

            ended.terminal, ended.direction = True, -1  # type: ignore[attr-defined]
            path = solve_ivp(lambda t, y: (y[1], -force(y[0]) / m_star), (0, np.inf), start, events=ended, **tight)
            return path.t[-1], *path.y[:, -1]

        there, top, _ = move(self.load, (0.0, speed), lambda y: y[1])
        dent = self.dent(top)
        back, _, v = move(lambda x: self.unload(x, top), (top, 0.0), lambda y: y[0] - dent)
        W, out = 0.5 * m_star * speed**2, 0.5 * m_star * v**2
        times = {"e_n": -v / speed, "contact_time": there + back, "force_max": self.load(top)}
        places = {"overlap_max": top, "residual_overlap": dent}
        return times | places | {"work_in": W, "work_out": out, "plastic_work": W - out}

    def prediction(self, x: Experiment) -> Prediction:
        """Theory of a case's impacts."""
        rows = [self.impact(m_star=x.m_star, speed=float(v), size=x.R_star) for v in x.speed]
        columns: dict[str, Any] = {name: np.array([row[name] for row in rows]) for name in rows[0]}
        radius = np.sqrt(columns["overlap_max"] * x.R_star)
        columns |= {"speed": x.speed, "radius_max": radius, "strain": x.law.share * radius / x.R_star}
        return Prediction(**columns, yields=(), yield_speeds={})


@dataclass(frozen=True)
class Luding(OtherLaw):
    """Linear, k_c = 0: k_1 up to delta_p = k_p/(k_p - k_1) phi_f 2 R*, k_p beyond; back along k_2."""

    k_1: float  # [N/m]
    k_p: float  # [N/m]
    phi_f: float
    R_star: float
    note: str = ""

    @classmethod
    def of(cls, x: Experiment) -> Self:
        own, middle = predict(x), x.speed.size // 2
        k_1 = float(own.force_max[middle] / own.overlap_max[middle])
        note = (
            f"k_1 = {k_1:.4g} N/m (F_max/overlap of {x.law.name} at {x.speed[middle]:.4g} m/s), "
            f"k_p/k_1 = {STIFFENING:g}, phi_f = {DEPTH:g}"
        )
        return cls(k_1, STIFFENING * k_1, DEPTH, x.R_star, note)

    @cached_property
    def limit(self) -> float:
        """delta_p [m], the largest overlap that still dents."""
        return self.k_p / (self.k_p - self.k_1) * self.phi_f * 2 * self.R_star

    def _slope(self, top: float) -> float:
        return self.k_1 + (self.k_p - self.k_1) * min(top / self.limit, 1.0)

    def load(self, x: float) -> float:
        return self.k_1 * min(x, self.limit) + self.k_p * max(x - self.limit, 0.0)

    def dent(self, top: float) -> float:
        return min(top, self.limit) * (1 - self.k_1 / self._slope(top))

    def unload(self, x: float, top: float) -> float:
        return self._slope(top) * (x - self.dent(top))


@dataclass(frozen=True)
class Edinburgh(OtherLaw):
    """Power law: F = k_1 x^n, and k_2 (x^n - dent^n) back. [Thakur et al. 2014]"""

    k_1: float  # [N/m^n]
    k_2: float
    n: float = EXPONENT
    note = f"k_1 = 4/3 E* sqrt(R*), k_2/k_1 = {STIFFENING:g}, n = {EXPONENT:g}, no adhesion"

    @classmethod
    def of(cls, x: Experiment) -> Self:
        k_1 = 4 / 3 * x.E_star * math.sqrt(x.R_star)
        return cls(k_1, STIFFENING * k_1)

    def load(self, x: float) -> float:
        return self.k_1 * float(max(x, 0.0) ** self.n)

    def dent(self, top: float) -> float:
        return float((1 - self.k_1 / self.k_2) ** (1 / self.n) * top)

    def unload(self, x: float, top: float) -> float:
        return self.k_2 * float(max(x, 0.0) ** self.n - self.dent(top) ** self.n)


@dataclass(frozen=True)
class Mdr(OtherLaw):
    """Sphere on a rigid flat, its radius constant [Zunker and Kamrin 2024], as a bed of springs under an ellipse.

    Mean pressure p_Y = Y (1 + 1.75 exp(-4.4 x/R)) once Hertz's has reached it; the volume under the flat goes aside,
    so that a^2 is nearly 2 R x. Unloading is that of a uniform pressure, shortened by the rise of the free surface.
    """

    young_modulus: float
    poisson_ratio: float
    yield_stress: float
    R: float
    note: str = ""

    @classmethod
    def of(cls, x: Experiment) -> Self:
        if math.isfinite(x.target.radius) or x.viscous_restitution is not None:
            raise CaseError("mdr is compared on walls and without a dashpot: its flats are rigid")
        stresses = [b.yield_stress for b in (x.body, x.target) if b.yield_stress is not None]
        if len(stresses) < 2 or x.body.rigid:
            raise CaseError("mdr needs the yield stress of both materials")
        nu, Y = x.body.poisson_ratio, min(stresses)
        E = x.E_star * (1 - nu * nu)
        note = (
            f"rigid flat, E = {E:.4g} Pa (the case's E*), Y = {Y:.4g} Pa, p = 2.75 Y; "
            "its radius grows, its theory's does not: a comparison"
        )
        return cls(E, nu, Y, x.R_star, note)

    @cached_property
    def E(self) -> float:
        """E/(1-nu^2) [Pa]."""
        return self.young_modulus / (1 - self.poisson_ratio**2)

    @cached_property
    def yield_overlap(self) -> float:
        """Where the mean pressure of Hertz's contact reaches p_Y [m]."""
        hertz = 4 * self.E / (3 * math.pi * math.sqrt(self.R))
        return float(bisect(lambda x: hertz * math.sqrt(x) < self.pressure(x), 0.0, self.R, steps=100)[1])

    def pressure(self, x: float) -> float:
        """p_Y [Pa]."""
        return self.yield_stress * (1 + 1.75 * math.exp(-4.4 * x / self.R))

    def area_over_pi(self, x: float) -> float:
        """a^2 [m^2] of a contact that yields."""
        return (2 * x - self.yield_overlap) * self.R - (x - self.yield_overlap) * (x + self.yield_overlap)

    def _springs(self, depth: float, high: float, wide: float) -> float:
        """Force of an ellipse that is pressed `depth` into the springs."""
        return self.E * high * wide / 4 * float(segment(2 * math.asin(math.sqrt(max(depth, 0.0) / high))))

    def load(self, x: float) -> float:
        if x <= self.yield_overlap:
            return self._springs(x, 4 * self.R, 2 * self.R)
        return math.pi * self.area_over_pi(x) * self.pressure(x)

    def _recovery(self, top: float) -> tuple[float, float, float]:
        """Radius, depth of the springs and rise of the free surface at the top [m]."""
        p, nu, a = self.pressure(top), self.poisson_ratio, math.sqrt(self.area_over_pi(top))
        deep = 2 * p * a / self.E
        z = self.R - top + deep  # of the sphere's centre under the flat, when all strain has gone
        slant = math.hypot(a, z)
        return a, deep, (2 * a * a * (nu - 1) - (2 * nu - 1) * z * (slant - z)) * p / (self.E * (1 - nu) * slant)

    def dent(self, top: float) -> float:
        if top > 0.499 * self.R:
            raise CaseError("mdr: the overlap passes half the radius")
        if top <= self.yield_overlap:
            return 0.0
        _, deep, rise = self._recovery(top)
        return top - deep - rise

    def unload(self, x: float, top: float) -> float:
        if top <= self.yield_overlap:
            return self.load(x)
        a, deep, rise = self._recovery(top)
        return self._springs((x - self.dent(top)) / (1 + rise / deep), 2 * deep, 2 * a)


def prediction(tool: object, x: Experiment) -> Prediction:
    """Theory of what an engine runs: of its own law if it has one, else of the case's."""
    own: type[OtherLaw] | None = getattr(tool, "own", None)
    return own.of(x).prediction(x) if own else predict(x)
