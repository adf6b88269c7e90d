# SPDX-License-Identifier: GPL-2.0-or-later
"""The adhesive opening of a flattened contact: superposed rigid punches [Mesarovic and Johnson 2000], less one punch in
tension whose rim has the stress intensity of Gamma [Maugis and Barquins 1978]."""

import numpy as np

from .adhesive_curve import AdhesiveCurve, Numbers, Path
from .numerics import bisect, gauss, segment

_X, _W = gauss(24)


class Flattened(AdhesiveCurve):
    """F = F_u(a) - P_t(a), alpha = alpha_u(a) - d(a) below a peak of force F0 [N], radius a0 [m] and flatness tau.

    With s = a/a0 (eq. 8.82): F_u = F0 [(1-tau) s^3 + (2 tau/pi)(asin s - s sqrt(1-s^2))], alpha_u = F0/(E* a0)
    [A s^2 + B (1 - sqrt(1-s^2))], A = 3/4 (1-tau), B = 2 tau/pi. Overlaps count from the dent. Of a small s this is a
    JKR contact of R' = 4 E* a0^3/(3 b F0), b = 1 - tau + 4 tau/(3 pi); of tau = 0 it is one at any s. No a exceeds a0.
    """

    path_nodes = 32

    def __init__(self, *, E_star: Numbers, Gamma: Numbers, force: Numbers, radius: Numbers, flatness: Numbers) -> None:
        self.tau, self.F0, self.a0 = (np.asarray(x, float) for x in (flatness, force, radius))
        share = 1 - self.tau + 4 * self.tau / (3 * np.pi)
        super().__init__(E_star=E_star, R_star=4 * E_star * self.a0**3 / (3 * share * self.F0), Gamma=Gamma)
        self.A, self.B = 0.75 * (1 - self.tau), 2 / np.pi * self.tau
        self.way = self.F0 / (self.E_star * self.a0)  # unit of overlaps [m]
        self.k = self.c * np.sqrt(self.a0) / self.way  # d(a0) in it

    def _share(self, a: Numbers) -> Numbers:
        return np.minimum(np.asarray(a, float) / self.a0, 1.0)

    def overlap(self, a: Numbers) -> Numbers:
        square = self._share(a) ** 2
        return self.way * (self.A + self.B / (1 + np.sqrt(1 - square))) * square - self.c * np.sqrt(a)

    def _opened(self, angle: Numbers) -> Numbers:
        """F_u/F0 at s = sin(angle)."""
        return (1 - self.tau) * np.sin(angle) ** 3 + self.B * segment(angle)

    def force(self, a: Numbers) -> Numbers:
        return self.F0 * self._opened(np.arcsin(self._share(a))) - self.adhesive_load(a)

    def energy(self, a: Numbers) -> Numbers:
        """U_u - F_u d + pi Gamma a^2: F is its slope by alpha, for dF_u = 2 E* a d alpha_u. U_u by Gauss's rule."""
        angle = np.arcsin(self._share(a))
        stored = 0.0
        for x, w in zip(_X, _W, strict=True):
            t = angle * x
            slope = 2 * self.A * np.sin(t) * np.cos(t) + self.B * np.sin(t)
            stored = stored + w * self._opened(t) * slope * angle
        F_u, d = self.F0 * self._opened(angle), self.c * np.sqrt(a)
        return self.F0 * self.way * stored - F_u * d + np.pi * self.Gamma * a * a

    def radius(self, alpha: Numbers) -> Numbers:
        """As of `AdhesiveCurve`, by bisection; a0 beyond the peak."""
        alpha = np.asarray(alpha, float)
        _, a = bisect(lambda a: self.overlap(a) < alpha, self.fold_radius, self.a0, steps=100)
        return np.where(alpha < self.fold_overlap, 0.0, a)

    def _extreme(self, factor: float) -> Numbers:
        """Contact radius [m] where a d alpha_u/da = factor d/2: s^1.5 (2 A + B/sqrt(1-s^2)) = factor k/2."""

        def below(s: Numbers) -> Numbers:
            with np.errstate(divide="ignore", invalid="ignore"):
                rim = np.where(self.B > 0, self.B / np.sqrt(1 - s * s), 0.0)
            return s**1.5 * (2 * self.A + rim) < factor * self.k / 2

        _, s = bisect(below, 0.0 * self.k, 1.0 + 0.0 * self.k, steps=200)
        return np.where(self.k > 0, s * self.a0, 0.0)

    @property
    def fold_radius(self) -> Numbers:
        return self._extreme(1.0)

    @property
    def fold_overlap(self) -> Numbers:
        return self.overlap(self.fold_radius)

    @property
    def touch_radius(self) -> Numbers:
        return self.radius(0.0)

    @property
    def pull_off_force(self) -> Numbers:
        """Largest pull [N]: where dF/da = 0, 2 a d alpha_u/da = 3 d."""
        return -self.force(self._extreme(3.0))

    def elastic_path(self, low: Numbers, high: Numbers) -> Path:
        """As of `AdhesiveCurve`; a = a0 sin x^2, x going straight, so that both functions are analytic."""
        left = np.sqrt(np.arcsin(self._share(low)))
        width = np.sqrt(np.arcsin(self._share(high))) - left

        def slope(t: Numbers) -> Numbers:
            x = left + width * t
            sin, cos = np.sin(x * x), np.cos(x * x)
            punch = 0.5 * self.c * np.sqrt(self.a0) * cos / np.sqrt(sin)
            return 2 * x * width * (self.way * sin * (2 * self.A * cos + self.B) - punch)

        def power(t: Numbers) -> Numbers:
            x = left + width * t
            F = self.F0 * self._opened(x * x) - self.adhesive_load(self.a0 * np.sin(x * x))
            return F * slope(t)

        return slope, power
