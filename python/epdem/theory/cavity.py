# SPDX-License-Identifier: GPL-2.0-or-later
"""The three-phase law: first yield (8.78), expanding cavity (8.81), fully plastic (8.80, 8.85).

This project's own composition of the chapter's ingredients; nothing in it is fitted.
"""

from typing import ClassVar

import numpy as np

from .backbones import LAWS, Backbone
from .checks import number


class Cavity(Backbone):
    """s = alpha/alpha_Y; 1 < s < s_P: a = a_Y s^((1+beta)/2), p_m = Y [2 c_Y/3 + (1+beta)/3 ln s], tau = ln s/ln s_P.

    Y [Pa] > 0; c_Y = 1.60 (first yield) and c_P = 2.8 (fully plastic) by default. ValueError where the law would create
    energy at yield: 2 (1+beta)(1 + 1/(2 c_Y)) - (1+beta)/2 - 0.125/ln s_P must not exceed 2.5.
    """

    name = "cavity"
    keywords: ClassVar = {"yield_stress": "Y", "first_yield_ratio": "c_Y", "plastic_ratio": "c_P"}

    def __init__(self, *, E_star, R_star, Y, c_Y=1.60, c_P=2.8):
        super().__init__(E_star, R_star)
        self.Y, self.c_Y, self.c_P = number("Y", Y), number("c_Y", c_Y), number("c_P", c_P)
        self.a_Y = np.pi * self.R_star * self.c_Y * self.Y / (2 * self.E_star)
        self.yield_overlap = self.a_Y**2 / self.R_star
        self.ln_s_P = 3 * (self.c_P - 2 * self.c_Y / 3) - np.log(2)
        self.beta = np.log(2) / self.ln_s_P
        excess = 2 * (1 + self.beta) * (1 + 1 / (2 * self.c_Y)) - (1 + self.beta) / 2 - 0.125 / self.ln_s_P
        if np.any(self.c_P <= self.c_Y):
            raise ValueError("plastic_ratio (c_P) must exceed first_yield_ratio (c_Y)")
        if np.any(excess > 2.5) or np.any(self.ln_s_P <= 0):
            raise ValueError(f"energy would be created at yield: the law's condition is {np.max(excess):.3g}, over "
                             "2.5; raise first_yield_ratio (c_Y) or plastic_ratio (c_P)")  # fmt: skip
        self.plastic_overlap = self.yield_overlap * np.exp(self.ln_s_P)

    def marks(self):
        return [self.yield_overlap, self.plastic_overlap]

    def _ln_s(self, alpha):
        """ln(alpha/alpha_Y), held between 0 and ln s_P; near 1 without cancellation."""
        x = np.maximum(alpha - self.yield_overlap, 0.0) / self.yield_overlap
        return np.minimum(np.log1p(x), self.ln_s_P)

    def flatness(self, alpha):
        return self._ln_s(alpha) / self.ln_s_P

    def radius(self, alpha):
        middle = self.a_Y * np.exp((1 + self.beta) / 2 * self._ln_s(alpha))
        ends = np.where(alpha < self.plastic_overlap, 1.0, np.sqrt(2.0)) * np.sqrt(self.R_star * alpha)
        return np.where((alpha > self.yield_overlap) & (alpha < self.plastic_overlap), middle, ends)

    def force(self, alpha):
        p_m = self.Y * (2 / 3 * self.c_Y + (1 + self.beta) / 3 * self._ln_s(alpha))
        elastic = self._hertz_force(np.minimum(alpha, self.yield_overlap))
        return np.where(alpha <= self.yield_overlap, elastic, np.pi * self.radius(alpha) ** 2 * p_m)

    def _middle_work(self, ln_s):
        """Work of phase 2 [J] from yield to ln s, and its derivative by ln s."""
        A, B, n = 2 / 3 * self.c_Y, (1 + self.beta) / 3, 2 + self.beta
        grow = np.expm1(n * ln_s)
        first = grow / n
        second = ((grow + 1) * ln_s - first) / n
        scale = np.pi * self.a_Y**2 * self.yield_overlap * self.Y
        return scale * (A * first + B * second), scale * (grow + 1) * (A + B * ln_s)

    def work(self, alpha):
        elastic = self._hertz_work(np.minimum(alpha, self.yield_overlap))
        P = self.plastic_overlap
        x = np.maximum(alpha - P, 0.0)
        return (
            elastic
            + self._middle_work(self._ln_s(alpha))[0]
            + np.pi * self.R_star * self.c_P * self.Y * x * (2 * P + x)
        )

    def overlap_of_work(self, W):
        W = np.asarray(W, float)
        W_Y = self._hertz_work(self.yield_overlap)
        W_P = W_Y + self._middle_work(self.ln_s_P)[0]
        elastic = (15 / 8 * W / (self.E_star * np.sqrt(self.R_star))) ** 0.4
        more = np.maximum(W - W_P, 0.0)
        slope, P = np.pi * self.R_star * self.c_P * self.Y, self.plastic_overlap
        plastic = P + more / slope / (P + np.sqrt(P * P + more / slope))
        # Newton in ln s from above: the work is convex in ln s, so every step lands above the root
        want = np.clip(W - W_Y, 0.0, W_P - W_Y)
        ln_s = np.broadcast_to(self.ln_s_P, want.shape).copy()
        for _ in range(60):
            value, slope_of = self._middle_work(ln_s)
            change = np.minimum((value - want) / slope_of, ln_s)
            ln_s = ln_s - change
            if np.all(np.abs(change) <= 4e-16 * np.maximum(ln_s, 1e-3)):
                break
        middle = self.yield_overlap * np.exp(ln_s)
        return np.where(W <= W_Y, elastic, np.where(W >= W_P, plastic, middle))


LAWS["cavity"] = Cavity
