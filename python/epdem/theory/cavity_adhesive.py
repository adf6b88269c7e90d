# SPDX-License-Identifier: GPL-2.0-or-later
"""The three-phase law with adhesion: a rigid punch in tension is superposed on each of its contacts."""

import numpy as np

from .adhesive_curve import AdhesiveCurve, Numbers, Path
from .cavity import LEAST_AREA, STRAIN_EXPONENT, Cavity
from .jkr import JKR
from .numerics import Array, bisect, gauss, segment

_X, _W = gauss(24)


class Flattened(AdhesiveCurve):
    """F = F_u(a) - P_t(a), alpha = alpha_u(a) - d(a) below a peak of force F0 [N], radius a0 [m] and flatness tau.

    With s = a/a0 (eq. 8.82): F_u = F0 [(1-tau) s^3 + (2 tau/pi)(asin s - s sqrt(1-s^2))], alpha_u = F0/(E* a0)
    [A s^2 + B (1 - sqrt(1-s^2))], A = 3/4 (1-tau), B = 2 tau/pi. Overlaps count from the dent. Of a small s this is a
    JKR contact of R' = 4 E* a0^3/(3 b F0), b = 1 - tau + 4 tau/(3 pi); of tau = 0 it is one at any s. No a exceeds a0.
    """

    path_nodes = 32

    def __init__(self, *, E_star: Numbers, Gamma: Numbers, force: Numbers, radius: Numbers, flatness: Numbers) -> None:
        self.tau, self.F0, self.a0 = (np.asarray(x, float) for x in (flatness, force, radius))
        share = 1 - self.tau + 4 * self.tau / (3 * np.pi)
        super().__init__(E_star=E_star, R_star=4 * E_star * self.a0**3 / (3 * share * self.F0), Gamma=Gamma)
        self.A, self.B = 0.75 * (1 - self.tau), 2 / np.pi * self.tau
        self.way = self.F0 / (self.E_star * self.a0)  # unit of overlaps [m]
        self.k = self.c * np.sqrt(self.a0) / self.way  # d(a0) in it

    def _share(self, a: Numbers) -> Numbers:
        return np.minimum(np.asarray(a, float) / self.a0, 1.0)

    def overlap(self, a: Numbers) -> Numbers:
        square = self._share(a) ** 2
        return self.way * (self.A + self.B / (1 + np.sqrt(1 - square))) * square - self.c * np.sqrt(a)

    def _opened(self, angle: Numbers) -> Numbers:
        """F_u/F0 at s = sin(angle)."""
        return (1 - self.tau) * np.sin(angle) ** 3 + self.B * segment(angle)

    def force(self, a: Numbers) -> Numbers:
        return self.F0 * self._opened(np.arcsin(self._share(a))) - self.adhesive_load(a)

    def energy(self, a: Numbers) -> Numbers:
        """U_u - F_u d + pi Gamma a^2: F is its slope by alpha, for dF_u = 2 E* a d alpha_u. U_u by Gauss's rule."""
        angle = np.arcsin(self._share(a))
        stored = 0.0
        for x, w in zip(_X, _W, strict=True):
            t = angle * x
            slope = 2 * self.A * np.sin(t) * np.cos(t) + self.B * np.sin(t)
            stored = stored + w * self._opened(t) * slope * angle
        F_u, d = self.F0 * self._opened(angle), self.c * np.sqrt(a)
        return self.F0 * self.way * stored - F_u * d + np.pi * self.Gamma * a * a

    def radius(self, alpha: Numbers) -> Numbers:
        """As of `AdhesiveCurve`, by bisection; a0 beyond the peak."""
        alpha = np.asarray(alpha, float)
        _, a = bisect(lambda a: self.overlap(a) < alpha, self.fold_radius, self.a0, steps=100)
        return np.where(alpha < self.fold_overlap, 0.0, a)

    def _extreme(self, factor: float) -> Numbers:
        """Contact radius [m] where a d alpha_u/da = factor d/2: s^1.5 (2 A + B/sqrt(1-s^2)) = factor k/2."""

        def below(s: Numbers) -> Numbers:
            with np.errstate(divide="ignore", invalid="ignore"):
                rim = np.where(self.B > 0, self.B / np.sqrt(1 - s * s), 0.0)
            return s**1.5 * (2 * self.A + rim) < factor * self.k / 2

        _, s = bisect(below, 0.0 * self.k, 1.0 + 0.0 * self.k, steps=200)
        return np.where(self.k > 0, s * self.a0, 0.0)

    @property
    def fold_radius(self) -> Numbers:
        return self._extreme(1.0)

    @property
    def fold_overlap(self) -> Numbers:
        return self.overlap(self.fold_radius)

    @property
    def touch_radius(self) -> Numbers:
        return self.radius(0.0)

    @property
    def pull_off_force(self) -> Numbers:
        """Largest pull [N]: where dF/da = 0, 2 a d alpha_u/da = 3 d."""
        return -self.force(self._extreme(3.0))

    def elastic_path(self, low: Numbers, high: Numbers) -> Path:
        """As of `AdhesiveCurve`; a = a0 sin x^2, x going straight, so that both functions are analytic."""
        left = np.sqrt(np.arcsin(self._share(low)))
        width = np.sqrt(np.arcsin(self._share(high))) - left

        def slope(t: Numbers) -> Numbers:
            x = left + width * t
            sin, cos = np.sin(x * x), np.cos(x * x)
            punch = 0.5 * self.c * np.sqrt(self.a0) * cos / np.sqrt(sin)
            return 2 * x * width * (self.way * sin * (2 * self.A * cos + self.B) - punch)

        def power(t: Numbers) -> Numbers:
            x = left + width * t
            F = self.F0 * self._opened(x * x) - self.adhesive_load(self.a0 * np.sin(x * x))
            return F * slope(t)

        return slope, power


