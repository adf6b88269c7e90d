# SPDX-License-Identifier: GPL-2.0-or-later
"""Elastic, perfectly plastic adhesive contact in closed form [Thornton and Ning 1998]."""

import numpy as np

from .adhesive_curve import AdhesiveCurve, Numbers, Path
from .jkr import JKR
from .numerics import gauss

_T, _W = gauss(8)  # exact up to degree 15, which is that of the work of the plastic branch


class ThorntonNing(JKR):
    """A JKR contact whose pressure is cut at p_y (Thornton and Ning 1998).

    Yield at a_y: 2 E* a_y/(pi R*) - sqrt(2 Gamma E*/(pi a_y)) = p_y. Beyond it u is the rim's share outside the core
    that flows: A u^2 - p_y u - B = 0, A = 2 E* a/(pi R*), B = sqrt(2 Gamma E*/(pi a)), and
    F = pi p_y a^2 (1 - u^2) + 2 pi a^2 (A u^3/3 - B u); the overlap stays a^2/R* - d. Unloading from a_m is a JKR
    contact of radius R_p = 4 E* a_m^3/(3 (F + P_t)), shifted by alpha_p = a_m^2 (1/R* - 1/R_p).
    Gamma = 0 is Thornton's law of 1997. p_y [Pa] > 0, 2.8 Y by default; the others as in JKR. ValueError outside.
    """

    name = "thornton_ning"

    def __init__(self, *, E_star: Numbers, R_star: Numbers, Gamma: Numbers, p_y: Numbers) -> None:
        super().__init__(E_star=E_star, R_star=R_star, Gamma=Gamma)
        (self.p_y,) = self.read_parameters(p_y=p_y)
        self._A = 2 * self.E_star / (np.pi * self.R_star)  # A = _A y^2
        self._B = np.sqrt(2 * self.Gamma * self.E_star / np.pi)  # B = _B/y
        self.yield_radius = self._yield_root() ** 2

    def _yield_root(self) -> Numbers:
        """sqrt(a_y): the positive root of y^3 - (p_y/_A) y - _B/_A = 0, closed for either sign of the discriminant."""
        third, t = self.p_y / self._A / 3, 0.5 * self._B / self._A
        t = t / third**1.5
        weak, strong = np.cos(np.arccos(np.minimum(t, 1.0)) / 3), np.cosh(np.arccosh(np.maximum(t, 1.0)) / 3)
        return 2 * np.sqrt(third) * np.where(t <= 1, weak, strong)

    def force(self, a: Numbers) -> Numbers:
        """Force F [N] at contact radius a [m] >= 0 while it grows: JKR up to a_y, then the truncated pressure."""
        a = np.asarray(a, float)
        return np.where(a <= self.yield_radius, super().force(a), self._plastic_force(np.sqrt(a), self._core(a)))

    def _core(self, a: Numbers) -> Numbers:
        """sqrt(p_y^2 + 4 A B) [Pa], so that u = (p_y + core)/(2 A)."""
        return np.sqrt(self.p_y**2 + 4 * self._A * self._B * np.sqrt(a))

    def _plastic_force(self, y: Numbers, core: Numbers) -> Numbers:
        """The force with u put in: a polynomial in core, for y is one, too."""
        sum_ = self.p_y + core
        less = self.p_y * sum_**2 / (12 * self._A**2) + 2 / 3 * self._B / self._A * y * sum_
        return np.pi * (self.p_y * y**4 - less)

    def plastic_path(self, low: Numbers, high: Numbers) -> Path:
        """As `elastic_path` on the plastic curve between contact radii >= a_y [m], the core pressure going straight;
        the second function is a polynomial of degree 15."""
        left, start = np.sqrt(low), self._core(low)
        D = (np.sqrt(high) - left) / (start + self._core(high))
        rise = 4 * self._A * self._B * D  # core(high) - core(low) without cancellation

        def y(t: Numbers) -> Numbers:
            return left + D * t * (2 * start + rise * t)

        def slope(t: Numbers) -> Numbers:
            return self.slope(y(t)) * 2 * D * (start + rise * t)

        def power(t: Numbers) -> Numbers:
            return self._plastic_force(y(t), start + rise * t) * slope(t)

        return slope, power

    def loading_paths(self, top: Numbers) -> list[tuple[Path, Numbers]]:
        first = self.touch_radius
        elastic = np.clip(self.yield_radius, first, np.maximum(top, first))
        last = np.maximum(top, elastic)
        return [(self.elastic_path(first, elastic), elastic), (self.plastic_path(elastic, last), last)]

    def work(self, a: Numbers) -> Numbers:
        """Work [J] put in from touch (a_0) to contact radius a [m] >= a_0 while it grows; exact to round-off."""
        a, first = np.asarray(a, float), self.touch_radius
        elastic = np.clip(self.yield_radius, first, np.maximum(a, first))  # where the elastic part ends
        _, power = self.plastic_path(elastic, a)
        flow = sum(w * power(t) for t, w in zip(_T, _W, strict=True))
        return self.energy(elastic) - self.energy(first) + np.where(a > elastic, flow, 0.0)

    def branch(self, a_max: Numbers) -> tuple[AdhesiveCurve, Numbers]:
        """The elastic contact (JKR) on which one that reached a_max [m] opens again, and the shift alpha_p [m] of its
        overlaps: alpha = alpha_p + branch.overlap(a). Up to a_y it is the law's own elastic branch."""
        a_max = np.asarray(a_max, float)
        yields = a_max > self.yield_radius
        safe: Numbers = np.where(yields, a_max, self.yield_radius)
        R_p: Numbers = 4 / 3 * self.E_star * safe**3 / (self.force(safe) + self.adhesive_load(safe))
        R_p = np.where(yields, R_p, self.R_star)
        opened = AdhesiveCurve(E_star=self.E_star, R_star=R_p, Gamma=self.Gamma)
        return opened, np.where(yields, safe**2 * (1 / self.R_star - 1 / R_p), 0.0)
