# SPDX-License-Identifier: GPL-2.0-or-later
"""The dumps of impacts and the tables of a scene from LAMMPS's files. Only this module reads their formats."""

from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from ...base.rendering import wall_id
from ...errors import EngineError
from ...impacts import engine as impacts
from ...impacts.engine import Trajectory
from ...impacts.plan import Plan
from ...scenes.plan.plan import ScenePlan
from ...scenes.tables import columns
from .. import log
from ..frames import Frames, Kinds, text_frame
from ..input_script import torque_origin
from .deck import END, PATH, contact_walls
from .launcher import OUT

TRIANGLES = ("triangle", "area", "normal_stress", "shear_stress", "wear")  # columns of compute triangles/ep


def impact_frames(path: Path, frames: int, bodies: int) -> np.ndarray:
    """A dump without headers and ids, shape (frames, bodies, columns - 1). Raises EngineError if it is incomplete."""
    try:
        return np.array(path.read_text(encoding="utf-8").split(), float).reshape(frames, bodies, -1)[:, :, 1:]
    except (OSError, ValueError) as error:
        raise EngineError(f"{path}: the run left an incomplete dump ({error}); see {OUT} beside it") from None


def trajectory(plan: Plan, folder: Path, seconds: dict[str, float]) -> Trajectory:
    """Overlap, force and approach velocity from the dumps of impacts. Raises EngineError if samples are missing."""
    path = np.moveaxis(impact_frames(folder / PATH, plan.steps + 1, plan.spheres), 2, 0)
    place, velocity, force = path.reshape(3, -1, *path.shape[1:])
    vx, spin = impact_frames(folder / END, 2, plan.spheres)[-1].T if plan.experiment.oblique else (None, None)
    return impacts.trajectory(plan, place, velocity, force, seconds, vx, spin)


def rows(p: ScenePlan, out: Path) -> pd.DataFrame:
    """The thermo rows. LAMMPS's fixes have the force on the spheres, and torques about the origin of coordinates."""
    found = log.scene_rows(p, out, on_spheres=p.measured_walls)
    for name in (n for n in p.measured_walls if n in p.scene.meshes):
        force = found[[f"{name}_{load}" for load in columns.LOADS[:3]]].to_numpy()
        found[[f"{name}_{load}" for load in columns.LOADS[3:]]] -= np.cross(torque_origin(p, name), force)
    return found


def kinds(p: ScenePlan) -> Kinds:
    """The files of frames: spheres, contacts between them, and with each wall."""
    values = ["overlap", "delta_max", "attached", *[*columns.GROWTH] * p.model.compaction, *columns.FORCE]
    found = {"particles": (p.frame_steps(p.frames), columns.columns_of_frames(p))} if p.frames else {}
    if p.contacts:
        steps, of_wall = p.frame_steps(p.contacts), ["i", *values, *columns.NORMAL]
        found["contacts"] = steps, ["i", "j", *values]
        found |= {f"contacts_{wall_id(name)}": (steps, of_wall) for name in contact_walls(p)}
        gates = {w.name: p.frame_steps_with(w.name, p.contacts) for w in p.scene.gates}
        found |= {f"contacts_{wall_id(name)}": (own, of_wall) for name, own in gates.items() if own}
    files: Kinds = {
        k: (f"{k}.{{}}.txt", steps, partial(text_frame, names=names)) for k, (steps, names) in found.items()
    }
    for name in p.stress_walls:
        file = f"stress_{wall_id(name)}.{{}}.txt"
        files[f"stress_{name}"] = file, p.frame_steps(p.frames), partial(text_frame, names=[*TRIANGLES])
    return files


def contacts(frames: Frames, spheres: pd.DataFrame) -> list[pd.DataFrame]:
    """Every contact of every frame."""
    found = [frames.table("contacts").assign(wall="")]
    for name in (w.name for w in frames.plan.scene.wall):
        if (kind := f"contacts_{wall_id(name)}") in frames.kinds:
            found.append(frames.table(kind).assign(wall=name, j=0))
    return found