class CavityAdhesive(JKR):
    """F = F_b - P_t(a), alpha = alpha_b - d(a) of `Cavity`'s force F_b and overlap alpha_b while the contact grows.

    This project's own composition: below first yield it is JKR's contact; it opens as `Flattened` says. Gamma = 0 is
    `cavity`. In a step of loading the dent loses d(W_b - U) - d (2 E* a d alpha_b - dF_b), U the elastic energy of the
    peak: ValueError beyond `largest_adhesion`, where this would create energy. The other parameters as in Cavity.
    """

    name = "cavity_adhesive"
    uses_share = True
    path_nodes = 32

    def __init__(
        self,
        *,
        E_star: Numbers,
        R_star: Numbers,
        Gamma: Numbers,
        Y: Numbers,
        c_Y: Numbers | None = None,
        c_P: Numbers | None = None,
        c_strain: Numbers | None = None,
        share: Numbers = 1.0,
    ) -> None:
        super().__init__(E_star=E_star, R_star=R_star, Gamma=Gamma)
        b = Cavity(E_star=E_star, R_star=R_star, Y=Y, c_Y=c_Y, c_P=c_P, c_strain=c_strain, share=share)
        self.backbone, self.Y, self.c_Y, self.c_P, self.c_strain = b, b.Y, b.c_Y, b.c_P, b.c_strain
        self.yield_radius = b.a_Y
        self.plastic_radius = np.sqrt(2 * self.R_star * b.plastic_overlap)  # without finite strain
        self.kinks = [b.radius(at) for at in b.kinks()] if b.softens else [self.yield_radius, self.plastic_radius]
        self.exponent = (1 + b.beta) / 2  # of a in alpha between yield and full plasticity
        if np.any(self.largest_adhesion < self.Gamma):
            at = np.argmin(np.broadcast_to(self.largest_adhesion / np.maximum(self.Gamma, 1e-300), np.shape(R_star)))
            most, R = np.broadcast_arrays(self.largest_adhesion, self.R_star)
            raise ValueError(
                f"work_of_adhesion (Gamma) = {np.max(self.Gamma):.4g} J/m^2 creates energy while a contact of R* = "
                f"{R.flat[at]:.3g} m yields; law {self.name} holds up to {most.flat[at]:.4g} J/m^2 there, in "
                "proportion to R* and to the cube of the yield stress; lower it, or take law thornton_ning"
            )

    @property
    def largest_adhesion(self) -> Numbers:
        """Work of adhesion [J/m^2] up to which growth creates no energy: E* a_Y^3/(2 pi R*^2) times the least of
        (D/K)^2 a_Y/a, D = d(W_b - U)/d alpha_b in pi a_Y^2 Y, K = 2 E* a - dF_b/d alpha_b in pi R* Y, where K > 0.

        Finite strain is that of share = 1, the largest one, up to its least area."""
        numbers = np.broadcast_arrays(self.c_Y, self.c_P, self.c_strain, self.yield_radius / self.R_star)
        kept = numbers if self.backbone.softens else [*numbers[:3], np.zeros(np.shape(numbers[3]))]
        sets, place = np.unique(np.reshape(kept, (4, -1)), axis=1, return_inverse=True)
        least = np.array([_least_ratio(*one) for one in sets.T])[np.ravel(place)]
        shaped = np.reshape(least, np.shape(numbers[0]))
        return shaped * self.E_star * self.yield_radius**3 / (2 * np.pi * self.R_star**2)

    # --- the growing contact, by contact radius

    def backbone_overlap(self, a: Numbers) -> Numbers:
        """alpha_b [m], the inverse of the radius of `Cavity`."""
        a, R, b = np.asarray(a, float), self.R_star, self.backbone
        middle = b.yield_overlap * np.maximum(a / self.yield_radius, 1.0) ** (1 / self.exponent)
        if b.softens:
            return np.where(a <= self.yield_radius, a * a / R, self._softened_overlap(a, middle))
        return np.where(a <= self.yield_radius, a * a / R, np.where(a < self.plastic_radius, middle, a * a / (2 * R)))

    def _softened_overlap(self, a: Array, middle: Array) -> Array:
        """The same beyond yield, by Newton's method on ln a from the overlap without finite strain, which is below."""
        at = np.maximum(np.minimum(middle, a * a / (2 * self.R_star)), self.backbone.yield_overlap)
        for _ in range(60):
            step = np.log(np.maximum(a, self.yield_radius) / self.backbone.radius(at)) / self._rate(at)
            at = at * np.exp(step)
            if not np.any(np.abs(step) > 1e-15):
                break
        return np.asarray(at)

    def _rate(self, alpha_b: Numbers) -> Numbers:
        """d ln a/d ln alpha_b of `Cavity`."""
        b = self.backbone
        between = (alpha_b > b.yield_overlap) & (alpha_b < b.plastic_overlap)
        rate = np.where(between, self.exponent, 0.5)
        if not b.softens:
            return rate
        falls = (alpha_b > b.yield_overlap) & (alpha_b < b.least_overlap)
        left = 1 - b.cut * np.maximum(np.minimum(alpha_b, b.least_overlap) - b.yield_overlap, 0.0) / self.R_star
        return rate - np.where(falls, b.cut * alpha_b / (2 * self.R_star * left), 0.0)

    def overlap(self, a: Numbers) -> Numbers:
        return self.backbone_overlap(a) - self.c * np.sqrt(a)

    def force(self, a: Numbers) -> Numbers:
        return self.backbone.force(self.backbone_overlap(a)) - self.adhesive_load(a)

    def slope(self, y: Numbers) -> Numbers:
        at = self.backbone_overlap(y * y)
        return 2 / self._rate(at) * at / y - self.c

    def work(self, a: Numbers) -> Numbers:
        return self._potential(a) - self._potential(self.touch_radius)

    def _potential(self, a: Numbers) -> Numbers:
        """W_b - F_b d + pi Gamma a^2 - integral of d (2 E* a d alpha_b - dF_b): F is its slope by alpha."""
        b = self.backbone
        at, d = self.backbone_overlap(a), self.c * np.sqrt(a)
        return b.work(at) - b.force(at) * d + np.pi * self.Gamma * a * a - self._mismatch(a)

    def _mismatch(self, a: Numbers) -> Numbers:
        """The integral of d (2 E* a d alpha_b - dF_b) from yield to `a` [J], in closed form without finite strain."""
        if self.backbone.softens:
            return self._mismatch_by_quadrature(self.backbone_overlap(a))
        b, E, R, q = self.backbone, self.E_star, self.R_star, self.exponent
        a_Y, a_P = self.yield_radius, self.plastic_radius
        log = np.log(np.clip(a, a_Y, a_P) / a_Y) / q  # ln s
        n, m = 2.5 * q, 1.5 * q + 1
        grow = np.expm1(n * log)
        A, B = 2 / 3 * b.c_Y, 2 / 3 * q  # p_m = Y (A + B ln s)
        pressure = (2 * q * A + B) * grow / n + 2 * q * B * (log * (grow + 1) / n - grow / n**2)
        middle = 2 * E * a_Y**1.5 * b.yield_overlap * np.expm1(m * log) / m - np.pi * a_Y**2.5 * b.Y * pressure
        x = np.maximum(a, a_P)
        above = 4 * E / (7 * R) * (x**3.5 - a_P**3.5) - 0.8 * np.pi * b.c_P * b.Y * (x**2.5 - a_P**2.5)
        return self.c * (middle + above)

    def _mismatch_by_quadrature(self, top: Array) -> Array:
        """The same, -d F_b and the integral of 2 E* a d + F_b dd/d alpha_b, in ln alpha_b between the kinks."""
        b, first = self.backbone, self.backbone.yield_overlap
        top, (x, w) = np.maximum(top, first), gauss(40)

        def opening(at: Numbers) -> Array:
            return np.asarray(self.c * np.sqrt(b.radius(at)))

        total = opening(first) * b.force(first) - opening(top) * b.force(top)
        for low, high in zip(b.kinks(), [*b.kinks()[1:], np.inf], strict=True):
            log = np.log(np.clip(top, low, high) / low)
            at = low * np.exp(np.multiply.outer(x, log))
            power = opening(at) * (2 * self.E_star * b.radius(at) * at + 0.5 * b.force(at) * self._rate(at))
            total = total + log * np.tensordot(w, power, 1)
        return np.asarray(total)

    def radius(self, alpha: Numbers) -> Numbers:
        """Contact radius a [m] of a contact that has grown up to the overlap alpha [m]; 0 below the fold of JKR."""
        alpha = np.asarray(alpha, float)
        elastic = super().radius(alpha)
        # alpha_b >= a^2/(2 R*), so that no contact is wider than JKR's of the radius 2 R*
        most = AdhesiveCurve(E_star=self.E_star, R_star=2 * self.R_star, Gamma=self.Gamma).radius(
            np.maximum(alpha, 0.0)
        )
        low = np.minimum(self.yield_radius, most)
        _, yielded = bisect(lambda a: self.overlap(a) < alpha, low, 1.001 * most + 0 * low, steps=100)
        return np.where(elastic <= self.yield_radius, elastic, yielded)

    @property
    def touch_radius(self) -> Numbers:
        """Contact radius a_0 [m] of a contact that has just formed at alpha = 0."""
        return self.radius(0.0)

    def branch(self, a_max: Numbers, factor: Numbers = 1.0) -> tuple[Flattened, Numbers]:
        """As of `AdhesiveCurve`; factor: force of the backbone at its peak over that of the law, with compaction."""
        top = np.maximum(np.asarray(a_max, float), self.yield_radius)
        yields = top > self.yield_radius
        at = self.backbone_overlap(top)
        F, tau = factor * self.backbone.force(at), self.backbone.flatness(at)
        opened = Flattened(E_star=self.E_star, Gamma=self.Gamma, force=F, radius=top, flatness=tau)
        dent = at - opened.way * (opened.A + opened.B)
        return opened, np.where(yields, np.maximum(dent, 0.0), 0.0)

    def loading_paths(self, top: Numbers) -> list[tuple[Path, Numbers]]:
        first, top = self.touch_radius, np.asarray(top, float)
        ends = [np.clip(x, first, np.maximum(top, first)) for x in self.kinks]
        ends.append(np.maximum(top, ends[-1]))
        elastic = AdhesiveCurve(E_star=self.E_star, R_star=self.R_star, Gamma=self.Gamma)
        grown = [(self._path(low, high), high) for low, high in zip(ends[:-1], ends[1:], strict=True)]
        return [(elastic.elastic_path(first, ends[0]), ends[0]), *grown]

    def _path(self, low: Numbers, high: Numbers) -> Path:
        """As `elastic_path`, on the growing curve within one phase, ln a going straight."""
        log = np.log(high / np.maximum(low, 1e-300))

        def slope(t: Numbers) -> Numbers:
            y = np.sqrt(low * np.exp(log * t))
            return self.slope(y) * 0.5 * y * log

        def power(t: Numbers) -> Numbers:
            return self.force(low * np.exp(log * t)) * slope(t)

        return slope, power

    def caveats(self, *, m_star: Numbers, speed: Array) -> list[str]:
        return [*super().caveats(m_star=m_star, speed=speed), *self.backbone.caveats(m_star=m_star, speed=speed)]


