# SPDX-License-Identifier: GPL-2.0-or-later
"""Clusters of spheres on prescribed paths with compaction: decks, and the forces by numpy from positions alone."""

import numpy as np
from plugin_decks import good

from bed import Bed, Material

E, NU, Y = 120e6, 0.34, 1e6

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


def forces(x, radius, planes):
    """Forces on spheres along a path, shape (steps, n, 3), with the sums of each step itself: the exact limit."""
    i, j, overlap, normal = geometry(x, radius, planes)
    like = Material(E, NU, Y)
    bodies = Bed(np.asarray(radius, float), i, j, like, plane=like)
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


def overlapping(apart=1.93):
    """Places, radii and velocities of a pair that overlaps beyond yield through the faces x = -4 and 4 and turns."""
    x = np.array([[4.0 - 0.48 * apart, 0.1, 0.2], [-4.0 + 0.52 * apart, 0.13, 0.11]])
    return x, np.array([1.0, 1.1]), np.array([[1.5, 0.9, -0.4], [-1.2, -1.1, 0.7]])
