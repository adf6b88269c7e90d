# SPDX-License-Identifier: GPL-2.0-or-later
"""What a planned scene probably does not mean: sentences for warnings."""

import numpy as np

from ..case.parts import Parts
from ..errors import CaseError
from . import shares
from .crossings import crosses, depths
from .layout import Plane
from .meshes import FloatArray, rectangle
from .plan import ScenePlan
from .timestep import stable_step

MOVED, LONGER = 0.02, 0.2  # by which share a phase may miss its duration: one in which walls move, another one
OVERLAP = 0.05  # of the smaller radius; a bed of an earlier run has less


def planned_doubts(p: ScenePlan) -> list[str]:
    """A sentence for each."""
    return shares.warnings(p.case, p.layout) + _time_steps(p) + _phases(p) + _overlaps(p) + _walls(p)


def _time_steps(p: ScenePlan) -> list[str]:
    """Given time steps with which not even a single contact is stable."""
    given = {"numerics.time_step": p.case.numerics.time_step}
    given |= {f"scene.phase.{stage.name}.time_step": stage.time_step for stage in p.layout.stages}
    if not (given := {place: step for place, step in given.items() if step}):
        return []
    try:
        stable = stable_step(p.case)
    except CaseError:  # no speed follows from the case
        return []
    return [
        f"{place} = {step:g} s: an impact at the scene's highest speed is stable up to {stable:.2g} s, a bed of "
        "spheres up to a quarter or a half of it; give less, or leave it out"
        for place, step in given.items()
        if step > stable
    ]


def _phases(p: ScenePlan) -> list[str]:
    """Phases that are longer or shorter than asked for, because they end with a row."""
    found = []
    for phase, stage in zip(p.phase_table.to_dict("records"), p.layout.stages, strict=True):
        seconds = phase["end_time"] - phase["begin_time"]
        if isinstance(p.case.scene, Parts) and abs(seconds / stage.seconds - 1.0) > (MOVED if stage.moves else LONGER):
            row = p.every * (stage.time_step or p.time_step)
            found.append(
                f"scene.phase.{stage.name} takes {seconds:.4g} s, not {stage.seconds:.4g} s: a phase ends with a row "
                f"(each {row:.2g} s) and the last one with a frame; give more output.rows"
            )
    return found


def _overlaps(p: ScenePlan) -> list[str]:
    """Spheres of a table that lie in each other at the start."""
    if len(p.layout.table) < 2:
        return []
    from scipy.spatial import cKDTree

    places = np.array([s.place for s in p.layout.table])
    radius = np.array([s.radius for s in p.layout.table])
    frozen = np.array([s.frozen for s in p.layout.table])
    i, j = cKDTree(places).query_pairs(2 * radius.max(), output_type="ndarray").T
    i, j = i[free := ~(frozen[i] & frozen[j])], j[free]
    share = (radius[i] + radius[j] - np.linalg.norm(places[i] - places[j], axis=1)) / np.minimum(radius[i], radius[j])
    if not (many := int((share > OVERLAP).sum())):
        return []
    worst = int(share.argmax())
    one, other = sorted((i[worst] + 1, j[worst] + 1))
    return [
        f"scene: {many} pairs of spheres overlap at the start by more than {OVERLAP:.0%} of the smaller radius, "
        f"spheres {one} and {other} of scene.fill and scene.body by {share[worst]:.0%}; check places and radii, or the "
        "bed begins with a burst"
    ]


def _sheet(p: ScenePlan, plane: Plane) -> FloatArray:
    """A plane as two triangles as large as the room."""
    low, high = np.array(p.layout.box[0::2]), np.array(p.layout.box[1::2])
    center, size = (low + high) / 2, np.delete(high - low, plane.axis)
    center[plane.axis] = plane.place
    return rectangle(plane.axis, center, (size[0], size[1]))


def _walls(p: ScenePlan) -> list[str]:
    """Regions that a wall runs through and spheres that lie in one, of walls that have not moved yet."""
    first, moved, found = p.layout.stages[0].name, set[str](), {}
    table = [(f"sphere {n} of scene.fill and scene.body", s, first) for n, s in enumerate(p.layout.table, 1)]
    table += [(f"scene.body.{b.name}", b.sphere, b.phase) for b in p.layout.bodies]
    for stage in p.layout.stages if isinstance(p.case.scene, Parts) else ():
        gates = [w for w in p.layout.gates if w.name in stage.gates]
        walls = {w.name: _sheet(p, w) for w in (*p.layout.planes, *gates)}
        walls |= {name: mesh.triangles for name, mesh in p.layout.meshes.items() if name not in moved}
        moved |= set(stage.moves)
        fills = [f for f in p.layout.fills if (f.phase or first) == stage.name]
        spheres = [(place, s) for place, s, phase in table if phase == stage.name and not s.frozen]
        places, radii = np.array([s.place for _, s in spheres]), np.array([s.radius for _, s in spheres])
        for name, triangles in walls.items():
            for f in fills:
                if crosses(f.region, triangles, OVERLAP * min(particles.radii()[0] for particles in f.parts)):
                    found[f.place, name] = f"{f.place}.region: wall {name} runs through it; move one of them"
            share = depths(triangles, places, radii) / radii if spheres else np.zeros(1)
            if share.max() > OVERLAP:
                place = spheres[int(share.argmax())][0]
                found["", name] = f"{place} lies in wall {name} by {share.max():.0%} of its radius; move it"
    return list(found.values())
