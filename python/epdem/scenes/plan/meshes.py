# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls of a scene: their triangles, STL files (refused if they are invalid), motions, and whether they leave the room.

Arrays of triangles have the shape (n, 3 corners, 3 coordinates), metres."""

import io
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import takewhile
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ...case.motions import FloatArray, Move, RotateMove
from ...case.parts import Parts
from ...case.places import Limits
from ...case.walls import BoxWall, ConeWall, CylinderWall, MeshWall, PlaneWall, PlateWall, RevolvedWall, StlWall
from ...errors import CaseError

FACETS = 48  # around a circle: the wall is at most 0.2 % of the radius off it


def _ring(radius: float, z: float) -> FloatArray:
    angle = 2 * np.pi * np.arange(FACETS) / FACETS
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(FACETS, z)])


def _band(lower: FloatArray, upper: FloatArray) -> FloatArray:
    a, b = np.roll(lower, -1, axis=0), np.roll(upper, -1, axis=0)
    return np.concatenate([np.stack([lower, a, upper], axis=1), np.stack([a, b, upper], axis=1)])


def revolve(profile: Sequence[tuple[float, float]]) -> FloatArray:
    """Surface of revolution about z through (radius, z) points, split so that no triangle is a needle."""
    bands = []
    for (r0, z0), (r1, z1) in zip(profile[:-1], profile[1:], strict=True):
        edge = 2 * math.pi * max(r0, r1) / FACETS
        n = max(1, round(math.hypot(r1 - r0, z1 - z0) / (3 * edge)))
        for k in range(n):
            s, t = k / n, (k + 1) / n
            low, high = (_ring(r0 + way * (r1 - r0), z0 + way * (z1 - z0)) for way in (s, t))
            bands.append(_band(low, high))
    return np.concatenate(bands)


def orient(axis: int, points: FloatArray) -> FloatArray:
    """Triangles about the z axis, about axis 0, 1 or 2 instead."""
    return points[:, :, {0: [2, 1, 0], 1: [0, 2, 1], 2: [0, 1, 2]}[axis]]


def _disc(radius: float, z: float) -> FloatArray:
    ring = _ring(radius, z)
    middle = np.broadcast_to([0.0, 0.0, z], ring.shape)
    return np.stack([middle, ring, np.roll(ring, -1, axis=0)], axis=1)


def tube(diameters: tuple[float, float], low: float, high: float, *, closed: tuple[bool, bool]) -> FloatArray:
    """A round tube about z between two heights, with the diameters there; `closed`: by discs at low, at high."""
    r0, r1 = diameters[0] / 2, diameters[1] / 2
    ends = [_disc(r, z) for r, z, shut in ((r0, low, closed[0]), (r1, high, closed[1])) if shut]
    return np.concatenate([revolve([(r0, low), (r1, high)]), *ends])


def rectangle(axis: int, center: npt.ArrayLike, size: tuple[float, float]) -> FloatArray:
    """Two triangles across an axis; `size` along the two other axes, in the order x, y, z."""
    first, second = (k for k in range(3) if k != axis)
    corner = np.tile(np.asarray(center, float), (4, 1))
    corner[:, first] += np.array([-1, 1, 1, -1]) * size[0] / 2
    corner[:, second] += np.array([-1, -1, 1, 1]) * size[1] / 2
    return np.stack([corner[[0, 1, 2]], corner[[0, 2, 3]]])


def box(limits: Sequence[float], *, without: Collection[str] = ()) -> FloatArray:
    """The faces ("-x", "+z") of a room xlo xhi ylo yhi zlo zhi [m]."""
    low, high = np.array(limits[0::2]), np.array(limits[1::2])
    parts = []
    for face in sorted({sign + axis for sign in "-+" for axis in "xyz"} - {*without}):
        axis, center = "xyz".index(face[1]), 0.5 * (low + high)
        center[axis] = (low if face[0] == "-" else high)[axis]
        first, second = np.delete(high - low, axis)
        parts.append(rectangle(axis, center, (first, second)))
    return np.concatenate(parts)


SMALLEST_ANGLE = math.radians(0.52)  # of a triangle: LIGGGHTS refuses sharper ones
MERGED = 9  # digits of the size of a mesh within which corners are one


def _read(path: Path, place: str) -> FloatArray:
    import trimesh

    raw = path.read_bytes()
    count = int.from_bytes(raw[80:84], "little")
    if len(raw) != 84 + 50 * count:  # not a binary file, so it must be a text
        raw = raw.lower()  # as some programs write it in capitals
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
    if not len(triangles):
        raise CaseError(f"{place} = '{path}': no triangles, or a text without 'endsolid' at its end; export it anew")
    if (bad := np.flatnonzero(~np.isfinite(triangles).all(axis=(1, 2)))).size:
        raise CaseError(f"{place} = '{path}': triangle {bad[0] + 1} has corners that are not numbers; export it anew")
    return triangles


def _at(point: FloatArray) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in point) + ") m"


def _refuse_faults(w: StlWall, triangles: FloatArray, place: str) -> None:
    """Raise CaseError for triangles that no engine takes, with their number and the place of the first."""
    import trimesh

    sharpest = trimesh.triangles.angles(triangles).min(axis=1)  # type: ignore[no-untyped-call]  # 0 where two corners are one
    sharp = np.flatnonzero(sharpest < SMALLEST_ANGLE)
    if sharp.size:
        where = _at(triangles[sharp[0]].mean(axis=0))
        raise CaseError(
            f"{place}: {sharp.size} degenerate triangles (an angle below {math.degrees(SMALLEST_ANGLE):.2f} deg), the "
            f"first is number {sharp[0] + 1} at {where}; repair the mesh"
        )
    size = float(np.ptp(triangles.reshape(-1, 3), axis=0).max())
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(triangles / size), process=False)  # type: ignore[no-untyped-call]
    mesh.merge_vertices(digits_vertex=MERGED)
    edges, corners = mesh.edges, size * mesh.vertices
    undirected, counts = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    directed, repeated = np.unique(edges, axis=0, return_counts=True)
    flipped = "neighbouring triangles are flipped against each other"
    for bad, known, said in (
        (counts > 2, undirected, "{} edges belong to more than two triangles, one at {}; repair the mesh"),
        (repeated > 1, directed, f"{flipped} at {{}} edges, one at {{}}; make their normals consistent"),
        ((counts == 1) & w.closed, undirected, "open along {} edges, one at {}; close the mesh, or remove 'closed'"),
    ):
        if bad.any():
            raise CaseError(f"{place}: {said.format(bad.sum(), _at(corners[known[bad][0]].mean(axis=0)))}")


def place_stl(w: StlWall, room: tuple[float, ...], largest: float) -> FloatArray:
    """The triangles of an STL wall in the room xlo xhi ylo yhi zlo zhi [m], shape (n, 3, 3).

    largest: of the radii [m], against which the size is checked. Raises CaseError for an invalid wall mesh.
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


