# SPDX-License-Identifier: GPL-2.0-or-later
"""Triangles as an ASCII STL file that LIGGGHTS reads."""

import numpy as np


def text(name: str, triangles: np.ndarray) -> str:
    """An STL solid of triangles, shape (n, 3 corners, 3 coordinates) [m].

    Corners keep 13 digits, the same ones wherever a corner is repeated: neighbours share them exactly.
    """
    lines = [f"solid {name}"]
    for corners in triangles:
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        normal = normal / np.linalg.norm(normal)
        lines.append("facet normal " + " ".join(f"{x:.9e}" for x in normal))
        lines.append(" outer loop")
        lines += ["  vertex " + " ".join(f"{x:.12e}" for x in corner) for corner in corners]
        lines += [" endloop", "endfacet"]
    return "\n".join([*lines, f"endsolid {name}", ""])
