# SPDX-License-Identifier: GPL-2.0-or-later
"""Base of the laws without adhesion."""

from abc import ABC, abstractmethod
from typing import Any

import numpy as np

from . import restitution as undamped
from . import viscous, yielding
from .curve import Curve
from .numerics import Array, Real
from .restitution import Impact

Numbers = Any  # a float or an array of floats; they broadcast


class Law(ABC):
    """A law for one R* [m] or many, shape (n,); overlaps alpha [m], masses [kg], speeds [m/s] broadcast with it."""

    @abstractmethod
    def impact(self, *, m_star: Numbers, speed: Numbers, restitution: float | None = None) -> Impact:
        """Impacts at `speed` > 0 with effective mass m_star > 0.

        restitution: of impacts that do not yield, by a dashpot; None: no dashpot. Raises ValueError if the theory has
        no dashpot beside this law.
        """

    @abstractmethod
    def radius(self, alpha: Numbers) -> Numbers:
        """Contact radius a [m] on the way to the largest overlap alpha."""

    @abstractmethod
    def radius_of_work(self, W: Numbers) -> Numbers:
        """Contact radius a [m] at which a growing contact has taken the work W [J]."""

    @abstractmethod
    def lost_work(self, alpha_max: Numbers) -> Numbers:
        """Work [J] that a contact takes up to the overlap alpha_max and does not give back until it ends."""

    @abstractmethod
    def has_yielded(self, impact: Impact) -> bool:
        """Whether one of the impacts leaves the elastic start."""

    @abstractmethod
    def yield_speed(self, *, m_star: Numbers) -> Numbers:
        """Speed [m/s] at which a contact leaves the elastic start; inf: never."""

    @abstractmethod
    def first_yield_speed(self, Y: Numbers, *, m_star: Numbers) -> Numbers | None:
        """Speed [m/s] from which a body of yield stress Y [Pa] yields beneath its surface; None: without theory."""

    @abstractmethod
    def sticking_speed(self, *, m_star: Numbers) -> Numbers:
        """Speed [m/s] up to which bodies stick; 0 without adhesion."""

    def observation_time(self, *, m_star: Numbers, speed: Numbers) -> float:
        """Time [s] for which impacts at `speed` [m/s] that stick are observed; NaN without adhesion."""
        return float("nan")

    def caveats(self, *, m_star: Numbers, speed: Array) -> list[str]:
        """Sentences on impacts at `speed`, shape (n,), that are beyond what the law is for."""
        return []


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
