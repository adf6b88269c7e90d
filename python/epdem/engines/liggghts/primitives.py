# SPDX-License-Identifier: GPL-2.0-or-later
"""Walls that LIGGGHTS has as a formula, planes and endless cylinders, and the sums of the forces on all walls."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from ...base.rendering import number, wall_id
from ...case.walls import CylinderWall, PlaneWall
from ...scenes.plan.plan import ScenePlan
from ..input_script import torque_origin

WIDE = 3.0  # radius of a cylinder over the largest radius of a sphere: LIGGGHTS divides by zero on the axis


@dataclass(frozen=True)
class Primitive:
    """style: with its numbers. force: LIGGGHTS stores the force of each sphere on it."""

    id: str
    style: str
    type: int
    force: bool


@dataclass(frozen=True)
class WallLoad:
    """The force on a wall in the rows, of number `number`, and the torque, of all but planes.

    mesh: LIGGGHTS sums both. variables: (name, formula), of which the last three are the torque: of each sphere, and of
    a mesh that moves from its place.
    """

    number: int
    id: str
    mesh: bool
    couple: bool = False  # the torque of rolling friction on each sphere is in the formulas
    variables: tuple[tuple[str, str], ...] = ()


def tubes(p: ScenePlan) -> dict[str, CylinderWall]:
    """The cylinders that LIGGGHTS has as a formula: at rest, as long as the room, wide, without results per triangle.

    A sphere that slides along the triangles of a round wall begins a new contact at each edge.
    """

    def fits(w: CylinderWall) -> bool:
        k = 2 * "xyz".index(w.axis)
        spans = w.start <= p.box[k] and w.to >= p.box[k + 1]
        plain = not (w.ends or w.angular_velocity or w.stress or w.wear)
        moves = any(w.name in phase.moves for phase in p.phases)
        return spans and plain and not moves and w.diameter > 2.0 * WIDE * p.largest

    return {name: w for name, w in p.scene.meshes.items() if isinstance(w, CylinderWall) and fits(w)}


def walls(p: ScenePlan) -> list[PlaneWall | CylinderWall]:
    """The walls that are a formula and always there."""
    return [*p.scene.planes, *tubes(p).values()]


def primitive(p: ScenePlan, w: PlaneWall | CylinderWall, *, force: bool = False) -> Primitive:
    """A wall in words of LIGGGHTS."""
    if isinstance(w, PlaneWall):
        style = f"{w.axis}plane {number(w.at)}"
    else:
        k = "xyz".index(w.axis)
        centre = [w.axis_point[(k + way) % 3] for way in (1, 2)]
        style = f"{w.axis}cylinder {' '.join(map(number, (0.5 * w.diameter, *centre)))}"
    return Primitive(wall_id(w.name), style, p.wall_types[w.name], force)


def primitives(p: ScenePlan) -> tuple[Primitive, ...]:
    """The walls that are a formula and always there, in words of LIGGGHTS."""
    return tuple(primitive(p, w, force=w.name in p.measured_walls or bool(p.contacts)) for w in walls(p))


def loads(p: ScenePlan) -> tuple[WallLoad, ...]:
    """The sums of the forces on the walls that the rows name."""
    round_ = tubes(p)
    found = []
    for n, name in enumerate(p.measured_walls, 1):
        mesh = name in p.scene.meshes and name not in round_
        moved = zip("xyz", torque(p, name), strict=True) if mesh and _leaves(p, name) else ()
        variables = tuple((f"torque_{axis}_{name}", formula) for axis, formula in moved)
        couple = name in round_ and p.model.rolling is not None
        variables = variables or _torque_of_tube(n, round_.get(name), couple=couple)
        found.append(WallLoad(n, wall_id(name), mesh, couple, variables))
    return tuple(found)


def _leaves(p: ScenePlan, name: str) -> bool:
    """Whether a mesh moves otherwise than about its one axis, so that LIGGGHTS takes the point of its torque along."""
    return any(name in phase.moves and not phase.moves[name].rotation for phase in p.phases)


def torque(p: ScenePlan, name: str) -> list[str]:
    """Formulas of the torque on a mesh about the place of its torque."""
    f = [f"f_{wall_id(name)}[{k}]" for k in range(1, 10)]  # force, torque about a point, the point
    if not _leaves(p, name):
        return f[3:6]
    arm = [f"({at}-{number(o)})" for at, o in zip(f[6:], torque_origin(p, name), strict=True)]
    turns = [((k + 1) % 3, (k + 2) % 3) for k in range(3)]
    return [f"{f[3 + k]}+{arm[a]}*{f[b]}-{arm[b]}*{f[a]}" for k, (a, b) in enumerate(turns)]


def _torque_of_tube(n: int, w: CylinderWall | None, *, couple: bool) -> tuple[tuple[str, str], ...]:
    """Torque of the force on a sphere in the middle of its overlap with the cylinder, about the origin of the room, and
    with `couple` of rolling friction."""
    if w is None:
        return ()
    across = [x for x in "xyz" if x != w.axis]
    off = {x: f"({x}-{number(c)})" for x, c in zip("xyz", w.axis_point, strict=True)}
    least = (1e-9 * w.diameter) ** 2  # a sphere on the axis bears no force
    off_axis = f"sqrt({off[across[0]]}^2+{off[across[1]]}^2+{number(least)})"
    wide = number(0.5 * w.diameter)
    stretch = f"0.5+0.5*({wide}+r*(1-2*({off_axis}>{wide})))/{off_axis}"  # r: a sphere outside is on the other side
    place = [
        x if x == w.axis else f"({number(c)}+{off[x]}*v_stretch{n})" for x, c in zip("xyz", w.axis_point, strict=True)
    ]
    force = [f"f_force_{wall_id(w.name)}[{k}]" for k in (1, 2, 3)]
    turns = [((k + 1) % 3, (k + 2) % 3) for k in range(3)]
    torque = [f"{place[a]}*{force[b]}-{place[b]}*{force[a]}" for a, b in turns]
    if couple:
        torque = [f"{x}+f_couple_{wall_id(w.name)}[{k}]" for k, x in enumerate(torque, 1)]
    return ((f"stretch{n}", stretch), *((f"torque{n}_{k}", formula) for k, formula in enumerate(torque, 1)))


def overlaps(w: PlaneWall | CylinderWall, spheres: pd.DataFrame) -> tuple[np.ndarray, np.ndarray]:
    """Overlap [m] of each sphere with a wall without growth, and the normal from the wall to the sphere, (n, 3)."""
    x, radius = spheres[[*"xyz"]].to_numpy(float), spheres["radius"].to_numpy(float)
    off, k = np.zeros(x.shape), "xyz".index(w.axis)
    if isinstance(w, PlaneWall):
        off[:, k] = x[:, k] - w.at
    else:
        off = x - np.array(w.axis_point)
        off[:, k] = 0.0
        distance = np.linalg.norm(off, axis=1, keepdims=True)
        off *= 1.0 - 0.5 * w.diameter / np.where(distance > 0.0, distance, np.inf)
    gap = np.linalg.norm(off, axis=1, keepdims=True)
    return radius - gap[:, 0], off / np.where(gap > 0.0, gap, 1.0)
