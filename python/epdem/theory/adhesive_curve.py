# SPDX-License-Identifier: GPL-2.0-or-later
"""Elastic adhesive contact in closed form [Johnson, Kendall and Roberts 1971].

The contact radius a [m] is the natural variable: force and overlap follow from it. All arguments broadcast. Internally
y = sqrt(a) and c = sqrt(2 pi Gamma/E*), so that the opening of the rim is d(a) = sqrt(2 pi Gamma a/E*) = c y.
"""

from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np

from .curve import Declared
from .numerics import number

Numbers = Any  # a float or an array of floats; they broadcast
Path = tuple[Callable[[Numbers], Numbers], Callable[[Numbers], Numbers]]


class AdhesiveCurve(Declared):
    """Elastic adhesive contact: F = 4 E* a^3/(3 R*) - P_t, alpha = a^2/R* - d (Johnson, Kendall and Roberts 1971).

    P_t(a) = 2 E* a d = sqrt(8 pi E* Gamma a^3), d(a) = sqrt(2 pi Gamma a/E*). A contact forms at alpha = 0 with a_0 and
    ends, under a given overlap, at the fold a_f, where d alpha/da = 0. Gamma = 0 is Hertz's contact.
    E_star [Pa] > 0, R_star [m] > 0, work of adhesion Gamma of the pair [J/m^2] >= 0. ValueError outside.
    """

    name: ClassVar[str] = "jkr"
    path_nodes: ClassVar[int] = 8  # of Gauss's rule for works along a path

    def __init__(self, *, E_star: Numbers, R_star: Numbers, Gamma: Numbers) -> None:
        self.E_star, self.R_star = number("E_star", E_star), number("R_star", R_star)
        (self.Gamma,) = self.read_parameters(Gamma=Gamma)
        self.c = np.sqrt(2 * np.pi * self.Gamma / self.E_star)
        self.yield_radius: Numbers = np.inf  # contact radius at which the contact yields [m]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{k}={v}' for k, v in vars(self).items())})"

    # --- the curve, by contact radius

    def overlap(self, a: Numbers) -> Numbers:
        """Overlap alpha [m] at contact radius a [m] >= 0: a^2/R* - d, negative while the bodies are apart."""
        return a * a / self.R_star - self.c * np.sqrt(a)

    def force(self, a: Numbers) -> Numbers:
        """Force F [N] at contact radius a [m] >= 0 while it grows: 4 E* a^3/(3 R*) - P_t, negative where it pulls."""
        return 4 / 3 * self.E_star / self.R_star * a**3 - self.adhesive_load(a)

    def adhesive_load(self, a: Numbers) -> Numbers:
        """P_t [N]: the load on a flat punch of radius a [m] that opens the rim by d, sqrt(8 pi E* Gamma a^3)."""
        return 2 * self.E_star * self.c * a * np.sqrt(a)

    def slope(self, y: Numbers) -> Numbers:
        """d alpha/dy [sqrt(m)] at y = sqrt(a): 4 y^3/R* - c."""
        return 4 * y**3 / self.R_star - self.c

    def energy(self, a: Numbers) -> Numbers:
        """Elastic and surface energy [J] at contact radius a [m], 0 for bodies apart; F = d(energy)/d(alpha).

        E* [8/15 a^5/R*^2 - 4/3 (a^3/R*) d + a d^2/2]: the last term is +2 pi Gamma a^2 of the flat punch less the
        surface energy pi Gamma a^2.
        """
        d, shape = self.c * np.sqrt(a), a * a / self.R_star
        return self.E_star * a * ((8 / 15 * shape - 4 / 3 * d) * shape + 0.5 * d * d)

    def radius(self, alpha: Numbers) -> Numbers:
        """Contact radius a [m] of a standing contact at overlap alpha [m]; 0 below the fold, where there is none.

        The largest root of y^4/R* - c y = alpha, in closed form: y^2 + Z = sqrt(2 Z) y + sqrt(R* alpha + Z^2) with
        Z^3 + R* alpha Z = (c R*)^2/8 (Ferrari and Cardano, in sums without cancellation).
        """
        X, s = self.R_star * np.asarray(alpha, float), (self.c * self.R_star) ** 2 / 16
        stands = X * np.ones_like(s) >= self.R_star * self.fold_overlap
        root = np.cbrt(s + np.sqrt(np.maximum(s * s + X**3 / 27, 0.0)))
        safe = np.where(root > 0, root, 1.0)
        Z = np.where(root > 0, 2 * s / (safe * safe + X / 3 + (X / (3 * safe)) ** 2), 0.0)
        y = 0.5 * (np.sqrt(2 * Z) + np.sqrt(np.maximum(4 * np.sqrt(np.maximum(X + Z * Z, 0.0)) - 2 * Z, 0.0)))
        return np.where(stands, y * y, 0.0)

    # --- the life of a contact

    @property
    def touch_radius(self) -> Numbers:
        """Contact radius a_0 [m] of a contact that has just formed at alpha = 0: (2 pi Gamma R*^2/E*)^(1/3)."""
        return np.cbrt(self.c * self.R_star) ** 2

    @property
    def pull_off_force(self) -> Numbers:
        """Largest pull [N] that the elastic contact stands: 3/2 pi Gamma R*."""
        return 1.5 * np.pi * self.Gamma * self.R_star

    @property
    def fold_radius(self) -> Numbers:
        """Contact radius a_f [m] at which the contact ends: (pi Gamma R*^2/(8 E*))^(1/3) = a_0/16^(1/3)."""
        return np.cbrt(self.c * self.R_star / 4) ** 2

    @property
    def fold_overlap(self) -> Numbers:
        """Overlap [m] at which the contact ends: -3/4 d(a_f)."""
        return -0.75 * self.c * np.sqrt(self.fold_radius)

    # --- work and its inverse

    def work(self, a: Numbers) -> Numbers:
        """Work [J] put in from touch (a_0) to contact radius a [m] >= a_0 while it grows; F is negative at first."""
        return self.energy(a) - self.energy(self.touch_radius)

    def branch(self, a_max: Numbers) -> tuple["AdhesiveCurve", Numbers]:
        """The elastic contact (JKR) on which one that reached a_max [m] opens again, and the shift alpha_p [m] of its
        overlaps: alpha = alpha_p + branch.overlap(a)."""
        return self, np.zeros(np.shape(a_max))

    def elastic_path(self, low: Numbers, high: Numbers) -> Path:
        """Functions (d alpha/dt [m], F d alpha/dt [J]) of t in [0, 1] on the elastic curve between the contact radii
        low and high [m], sqrt(a) going straight; the second is a polynomial of degree 9."""
        left, width = np.sqrt(low), np.sqrt(high) - np.sqrt(low)

        def slope(t: Numbers) -> Numbers:
            return self.slope(left + width * t) * width

        def power(t: Numbers) -> Numbers:
            cube = (left + width * t) ** 3
            return 2 * self.E_star * cube * (2 / 3 * cube / self.R_star - self.c) * slope(t)

        return slope, power

    def loading_paths(self, top: Numbers) -> list[tuple[Path, Numbers]]:
        """Paths from touch to the contact radius `top` [m] while the contact grows, each with the radius at its end."""
        return [(self.elastic_path(self.touch_radius, top), top)]

    def radius_of_work(self, W: Numbers) -> Numbers:
        """Contact radius [m] at which the growing contact has taken W [J] >= 0: the inverse of `work`.

        Newton's method from above on a function of sqrt(a) that is convex where F > 0: it ends at round-off.
        """
        W = np.asarray(W, float)
        hertz = (15 / 8 * W * self.R_star**2 / self.E_star) ** 0.1
        y = 1.1 * (hertz + 1.5 * np.sqrt(self.touch_radius))
        for _ in range(400):
            short = self.work(y * y) < W
            if not short.any():
                break
            y = np.where(short, 1.25 * y, y)
        for _ in range(200):
            a = y * y
            step = (self.work(a) - W) / (self.force(a) * self.slope(y))
            y = y - step
            if not np.any(np.abs(step) > 1e-9 * y):  # convergence is quadratic
                break
        return y * y
