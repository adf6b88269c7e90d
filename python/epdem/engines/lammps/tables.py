# SPDX-License-Identifier: GPL-2.0-or-later
"""The dumps of impacts and the tables of a scene from LAMMPS's files. Only this module reads their formats."""

import math
from collections.abc import Collection
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from ...base.rendering import wall_id
from ...errors import EngineError
from ...impacts import engine as impacts
from ...impacts.engine import Trajectory
from ...impacts.plan import Plan
from ...scenes import columns
from ...scenes.plan import ScenePlan
from .. import log
from ..host import frames
from ..input_script import torque_origin
from .deck import END, PATH, contact_walls
from .launcher import OUT


def impact_frames(path: Path, frames: int, bodies: int) -> np.ndarray:
    """A dump without headers and ids, shape (frames, bodies, columns - 1). Raises EngineError if it is incomplete."""
    try:
        return np.array(path.read_text(encoding="utf-8").split(), float).reshape(frames, bodies, -1)[:, :, 1:]
    except (OSError, ValueError) as error:
        raise EngineError(f"{path}: the run left an incomplete dump ({error}); see {OUT} beside it") from None


def trajectory(plan: Plan, folder: Path, seconds: dict[str, float]) -> Trajectory:
    """Overlap, force and approach velocity from the dumps of impacts. Raises EngineError if samples are missing."""
    bodies = plan.n if math.isinf(plan.experiment.target.radius) else 2 * plan.n
    path = np.moveaxis(impact_frames(folder / PATH, plan.steps + 1, bodies), 2, 0)
    place, velocity, force = path.reshape(3, -1, *path.shape[1:])
    vx, spin = impact_frames(folder / END, 2, bodies)[-1].T if plan.experiment.oblique else (None, None)
    return impacts.trajectory(plan, place, velocity, force, seconds, vx, spin)


def rows(p: ScenePlan, out: Path) -> pd.DataFrame:
    """The thermo rows. LAMMPS's fixes have the force on the spheres, and torques about the origin of coordinates."""
    found = log.scene_rows(p, out, on_spheres=p.measured_walls)
    for name in (n for n in p.measured_walls if n in p.scene.meshes):
        force = found[[f"{name}_{load}" for load in columns.LOADS[:3]]].to_numpy()
        found[[f"{name}_{load}" for load in columns.LOADS[3:]]] -= np.cross(torque_origin(p, name), force)
    return found


def _frame(path: Path, names: list[str]) -> pd.DataFrame:
    """The table of a file. Raises OSError, ValueError if it is not whole."""
    lines = path.read_text(encoding="utf-8").split("\n")
    values = np.array(" ".join(lines).split(), float).reshape(-1, len(names))
    if len(lines) != len(values) + 1:
        raise ValueError(f"{len(lines) - 1} lines of {len(values)}")
    return pd.DataFrame(values, columns=names)


def _kinds(p: ScenePlan) -> dict[str, tuple[int, list[str]]]:
    """Steps between two frames and columns of each kind of file."""
    values = ["overlap", "delta_max", "attached", *columns.GROWTH * p.model.compaction, *columns.FORCE]
    kinds = {"particles": (p.frames, columns.columns_of_frames(p)), "contacts": (p.contacts, ["one", "two", *values])}
    for name in contact_walls(p):
        kinds[f"contacts_{wall_id(name)}"] = p.contacts, ["i", *values, *columns.NORMAL]
    return {kind: (every, names) for kind, (every, names) in kinds.items() if every}


def damaged(p: ScenePlan, folder: Path, upto: int) -> list[int]:
    """Steps up to `upto` of which a frame is missing or not whole."""
    steps = set()
    for kind, (every, names) in _kinds(p).items():
        for step in (n for n in p.frame_steps(every) if n <= upto):
            try:
                _frame(folder / f"{kind}.{step}.txt", names)
            except (OSError, ValueError):
                steps.add(step)
    return sorted(steps)


def _frames(p: ScenePlan, folder: Path, kind: str, without: Collection[int]) -> pd.DataFrame:
    every, names = _kinds(p)[kind]
    return frames(p, folder, f"{kind}.{{}}.txt", every, partial(_frame, names=names), without)


def particles(p: ScenePlan, folder: Path, without: Collection[int] = ()) -> pd.DataFrame:
    """Every sphere of every frame."""
    return columns.whole(p, _frames(p, folder, "particles", without), folder)


def contact_table(p: ScenePlan, folder: Path, spheres: pd.DataFrame, without: Collection[int] = ()) -> pd.DataFrame:
    """Every contact of every frame."""
    pairs = _frames(p, folder, "contacts", without)
    pairs.loc[pairs["one"] > pairs["two"], columns.FORCE] *= -1.0
    pairs = pairs.assign(wall="", i=pairs[["one", "two"]].min(axis=1), j=pairs[["one", "two"]].max(axis=1))
    across = pairs["added_overlap"] if p.model.compaction else 0.0
    found = [pairs[(pairs["overlap"] + across > 0) | (p.model.adheres & (pairs["attached"] > 0))]]
    for name in contact_walls(p):
        table = _frames(p, folder, f"contacts_{wall_id(name)}", without)
        found.append(table.assign(wall=name, j=0))
    raw = pd.concat([part for part in found if len(part)] or found[:1], ignore_index=True)
    raw = raw.assign(attached=raw["attached"] > 0) if p.model.adheres else raw.drop(columns="attached")
    return columns.complete(p, raw, spheres, folder)
