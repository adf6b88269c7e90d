# SPDX-License-Identifier: GPL-2.0-or-later
"""Spheres in contact with each other and with planes, whose contacts feel each other: option compaction of cavity.

Overlaps are given, and in each step growth, screening and forces are solved together as a fixed point. No number is
fitted: those of the growth and of the screening are derived in docs/compaction.md.
"""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from epdem.theory.cavity import FINITE_STRAIN, Cavity
from epdem.theory.numerics import Array, Real, gauss
from epdem.theory.pair import curvature_share, strain_share

Index: TypeAlias = NDArray[np.intp]

PLANE = -1  # in place of the second sphere of a contact
FIRST_YIELD, FULL_PLASTICITY = 1.6, 2.8  # c_Y and c_P
MOST_COVER = 1.6  # S1 above which the growth rises no faster
MOST_GROWTH = 0.2  # of the radius
LEAST_SCREENING = 0.05
REACH = 0.25  # growth closes gaps up to this share of the radii
CHANGE = 1e-13  # of the added overlaps over the radii where the fixed point ends


@dataclass(frozen=True)
class Material:
    """Elastic constants and yield stress [Pa]; E and Y may be infinite."""

    E: float
    nu: float
    Y: float


RIGID = Material(np.inf, 0.0, np.inf)


def growth(cover: Array, volume: Array) -> Array:
    """Growth g of a sphere over its radius: S2/(4 - 2 S1), at most 0.2; S1, S2: sums of x, x^2, x: depth over radius.

    A plane at (1 - x) R cuts a cap of the volume pi (x^2 + 2 x g) R^3, to first order in g, off a sphere that grew by g
    R. All caps have the volume of the growth, 4 pi g R^3.
    """
    return np.minimum(volume / (4.0 - 2.0 * np.minimum(cover, MOST_COVER)), MOST_GROWTH)


def screening(others: Array, own: Array, radius: Array, nu: Array, depth: Array) -> Array:
    """Recovery of a contact beside others over that of the same contact alone on a half-space, 0.05 to 1.

    others, own: squares of contact radii [m^2]. Constriction (1 - eps)^1.5 of the flux tube of a contact where the
    other contacts cover the share eps^2 of the surface of the sphere (Cooper, Mikic and Yovanovich 1969), and the
    compression of the sphere by the mean pressure, between its center and the plane of the contact at this depth [m].
    """
    eps = np.minimum(np.sqrt(others) / (2 * radius), 1.0)
    bulk = (1 - 2 * nu) / (2 * np.pi * (1 - nu**2)) * others / (np.sqrt(own) * radius) * (1 - depth / radius)
    return np.asarray(np.clip((1 - eps) ** 1.5 + bulk, LEAST_SCREENING, 1.0))


def stored_share(y: Array, tau: Array) -> Array:
    """Elastic energy of a contact at depth y of its unloading, over F^2/(E* a) of its peak: integral of force and way.

    F/F_max = (1-tau) sin^3 t + (2/pi) tau (t - sin t cos t), way = A cos^2 t + B cos t with cos t = y.
    """
    nodes, weights = gauss(24)
    most = np.arccos(np.clip(y, 0.0, 1.0))
    t = np.multiply.outer(nodes, most)
    force = (1 - tau) * np.sin(t) ** 3 + 2 / np.pi * tau * (t - np.sin(t) * np.cos(t))
    slope = (1.5 * (1 - tau) * np.cos(t) + 2 / np.pi * tau) * np.sin(t)
    return np.asarray(most * np.tensordot(weights, force * slope, 1))


def unload(law: Cavity, peak: Array, F: Array, way: Array) -> tuple[Array, Array]:
    """Force [N] and contact radius [m] at a way [m] below the peak overlap; F: peak force."""
    share = F / law.force(peak)  # the way scales with the peak force
    force, radius = law.unloading(peak - way / share, peak)
    return np.asarray(share * force), radius


def unloaded(law: Cavity, peak: Array, F: Array, way: Array) -> Array:
    """Elastic energy [J] at a way [m] below the peak overlap; F: peak force."""
    a, tau = law.radius(peak), law.flatness(peak)
    A, B = 0.75 * (1 - tau), 2 / np.pi * tau
    x = way * law.E_star * a / F
    S = np.maximum(B + np.sqrt(B * B + 4 * A * x), 1e-300)
    y = np.clip(2 * x / S, 0.0, 1.0)
    return np.asarray(F**2 / (law.E_star * a) * stored_share(y, tau))


