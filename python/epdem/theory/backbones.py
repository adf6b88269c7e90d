# SPDX-License-Identifier: GPL-2.0-or-later
"""Loading backbones of the laws and the unloading that they share (eqs. 8.81, 8.82, 8.85)."""

import numpy as np


class Backbone:
    """A law for one pair: F(alpha), a(alpha), tau(alpha), W(alpha), and the elastic branch below alpha_max.

    All methods take overlaps [m] >= 0 of any shape that broadcasts with the law's parameters.
    """

    name: str
    keywords: dict[str, str] = {}
    default_ratio = 1.0
    E_star: float
    R_star: float
    yield_overlap: float

    def hertz_force(self, alpha):
        return 4 / 3 * self.E_star * np.sqrt(self.R_star) * alpha**1.5

    def hertz_work(self, alpha):
        return 8 / 15 * self.E_star * np.sqrt(self.R_star) * alpha**2.5

    def flatness(self, alpha):
        return np.zeros_like(alpha, dtype=float)

    def marks(self):
        return [self.yield_overlap]

    def recovered_overlap(self, alpha_max):
        tau = self.flatness(alpha_max)
        F, a = self.force(alpha_max), self.radius(alpha_max)
        return (0.75 * (1 - tau) + 2 / np.pi * tau) * F / (self.E_star * a)

    def recovered_work(self, alpha_max):
        tau = self.flatness(alpha_max)
        kappa = 0.3 * (1 - tau) ** 2 + 0.5625 * tau * (1 - tau) + 8 / (3 * np.pi**2) * tau**2
        return kappa * self.force(alpha_max) ** 2 / (self.radius(alpha_max) * self.E_star)

    def residual_overlap(self, alpha_max):
        return np.where(alpha_max <= self.yield_overlap, 0.0, alpha_max - self.recovered_overlap(alpha_max))

    def unloading(self, alpha, alpha_max):
        F, a, tau = self.force(alpha_max), self.radius(alpha_max), self.flatness(alpha_max)
        w = (alpha_max - alpha) * self.E_star * a / F
        A, B = 0.75 * (1 - tau), 2 / np.pi * tau
        S = B + np.sqrt(B * B + 4 * A * w)
        y = np.clip(np.divide(2 * w, S, out=np.zeros(np.broadcast(w, S).shape), where=S > 0), 0, 1)
        share = (1 - tau) * (1 - y * y) ** 1.5 + B * (np.arccos(y) - y * np.sqrt(1 - y * y))
        return F * share, a * np.sqrt(1 - y * y)

    def unloading_force(self, alpha, alpha_max):
        return self.unloading(alpha, alpha_max)[0]

    def unloading_radius(self, alpha, alpha_max):
        return self.unloading(alpha, alpha_max)[1]

    def overlap_of_work(self, W):
        low = np.zeros_like(W) + 1e-300
        high = np.full_like(W, 1e3)
        for _ in range(2000):
            mid = np.sqrt(low * high)
            big = self.work(mid) > W
            new_low, new_high = np.where(big, low, mid), np.where(big, mid, high)
            if np.all((new_low == low) & (new_high == high)):
                break
            low, high = new_low, new_high
        return mid


class Hertz(Backbone):
    name = "hertz"

    def __init__(self, *, E_star, R_star):
        self.E_star, self.R_star, self.yield_overlap = E_star, R_star, np.inf

    def force(self, alpha):
        return self.hertz_force(alpha)

    def radius(self, alpha):
        return np.sqrt(self.R_star * alpha)

    def work(self, alpha):
        return self.hertz_work(alpha)


