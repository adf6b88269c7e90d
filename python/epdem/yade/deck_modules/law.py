# SPDX-License-Identifier: GPL-2.0-or-later
"""The contact laws as plain numbers, for a Python without any package; every YADE deck contains a copy.

A law holds the constants of a pair of materials; R_star [m] comes apart because it changes from contact to contact.
Overlaps delta in m, forces in N, pressures in Pa. The same laws in C++ are in cpp_contact/include/epdem; a test
compares the two to 2e-15. Here everything is written for one contact at a time, as a re-anchoring needs it.
"""

from math import acos, asin, exp, inf, isfinite, log, pi, sqrt
from typing import Protocol

# A point of a loading backbone: force [N], contact radius [m], flatness of the pressure (0 Hertz's, 1 uniform).
Point = tuple[float, float, float]


def hertz(E_star: float, R_star: float, delta: float) -> Point:
    """Hertz (1882): F = 4/3 E* sqrt(R*) delta^1.5, a^2 = R* delta; delta >= 0."""
    radius = sqrt(R_star * delta)
    return (4.0 / 3.0 * E_star * radius * delta, radius, 0.0)


def _positive(law: str, **values: float) -> None:
    for name, value in values.items():
        if not value > 0.0:
            raise ValueError(f"law {law}: {name} = {value!r}, must be > 0 (SI units)")


class Law(Protocol):
    """The constants of a pair of materials."""

    name: str
    strength_name: str | None  # None: it never yields
    trigger_factor: float  # pressure at which Hertz's contact yields first, over the strength
    flattens: bool  # whether unloading differs from Hertz's
    ratios: tuple[str, ...]  # dimensionless parameters
    E_star: float
    yield_ratio: float  # overlap of first yield over R*

    def __init__(self, E_star: float, strength: float = inf, **ratios: float) -> None: ...

    def load(self, R_star: float, delta: float) -> Point:
        """The loading backbone beyond first yield."""


class Hertz:
    """Elastic contact (Hertz 1882): never yields. `strength` is ignored, so that all laws are made alike."""

    name = "hertz"
    strength_name: str | None = None
    trigger_factor = inf
    flattens = False
    ratios: tuple[str, ...] = ()

    def __init__(self, E_star: float, strength: float = inf):
        _positive(self.name, E_star=E_star)
        self.E_star, self.yield_ratio = E_star, inf

    def load(self, R_star: float, delta: float) -> Point:
        return hertz(self.E_star, R_star, delta)


class Thornton:
    """Elastic, perfectly plastic (Thornton 1997, J. Appl. Mech. 64, 383); strength p_y [Pa]; eq. 8.83 and 8.84."""

    name = "thornton"
    strength_name: str | None = "yield_pressure"
    trigger_factor = 1.0
    flattens = False
    ratios: tuple[str, ...] = ()

    def __init__(self, E_star: float, strength: float):
        _positive(self.name, E_star=E_star, yield_pressure=strength)
        self.E_star = E_star
        self.yield_ratio = (0.5 * pi * strength / E_star) ** 2  # delta_y/R*
        self.slope_ratio = pi * strength  # dF/d delta over R*

    def load(self, R_star: float, delta: float) -> Point:
        """The plastic line beyond first yield, delta > yield_ratio R*: F_y is 2/3 of slope times delta_y."""
        line = self.slope_ratio * R_star * (delta - self.yield_ratio * R_star / 3.0)
        return (line, sqrt(R_star * delta), 0.0)


class Johnson:
    """Fully plastic, eq. 8.85 (Johnson 1985, section 11.5), and Hertz while that is the smaller force; strength p_m."""

    name = "johnson"
    strength_name: str | None = "yield_pressure"
    trigger_factor = 3.0
    flattens = False
    ratios: tuple[str, ...] = ()

    def __init__(self, E_star: float, strength: float):
        _positive(self.name, E_star=E_star, yield_pressure=strength)
        self.E_star = E_star
        self.yield_ratio = (1.5 * pi * strength / E_star) ** 2
        self.slope_ratio = 2.0 * pi * strength

    def load(self, R_star: float, delta: float) -> Point:
        """F = 2 pi R* p_m delta, a^2 = 2 R* delta; delta > yield_ratio R*."""
        return (self.slope_ratio * R_star * delta, sqrt(2.0 * R_star * delta), 0.0)


