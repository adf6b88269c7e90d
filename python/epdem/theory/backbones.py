# SPDX-License-Identifier: GPL-2.0-or-later
"""The laws: loading backbones F(alpha), a(alpha), W(alpha) and the unloading that they share.

Overlaps [m] and parameters broadcast. A law is one class; `keywords` maps the names of its parameters in case files and
in C++ to those of the constructor, `default_ratio` is its strength in units of the softer body's yield stress.
"""

from typing import ClassVar

import numpy as np

from .checks import number


class Backbone:
    """What all laws share: the elastic start and, below alpha_max, superposed rigid punches (Mesarovic and Johnson)."""

    name: str
    keywords: ClassVar[dict[str, str]] = {}
    default_ratio = 1.0
    yield_overlap: np.ndarray | float  # end of the elastic branch [m]

    def __init__(self, E_star, R_star):
        self.E_star, self.R_star = number("E_star", E_star), number("R_star", R_star)

    def _hertz_force(self, alpha):
        return 4 / 3 * self.E_star * np.sqrt(self.R_star * alpha) * alpha

    def _hertz_work(self, alpha):
        return 8 / 15 * self.E_star * np.sqrt(self.R_star * alpha) * alpha**2

    def force(self, alpha):
        """Backbone force F [N] at overlaps alpha [m] >= 0."""
        raise TypeError(f"{type(self).__name__} does not define it")

    def radius(self, alpha):
        """Contact radius a [m] on the backbone."""
        raise TypeError(f"{type(self).__name__} does not define it")

    def work(self, alpha):
        """Work W [J] along the backbone from 0 to alpha [m]."""
        raise TypeError(f"{type(self).__name__} does not define it")

    def overlap_of_work(self, W):
        """Overlap alpha [m] at which the backbone has taken W [J]: the inverse of `work`."""
        raise TypeError(f"{type(self).__name__} does not define it")

    def flatness(self, alpha):
        """tau of the contact pressure on the backbone: 0 Hertz's half-ellipse, 1 uniform."""
        return np.zeros(np.shape(alpha))

    def marks(self):
        """Overlaps [m] at which the backbone changes its formula."""
        return [self.yield_overlap]

    def recovered_overlap(self, alpha_max):
        """Overlap given back on full unloading [m]: delta_e = (A + B) F/(E* a), A = 3/4 (1-tau), B = (2/pi) tau."""
        tau = self.flatness(alpha_max)
        return (0.75 * (1 - tau) + 2 / np.pi * tau) * self.force(alpha_max) / (self.E_star * self.radius(alpha_max))

    def residual_overlap(self, alpha_max):
        """The dent [m]: alpha_max - delta_e, exactly 0 up to yield."""
        alpha_max = np.asarray(alpha_max, float)
        dent = np.maximum(alpha_max - self.recovered_overlap(alpha_max), 0.0)
        return np.where(alpha_max <= self.yield_overlap, 0.0, dent)

    def recovered_work(self, alpha_max):
        """Energy given back on full unloading [J]: kappa F^2/(a E*)."""
        tau = self.flatness(alpha_max)
        kappa = 0.3 * (1 - tau) ** 2 + 0.5625 * tau * (1 - tau) + 8 / (3 * np.pi**2) * tau**2
        return kappa * self.force(alpha_max) ** 2 / (self.radius(alpha_max) * self.E_star)

    def plastic_work(self, alpha_max):
        """Work that stays in the dent [J]: W - kappa F^2/(a E*), exactly 0 up to yield."""
        lost = np.maximum(self.work(alpha_max) - self.recovered_work(alpha_max), 0.0)
        return np.where(alpha_max <= self.yield_overlap, 0.0, lost)

    def unloading(self, alpha, alpha_max):
        """Force [N] and contact radius [m] at alpha <= alpha_max on the elastic branch from alpha_max.

        Eq. 8.82 [Mesarovic and Johnson 2000]: F/F_max = (1-tau)(1-y^2)^1.5 + (2/pi) tau (acos y - y sqrt(1-y^2)),
        a = a_max sqrt(1-y^2), A y^2 + B y = (alpha_max-alpha) E* a_max/F_max, A = 3/4 (1-tau), B = (2/pi) tau
        """
        alpha, alpha_max = np.asarray(alpha, float), np.asarray(alpha_max, float)
        F, a, tau = self.force(alpha_max), self.radius(alpha_max), self.flatness(alpha_max)
        w = (alpha_max - alpha) * self.E_star * a / F
        y = np.clip(_depth(w, tau), 0.0, 1.0)
        rest = 1 - y * y
        share = (1 - tau) * rest**1.5 + 2 / np.pi * tau * (np.arccos(y) - y * np.sqrt(rest))
        return F * share, a * np.sqrt(rest)

    def unloading_force(self, alpha, alpha_max):
        """Force [N] on the elastic branch below alpha_max [m]."""
        return self.unloading(alpha, alpha_max)[0]

    def unloading_radius(self, alpha, alpha_max):
        """Contact radius [m] on the elastic branch below alpha_max [m]."""
        return self.unloading(alpha, alpha_max)[1]


def _depth(w, tau):
    """y of A y^2 + B y = w: how much of the contact circle has opened."""
    A, B = 0.75 * (1 - tau), 2 / np.pi * tau
    S = B + np.sqrt(B * B + 4 * A * w)
    return np.divide(2 * w, S, out=np.zeros(np.broadcast(w, S).shape), where=S > 0)


