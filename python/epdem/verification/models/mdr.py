# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts of a sphere on a rigid flat under LAMMPS's `mdr` without adhesion and damping, its radius constant.

Mean pressure p_Y = Y (1 + 1.75 exp(-4.4 delta/R)), 2.75 Y at small overlaps; the volume under the flat goes sideways,
so that a^2 is nearly 2 R delta; unloading is that of a uniform pressure (tau = 1 of our laws, eq. 8.82), shortened by
how the free surface around the contact moves. It yields when the mean pressure of Hertz's contact reaches p_Y.
[Zunker and Kamrin 2024]
"""

import numpy as np

from ...theory.numerics import Array, Real, bisect, gauss, number, poisson_ratio
from .hysteresis import Impact

GIVEN_BACK = 4 / (3 * np.pi)  # integral of (2/pi)(acos y - y sqrt(1-y^2)) over y in [0, 1]
_X, _W = gauss(48)


class Flat:
    """The loading curve of a sphere on a rigid flat; scalars in SI: E_eff = E/(1-nu^2) [Pa], R [m], Y [Pa]."""

    def __init__(self, *, E_eff: float, nu: float, R: float, Y: float):
        self.E, self.R, self.Y = number("E_eff", E_eff), number("R", R), number("Y", Y)
        self.nu = poisson_ratio("nu", nu)
        self.G = E_eff * (1 - nu) / 2
        self.yield_overlap = float(bisect(lambda d: self._excess(d) < 0, 0.0, R, steps=100)[1])

    def _excess(self, overlap: Real) -> Real:
        """Mean pressure of Hertz's contact beyond that of a yielding one [Pa]."""
        return 4 * self.E * np.sqrt(overlap / self.R) / (3 * np.pi) - self.pressure(overlap)

    def pressure(self, overlap: Real) -> Real:
        """Mean pressure [Pa] of a contact that yields."""
        return self.Y * (1 + 1.75 * np.exp(-4.4 * overlap / self.R))

    def area_over_pi(self, overlap: Real) -> Real:
        """a^2 [m^2] of a contact that yields."""
        d, y = overlap, self.yield_overlap
        return (2 * d - y) * self.R - (d - y) * (d + y)

    def force(self, overlap: Real) -> Array:
        """Force [N] while the overlap grows."""
        c = 1 - overlap / (2 * self.R)
        s = np.sqrt(np.maximum(1 - c * c, 0))
        elastic = 2 * self.E * self.R**2 * (np.arctan2(s, c) - c * s)
        plastic = np.pi * self.area_over_pi(overlap) * self.pressure(overlap)
        return np.where(overlap <= self.yield_overlap, elastic, plastic)

    def work(self, overlap: Real) -> Array:
        """Work [J] up to an overlap [m], by Gauss on either side of yielding."""
        middle = np.minimum(overlap, self.yield_overlap)
        total = np.zeros(np.shape(overlap))
        for low, wide in ((np.zeros_like(middle), middle), (middle, overlap - middle)):
            total = total + wide * sum(w * self.force(low + wide * x) for x, w in zip(_X, _W, strict=True))
        return total


def impact(*, E_eff: float, nu: float, R: float, Y: float, m_star: float, speed: Real) -> Impact:
    """An impact at `speed` [m/s] > 0, shape (n,), of a sphere with mass m_star [kg], up to overlaps of R/2.

    E_eff = E/(1-nu^2) [Pa] and Poisson's ratio nu of the sphere, its radius R [m] and yield stress Y [Pa]. With
    delta_e = 2 p_Y a/E_eff and delta_R the rise of the free surface, e_n^2 = (8/(3 pi^2)) F^2/(a E_eff W)
    (1 + delta_R/delta_e). Raises ValueError.
    """
    law, v = Flat(E_eff=E_eff, nu=nu, R=R, Y=Y), np.atleast_1d(number("speed", speed))
    m = number("m_star", m_star)
    W = 0.5 * m * v**2
    top = bisect(lambda d: law.work(d) < W, np.zeros(v.shape), 0.5 * R, steps=100)[1]
    if np.any(top > 0.499 * R):
        raise ValueError(f"speed = {v.max():g}, the overlap passes half the radius")
    yielded, F = top > law.yield_overlap, law.force(top)
    # time on the way in: delta = top (1 - q^2), with the work that is left by Gauss as well; split where it yields
    kink = np.sqrt(np.maximum(1 - law.yield_overlap / top, 0))
    there = np.zeros(v.shape)
    for low, high in ((np.zeros_like(kink), kink), (kink, np.ones_like(kink))):
        for x, w in zip(_X, _W, strict=True):
            q = low + (high - low) * x
            left = np.maximum(W - law.work(top * (1 - q * q)), 1e-300)
            there = there + w * (high - low) * 2 * top * q / np.sqrt(2 * left / m)
    a = np.sqrt(np.where(yielded, law.area_over_pi(top), law.R * top))
    recovery = 2 * law.pressure(top) * a / law.E
    depth = R - top + recovery  # of the sphere's centre under the flat, when all strain has gone
    slant = np.sqrt(a * a + depth * depth)
    rise = (2 * a * a * (nu - 1) - (2 * nu - 1) * depth * (slant - depth)) * F / (2 * np.pi * a * a * law.G * slant)
    share = 1 + rise / recovery
    out = np.where(yielded, GIVEN_BACK * F * recovery * share, W)
    back = np.zeros(v.shape)
    for x, w in zip(_X, _W, strict=True):
        y = x * x  # speed rises from 0 as the root of y
        root = np.sqrt(1 - y * y)
        given = 2 / np.pi * (y * np.arccos(y) - root + 1 - (1 - root**3) / 3)
        back = back + w * 2 * x / np.sqrt(2 * F * recovery * share * given / m)
    back = np.where(yielded, recovery * share * back, there)
    return Impact(
        e_n=np.sqrt(out / W),
        contact_time=there + back,
        force_max=F,
        overlap_max=top,
        residual_overlap=np.where(yielded, top - recovery * share, 0.0),
        work_in=W,
        work_out=out,
    )
