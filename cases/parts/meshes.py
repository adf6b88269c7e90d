# SPDX-License-Identifier: GPL-2.0-or-later
"""Writes hopper.stl (5,000 triangles) and screw.stl beside itself, in mm: python3 cases/parts/meshes.py [FOLDER]"""

import math
import struct
import sys
from pathlib import Path


def line(start, end, n):
    """n + 1 points of a profile."""
    return [tuple(a + (b - a) * k / n for a, b in zip(start, end, strict=False)) for k in range(n + 1)]


def grid(rows):
    """Two triangles between four neighbours of a grid of points; those without an area are left out."""
    found = []
    for one, two in zip(rows, rows[1:], strict=False):
        for a, b, c, d in zip(one, one[1:], two[1:], two, strict=False):
            found += [t for t in ((a, b, c), (a, c, d)) if len({*t}) == 3]
    return found


def revolve(profile, n):
    """Of points (radius, z)."""
    turns = [2 * math.pi * (k % n) / n for k in range(n + 1)]
    return grid([[(r * math.cos(t), r * math.sin(t), z) for t in turns] for r, z in profile])


def helicoid(radii, low, high, turns, n):
    """A flight without thickness."""
    steps = [k / (turns * n) for k in range(turns * n + 1)]
    angle = 2 * math.pi * turns
    return grid(
        [[(r * math.cos(angle * s), r * math.sin(angle * s), low + (high - low) * s) for s in steps] for r in radii]
    )


MESHES = {
    "hopper": revolve([*line((8, 0), (17, 9), 15), *line((17, 9), (17, 99), 35)[1:]], 50),
    "screw": revolve([(0, 4), *line((3, 4), (3, 34), 6), (0, 34)], 24) + helicoid((2.5, 5.5, 8, 11), 5, 29, 2, 24),
}


def write(folder, name, triangles):
    """NAME.stl in a folder."""
    rows = [struct.pack("<12fH", 0, 0, 0, *(x for corner in t for x in corner), 0) for t in triangles]
    head = f"{name} in mm".encode().ljust(80)
    (Path(folder) / f"{name}.stl").write_bytes(head + struct.pack("<I", len(rows)) + b"".join(rows))


if __name__ == "__main__":
    for name, triangles in MESHES.items():
        write(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent, name, triangles)
