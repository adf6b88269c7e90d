# SPDX-License-Identifier: GPL-2.0-or-later
"""Limits of a scene: a scene beyond them is refused before anything starts."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ...case.motions import FloatArray
from ...case.parts import FileFill, Parts, Sphere
from ...case.scene import SceneCase
from ...case.walls import ConeWall, CylinderWall, MeshWall
from ...errors import CaseError, EngineError
from . import meshes
from .timestep import highest_speed

if TYPE_CHECKING:
    from .plan import ScenePlan

IntArray = npt.NDArray[np.int64]
Named = list[tuple[str, Sphere]]  # the name of a sphere in messages, the sphere
TOUCH = 1e-6  # of a radius: overlap up to which a body that comes only touches
MOST_STEPS = 2_000_000_000  # engines count steps in 32 bits


def refuse_faster_than_sound(case: SceneCase) -> None:
    """Raise CaseError for speeds above sqrt(E/rho) of a material: overlaps would exceed the radii."""
    v = highest_speed(case)
    names = {p.material for p in case.parts.filled}
    sounds = {name: math.sqrt(case.materials[name].young_modulus / case.materials[name].density) for name in names}
    name = min(sounds, key=lambda n: (sounds[n], n))
    if v > sounds[name]:
        raise CaseError(
            f"scene: speeds reach {v:.3g} m/s, faster than sound in {name} (sqrt(E/rho) = {sounds[name]:.3g} m/s); "
            "check the units of lengths, speeds, gravity and young_modulus, or give numerics.highest_speed"
        )


def refuse_steps(case: SceneCase, rows: int, duration: float, dt: float) -> None:
    """Raise CaseError for more steps than an engine counts, or fewer than rows."""
    steps = duration / dt
    if steps > MOST_STEPS:
        raise CaseError(
            f"scene: {duration:g} s are {steps:.3g} steps of {dt:g} s, at most {MOST_STEPS:g}; "
            "shorten the duration, or check its unit"
        )
    if rows > max(1.0, steps):
        raise CaseError(
            f"output.rows: {rows} rows (a multiple of output.particles), and the {duration:g} s of the run have only "
            f"{steps:.3g} steps of {dt:g} s; give fewer rows, or a longer duration"
        )


def refuse_outside(s: Parts, triangles: dict[str, FloatArray]) -> None:
    """Raise CaseError for regions and walls beyond the room."""
    low, high = np.array(s.room.limits[0::2]), np.array(s.room.limits[1::2])
    for f in s.random_fills:
        limits = np.array(f.region.limits)
        if (limits[0::2] < low).any() or (limits[1::2] > high).any():
            raise CaseError(
                f"scene.fill.{f.name}.region reaches beyond scene.room; make it smaller, or enlarge the room"
            )
    for name, corners in triangles.items():
        if (corners < low).any() or (corners > high).any():
            raise CaseError(f"scene.wall.{name}: reaches beyond scene.room; enlarge the room, or make the wall smaller")


def refuse_walls_at_faces(s: Parts, triangles: dict[str, FloatArray]) -> None:
    """Raise CaseError for flat walls that spheres would touch through a face of a periodic room: planes across an axis
    along which the room repeats, and triangles parallel to a face and nearer to it than the largest radius.

    No host lets walls act through a face.
    """
    largest = max(p.radii()[1] for p in s.filled)
    for k, axis in enumerate("xyz"):
        if not s.periods[k]:
            continue
        walls = [w.name for w in (*s.planes, *s.gates) if w.axis == axis]
        for name, corners in triangles.items():
            along = corners[..., k]
            near = np.abs(along[:, :1] - s.room.limits[2 * k : 2 * k + 2]).min(axis=1) < largest
            if (near & (np.ptp(along, axis=1) < 1e-9 * s.periods[k])).any():
                walls.append(name)
        for name in walls:
            raise CaseError(
                f"scene.wall.{name}: a wall across {axis}, along which the room repeats, so that spheres would touch "
                f"it through a face; remove the wall, or let the room repeat along {'xy'.replace(axis, '')} alone, "
                f"scene.periodic = {'xy'.replace(axis, '')!r}"
            )


def refuse_currents(case: SceneCase, s: Parts) -> None:
    """Raise CaseError for potentials that give no current."""
    walls = {w.name: w for w in s.wall if w.potential is not None}
    if not walls:
        return
    name = next(iter(walls))
    if len({w.potential for w in walls.values()}) < 2:
        raise CaseError(
            f"scene.wall.{name}.potential: no other wall has another potential, so no current flows; give one"
        )
    if not (case.output.contacts or case.output.energy):
        raise CaseError(f"scene.wall.{name}.potential: currents follow from the contacts; give output.contacts")
    for material in dict.fromkeys([*(x.material for x in s.filled), *(w.material for w in walls.values())]):
        if case.materials[material].electrical_conductivity is None:
            raise CaseError(f"materials.{material}.electrical_conductivity is missing: wall {name} has a potential")


def refuse_combinations(case: SceneCase, s: Parts) -> None:
    """Raise CaseError for parts that exclude each other."""
    if case.measured and not s.stages:
        raise CaseError("measured: relative densities under pressure belong to a press; remove it, or take kind press")
    refuse_currents(case, s)
    gates = {w.name for w in s.gates}
    for phase in s.phase:
        if phase.until and phase.until.force is not None and phase.until.wall in gates:
            raise CaseError(
                f"scene.phase.{phase.name}.until.wall: {phase.until.wall} is a wall of some phases; name another one"
            )
    moves = [(name, move) for phase in s.phase for name, move in phase.moves.items()]
    pressed = {name for name, move in moves if move.press}
    if both := {name for name, move in moves if name in pressed and not move.press}:
        raise CaseError(f"scene.wall.{min(both)}: a wall that a force drives has no other motion; take a second wall")
    for row in s.row:
        if row.position and row.wall in pressed:
            raise CaseError(
                f"scene.row.{row.name}: a force drives wall {row.wall}, and rows do not know its place; remove the row"
            )
    turning = {w.name for w in s.wall if isinstance(w, CylinderWall | ConeWall) and w.angular_velocity}
    if both := pressed & turning:
        raise CaseError(
            f"scene.wall.{min(both)}: a wall that a force drives has no angular_velocity; remove one of both"
        )
    for w in s.wall:
        if not isinstance(w, MeshWall):
            continue
        if (w.stress or w.wear) and not case.output.particles:
            raise CaseError(f"scene.wall.{w.name}: stress and wear are written with the frames; give output.particles")


def overlaps(spheres: Sequence[Sphere], s: Parts) -> tuple[IntArray, IntArray, FloatArray]:
    """(i, j, overlap over the smaller radius) of the pairs of spheres of a scene that overlap, except pairs of frozen
    ones; in a periodic room also through its faces.

    If centres lie in other spheres, only the nearest neighbours are found: a table of one position has too many pairs.
    """
    if len(spheres) < 2:
        return np.zeros(0, int), np.zeros(0, int), np.zeros(0)
    from scipy.spatial import cKDTree  # slow to import

    low = np.array([s.room.x[0], s.room.y[0], 0.0])
    period = np.array(s.periods)
    positions = np.array([x.place for x in spheres])
    positions[:, period > 0] = ((positions - low) % np.where(period > 0, period, 1.0))[:, period > 0]
    radius = np.array([x.radius for x in spheres])
    frozen = np.array([x.frozen for x in spheres])
    every = np.arange(len(spheres))

    def found(i: IntArray, j: IntArray) -> tuple[IntArray, IntArray, FloatArray]:
        way = positions[i] - positions[j]
        way -= period * np.round(way / np.where(period > 0, period, np.inf))
        distance = np.linalg.norm(way, axis=1)
        share = (radius[i] + radius[j] - distance) / np.minimum(radius[i], radius[j])
        chosen = (share > 0) & ~(frozen[i] & frozen[j])
        return i[chosen], j[chosen], share[chosen]

    _, first, group = np.unique(positions, axis=0, return_index=True, return_inverse=True)
    again = every[first[group.ravel()] != every]  # a tree takes minutes for many spheres at one position
    same = found(first[group.ravel()[again]], again)
    if len(same[0]):
        return same
    tree = cKDTree(positions, boxsize=period if s.periodic else None)
    two = tree.query(positions, k=2)[1]  # of spheres at one position itself and another one, in any order
    nearest = found(every, np.where(two[:, 0] == every, two[:, 1], two[:, 0]))
    if (nearest[2] >= 1.0).any():
        return nearest
    around = tree.query_ball_point(positions, 2.0 * radius)  # of two spheres the larger one finds the other
    i = np.repeat(every, [len(x) for x in around])
    j = np.concatenate([np.asarray(x, int) for x in around])
    once = (radius[j] < radius[i]) | ((radius[j] == radius[i]) & (i < j))
    return found(i[once], j[once])


def _by_phase(s: Parts) -> list[Named]:
    """The spheres with given positions, in the order of `Parts.table`, by the phase with which they come."""
    first = s.phase[0].name
    files = [f for f in s.fill if isinstance(f, FileFill)]
    groups = {first: [(f"scene.fill.{f.name}, sphere {n}", x) for f in files for n, x in enumerate(f.spheres, 1)]}
    for body in s.body:
        groups.setdefault(body.phase or first, []).append((f"scene.body.{body.name}.position", body.sphere))
    return [*groups.values()]


def refuse_positions(s: Parts) -> None:
    """Raise CaseError for a sphere outside of the room or on its limit, for one whose centre lies in another one, and
    for spheres of a later phase that overlap.

    Engines lose the former and divide by zero for the latter. A periodic room has no limits where it repeats.
    """
    limits = s.room.limits
    sides = [*zip(limits[0::2], limits[1::2], strict=True)]
    first, *later = _by_phase(s)
    for group in (first, *later):
        for name, x in group:
            inside = all(
                low < v < high or (period and low <= v <= high)
                for v, (low, high), period in zip(x.place, sides, s.periods, strict=True)
            )
            if not inside:
                raise CaseError(
                    f"{name}: {tuple(x.place)} m lies beyond scene.room or on its limit; move it, or enlarge the room"
                )
        i, j, share = overlaps([x for _, x in group], s)
        most = 1.0 if group is first else TOUCH  # what comes later begins without energy of its own
        if len(share) and share.max() >= most:
            worst = int(share.argmax())
            one, other = group[max(i[worst], j[worst])][0], group[min(i[worst], j[worst])][0]
            raise CaseError(
                f"{one}: overlaps {other} by {share[worst]:.0%} of the smaller radius as they come, must be "
                f"{'below 100 %' if group is first else '0'}; move one of them"
            )


def depths(triangles: FloatArray, places: FloatArray, radii: FloatArray) -> FloatArray:
    """How far [m] the nearest of the triangles, shape (n, 3 corners, 3), lies in each sphere; below 0: it does not.

    places: centres, shape (m, 3), radii: shape (m,).
    """
    found = np.full(len(radii), -np.inf)
    low, high = places - radii[:, None], places + radii[:, None]
    beside = (triangles.min(axis=1) > high.max(axis=0)) | (triangles.max(axis=1) < low.min(axis=0))
    for triangle in triangles[~beside.any(axis=1)]:
        near = np.flatnonzero(((triangle.min(axis=0) <= high) & (triangle.max(axis=0) >= low)).all(axis=1))
        if near.size:
            import trimesh  # a second: only where a wall is near

            same = np.tile(triangle, (near.size, 1, 1))
            closest = trimesh.triangles.closest_point(same, places[near])  # type: ignore[no-untyped-call]
            found[near] = np.maximum(found[near], radii[near] - np.linalg.norm(closest - places[near], axis=1))
    return found


def _in_wall(s: Parts, phase: str, walls: Mapping[str, FloatArray]) -> str | None:
    """A sentence on a single sphere that comes into a wall with a phase; None: none does. walls: triangles [m] then."""
    planes = [w for w in (*s.planes, *s.gates) if not w.phases or phase in w.phases]
    for b in (b for b in s.later if b.phase == phase):
        center = np.array(b.position)
        found = {w.name: b.radius - abs(center["xyz".index(w.axis)] - w.at) for w in planes}
        for name, corners in walls.items():
            found[name] = float(depths(corners, center[None], np.array([b.radius]))[0])
        for name, depth in found.items():
            if depth > TOUCH * b.radius:
                return (
                    f"scene.body.{b.name}.position: at the begin of phase {phase} the body overlaps wall {name} by "
                    f"{depth:.3g} m; move the body, or give it another phase"
                )
    return None


def refuse_bodies_in_walls(s: Parts, triangles: dict[str, FloatArray]) -> None:
    """Raise CaseError for a single sphere that comes into a wall with a phase but the first.

    A wall whose place at that time the run alone knows is left to `refuse_bodies_in_moved_walls`: one that a force
    drives, or that has moved in a phase with a condition.
    """
    for number, phase in enumerate(s.phase):
        before = [(p.moves, p.seconds) for p in s.phase[:number]]
        unknown = {name for p in s.phase[:number] if p.condition for name in p.moves}
        known = {name: x for name, x in triangles.items() if name not in unknown} if s.later else {}
        if said := _in_wall(s, phase.name, meshes.at_end(before, known)):
            raise CaseError(said)


def refuse_bodies_in_moved_walls(p: "ScenePlan", ways: Mapping[tuple[str, str], FloatArray]) -> None:
    """Raise EngineError for the same of a plan of a run. ways: (phase, wall) that a force drives, way [m] before it."""
    for phase in p.phase_steps if p.scene.later else ():
        walls = meshes.at_end(p.motions_until(phase.end - phase.steps), p.triangles)
        walls |= {wall: p.triangles[wall] + way for (name, wall), way in ways.items() if name == phase.name}
        if phase.steps and (said := _in_wall(p.scene, phase.name, walls)):
            raise EngineError(said)
