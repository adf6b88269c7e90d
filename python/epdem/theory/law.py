# SPDX-License-Identifier: GPL-2.0-or-later
"""The protocol of a law in the theory: what all else asks of a law, whichever it is."""

from abc import ABC, abstractmethod
from typing import Any

from .numerics import Array
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
