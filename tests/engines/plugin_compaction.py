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


def side_depths(a, b, overlap):
    """Depths of the dents of two spheres over their radii, to the plane in which their surfaces intersect."""
    distance = a + b - overlap
    plane = (distance**2 + a**2 - b**2) / (2 * distance)  # from the centre of a
    return (a - plane) / a, (b - (distance - plane)) / b


def forces(x, radius, planes):
    """Forces on spheres along a path, shape (steps, n, 3), with both sums of each step known: the exact limit.

    x: centres, shape (steps, n, 3); planes: (axis, place) of walls below the spheres.
    """
    steps, n = x.shape[:2]
    contacts = [(i, j) for i in range(n) for j in range(i + 1, n)] + [
        (i, ~k) for i in range(n) for k in range(len(planes))
    ]
    overlap, normal, R = [], [], []
    for i, j in contacts:
        if j >= 0:
            d = x[:, i] - x[:, j]
            r = np.linalg.norm(d, axis=1)
            overlap.append(radius[i] + radius[j] - r)
            normal.append(d / r[:, None])
            R.append(radius[i] * radius[j] / (radius[i] + radius[j]))
        else:
            axis, place = planes[~j]
            overlap.append(radius[i] - (x[:, i, axis] - place))
            normal.append(np.broadcast_to(np.eye(3)[axis], (steps, 3)))
            R.append(radius[i])
    overlap = np.array(overlap)
    largest = np.maximum.accumulate(overlap, axis=1)
    dents = np.maximum(largest, 0.0)
    depth = np.zeros((len(contacts), 2, steps))
    sums = np.zeros((n, 2, steps))
    for c, (i, j) in enumerate(contacts):
        if j >= 0:
            depth[c] = side_depths(radius[i], radius[j], dents[c])
            depth[c][:, dents[c] == 0.0] = 0.0
            sums[j] += depth[c, 1], depth[c, 1] ** 2
        else:
            depth[c, 0] = dents[c] / radius[i]
        sums[i] += depth[c, 0], depth[c, 0] ** 2
    growth = sums[:, 1] / (4 - 2 * np.minimum(sums[:, 0], GROWTH))
    F = np.zeros((steps, n, 3))
    for c, (i, j) in enumerate(contacts):
        sides = [(i, depth[c, 0])] + ([(j, depth[c, 1])] if j >= 0 else [])
        u = sum(radius[k] * np.maximum(growth[k] - s**2 / (4 - 2 * s), 0.0) for k, s in sides)
        law = Cavity(E_star=E_STAR, R_star=R[c], Y=Y, c_strain=0.82)
        now, most = overlap[c] + u, largest[c] + u
        on = now > 0.0
        f = np.zeros(steps)
        f[on] = np.nan_to_num(law.unloading_force(np.minimum(now[on], most[on]), most[on]))
        F[:, i] += f[:, None] * normal[c]
        if j >= 0:
            F[:, j] -= f[:, None] * normal[c]
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
