# SPDX-License-Identifier: GPL-2.0-or-later
"""Force, radius and work of a contact without adhesion by its overlap: elastic start, loading, unloading."""

from collections.abc import Callable
from typing import ClassVar

import numpy as np

from ..base.declarations import Declaration, declarations
from .numerics import Array, Real, number


class Declared:
    """A law whose declaration stands in C++: names, defaults and ranges of its parameters are read from there."""

    name: ClassVar[str]
    uses_share: ClassVar[bool] = False  # whether it takes the share of the weaker body in the strain

    @classmethod
    def declaration(cls) -> Declaration:
        return declarations()[cls.name]

    def read_parameters(self, **values: Real | None) -> tuple[Real, ...]:
        """Parameters by their symbols, each its default if it is None. ValueError outside of their ranges."""
        known = {p.symbol: p for p in self.declaration().parameters}
        numbers = []
        for symbol, value in values.items():
            p = known[symbol]
            x = p.default if value is None else value
            x = np.nan if x is None else x
            numbers.append(number(symbol, x, high=p.below, low_ok=p.may_vanish, high_ok=p.below == np.inf))
        return tuple(numbers)


class Curve(Declared):
    """Elastic start, backbone of a law and, below alpha_max, superposed rigid punches (Mesarovic and Johnson)."""

    yield_overlap: Real  # end of the elastic branch [m]

    def __init__(self, E_star: Real, R_star: Real):
        self.E_star, self.R_star = number("E_star", E_star), number("R_star", R_star)

    def _hertz_force(self, alpha: Real) -> Real:
        return 4 / 3 * self.E_star * np.sqrt(self.R_star * alpha) * alpha

    def _hertz_work(self, alpha: Real) -> Real:
        return 8 / 15 * self.E_star * np.sqrt(self.R_star * alpha) * alpha**2

    def _hertz_overlap(self, W: Real) -> Real:
        return (15 / 8 * W / (self.E_star * np.sqrt(self.R_star))) ** 0.4

    def force(self, alpha: Real) -> Real:
        """Backbone force F [N] at overlaps alpha [m] >= 0."""
        raise TypeError(f"{type(self).__name__} does not define it")

    def radius(self, alpha: Real) -> Real:
        """Contact radius a [m] on the backbone."""
        raise TypeError(f"{type(self).__name__} does not define it")

    def work(self, alpha: Real) -> Real:
        """Work W [J] along the backbone from 0 to alpha [m]."""
        raise TypeError(f"{type(self).__name__} does not define it")

    def overlap_of_work(self, W: Real) -> Real:
        """Overlap alpha [m] at which the backbone has taken W [J] >= 0: the inverse of `work`.

        Newton's method, for the slope of the work is the force, from Hertz's overlap, which a law that yields exceeds.
        """
        W = np.asarray(W, float)
        alpha = hertz = self._hertz_overlap(W)
        yields = self._hertz_work(self.yield_overlap) < W
        for _ in range(60):  # 8 to 15
            before, change = alpha, (W - self.work(alpha)) / np.maximum(self.force(alpha), 1e-300)
            alpha = np.where(yields, np.maximum(before + change, self.yield_overlap), hertz)
            if np.all(np.abs(alpha - before) <= 1e-9 * alpha):  # convergence is quadratic
                break
        return alpha

    def flatness(self, alpha: Real) -> Real:
        """tau of the contact pressure on the backbone: 0 Hertz's half-ellipse, 1 uniform."""
        return np.zeros(np.shape(alpha))

    def pressure_max(self, alpha: Real) -> Real:
        """Largest contact pressure [Pa] on the backbone: 1.5 - 0.5 tau of the mean one, if the law does not say it."""
        return (1.5 - 0.5 * self.flatness(alpha)) * self.force(alpha) / (np.pi * self.radius(alpha) ** 2)

    def kinks(self) -> list[Real]:
        """Overlaps [m] at which the backbone changes its formula."""
        return [self.yield_overlap]

    def recovered_overlap(self, alpha_max: Real) -> Real:
        """Overlap given back on full unloading [m]: delta_e = (A + B) F/(E* a), A = 3/4 (1-tau), B = (2/pi) tau."""
        tau = self.flatness(alpha_max)
        return (0.75 * (1 - tau) + 2 / np.pi * tau) * self.force(alpha_max) / (self.E_star * self.radius(alpha_max))

    def residual_overlap(self, alpha_max: Real) -> Real:
        """The dent [m]: alpha_max - delta_e, exactly 0 up to yield."""
        alpha_max = np.asarray(alpha_max, float)
        dent = np.maximum(alpha_max - self.recovered_overlap(alpha_max), 0.0)
        return np.where(alpha_max <= self.yield_overlap, 0.0, dent)

    def recovered_work(self, alpha_max: Real) -> Real:
        """Energy given back on full unloading [J]: kappa F^2/(a E*)."""
        tau = self.flatness(alpha_max)
        kappa = 0.3 * (1 - tau) ** 2 + 0.5625 * tau * (1 - tau) + 8 / (3 * np.pi**2) * tau**2
        return kappa * self.force(alpha_max) ** 2 / (self.radius(alpha_max) * self.E_star)

    def plastic_work(self, alpha_max: Real) -> Real:
        """Work that stays in the dent [J]: W - kappa F^2/(a E*), exactly 0 up to yield."""
        lost = np.maximum(self.work(alpha_max) - self.recovered_work(alpha_max), 0.0)
        return np.where(alpha_max <= self.yield_overlap, 0.0, lost)

    def elastic_branch(self, alpha_max: Real) -> Callable[[Real], tuple[Array, Array]]:
        """Force [N] and contact radius [m] as a function of alpha <= alpha_max on the elastic branch from alpha_max.

        Eq. 8.82 [Mesarovic and Johnson 2000]: F/F_max = (1-tau)(1-y^2)^1.5 + (2/pi) tau (acos y - y sqrt(1-y^2)),
        a = a_max sqrt(1-y^2), A y^2 + B y = (alpha_max-alpha) E* a_max/F_max, A = 3/4 (1-tau), B = (2/pi) tau
        """
        top = np.asarray(alpha_max, float)
        F, a, tau = self.force(top), self.radius(top), self.flatness(top)
        stiffness = self.E_star * a / F

        def force_and_radius(alpha: Real) -> tuple[Array, Array]:
            y = np.clip(_depth((top - alpha) * stiffness, tau), 0.0, 1.0)
            rest = 1 - y * y
            root = np.sqrt(rest)
            share = (1 - tau) * rest * root + 2 / np.pi * tau * (np.arccos(y) - y * root)
            return F * share, a * root

        return force_and_radius

    def unloading(self, alpha: Real, alpha_max: Real) -> tuple[Array, Array]:
        """Force [N] and contact radius [m] at alpha <= alpha_max on the elastic branch from alpha_max."""
        return self.elastic_branch(alpha_max)(np.asarray(alpha, float))

    def unloading_force(self, alpha: Real, alpha_max: Real) -> Array:
        """Force [N] on the elastic branch below alpha_max [m]."""
        return self.unloading(alpha, alpha_max)[0]


def _depth(w: Real, tau: Real) -> Array:
    """y of A y^2 + B y = w: how much of the contact circle has opened."""
    A, B = 0.75 * (1 - tau), 2 / np.pi * tau
    S = B + np.sqrt(B * B + 4 * A * w)
    return np.divide(2 * w, S, out=np.zeros(np.broadcast(w, S).shape), where=S > 0)
