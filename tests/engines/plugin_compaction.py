# SPDX-License-Identifier: GPL-2.0-or-later
"""Clusters of spheres on prescribed paths with compaction: decks, and the forces by numpy from positions alone."""

import numpy as np
from plugin_decks import good

from epdem.theory.cavity import Cavity

E, NU, Y = 120e6, 0.34, 1e6
E_STAR = E / (1 - NU**2) / 2  # of two spheres; a wall has the same material
GROWTH = 1.6  # S1 above which growth rises no faster

HEAD = f"""atom_style granular
atom_modify map array sort 0 0
boundary f f f
newton off
communicate single vel yes
units si
%(head)s
%(atoms)s
neighbor 0.3 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype {E!r}
fix m2 all property/global poissonsRatio peratomtype {NU!r}
fix p1 all property/global yieldStress peratomtype {Y!r}
fix p2 all property/global finiteStrain peratomtype 0.82
pair_style gran model ep/cavity tangential off %(settings)s
pair_coeff * *
"""


def data(x, radius, v, density, half=4.0):
    """A data file of spheres in a cube."""
    n, x, v, radius = len(radius), x.tolist(), v.tolist(), radius.tolist()
    rows = [f"{k + 1} 1 {2 * radius[k]!r} {density!r} {' '.join(map(repr, x[k]))}" for k in range(n)]
    speeds = [f"{k + 1} {' '.join(map(repr, v[k]))} 0 0 0" for k in range(n)]
    box = [f"{-half!r} {half!r} {c}lo {c}hi" for c in "xyz"]
    head = ["x", "", f"{n} atoms", "1 atom types", "", *box]
    return "\n".join([*head, "", "Atoms", "", *rows, "", "Velocities", "", *speeds, ""])


def deck(settings, *, walls=(), runs, dt, head="", restart=None, columns="fx fy fz", every=1):
    """`walls`: planes as LIGGGHTS writes them ("zplane -0.97"); `runs`: lines that run."""
    text = HEAD % {
        "settings": settings,
        "head": head,
        "atoms": f"read_restart {restart}" if restart else "read_data spheres.data",
    }
    for k, wall in enumerate(walls):
        text += f"fix w{k} all wall/gran model ep/cavity tangential off primitive type 1 {wall} {settings}\n"
    text += f"fix move all nve/sphere\ntimestep {dt!r}\ndump d all custom {every} out.bin id {columns}\n"
    return text + "dump_modify d sort id\n" + runs


def geometry(x, radius, planes):
    """Contacts of spheres along a path: bodies i and j (-1: a plane), overlaps and normals on i for each step.

    x: centres, shape (steps, n, 3); planes: (axis, place) of walls below the spheres.
    """
    n = len(radius)
    pairs, overlap, normal = [], [], []
    for i in range(n):
        for j in range(i + 1, n):
            d = x[:, i] - x[:, j]
            r = np.linalg.norm(d, axis=1)
            pairs.append((i, j))
            overlap.append(radius[i] + radius[j] - r)
            normal.append(d / r[:, None])
        for axis, place in planes:
            pairs.append((i, -1))
            overlap.append(radius[i] - (x[:, i, axis] - place))
            normal.append(np.broadcast_to(np.eye(3)[axis], (len(x), 3)))
    return *np.array(pairs).T, np.array(overlap).T, np.moveaxis(np.array(normal), 0, 1)


