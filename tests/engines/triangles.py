# SPDX-License-Identifier: GPL-2.0-or-later
"""Triangles for walls of LIGGGHTS and LAMMPS, arrays of the shape (n, 3, 3) [m]."""

from itertools import product

import numpy as np

from epdem.scenes.plan.meshes import stl_text


def tiles(x, y, n=1, m=1, height=0.0):
    """n times m rectangles between limits, of two triangles each."""
    xs, ys = np.linspace(*x, n + 1).tolist(), np.linspace(*y, m + 1).tolist()
    found = []
    for i, j in product(range(n), range(m)):
        a, b, c, d = ((xs[i + di], ys[j + dj], height) for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)))
        found += [(a, b, c), (a, c, d)]
    return np.array(found)


def fold(angle, x, y):
    """A level floor up to x = 0 and a slope beyond; angle > 0: the slope goes up."""
    level, slope = tiles((x[0], 0.0), y), tiles((0.0, x[1]), y)
    slope[..., 2] = slope[..., 0] * np.tan(angle)
    return [*level, *slope]


def cube(half, cells):
    """The faces of a cube, each cut into 2 cells^2 triangles."""
    face = tiles((-half, half), (-half, half), cells, cells)[..., :2]
    return np.concatenate([np.insert(face, axis, side, axis=2) for axis in range(3) for side in (-half, half)])


def plate(x=(-0.1, 0.1), y=(-0.1, 0.1), cells=1):
    """STL text of a plate at z = 0, `cells` x `cells` rectangles of two triangles."""
    return stl_text("plate", tiles(x, y, cells, cells))


def written(folder, triangles, name="f"):
    """A folder with the triangles in the file NAME.stl."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.stl").write_text(stl_text(name, np.asarray(triangles)))
    return folder