def _ratio(log: Array, c_Y: float, c_P: float, c_strain: float, a_Y: float) -> Array:
    """(D/K)^2 a_Y/a of `largest_adhesion` at ln s > 0; a_Y in R*, 0 without finite strain."""
    ln_s_P = _ln_s_P(c_Y, c_P)
    q = (1 + np.log(2) / ln_s_P) / 2
    full = log >= ln_s_P
    s, tau = np.exp(log), np.minimum(log / ln_s_P, 1.0)
    p = np.where(full, c_P, 2 / 3 * c_Y + 2 / 3 * q * np.minimum(log, ln_s_P))  # p_m/Y
    a = np.where(full, np.sqrt(2 * s), s**q)  # in a_Y
    rate = np.where(full, 0.5, q)  # d ln a/d ln s
    # area and pressure of finite strain and their slopes by ln s
    kept, pressure, fall, weaker = np.ones_like(s), np.ones_like(s), np.zeros_like(s), np.zeros_like(s)
    if a_Y > 0:
        kept = 1 - 0.5 * a_Y**2 * (s - 1)
        fall = -0.5 * a_Y**2 * s / kept
        x, first = c_strain * (a_Y * a) ** -STRAIN_EXPONENT, c_strain * a_Y**-STRAIN_EXPONENT
        pressure = np.expm1(-x) / np.expm1(-first)
        weaker = -STRAIN_EXPONENT * rate * x * np.exp(-x) / -np.expm1(-x)
    F = a * a * p * kept * pressure
    dF = (F * (2 * rate + fall + weaker) + np.where(full, 0.0, a * a * kept * pressure * 2 / 3 * q)) / s
    a, rate = a * np.sqrt(kept), rate + 0.5 * fall
    kappa = 0.3 * (1 - tau) ** 2 + 0.5625 * tau * (1 - tau) + 8 / (3 * np.pi**2) * tau**2
    bend = np.where(full, 0.0, (-0.6 * (1 - tau) + 0.5625 * (1 - 2 * tau) + 16 / (3 * np.pi**2) * tau) / ln_s_P)
    dU = 2 / c_Y * F / a * ((bend * F + 2 * kappa * s * dF - kappa * rate * F) / s)
    K = c_Y * a - dF
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(K > 0, (np.maximum(F - dU, 0.0) / K) ** 2 / a, np.inf)


def _ln_s_P(c_Y: float, c_P: float) -> float:
    return float(3 * (c_P - 2 * c_Y / 3) - np.log(2))


def _least_ratio(c_Y: float, c_P: float, c_strain: float, a_Y: float) -> float:
    """The least `_ratio` of all overlaps: in 2000 steps of each phase, then by halving the steps around it."""
    ln_s_P, least = _ln_s_P(c_Y, c_P), np.inf
    end = min(ln_s_P + 10, np.log1p(2 * (1 - LEAST_AREA) / a_Y**2)) if a_Y > 0 else ln_s_P + 10
    for low, high in ((1e-9, min(ln_s_P * (1 - 1e-12), end)), (ln_s_P, end)):
        for _ in range(8 * (high > low)):
            log = np.linspace(low, high, 2001)
            ratio = _ratio(log, c_Y, c_P, c_strain, a_Y)
            k = int(np.argmin(ratio))
            least = min(least, float(ratio[k]))
            low, high = log[max(k - 2, 0)], log[min(k + 2, 2000)]
    return least