class Hertz(Backbone):
    """Elastic contact (Hertz 1882): F = 4/3 E* sqrt(R*) alpha^1.5, a^2 = R* alpha, W = 8/15 E* sqrt(R*) alpha^2.5."""

    name = "hertz"

    def __init__(self, *, E_star, R_star):
        super().__init__(E_star, R_star)
        self.yield_overlap = np.inf

    def force(self, alpha):
        return self._hertz_force(alpha)

    def radius(self, alpha):
        return np.sqrt(self.R_star * alpha)

    def work(self, alpha):
        return self._hertz_work(alpha)

    def overlap_of_work(self, W):
        return (15 / 8 * W / (self.E_star * np.sqrt(self.R_star))) ** 0.4


class Thornton(Backbone):
    """Truncated Hertz pressure (Thornton 1997): F = F_y + pi p_y R* (alpha - alpha_y) past a_y = pi R* p_y/(2E*).

    a^2 = R* alpha throughout; p_y [Pa] > 0, 2.8 Y by default.
    """

    name = "thornton"
    keywords: ClassVar = {"yield_pressure": "p_y"}
    default_ratio = 2.8

    def __init__(self, *, E_star, R_star, p_y):
        super().__init__(E_star, R_star)
        self.p_y = number("p_y", p_y)
        self.yield_overlap = self.R_star * (np.pi * self.p_y / (2 * self.E_star)) ** 2

    def force(self, alpha):
        y, slope = self.yield_overlap, np.pi * self.p_y * self.R_star
        # F_y = 2/3 slope alpha_y
        return np.where(alpha <= y, self._hertz_force(np.minimum(alpha, y)), slope * (alpha - y / 3))

    def radius(self, alpha):
        return np.sqrt(self.R_star * alpha)

    def work(self, alpha):
        y, slope = self.yield_overlap, np.pi * self.p_y * self.R_star
        x = np.maximum(alpha - y, 0.0)
        return self._hertz_work(np.minimum(alpha, y)) + slope * x * (2 / 3 * y + x / 2)

    def overlap_of_work(self, W):
        y, slope = self.yield_overlap, np.pi * self.p_y * self.R_star
        more = np.maximum(W - self._hertz_work(y), 0.0)
        h = 2 / 3 * y
        x = 2 * more / slope / (h + np.sqrt(h * h + 2 * more / slope))  # the root without cancellation
        elastic = (15 / 8 * np.asarray(W) / (self.E_star * np.sqrt(self.R_star))) ** 0.4
        return np.where(more > 0, y + x, elastic)

    def _beyond_yield(self, alpha_max):
        """t = sqrt(alpha_max/alpha_y), at least 1, and t - 1 without cancellation."""
        x = np.maximum(alpha_max - self.yield_overlap, 0.0) / self.yield_overlap
        t = np.sqrt(1 + x)
        return t, x / (1 + t)

    def residual_overlap(self, alpha_max):
        """The dent [m]: alpha_y (t-1)^2 (t + 1/2)/t with t^2 = alpha_max/alpha_y; its difference would cancel."""
        t, more = self._beyond_yield(alpha_max)
        return self.yield_overlap * more**2 * (t + 0.5) / t

    def plastic_work(self, alpha_max):
        """Work that stays in the dent [J]: pi p_y R* alpha_y^2 (t-1)^2 (15 t^3 + 12 t^2 - t - 2)/(30 t), t as above."""
        t, more = self._beyond_yield(alpha_max)
        unit = np.pi * self.p_y * self.R_star * self.yield_overlap**2
        return unit * more**2 * (((15 * t + 12) * t - 1) * t - 2) / (30 * t)


class Johnson(Backbone):
    """Fully plastic contact; Hertz while that is the smaller force (section 11.5).

    Eq. 8.85 [Johnson 1985]: F = 2 pi R* p_m alpha, a^2 = 2 R* alpha

    The radius jumps by sqrt 2 at alpha_c = R* (3 pi p_m/(2E*))^2. p_m [Pa] > 0, 3.0 Y by default.
    """

    name = "johnson"
    keywords: ClassVar = {"yield_pressure": "p_m"}
    default_ratio = 3.0

    def __init__(self, *, E_star, R_star, p_m):
        super().__init__(E_star, R_star)
        self.p_m = number("p_m", p_m)
        self.yield_overlap = self.R_star * (3 * np.pi * self.p_m / (2 * self.E_star)) ** 2

    def force(self, alpha):
        elastic = self._hertz_force(np.minimum(alpha, self.yield_overlap))
        return np.where(alpha <= self.yield_overlap, elastic, 2 * np.pi * self.R_star * self.p_m * alpha)

    def radius(self, alpha):
        return np.where(alpha <= self.yield_overlap, 1.0, np.sqrt(2.0)) * np.sqrt(self.R_star * alpha)

    def work(self, alpha):
        y = self.yield_overlap
        x = np.maximum(alpha - y, 0.0)
        return self._hertz_work(np.minimum(alpha, y)) + np.pi * self.R_star * self.p_m * x * (2 * y + x)

    def overlap_of_work(self, W):
        y, slope = self.yield_overlap, np.pi * self.R_star * self.p_m
        more = np.maximum(W - self._hertz_work(y), 0.0)
        x = more / slope / (y + np.sqrt(y * y + more / slope))
        elastic = (15 / 8 * np.asarray(W) / (self.E_star * np.sqrt(self.R_star))) ** 0.4
        return np.where(more > 0, y + x, elastic)


LAWS: dict[str, type[Backbone]] = {"hertz": Hertz, "thornton": Thornton, "johnson": Johnson}

from .cavity import Cavity  # noqa: E402  its module needs the names above; it enters itself into LAWS

__all__ = ["LAWS", "Backbone", "Cavity", "Hertz", "Johnson", "Thornton"]