class Cavity:
    """Three phases: elastic to p_0 = c_Y Y (8.78), expanding cavity (8.81), fully plastic at c_P Y (8.80, 8.85).

    strength is Y [Pa]. The composition of the phases is this project's own; nothing in it is fitted.
    """

    name = "cavity"
    strength_name: str | None = "yield_stress"
    flattens = True
    ratios: tuple[str, ...] = ("first_yield_ratio", "plastic_ratio")

    def __init__(self, E_star: float, strength: float, first_yield_ratio: float = 1.60, plastic_ratio: float = 2.8):
        _positive(self.name, E_star=E_star, yield_stress=strength, first_yield_ratio=first_yield_ratio)
        excess = yield_excess(first_yield_ratio, plastic_ratio)
        if excess > 2.5:
            pair = f"first_yield_ratio = {first_yield_ratio!r} with plastic_ratio = {plastic_ratio!r}"
            raise ValueError(f"law cavity: {pair} would create energy at yield ({excess:.4g} > 2.5); take 1.6 and 2.8")
        self.E_star, self.Y, self.c_Y, self.c_P = E_star, strength, first_yield_ratio, plastic_ratio
        self.trigger_factor = first_yield_ratio
        self.a_ratio = 0.5 * pi * first_yield_ratio * strength / E_star  # a_Y/R*
        self.yield_ratio = self.a_ratio**2
        self.log_s_P = log_plastic(first_yield_ratio, plastic_ratio)
        self.beta = log(2.0) / self.log_s_P
        self.full_ratio = self.yield_ratio * exp(self.log_s_P)  # delta_P/R*

    def load(self, R_star: float, delta: float) -> Point:
        """Phases 2 and 3, delta > yield_ratio R*."""
        if delta >= self.full_ratio * R_star:
            return (2.0 * pi * R_star * self.c_P * self.Y * delta, sqrt(2.0 * R_star * delta), 1.0)
        log_s = log(delta / (self.yield_ratio * R_star))
        radius = self.a_ratio * R_star * exp(0.5 * (1.0 + self.beta) * log_s)
        mean_pressure = self.Y * (2.0 * self.c_Y + (1.0 + self.beta) * log_s) / 3.0
        return (pi * radius * radius * mean_pressure, radius, log_s / self.log_s_P)


def log_plastic(first_yield_ratio: float, plastic_ratio: float) -> float:
    """ln s_P: where the expanding cavity reaches plastic_ratio; eq. 8.81 has slope 2/3 against ln a."""
    return 3.0 * (plastic_ratio - 2.0 / 3.0 * first_yield_ratio) - log(2.0)


def yield_excess(first_yield_ratio: float, plastic_ratio: float) -> float:
    """Energy condition just above yield; it must not exceed 2.5. inf where the phases do not follow each other."""
    log_s = log_plastic(first_yield_ratio, plastic_ratio)
    if not (plastic_ratio > first_yield_ratio > 0.0 and log_s > 0.0 and isfinite(log_s)):
        return inf
    grow = 1.0 + log(2.0) / log_s
    return 2.0 * grow * (1.0 + 0.5 / first_yield_ratio) - 0.5 * grow - 0.125 / log_s


LAWS: dict[str, type[Law]] = {
    "hertz": Hertz,
    "thornton": Thornton,
    "johnson": Johnson,
    "cavity": Cavity,
}


def _segment(u: float) -> float:
    """acos y - y sqrt(1 - y^2) with y = 1 - u, u in [0, 1]: the half-angle form and a series where that cancels."""
    if u > 0.25:
        y = 1.0 - u
        return acos(y) - y * sqrt(u * (1.0 + y))
    phi = 4.0 * asin(sqrt(0.5 * u))  # the segment is (phi - sin phi)/2
    q, term, total, k = phi * phi, phi * phi * phi / 6.0, 0.0, 4
    while abs(term) > 1e-17 * total:
        total += term
        term *= -q / (k * (k + 1))
        k += 2
    return 0.5 * total


def unload(E_star: float, peak: Point, delta_max: float, delta: float) -> tuple[float, float]:
    """(F, a) on the elastic branch below delta_max, whose backbone point is `peak` (Mesarovic and Johnson 2000, 8.82).

    Superposed rigid punches between the contact circle and a_max: dF/d delta = 2 E* a all along the branch.
    (0, 0) once the bodies have parted inside the dent.
    """
    force, radius, tau = peak
    w = (delta_max - delta) * E_star * radius / force
    if w <= 0.0:
        return force, radius
    A, B = 0.75 * (1.0 - tau), 2.0 / pi * tau
    S = B + sqrt(B * B + 4.0 * A * w)
    u = (S - 2.0 * w) / S  # 1 - y: what is left of the branch
    if u <= 0.0:
        return 0.0, 0.0
    disc = u * (2.0 - u)
    root = sqrt(disc)
    share = (1.0 - tau) * disc * root
    if tau > 0.0:
        share += B * _segment(u)
    return force * share, radius * root


def recovered_overlap(E_star: float, peak: Point) -> float:
    """Overlap given back on full unloading [m]; delta_max less this is the dent."""
    force, radius, tau = peak
    return (0.75 * (1.0 - tau) + 2.0 / pi * tau) * force / (E_star * radius)


def step(law: Law, R_star: float, delta_max: float, delta: float) -> tuple[float, float, float]:
    """(F, a, new delta_max) of a contact with the history delta_max: one step of the C++ law."""
    if not delta > 0.0:
        return 0.0, 0.0, delta_max
    after = max(delta, delta_max)
    if after <= law.yield_ratio * R_star:
        return (*hertz(law.E_star, R_star, delta)[:2], after)
    peak = law.load(R_star, after)
    return (*unload(law.E_star, peak, after, delta), after)


def hertz_branch(E_star: float, force: float, radius: float, delta: float) -> tuple[float, float]:
    """(R, dent) of the Hertz contact F = 4/3 E* sqrt(R) (delta - dent)^1.5 with this force and slope 2 E* a at delta.

    For a law with flatness 0 it is the whole elastic branch, exactly; else it touches the branch at delta.
    """
    x = 0.75 * force / (E_star * radius)
    return radius * radius / x, delta - x