class Bodies:
    """Contacts of like spheres with each other and with walls of their material, whose sums are those of the step itself.

    Hosts take the sums of the step before, extrapolated. E = 120 Y, both bodies of a contact share strain and compliance
    alike: w = s = 1/2.
    """

    def __init__(self, radius, i, j):
        self.radius, self.sides = radius, ((i, i >= 0), (j, j >= 0))
        R_i, R_j = radius[i], np.where(j >= 0, radius[j], np.inf)
        self.R = [R_i, R_j]
        self.law = Cavity(E_star=E_STAR, R_star=1 / (1 / R_i + 1 / R_j), Y=Y, c_strain=0.82, share=0.5)
        self.forget(np.full(len(i), True))

    def forget(self, ended):
        zero = dict.fromkeys(("q", "unstored", "peak", "residual", "area"), 0.0)
        for name, value in {"most": -np.inf, "least": 1.0, **zero}.items():
            old = getattr(self, name, np.full(len(ended), value))
            setattr(self, name, np.where(ended, value, old))

    def total(self, of_sides):
        """Sums over the contacts of each body."""
        sums = np.zeros(len(self.radius))
        for (body, real), values in zip(self.sides, of_sides, strict=True):
            np.add.at(sums, body[real], values[real])
        return sums

    def depths(self, residual):
        """Depths of the dents over the radii, to the plane in which the surfaces intersect."""
        R_i, R_j = self.R
        wall = np.isinf(R_j)
        R_2 = np.where(wall, 1.0, R_j)
        distance = R_i + R_2 - residual
        plane = (distance**2 + R_i**2 - R_2**2) / (2 * distance)  # from the centre of i
        return np.where(wall, residual, R_i - plane) / R_i, np.where(wall, 0.0, R_2 - distance + plane) / R_2

    def step(self, overlap):
        """Forces [N] at these overlaps [m]."""
        most = np.maximum(self.most, overlap)
        residual, area = self.residual, self.area
        for _ in range(6):  # the sums follow from the contacts, and these from the sums
            depths = self.depths(residual)
            cover, volume = self.total(depths), self.total([x**2 for x in depths])
            area_of = self.total([area, area])
            growth = volume / (4 - 2 * np.minimum(cover, GROWTH))
            u, gamma = 0.0, 0.0
            for (body, real), x, R in zip(self.sides, depths, self.R, strict=True):
                own = x**2 / (4 - 2 * np.minimum(x, GROWTH))
                u = u + np.where(real, np.where(real, R, 0.0) * np.maximum(growth[body] - own, 0.0), 0.0)
                others = np.where(real, np.maximum(area_of[body] - area, 0.0), 0.0)
                bulk = others / np.sqrt(np.where(area > 0, area, np.inf)) / R * (1 - 2 * NU) / (2 * np.pi * (1 - NU**2))
                gamma = gamma + 0.5 * ((1 - np.minimum(np.sqrt(others) / (2 * R), 1)) ** 1.5 + bulk)
            v = u + self.q if _ == 0 else u + q
            on = overlap + v > 0
            b = np.where(on, most + v, 0.5 * self.law.yield_overlap)
            peak, a = self.law.force(b), self.law.radius(b)
            yields = on & (b > self.law.yield_overlap)
            m = np.where(yields, 1 - self.law.yield_overlap / b, 0.0)
            least = np.where(yields & (self.area > 0), np.minimum(self.least, np.clip(gamma, 0.05, 1)), self.least)
            G = 1 - (1 - least) * m
            unstored = np.where(yields, (1 - G) * self.law.recovered_work(b), 0.0)
            mean = np.where(self.peak > 0, 0.5 * (peak + self.peak), peak)
            q = self.q + np.where(yields, (unstored - self.unstored) / mean, 0.0)
            recovered = np.maximum(most, 0.0) - G * self.law.recovered_overlap(b)
            residual, area = np.where(yields, np.maximum(recovered, 0.0), 0.0), m * a**2
        back = np.maximum(b - np.maximum(most - overlap, 0.0) / np.where(yields, G, 1.0), 1e-12)
        F = np.where(yields, self.law.unloading_force(back, b), self.law.force(np.maximum(overlap + v, 0.0)))
        self.most, self.least, self.q, self.unstored, self.peak = most, least, q, unstored, np.where(yields, peak, 0.0)
        self.residual, self.area = residual, area
        self.forget(~on)
        return np.where(on, np.nan_to_num(F), 0.0)


def forces(x, radius, planes):
    """Forces on spheres along a path, shape (steps, n, 3)."""
    i, j, overlap, normal = geometry(x, radius, planes)
    bodies = Bodies(radius, i, j)
    F = np.zeros(x.shape)
    for t in range(len(x)):
        f = bodies.step(overlap[t])[:, None] * normal[t]
        np.add.at(F[t], i, f)
        np.add.at(F[t], j[j >= 0], -f[j >= 0])
    return F


def run(folder, text, spheres, **options):
    """The frames of a run."""
    return good(folder, text, files={"spheres.data": spheres}, **options).frames()[1]


def alone(n, aside=30.0):
    """Places, radii and velocities of n pairs of spheres, then of n spheres that fall on a floor at z = -1.

    The impacts are elastic to fully plastic.
    """
    rng = np.random.default_rng(5)
    a = np.column_stack([np.linspace(-60, 60, n), np.zeros(n), np.full(n, 4.0)])
    radius = rng.uniform(0.7, 1.3, 3 * n)
    b = a + np.column_stack([np.zeros(n), radius[:n] + radius[n : 2 * n] + 1e-3, rng.uniform(-0.3, 0.3, n)])
    c = a - np.column_stack([np.zeros(n), np.full(n, aside), 5.0 - radius[2 * n :] - 1e-3])
    v = np.zeros((3 * n, 3))
    v[n : 2 * n, 1] = v[2 * n :, 2] = -np.geomspace(0.05, 20, n)
    return np.concatenate([a, b, c]), radius, v