class Kept(Cavity):
    """A law that computes force, radius and flatness at one array of overlaps, `at`, once."""

    at: Array | None = None

    def _once(self, name: str, alpha: Real) -> Real:
        if alpha is not self.at:
            return getattr(super(), name)(alpha)
        if name not in self._found:
            self._found[name] = getattr(super(), name)(alpha)
        return self._found[name]

    def look(self, alpha: Array) -> None:
        self.at, self._found = alpha, {}

    def force(self, alpha: Real) -> Real:
        return self._once("force", alpha)

    def radius(self, alpha: Real) -> Real:
        return self._once("radius", alpha)

    def flatness(self, alpha: Real) -> Real:
        return self._once("flatness", alpha)


class Bed:
    """Contacts (i, j) of spheres, j = PLANE: with a plane. The state after a step is in its arrays, one value each.

    radius [m]: of the spheres; material: of all spheres or of each; plane: material of all planes. Gamma: work of
    adhesion [J/m^2] of all pairs, for contacts that do not part (law cavity_adhesive): F = F_b - 2 E* a d at the
    overlap of the backbone less d = sqrt(2 pi Gamma a/E*).
    """

    def __init__(
        self,
        radius: Array,
        i: Index,
        j: Index,
        material: Material | list[Material],
        *,
        plane: Material = RIGID,
        c_strain: float = FINITE_STRAIN,
        grows: bool = True,
        Gamma: float = 0.0,
    ):
        n, contacts = len(radius), len(i)
        bodies = [material] * n if isinstance(material, Material) else list(material)
        E, self._nu, Y = (np.array([getattr(m, k) for m in [*bodies, plane]]) for k in ("E", "nu", "Y"))
        self.radius, self.i, self.j, self.wall = radius, i, j, j == PLANE
        self.R_i, self.R_j = radius[i], np.where(self.wall, np.inf, radius[j])  # PLANE is the last of E, nu and Y
        yields = (1 - self._nu**2) / E
        self.E_star, self.share_i = 1 / (yields[i] + yields[j]), yields[i] / (yields[i] + yields[j])
        self.R_star = np.where(self.wall, self.R_i, 1 / (1 / self.R_i + 1 / self.R_j))
        self.Y = np.minimum(Y[i], Y[j])
        self.strain_i = strain_share(Y[i], Y[j], hardening=FULL_PLASTICITY / FIRST_YIELD)
        self._c_strain, self._grows, self._Gamma = c_strain, grows, Gamma
        self.opened = np.zeros(contacts)  # d [m]
        self.force, self.stored = np.zeros((2, contacts))  # after a step [N], [J]
        self.reached = np.full(contacts, -np.inf)  # largest overlap without growth [m]
        self.grown, self.shift, self.unstored = np.zeros((3, contacts))  # u, q [m] and (1-G) U [J]
        self.peak, self.peak_force = np.zeros((2, contacts))  # overlap with growth [m] and force [N] at the peak
        self.screened = np.zeros((2, contacts))  # largest 1 - gamma of both sides
        self.retreat = np.zeros(contacts)  # e [m]
        self.full, self.lift = np.zeros(n + 1), np.ones(n + 1)  # N [J] and Q of each sphere
        self.pressure = np.zeros(n + 1)  # largest so far of each sphere [Pa], and 0 of planes
        self._near: Index = np.zeros(0, np.intp)
        self._law: Kept | None = None

    def _law_of(self, near: Index) -> Kept:
        if self._law is None or not np.array_equal(near, self._near):
            self._near, self._law = (
                near,
                Kept(
                    E_star=self.E_star[near],
                    R_star=self.R_star[near],
                    Y=self.Y[near],
                    c_Y=FIRST_YIELD,
                    c_P=FULL_PLASTICITY,
                    c_strain=self._c_strain,
                    share=curvature_share(self.strain_i[near], R_star=self.R_star[near], R1=self.R_i[near]),
                ),
            )
        return self._law

    def _sum(self, k: Index, to_i: Array, to_j: Array) -> Array:
        """Sums of the spheres; what goes to a plane is lost."""
        n = len(self.radius)
        return np.asarray(np.bincount(self.i[k], to_i, n + 1) + np.bincount(self.j[k] % (n + 1), to_j, n + 1), float)

    def _depths(self, k: Index, overlap: Array) -> tuple[Array, Array]:
        """Depths [m] of both spheres to the plane where they intersect."""
        R_i, wall = self.R_i[k], self.wall[k]
        R_j = np.where(wall, 1.0, self.R_j[k])
        half = 0.5 * overlap / (R_i + R_j - overlap)
        return np.where(wall, overlap, half * (2 * R_j - overlap)), np.where(wall, 0, half * (2 * R_i - overlap))

    def _pressure(self, k: Index, force: Array, overlap: Array) -> Array:
        """Mean pressure [Pa] of all spheres: sum F (R - h)/(3 V), h: depth; 0 of planes."""
        depth_i, depth_j = self._depths(k, overlap)
        moment_i, moment_j = force * (self.R_i[k] - depth_i), force * (np.where(self.wall[k], 0, self.R_j[k]) - depth_j)
        found = self._sum(k, moment_i, moment_j) / (4 * np.pi * np.append(self.radius, 1.0) ** 3)
        found[-1] = 0.0
        return found

    def _between(self, k: Index, g: Array, p: Array) -> Array:
        """Pressure [Pa] of both spheres of contacts, weighted by their growth R g."""
        grown = g * np.append(self.radius, 0.0)
        i, j = self.i[k], self.j[k]
        weight = grown[i] + grown[j]
        return np.asarray((grown[i] * p[i] + grown[j] * p[j]) / np.where(weight > 0, weight, 1.0))

    def _by_others(self, k: Index, residual: Array) -> tuple[Array, Array]:
        """Overlap u [m] that each contact gains by the dents of the others, and growth of all spheres."""
        R_i, wall = self.R_i[k], self.wall[k]
        R_j, w = np.where(wall, 1.0, self.R_j[k]), self.strain_i[k]
        d_i, d_j = self._depths(k, residual)
        volume_i = np.minimum(1, 2 * w) * R_i * d_i**2 + np.maximum(0, 2 * w - 1) * R_j * d_j**2
        volume_j = np.minimum(1, 2 - 2 * w) * R_j * d_j**2 + np.maximum(0, 1 - 2 * w) * R_i * d_i**2
        own = (d_i / R_i, volume_i / R_i**3), (d_j / R_j, volume_j / R_j**3)
        g = growth(*(self._sum(k, *both) for both in zip(*own, strict=True)))
        u_i, u_j = g[self.i[k]] - growth(*own[0]), g[self.j[k]] - growth(*own[1])
        u = np.asarray(R_i * np.maximum(0.0, u_i) + np.where(wall, 0.0, R_j * np.maximum(0.0, u_j)))
        g[-1] = 0.0  # of planes
        return u, g

    def _screened(self, k: Index, area: Array, yields: NDArray[np.bool_], reached: Array) -> Array:
        """1 - gamma of both sides of the contacts that yield, 0 of the others; area: m a^2 [m^2]."""
        total = self._sum(k, area, area)
        own = np.where(yields, area, 1.0)
        found = []
        for body, depth in zip((self.i[k], self.j[k]), self._depths(k, reached), strict=True):
            others = np.where(body == PLANE, 0.0, np.maximum(total[body] - area, 0.0))
            found.append(1 - screening(others, own, np.append(self.radius, 1.0)[body], self._nu[body], depth))
        return np.where(yields, found, 0.0)

    def _peak_force(self, law: Cavity, b: Array, alone: Array, m: Array, pressure: Array) -> Array:
        """Force [N] at the peak overlap b, of which `alone` is without growth: growth carries 2/3 Y + pressure."""
        F, G, a2 = law.force(b), np.zeros_like(b), np.zeros_like(b)
        has = alone > 0.0
        G[has], a2[has] = law.force(np.where(has, alone, b))[has], (law.radius(np.where(has, alone, b)) ** 2)[has]
        flow = 2 / 3 * law.Y + pressure
        return np.asarray(F - m * (F - G - np.pi * (law.radius(b) ** 2 - a2) * flow))

    def step(self, overlap: Array) -> Array:
        """Forces [N] of all contacts at overlaps without growth [m], negative across a gap."""
        k = np.flatnonzero(overlap > -REACH * (self.R_i + np.where(self.wall, 0.0, self.R_j)))
        law, R = self._law_of(k), self.R_star[k]
        u, q, e, F_before = self.grown[k], self.shift[k], self.retreat[k], self.peak_force[k]
        s, body, pressure = self.share_i[k], self.pressure, np.zeros(len(k))
        touches = np.ones(len(k), bool)
        stood, d, d_top, E_star = self.opened[k] > 0.0, self.opened[k], self.opened[k], self.E_star[k]
        for turn in range(400):
            v = u + q
            reached = np.maximum(self.reached[k], overlap[k] - e)
            on = (overlap[k] + v > 0.0) | stood
            touches = on if turn < 30 else touches & on  # one that ends in this step does not come back in it
            b = np.maximum(reached + v + d_top, 1e-12 * R)
            law.look(b)
            yields = touches & (b > law.yield_overlap)
            m = np.where(yields, 1 - law.yield_overlap / b, 0.0)
            F = np.where(touches, self._peak_force(law, b, np.maximum(b - u, 0.0), m, pressure), 0.0)
            share = np.where(touches, F / law.force(b), 1.0)
            area = m * law.radius(b) ** 2
            found = self._screened(k, area, yields, np.maximum(reached, 0.0))
            lost = np.maximum(self.screened[:, k], found)
            lost = np.where(touches & self._grows, lost, 0.0)
            c_i, c_j = s * lost[0] * m, (1 - s) * lost[1] * m
            back = share * law.recovered_overlap(b)
            residual = np.where(yields, np.maximum(np.maximum(reached + d_top, 0) - (1 - c_i - c_j) * back, 0), 0.0)
            unstored = np.where(yields, (c_i + c_j) * share**2 * law.recovered_work(b), 0.0)
            mean = np.where(F_before > 0, 0.5 * (F + F_before), F)
            q = self.shift[k] + np.where(yields, (unstored - self.unstored[k]) / np.where(yields, mean, 1.0), 0.0)
            way = np.maximum(reached + e - overlap[k] + (d_top - d), 0.0)
            force, a = unload(law, b, np.where(touches, F, 1.0), way)
            d_before, d, d_top = d, *(np.sqrt(2 * np.pi * self._Gamma * x / E_star) for x in (a, law.radius(b)))
            top = F - 2 * E_star * law.radius(b) * d_top
            force = np.where(touches, force - 2 * E_star * a * d, 0.0)
            before, e_before = pressure, e
            B_i, B_j = np.where(yields, c_i * back, 0.0), np.where(yields, c_j * back, 0.0)
            full = np.maximum(self.full, self._sum(k, B_i * top, B_j * top))
            full[-1] = 0.0
            lift = np.clip(self._sum(k, B_i * force, B_j * force) / np.where(full > 0, full, np.inf), 0, 1) ** 0.75
            lift = np.where(full > 0, lift, 1.0)
            e = B_i * (1 - lift[self.i[k]]) + B_j * (1 - lift[self.j[k]])
            if self._grows:
                u, g = self._by_others(k, residual)
                body = np.maximum(self.pressure, self._pressure(k, force, overlap[k]))
                pressure = self._between(k, g, body)
            settled = np.all(np.abs(pressure - before) <= CHANGE * self.Y[k])
            settled = settled and np.all(np.abs(d - d_before) <= CHANGE * R)
            settled = settled and np.all(np.abs(e - e_before) <= 0.1 * CHANGE * R)
            if settled and np.all(np.abs(u + q - v) <= CHANGE * R):
                break
        else:
            raise ArithmeticError(f"growth of {np.max(np.abs(u + q - v) / R):.1e} R* per turn after {turn} turns")
        stored = unloaded(law, b, np.where(touches, F, 1.0), way)
        after = {"force": force, "stored": stored, "grown": u, "shift": q, "unstored": unstored}
        after |= {"peak": b, "peak_force": F, "reached": reached, "retreat": e, "opened": d}
        for name, values in after.items():
            empty = {"reached": -np.inf}.get(name, 0.0)
            kept: Array = getattr(self, name)
            kept[:] = empty
            kept[k] = np.where(touches, values, empty)
        self.screened[:] = 0.0
        self.screened[:, k] = lost
        lives = self._sum(k, touches, touches) > 0
        self.pressure = np.where(lives, body, 0.0)
        self.full, self.lift = np.where(lives, full, 0.0), np.where(lives, lift, 1.0)
        return self.force.copy()

    def taken(self) -> Array:
        """Energy that each sphere takes from the stored energy of its contacts [J]."""
        return np.asarray(3 / 7 * (self.full * self.lift ** (7 / 3))[:-1])
