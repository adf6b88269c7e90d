# SPDX-License-Identifier: GPL-2.0-or-later
"""The elastic, perfectly plastic law with a truncated pressure."""

import numpy as np

from .backbone import Backbone
from .numerics import Real


class Thornton(Backbone):
    """Truncated Hertz pressure (Thornton 1997): F = F_y + pi p_y R* (alpha - alpha_y) past a_y = pi R* p_y/(2E*).

    a^2 = R* alpha throughout; p_y [Pa] > 0, 2.8 Y by default.
    """

    name = "thornton"

    def __init__(self, *, E_star: Real, R_star: Real, p_y: Real):
        super().__init__(E_star, R_star)
        (self.p_y,) = self.read_parameters(p_y=p_y)
        self.yield_overlap = self.R_star * (np.pi * self.p_y / (2 * self.E_star)) ** 2

    def force(self, alpha: Real) -> Real:
        y, slope = self.yield_overlap, np.pi * self.p_y * self.R_star
        # F_y = 2/3 slope alpha_y
        return np.where(alpha <= y, self._hertz_force(np.minimum(alpha, y)), slope * (alpha - y / 3))

    def radius(self, alpha: Real) -> Real:
        return np.sqrt(self.R_star * alpha)

    def pressure_max(self, alpha: Real) -> Real:
        return np.where(alpha <= self.yield_overlap, super().pressure_max(alpha), self.p_y)

    def work(self, alpha: Real) -> Real:
        y, slope = self.yield_overlap, np.pi * self.p_y * self.R_star
        x = np.maximum(alpha - y, 0.0)
        return self._hertz_work(np.minimum(alpha, y)) + slope * x * (2 / 3 * y + x / 2)

    def _beyond_yield(self, alpha_max: Real) -> tuple[Real, Real]:
        """t = sqrt(alpha_max/alpha_y), at least 1, and t - 1 without cancellation."""
        x = np.maximum(alpha_max - self.yield_overlap, 0.0) / self.yield_overlap
        t = np.sqrt(1 + x)
        return t, x / (1 + t)

    def residual_overlap(self, alpha_max: Real) -> Real:
        """The dent [m]: alpha_y (t-1)^2 (t + 1/2)/t with t^2 = alpha_max/alpha_y; its difference would cancel."""
        t, more = self._beyond_yield(alpha_max)
        return self.yield_overlap * more**2 * (t + 0.5) / t

    def plastic_work(self, alpha_max: Real) -> Real:
        """Work that stays in the dent [J]: pi p_y R* alpha_y^2 (t-1)^2 (15 t^3 + 12 t^2 - t - 2)/(30 t), t as above."""
        t, more = self._beyond_yield(alpha_max)
        unit = np.pi * self.p_y * self.R_star * self.yield_overlap**2
        return unit * more**2 * (((15 * t + 12) * t - 1) * t - 2) / (30 * t)
