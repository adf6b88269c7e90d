# SPDX-License-Identifier: GPL-2.0-or-later
"""The fully plastic law."""

import numpy as np

from .backbone import Backbone
from .numerics import Array, Real


class Johnson(Backbone):
    """Fully plastic contact; Hertz while that is the smaller force (section 11.5).

    Eq. 8.85 [Johnson 1985]: F = 2 pi R* p_m alpha, a^2 = 2 R* alpha

    The radius jumps by sqrt 2 at alpha_c = R* (3 pi p_m/(2E*))^2. p_m [Pa] > 0, 3.0 Y by default.
    """

    name = "johnson"
    trusted_from = 2.0  # in units of v_c, the speed that reaches alpha_c

    def __init__(self, *, E_star: Real, R_star: Real, p_m: Real):
        super().__init__(E_star, R_star)
        (self.p_m,) = self.read_parameters(p_m=p_m)
        self.yield_overlap = self.R_star * (3 * np.pi * self.p_m / (2 * self.E_star)) ** 2

    def force(self, alpha: Real) -> Real:
        elastic = self._hertz_force(np.minimum(alpha, self.yield_overlap))
        return np.where(alpha <= self.yield_overlap, elastic, 2 * np.pi * self.R_star * self.p_m * alpha)

    def radius(self, alpha: Real) -> Real:
        return np.where(alpha <= self.yield_overlap, 1.0, np.sqrt(2.0)) * np.sqrt(self.R_star * alpha)

    def pressure_max(self, alpha: Real) -> Real:
        return np.where(alpha <= self.yield_overlap, super().pressure_max(alpha), self.p_m)

    def work(self, alpha: Real) -> Real:
        y = self.yield_overlap
        x = np.maximum(alpha - y, 0.0)
        return self._hertz_work(np.minimum(alpha, y)) + np.pi * self.R_star * self.p_m * x * (2 * y + x)

    def caveats(self, *, m_star: Real, speed: Array) -> list[str]:
        """Between first yield (1.60 Y, p_m = 3 Y) and 2 v_c the law is elastic, or just past the jump of its radius."""
        jump = np.sqrt(2 * self._hertz_work(self.yield_overlap) / m_star)
        # Hertz's peak pressure at alpha_c is 3 p_m = 9 Y, and speeds go as its power 5/2
        doubtful = speed[(speed > (1.6 / 9) ** 2.5 * jump) & (speed < self.trusted_from * jump)]
        if not doubtful.size:
            return []
        return [
            f"speed = {doubtful.min():.3g} m/s is below {self.trusted_from * float(jump):.3g} m/s, twice the speed at "
            "which johnson turns from elastic to fully plastic: its e_n is up to 53 % above that of cavity there "
            "(11 % at the end); use cavity"
        ]
