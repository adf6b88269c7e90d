# SPDX-License-Identifier: GPL-2.0-or-later
"""What a planned scene probably does not mean: sentences for warnings."""

import numpy as np

from ..case.parts import Parts
from .plan import ScenePlan

MOVED, LONGER = 0.02, 0.2  # by which share a phase may miss its duration: one in which walls move, another one
OVERLAP = 0.05  # of the smaller radius; a bed of an earlier run has less


def planned_doubts(p: ScenePlan) -> list[str]:
    """A sentence for each."""
    return _phases(p) + _overlaps(p)


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
    i, j = cKDTree(places).query_pairs(2 * radius.max(), output_type="ndarray").T
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
