# SPDX-License-Identifier: GPL-2.0-or-later
"""A metal that hardens: the family of laws between Thornton's eq. 8.83 and Hertz, by powers of the contact radius."""

import numpy as np

from .backbone import Backbone
from .numerics import Real


class Meyer(Backbone):
    """A limiting pressure that grows with the contact, p = p_y q^x, q = a/a_y >= 1 (Meyer 1908; Tabor 1951).

    a_y = pi R* p_y/(2E*) and a^2 = R* alpha as in Thornton 1997; from dF = 2 pi a p da:
    F/F_y = 1 + 3/(2+x) (q^(2+x) - 1), W/W_y = 1 + 5/2 [(1 - 3/(2+x)) (q^2 - 1) + 6/((2+x)(4+x)) (q^(4+x) - 1)].
    Meyer's index of indentation tests is n = 2 + x. p_y [Pa] > 0 at first yield, 2.8 Y by default; 0 <= x < 1, 0 by
    default, which is Thornton's law; x = 1 would be Hertz's.
    """

    name = "meyer"

    def __init__(self, *, E_star: Real, R_star: Real, p_y: Real, x: Real | None = None):
        super().__init__(E_star, R_star)
        self.p_y, self.x = self.read_parameters(p_y=p_y, x=x)
        self.yield_overlap = self.R_star * (np.pi * self.p_y / (2 * self.E_star)) ** 2
        self._F_y, self._W_y = self._hertz_force(self.yield_overlap), self._hertz_work(self.yield_overlap)

    def _log_q(self, alpha: Real) -> Real:
        """ln(a/a_y), at least 0; near 0 without cancellation."""
        return 0.5 * np.log1p(np.maximum(alpha - self.yield_overlap, 0.0) / self.yield_overlap)

    def force(self, alpha: Real) -> Real:
        n = 2 + self.x
        plastic = self._F_y * (1 + 3 / n * np.expm1(n * self._log_q(alpha)))
        return np.where(alpha <= self.yield_overlap, self._hertz_force(np.minimum(alpha, self.yield_overlap)), plastic)

    def radius(self, alpha: Real) -> Real:
        return np.sqrt(self.R_star * alpha)

    def pressure_max(self, alpha: Real) -> Real:
        grown = self.p_y * np.exp(self.x * self._log_q(alpha))
        return np.where(alpha <= self.yield_overlap, super().pressure_max(alpha), grown)

    def work(self, alpha: Real) -> Real:
        n, log_q = 2 + self.x, self._log_q(alpha)
        plastic = 2.5 * ((1 - 3 / n) * np.expm1(2 * log_q) + 6 / (n * (n + 2)) * np.expm1((n + 2) * log_q))
        return self._hertz_work(np.minimum(alpha, self.yield_overlap)) + self._W_y * plastic