class Thornton(Backbone):
    name = "thornton"
    keywords = {"yield_pressure": "p_y"}
    default_ratio = 2.8

    def __init__(self, *, E_star, R_star, p_y):
        self.E_star, self.R_star, self.p_y = E_star, R_star, p_y
        self.yield_overlap = R_star * (np.pi * p_y / (2 * E_star)) ** 2

    def force(self, alpha):
        y = self.yield_overlap
        line = self.hertz_force(y) + np.pi * self.p_y * self.R_star * (alpha - y)
        return np.where(alpha <= y, self.hertz_force(np.minimum(alpha, y)), line)

    def radius(self, alpha):
        return np.sqrt(self.R_star * alpha)

    def work(self, alpha):
        y = self.yield_overlap
        x = np.maximum(alpha - y, 0)
        return self.hertz_work(np.minimum(alpha, y)) + self.hertz_force(y) * x + np.pi * self.p_y * self.R_star * x * x / 2


class Johnson(Backbone):
    name = "johnson"
    keywords = {"yield_pressure": "p_m"}
    default_ratio = 3.0

    def __init__(self, *, E_star, R_star, p_m):
        self.E_star, self.R_star, self.p_m = E_star, R_star, p_m
        self.yield_overlap = R_star * (3 * np.pi * p_m / (2 * E_star)) ** 2

    def force(self, alpha):
        return np.where(alpha <= self.yield_overlap, self.hertz_force(alpha), 2 * np.pi * self.R_star * self.p_m * alpha)

    def radius(self, alpha):
        return np.where(alpha <= self.yield_overlap, 1, np.sqrt(2)) * np.sqrt(self.R_star * alpha)

    def work(self, alpha):
        y = self.yield_overlap
        return self.hertz_work(np.minimum(alpha, y)) + np.pi * self.R_star * self.p_m * np.maximum(alpha**2 - y**2, 0)


class Cavity(Backbone):
    name = "cavity"
    keywords = {"yield_stress": "Y", "first_yield_ratio": "c_Y", "plastic_ratio": "c_P"}

    def __init__(self, *, E_star, R_star, Y, c_Y=1.60, c_P=2.8):
        self.E_star, self.R_star, self.Y, self.c_Y, self.c_P = E_star, R_star, Y, c_Y, c_P
        self.a_Y = np.pi * R_star * c_Y * Y / (2 * E_star)
        self.yield_overlap = self.a_Y**2 / R_star
        self.ln_s_P = 3 * (c_P - 2 * c_Y / 3) - np.log(2)
        self.beta = np.log(2) / self.ln_s_P
        self.plastic_overlap = self.yield_overlap * np.exp(self.ln_s_P)

    def marks(self):
        return [self.yield_overlap, self.plastic_overlap]

    def _ln_s(self, alpha):
        return np.clip(np.log(np.maximum(alpha, 1e-300) / self.yield_overlap), 0, self.ln_s_P)

    def flatness(self, alpha):
        return self._ln_s(alpha) / self.ln_s_P

    def radius(self, alpha):
        middle = self.a_Y * np.exp((1 + self.beta) / 2 * self._ln_s(alpha))
        R = self.R_star
        return np.where(alpha <= self.yield_overlap, np.sqrt(R * alpha), np.where(alpha < self.plastic_overlap, middle, np.sqrt(2 * R * alpha)))

    def force(self, alpha):
        p = self.Y * (2 * self.c_Y / 3 + (1 + self.beta) / 3 * self._ln_s(alpha))
        return np.where(alpha <= self.yield_overlap, self.hertz_force(alpha), np.pi * self.radius(alpha) ** 2 * p)

    def work(self, alpha):
        y, P, L, n = self.yield_overlap, self.plastic_overlap, self._ln_s(alpha), 2 + self.beta
        grow = np.expm1(n * L)
        I0 = grow / n
        I1 = ((grow + 1) * L - I0) / n
        A, B = 2 * self.c_Y / 3, (1 + self.beta) / 3
        W = self.hertz_work(np.minimum(alpha, y)) + np.pi * self.a_Y**2 * y * self.Y * (A * I0 + B * I1)
        return W + np.pi * self.R_star * self.c_P * self.Y * np.maximum(alpha**2 - P**2, 0)


LAWS = {"hertz": Hertz, "thornton": Thornton, "johnson": Johnson, "cavity": Cavity}
