# SPDX-License-Identifier: GPL-2.0-or-later
"""STL files of walls: read, scaled, rotated, moved; an invalid file is refused before a run."""

import io
import math
from pathlib import Path

import numpy as np

from ..case.walls import StlWall
from ..errors import CaseError
from .meshes import FloatArray

SMALLEST_ANGLE = math.radians(0.52)  # of a triangle: LIGGGHTS refuses sharper ones
MERGED = 1e-9  # of the size of a mesh: corners closer than this are one


def _read(path: Path, place: str) -> FloatArray:
    """The triangles of a file, shape (n, 3, 3), in its unit. Raises CaseError."""
    import trimesh

    raw = path.read_bytes()
    count = int.from_bytes(raw[80:84], "little")
    if len(raw) != 84 + 50 * count:  # not a binary file, so it must be a text
        if b"facet" not in raw:
            raise CaseError(
                f"{place} = '{path}': not an STL file ({len(raw)} bytes; the {count} triangles of its header have "
                f"{84 + 50 * count}, and a text has the word 'facet'); export it anew"
            )
        raw = raw.decode("utf-8", errors="replace").encode()
    try:
        mesh = trimesh.load_mesh(io.BytesIO(raw), file_type="stl", process=False)
        triangles: FloatArray = np.asarray(mesh.triangles, dtype=np.float64)
    except Exception as error:  # of a damaged file trimesh says almost anything
        reason = " ".join(str(error).split())[:80] or type(error).__name__
        raise CaseError(f"{place} = '{path}': not an STL file ({reason}); export it anew") from None
    if not len(triangles) or not np.isfinite(triangles).all():
        raise CaseError(f"{place} = '{path}': no triangles, or corners that are not numbers; export it anew")
    return triangles


def _at(point: FloatArray) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in point) + ") m"


def _edges(triangles: FloatArray) -> tuple[np.ndarray, np.ndarray]:
    """(numbers of the two corners of each directed edge, shape (3 n, 2); places of the corners)."""
    size = float(np.ptp(triangles.reshape(-1, 3), axis=0).max())
    keys = np.round(triangles.reshape(-1, 3) / (MERGED * size)).astype(np.int64)
    _, first, numbers = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    faces = numbers.reshape(-1, 3)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return edges, triangles.reshape(-1, 3)[first]


def _refuse_faults(w: StlWall, triangles: FloatArray, place: str) -> None:
    """Raise CaseError for triangles that no engine takes, with their number and the place of the first."""
    from trimesh.triangles import angles  # 0 where two corners are one

    sharpest = angles(triangles).min(axis=1)  # type: ignore[no-untyped-call]
    sharp = np.flatnonzero(sharpest < SMALLEST_ANGLE)
    if sharp.size:
        where = _at(triangles[sharp[0]].mean(axis=0))
        raise CaseError(
            f"{place}: {sharp.size} degenerate triangles (an angle below {math.degrees(SMALLEST_ANGLE):.2f} deg), the "
            f"first is number {sharp[0] + 1} at {where}; repair the mesh"
        )
    edges, corners = _edges(triangles)
    undirected, counts = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    _, repeated = np.unique(edges, axis=0, return_counts=True)

    def middle(edge: np.ndarray) -> str:
        return _at(corners[edge].mean(axis=0))

    if (counts > 2).any():
        n, edge = int((counts > 2).sum()), undirected[counts > 2][0]
        raise CaseError(f"{place}: {n} edges belong to more than two triangles, one at {middle(edge)}; repair the mesh")
    if (repeated > 1).any():
        n = int((repeated > 1).sum())
        edge = np.unique(edges, axis=0)[repeated > 1][0]
        raise CaseError(
            f"{place}: neighbouring triangles are flipped against each other at {n} edges, one at {middle(edge)}; make "
            "their normals consistent"
        )
    if w.closed and (counts == 1).any():
        n, edge = int((counts == 1).sum()), undirected[counts == 1][0]
        raise CaseError(f"{place}: open along {n} edges, one at {middle(edge)}; close the mesh, or remove 'closed'")


def placed(w: StlWall, room: tuple[float, ...], largest: float) -> FloatArray:
    """The triangles of an STL wall in the room xlo xhi ylo yhi zlo zhi [m], shape (n, 3, 3).

    largest: of the radii [m], against which the size is checked. Raises CaseError for a file that is no good wall.
    """
    place = f"scene.wall.{w.name}.file"
    points: FloatArray = w.scale * _read(w.file, place)
    if w.rotate is not None:
        from trimesh.transformations import rotation_matrix

        turn: FloatArray = rotation_matrix(w.rotate.angle, w.rotate.axis)  # type: ignore[no-untyped-call]
        points = points @ turn[:3, :3].T
    points = points + np.array(w.position)
    low, high = points.reshape(-1, 3).min(axis=0), points.reshape(-1, 3).max(axis=0)
    extent = " x ".join(f"{x:.4g}" for x in high - low)
    if (high - low).max() < 2 * largest:
        raise CaseError(
            f"{place}: the wall of {extent} m is smaller than a sphere; check its unit, scale = {w.scale:g}"
        )
    if (low < room[0::2]).any() or (high > room[1::2]).any():
        raise CaseError(
            f"{place}: the wall reaches from {_at(low)} to {_at(high)}, beyond scene.room; check its unit (scale = "
            f"{w.scale:g}; 0.001 if the file is in mm), its place, or enlarge the room"
        )
    _refuse_faults(w, points, place)
    return points
