# SPDX-License-Identifier: GPL-2.0-or-later
"""The elastic adhesive law, and base of the laws with adhesion."""

from . import adhesion
from .adhesive_curve import AdhesiveCurve, Numbers
from .backbone import Law
from .numerics import Array
from .restitution import Impact


class JKR(AdhesiveCurve, Law):
    """A law with adhesion: its curve by contact radius (Johnson, Kendall and Roberts 1971), and its impacts."""

    name = "jkr"

    def impact(self, *, m_star: Numbers, speed: Numbers, restitution: float | None = None) -> Impact:
        if restitution is not None:
            raise ValueError(f"law {self.name}: no theory of impacts has both adhesion and a dashpot; remove one")
        return adhesion.impact(self, m_star=m_star, speed=speed)

    lost_work = adhesion.lost_work
    yield_speed = adhesion.yield_speed
    sticking_speed = adhesion.sticking_speed
    observation_time = adhesion.observation_time

    def has_yielded(self, impact: Impact) -> bool:
        return bool(impact.radius_max.max() > max(float(self.touch_radius), float(self.yield_radius)))

    def first_yield_speed(self, Y: Numbers, *, m_star: Numbers) -> None:
        return None

    def caveats(self, *, m_star: Numbers, speed: Array) -> list[str]:
        tabor = adhesion.warning(self)
        return [tabor] if tabor else []
