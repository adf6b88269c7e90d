# SPDX-License-Identifier: GPL-2.0-or-later
"""The energy balance of stiff bulk scenes."""

from pathlib import Path

import numpy as np
import pandas as pd

from ...base.declarations import declarations
from .assembly import Assembly, AssemblyPlan, ContactFrame
from .assembly_liggghts import LiggghtsAssemblies
from .two_walls import stored

FRAMES = 40


def _elastic(scene: Assembly, kind: np.ndarray, contacts: ContactFrame, *, plates: bool) -> float:
    """Elastic energy [J] in the contacts of a frame; kind: types of the spheres, shape (n,)."""
    types = kind[contacts.spheres]
    if plates:
        types = np.hstack([types, np.ones_like(types)])
    energy = 0.0
    for i, j in {(int(i), int(j)) for i, j in types}:
        theory, here = scene.theory(i, j, plate=plates), (types == (i, j)).all(axis=1)
        top = contacts.overlap_max[here]
        energy += float((stored(theory, contacts.overlap[here], top) - theory.plastic_work(top)).sum())
    return energy


def energy_balance(plan: AssemblyPlan, tool: LiggghtsAssemblies, folder: Path) -> pd.DataFrame:
    """Energies at every frame [J]: kinetic, elastic (theory's, from overlap and memory of each contact), plastic (what
    the engine has booked), brought in by the plate; no term is the remainder. `total` is their sum.
    """
    scene, moved = plan.assembly, plan.assembly.plate_speed > 0
    memory = declarations()[scene.law].memory
    rows, brought = [], 0.0
    push = tool.pushes(folder) if moved else {}
    for k, frame in enumerate(tool.frames(folder)):
        step, kind = k * plan.every, frame[:, 0].astype(int)
        kinetic = 0.5 * scene.mass * float((frame[:, 4:7] ** 2).sum())
        elastic = sum(
            _elastic(scene, kind, tool.contacts(plan, folder, step, plates=plates), plates=plates)
            for plates in ((False, True) if moved else (False,))
        )
        if k and moved:
            # trapezoids: the mean is over the steps since the last frame, the two ends count half
            ends = 0.5 * (push[step][1] - push[step - plan.every][1])
            brought += (push[step][0] * plan.every - ends) * scene.plate_speed * plan.time_step
        rows.append(
            {
                "step": step,
                "spheres": len(frame),
                "kinetic": kinetic,
                "elastic": elastic,
                "plastic": float(frame[:, 7].sum()) if memory else 0.0,
                "brought": brought,
            }
        )
    table = pd.DataFrame(rows)
    table["total"] = table["kinetic"] + table["elastic"] + table["plastic"] - table["brought"]
    return table
