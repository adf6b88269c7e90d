# SPDX-License-Identifier: GPL-2.0-or-later
"""The elastic law."""

import numpy as np

from .backbone import Backbone
from .numerics import Real


class Hertz(Backbone):
    """Elastic contact (Hertz 1882): F = 4/3 E* sqrt(R*) alpha^1.5, a^2 = R* alpha, W = 8/15 E* sqrt(R*) alpha^2.5."""

    name = "hertz"

    def __init__(self, *, E_star: Real, R_star: Real):
        super().__init__(E_star, R_star)
        self.yield_overlap = np.inf

    def force(self, alpha: Real) -> Real:
        return self._hertz_force(alpha)

    def radius(self, alpha: Real) -> Real:
        return np.sqrt(self.R_star * alpha)

    def work(self, alpha: Real) -> Real:
        return self._hertz_work(alpha)
