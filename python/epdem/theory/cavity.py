# SPDX-License-Identifier: GPL-2.0-or-later
"""The three-phase law: first yield (8.78), expanding cavity (8.81), fully plastic (8.80, 8.85).

This project's own combination of equations 8.78, 8.80, 8.81 and 8.85 (Johnson 1985); it unloads as in
Mesarovic and Johnson 2000. No parameter is fitted.
"""

import numpy as np

from .backbone import Backbone
from .numerics import Array, Real, gauss, number

FINITE_STRAIN = 0.82  # c of f(s) = 1 - exp(-c s^-0.7) (Jackson and Green 2005)
STRAIN_EXPONENT = 0.7
LARGEST_LOG = 300.0  # ln of the fully plastic overlap over that at yield, whose powers are numbers
LEAST_AREA = 1 / 1.65  # of the area of small strain; below it alpha k alpha^-0.35, F at large strain, would fall


class Cavity(Backbone):
    """s = alpha/alpha_Y; 1 < s < s_P: a = a_Y s^((1+beta)/2), p_m = Y [2 c_Y/3 + (1+beta)/3 ln s], tau = ln s/ln s_P.

    Y [Pa] > 0; c_Y = 1.60 (first yield) and c_P = 2.8 (fully plastic) by default. Finite strain with a of small strain:
    p_m times f(l a/R*)/f(l a_Y/R*), f(x) = 1 - exp(-c x^-0.7), and the area that a plane cuts, a^2 times k =
    max(1/1.65, 1 - l^2 (alpha - alpha_Y)/(2 R*)). c_strain = c, by default so large that nothing changes; share = l,
    0 to 1, the weighted curvature of both bodies (`pair.curvature_share`). ValueError where the law would create energy
    at yield: 2 (1+beta)(1 + 1/(2 c_Y)) - (1+beta)/2 - 0.125/ln s_P must not exceed 2.5.
    """

    name = "cavity"
    uses_share = True
    narrowest, latest = 1.3, 1.88  # c_P/c_Y and c_Y beyond which the three phases are no picture of a metal

    def __init__(
        self,
        *,
        E_star: Real,
        R_star: Real,
        Y: Real,
        c_Y: Real | None = None,
        c_P: Real | None = None,
        c_strain: Real | None = None,
        share: Real = 1.0,
    ):
        super().__init__(E_star, R_star)
        (none,) = self.read_parameters(c_strain=None)  # so large a number that nothing changes
        self.Y, self.c_Y, self.c_P, self.c_strain = self.read_parameters(Y=Y, c_Y=c_Y, c_P=c_P, c_strain=c_strain)
        self.share = number("share", share, low=0.0, high=1.0, low_ok=True)
        self.softens = bool(np.any(self.c_strain < none))
        self.cut = np.where(self.c_strain < none, self.share**2 / 2, 0.0)
        self.a_Y = np.pi * self.R_star * self.c_Y * self.Y / (2 * self.E_star)
        self.yield_overlap = self.a_Y**2 / self.R_star
        self.ln_s_P = 3 * (self.c_P - 2 * self.c_Y / 3) - np.log(2)
        self.beta = np.log(2) / self.ln_s_P
        excess = 2 * (1 + self.beta) * (1 + 1 / (2 * self.c_Y)) - (1 + self.beta) / 2 - 0.125 / self.ln_s_P
        if np.any(self.c_P <= self.c_Y):
            raise ValueError("plastic_ratio (c_P) must exceed first_yield_ratio (c_Y)")
        if np.any(excess > 2.5) or np.any(self.ln_s_P <= 0):
            raise ValueError(
                f"energy would be created at yield: the law's condition is {np.max(excess):.3g}, over "
                "2.5; raise first_yield_ratio (c_Y) or plastic_ratio (c_P)"
            )
        if np.any(self.ln_s_P > LARGEST_LOG):
            raise ValueError(
                f"the contact would become fully plastic at exp({np.max(self.ln_s_P):.3g}) of the overlap at yield, at "
                f"most exp({LARGEST_LOG:g}); lower plastic_ratio (c_P)"
            )
        if np.any(self.c_strain < 1e-3):
            raise ValueError(f"finite_strain (c_strain) = {np.min(self.c_strain):g}, must be at least 1e-3")
        self.plastic_overlap = self.yield_overlap * np.exp(self.ln_s_P)
        self.least_overlap = self.yield_overlap + 2 * (1 - LEAST_AREA) * self.R_star / np.maximum(self.share, 1e-6) ** 2
        self._kept_at_yield = self._kept_pressure(self.yield_overlap)

    def kinks(self) -> list[Real]:
        if not self.softens:
            return [self.yield_overlap, self.plastic_overlap]
        ends = self.plastic_overlap, self.least_overlap
        return [self.yield_overlap, np.minimum(*ends), np.maximum(*ends)]

    def _ln_s(self, alpha: Real) -> Real:
        """ln(alpha/alpha_Y), held between 0 and ln s_P; near 1 without cancellation."""
        x = np.maximum(alpha - self.yield_overlap, 0.0) / self.yield_overlap
        return np.asarray(np.minimum(np.log1p(x), self.ln_s_P))

    def flatness(self, alpha: Real) -> Real:
        return np.asarray(self._ln_s(alpha) / self.ln_s_P)

    def radius(self, alpha: Real) -> Real:
        a = self._small_strain_radius(alpha)
        return a * np.sqrt(self._kept_area(alpha)) if self.softens else a

    def _small_strain_radius(self, alpha: Real) -> Real:
        middle = self.a_Y * np.exp((1 + self.beta) / 2 * self._ln_s(alpha))
        ends = np.where(alpha < self.plastic_overlap, 1.0, np.sqrt(2.0)) * np.sqrt(self.R_star * alpha)
        return np.where((alpha > self.yield_overlap) & (alpha < self.plastic_overlap), middle, ends)

    def force(self, alpha: Real) -> Real:
        F = self._small_strain_force(alpha)
        if not self.softens:
            return F
        kept = self._kept_area(alpha) * self._kept_pressure(alpha) / self._kept_at_yield
        return np.where(alpha <= self.yield_overlap, F, kept * F)

    def _kept_pressure(self, alpha: Real) -> Array:
        """f of finite strain."""
        strain = np.maximum(self.share * self._small_strain_radius(alpha) / self.R_star, 1e-9)
        return np.asarray(-np.expm1(-self.c_strain * strain**-STRAIN_EXPONENT))

    def _kept_area(self, alpha: Real) -> Array:
        """k of finite strain."""
        beyond = np.maximum(alpha - self.yield_overlap, 0.0)
        return np.maximum(1 - self.cut * beyond / self.R_star, LEAST_AREA)

    def _small_strain_force(self, alpha: Real) -> Real:
        p_m = self.Y * (2 / 3 * self.c_Y + (1 + self.beta) / 3 * self._ln_s(alpha))
        elastic = self._hertz_force(np.minimum(alpha, self.yield_overlap))
        return np.where(alpha <= self.yield_overlap, elastic, np.pi * self._small_strain_radius(alpha) ** 2 * p_m)

    def _middle_work(self, ln_s: Real) -> Real:
        """Work of phase 2 [J] from yield to ln s."""
        A, B, n = 2 / 3 * self.c_Y, (1 + self.beta) / 3, 2 + self.beta
        grow = np.expm1(n * ln_s)
        first = grow / n
        second = ((grow + 1) * ln_s - first) / n
        work: Real = np.pi * self.a_Y**2 * self.yield_overlap * self.Y * (A * first + B * second)
        return work

    def work(self, alpha: Real) -> Real:
        elastic = self._hertz_work(np.minimum(alpha, self.yield_overlap))
        if self.softens:
            return elastic + self._plastic_work_by_quadrature(alpha)
        P = self.plastic_overlap
        x = np.maximum(alpha - P, 0.0)
        plastic: Real = np.pi * self.R_star * self.c_P * self.Y * x * (2 * P + x)
        return elastic + self._middle_work(self._ln_s(alpha)) + plastic

    def _plastic_work_by_quadrature(self, alpha: Real) -> Array:
        """Work [J] beyond yield, by quadrature in ln alpha between the kinks."""
        x, w = gauss(40)
        total = np.zeros(np.shape(alpha))
        for low, high in zip(self.kinks(), [*self.kinks()[1:], np.inf], strict=True):
            log = np.log1p((np.clip(alpha, low, high) - low) / low)
            at = low * np.exp(np.multiply.outer(x, log))
            total = total + log * np.tensordot(w, self.force(at) * at, 1)
        return total

    def caveats(self, *, m_star: Real, speed: Array) -> list[str]:
        """Parameters that pass the condition on energy and still describe no body."""
        sentences, ratio = [], np.min(np.divide(self.c_P, self.c_Y))
        if ratio < self.narrowest:
            sentences.append(
                f"plastic_ratio/first_yield_ratio (c_P/c_Y) = {ratio:.3g}, below {self.narrowest}: just above yield "
                "the force of cavity passes Hertz's, by 4 to 15 %"
            )
        if np.max(self.c_Y) > self.latest:
            sentences.append(
                f"first_yield_ratio (c_Y) = {np.max(self.c_Y):.3g}, above {self.latest}: a sphere yields at 1.877 Y at "
                "the latest (nu = 0.5, eq. 8.78)"
            )
        return sentences
