# SPDX-License-Identifier: GPL-2.0-or-later
"""The trajectory of impacts and the tables of a scene from YADE's files. Only this module reads their formats."""

from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from ...errors import EngineError
from ...impacts import engine as impacts
from ...impacts.engine import Trajectory
from ...impacts.plan import Plan
from ...scenes.plan.plan import ScenePlan
from ...scenes.tables import columns
from .. import log
from ..frames import Frames, Kinds
from .deck import axes
from .launcher import OUT
from .scene_parts import wall_names

# of a contact: number of the sphere and of the other body (from 0; walls after the spheres), overlaps [m], whether the
# bodies are attached, force on the first [N], unit normal; with compaction what growth adds
CONTACT = ["i", "j", "overlap", "delta_max", "attached", *columns.FORCE, *columns.NORMAL, *columns.GROWTH]


def trajectory(plan: Plan, folder: Path, seconds: dict[str, float]) -> Trajectory:
    """Overlap, force, approach velocity from z, v_z, F_z of every body. Raises EngineError if samples are missing."""
    path = folder / "path.bin"
    expected = (plan.steps + 2, 3, len(axes(plan)), plan.spheres)
    tangential = spin = None
    try:
        with path.open("rb") as file:
            samples = np.load(file)
            if plan.experiment.oblique:
                tangential, spin = np.load(file)
        if samples.shape != expected or not np.isfinite(samples).all():
            raise ValueError(f"{samples.shape} samples, expected {expected}, all finite")
    except (OSError, ValueError) as error:
        raise EngineError(f"{path}: the run left no complete result ({error}); see {OUT} beside it") from None
    place, before, force = np.moveaxis(samples, 0, 2)
    place, force, velocity = place[:, :-1], force[:, :-1], 0.5 * (before[:, :-1] + before[:, 1:])
    return impacts.trajectory(plan, place, velocity, force, seconds, tangential, spin)


def kinds(p: ScenePlan) -> Kinds:
    """The files of frames: spheres and contacts."""
    found = {
        "particles": (p.frames, columns.columns_of_frames(p)),
        "contacts": (p.contacts, CONTACT if p.model.compaction else CONTACT[:11]),
    }
    return {
        kind: (f"{kind}.{{}}.npy", p.frame_steps(every), partial(_frame, p, names))
        for kind, (every, names) in found.items()
        if every
    }


def _frame(p: ScenePlan, names: list[str], path: Path) -> pd.DataFrame:
    table = pd.DataFrame(np.load(path), columns=names)
    if "overlap" in names:
        table["delta_max"] = table["delta_max"].fillna(table["overlap"])  # of a law without history
        return table
    for axis, low, period in zip("xyz", p.box[0::2], p.scene.periods, strict=True):
        if period:  # YADE does not put back what leaves its periodic cell
            table[axis] = (table[axis] - low) % period + low
    return table


def rows(p: ScenePlan, out: Path) -> pd.DataFrame:
    """The rows that a run printed. Raises EngineError."""
    return log.scene_rows(p, out)


def contacts(frames: Frames, spheres: pd.DataFrame) -> list[pd.DataFrame]:
    """Every contact of every frame."""
    p, raw, folder = frames.plan, frames.table("contacts"), frames.folder
    walls = np.array(["", *wall_names(p)])
    last = p.count + len(walls) - 2
    bodies = raw[["i", "j"]].to_numpy(float)
    if not ((bodies >= 0) & (bodies <= last) & (bodies == np.floor(bodies))).all():
        raise EngineError(f"{folder}: the contacts name bodies beyond the {last + 1} of the scene; run the case again")
    raw = raw.astype({"step": "int64", "i": "int64", "j": "int64"})
    beyond = raw["j"] - p.count + 1
    raw["wall"] = walls[beyond.clip(lower=0)]
    raw["i"], raw["j"] = raw["i"] + 1, np.where(beyond > 0, 0, raw["j"] + 1)
    return [raw]