def _triangles(w: MeshWall, room: Limits, largest: float) -> FloatArray:
    match w:
        case PlateWall():
            first, second = w.size
            return rectangle("xyz".index(w.axis), np.array(w.center), (first, second))
        case BoxWall():
            return box((*w.x, *w.y, *w.z), without=w.open)
        case CylinderWall() | ConeWall():
            closed = ("from" in w.ends, "to" in w.ends)
            upright = tube(w.diameters_of_ends(), w.start, w.to, closed=closed)
            turned: FloatArray = orient("xyz".index(w.axis), upright) + np.array(w.axis_point)
            return turned
        case RevolvedWall():
            surface: FloatArray = revolve(w.profile) + np.array([*w.center, 0.0])
            return surface
        case StlWall():
            return place_stl(w, room, largest)
    raise AssertionError(w)


def triangles(scene: Parts) -> dict[str, FloatArray]:
    """The triangles of each wall that is not a plane. Raises CaseError for an invalid wall mesh."""
    largest = max(p.radii()[1] for p in scene.filled)
    room = scene.room.limits
    return {w.name: _triangles(w, room, largest) for w in scene.wall if isinstance(w, MeshWall)}


def sheet(plane: PlaneWall, room: Limits) -> FloatArray:
    """A plane as two triangles as large as the room."""
    low, high, axis = np.array(room[0::2]), np.array(room[1::2]), "xyz".index(plane.axis)
    low[axis] = high[axis] = plane.at
    first, second = np.delete(high - low, axis)
    return rectangle(axis, (low + high) / 2, (first, second))


