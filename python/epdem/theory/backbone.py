# SPDX-License-Identifier: GPL-2.0-or-later
"""Base of the laws without adhesion."""

import numpy as np

from . import restitution as undamped
from . import viscous, yielding
from .curve import Curve
from .law import Law
from .numerics import Real
from .restitution import Impact


class Backbone(Curve, Law):
    """A law without adhesion: its curve, and the impacts that follow from any such curve."""

    first_yield_speed = yielding.first_yield_speed

    def impact(self, *, m_star: Real, speed: Real, restitution: float | None = None) -> Impact:
        if restitution is None:
            return undamped.impact(self, m_star=m_star, speed=speed)
        return viscous.impact(self, m_star=m_star, speed=speed, restitution=restitution)

    def radius_of_work(self, W: Real) -> Real:
        return self.radius(self.overlap_of_work(W))

    def lost_work(self, alpha_max: Real) -> Real:
        return self.work(alpha_max) - self.recovered_work(alpha_max)

    def has_yielded(self, impact: Impact) -> bool:
        return bool(impact.overlap_max.max() > self.yield_overlap)

    def yield_speed(self, *, m_star: Real) -> Real:
        return np.sqrt(2 * self.work(self.yield_overlap) / m_star)

    def sticking_speed(self, *, m_star: Real) -> Real:
        return 0.0