def spans(w: PlateWall, axis: str, box: Limits) -> bool:
    """Whether a plate is as wide as a box along an axis in its plane."""
    k = "xyz".index(axis)
    return dict(zip("xyz".replace(w.axis, ""), w.size, strict=True))[axis] >= (box[2 * k + 1] - box[2 * k]) * (1 - 1e-9)


def surface_rotation(w: MeshWall) -> RotateMove | None:
    """The rotation of the surface of a round wall, whose triangles stay where they are."""
    if not isinstance(w, CylinderWall | ConeWall) or not w.angular_velocity:
        return None
    axis = [float(axis == w.axis) for axis in "xyz"]
    return RotateMove.model_construct(
        wall=w.name, kind="rotate", axis=axis, origin=w.axis_point, rate=w.angular_velocity
    )


def under_way(
    phases: Iterable[tuple[Mapping[str, Move], float]], points: Mapping[str, FloatArray]
) -> Iterator[tuple[int, str, Move, float, FloatArray]]:
    """(number of the phase, wall, motion, how long it has lasted [s] at the end of the phase, where it began [m]) of
    every wall that moves in `phases`, each with its motions and duration [s].

    A motion that goes on from phase to phase begins once. points: of each wall at the start, shape (n, 3) [m].
    """
    here = dict(points)
    begun: dict[str, tuple[Move, FloatArray, float]] = {}
    for number, (moves, duration) in enumerate(phases):
        begun = {name: x for name, x in begun.items() if moves.get(name) == x[0]}
        for name in (name for name in moves if name in here):
            move, begin, before = begun.get(name, (moves[name], here[name], 0.0))
            seconds = before + duration
            begun[name], here[name] = (move, begin, seconds), move.point_at(seconds, begin)
            yield number, name, move, seconds, begin


def at_end(
    phases: Sequence[tuple[Mapping[str, Move], float]], triangles: dict[str, FloatArray]
) -> dict[str, FloatArray]:
    """The triangles of each wall, shape (n, 3 corners, 3), after `phases`; without walls that a force drives."""
    found = {name: corners.reshape(-1, 3) for name, corners in triangles.items()}
    for _, name, move, seconds, begin in under_way(phases, found.copy()):
        found[name] = move.point_at(seconds, begin)
    return {name: points.reshape(-1, 3, 3) for name, points in found.items() if not np.isnan(points).any()}


def refuse_leaving(scene: Parts, triangles: dict[str, FloatArray]) -> None:
    """Raise CaseError for a wall whose motion takes the centre of a triangle out of the room.

    Walls that a force drives, and phases from the first with a condition on, are not checked.
    """
    room = scene.room.limits
    phases = [*takewhile(lambda phase: not phase.condition, scene.phase)]
    centers = {name: corners.mean(axis=1) for name, corners in triangles.items()}
    for number, name, move, seconds, begin in under_way([(x.moves, x.seconds) for x in phases], centers):
        for k, (axis, low, high) in enumerate(zip("xyz", *move.extent(seconds, begin), strict=True)):
            if low < room[2 * k] or high > room[2 * k + 1]:
                reached = high if high > room[2 * k + 1] else low
                raise CaseError(
                    f"scene.phase.{phases[number].name}.move: wall {name} leaves scene.room, the centre of a triangle "
                    f"reaches {axis} = {reached:.4g} m and the room is from {room[2 * k]:g} m to "
                    f"{room[2 * k + 1]:g} m; shorten its way, or enlarge the room"
                )


def stl_text(name: str, triangles: FloatArray) -> str:
    """An STL solid of triangles, shape (n, 3 corners, 3 coordinates) [m].

    Corners keep 13 digits, the same ones wherever a corner is repeated: neighbours share them exactly.
    """
    a, b, c = np.moveaxis(triangles, 1, 0)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    corners = 3 * ("  vertex" + 3 * " %.12e" + "\n")
    facet = "facet normal" + 3 * " %.9e" + f"\n outer loop\n{corners} endloop\nendfacet\n"
    rows = np.concatenate([normals[:, None], triangles], axis=1).reshape(-1, 12).tolist()
    return f"solid {name}\n{''.join(facet % tuple(row) for row in rows)}endsolid {name}\n"
