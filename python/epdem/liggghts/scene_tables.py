# SPDX-License-Identifier: GPL-2.0-or-later
"""What LIGGGHTS wrote, as pandas tables. Its words and file formats end here."""

import re
from pathlib import Path

import numpy as np
import pandas as pd

from ..case.scene import SceneCase
from ..errors import EngineError
from . import dump
from . import log as thermo
from .scene_deck import Deck

PARTICLES = ["id", "type", "radius", "mass", "x", "y", "z", "vx", "vy", "vz"]
SPINS = ["omega_x", "omega_y", "omega_z"]
# thermo words of the deck: column and unit
ROWS = {
    "Step": ("step", "1"),
    "Atoms": ("particles", "1"),
    "KinEng": ("kinetic_energy", "J"),
    "load": ("floor_load", "N"),
    "press_z": ("plate_force", "N"),
    "torque": ("torque", "N m"),
}


def rows(log: Path, time_step: float) -> pd.DataFrame:
    """The thermo rows: one per step. Raises EngineError.

    A run that continues another one begins again at the step of its restart file: what the earlier run wrote beyond
    that step is replaced, but not the row of that step itself, whose means over an interval only the earlier run knows.
    """
    every = thermo.rows(log)
    if every.empty:
        raise EngineError(f"{log}: no thermo rows; the run ended before its first step")
    table = every.iloc[:0]
    for _, part in every.groupby("run"):
        begin = part["Step"].iloc[0]
        table = table[table["Step"] <= begin]
        table = pd.concat([table, part[1:] if begin in table["Step"].to_numpy() else part])
    table = table.drop_duplicates("Step", keep="last").drop(columns="run").reset_index(drop=True)
    table = table.drop(columns="CPU", errors="ignore")  # LIGGGHTS's own choice when it is not asked for columns
    table.columns = [ROWS.get(n, (n, ""))[0] for n in table.columns]
    table.insert(1, "time", table["step"] * time_step)
    return table


def plate_height(case: SceneCase, deck: Deck, time: np.ndarray) -> np.ndarray:
    """Height [m] of the moving plate of a compaction."""
    s, turn = case.scene, deck.phases[0].end * deck.time_step
    return s.box[2] - s.speed * np.minimum(time, turn) + s.release * np.maximum(time - turn, 0.0)


def add_plate(case: SceneCase, deck: Deck, table: pd.DataFrame) -> None:
    """Columns plate_z [m] (middle of the interval that the force is a mean of) and stress [Pa]."""
    middle = (table["step"] - 0.5 * deck.every).clip(lower=0) * deck.time_step
    table["plate_z"] = plate_height(case, deck, middle.to_numpy())
    table["stress"] = table["plate_force"] / (case.scene.box[0] * case.scene.box[1])


def _steps(folder: Path, pattern: str) -> list[tuple[int, Path]]:
    """(step, file) of the frames of a dump, by step."""
    found = [(int(re.search(r"(\d+)\.\w+$", p.name).group(1)), p) for p in folder.glob(pattern)]
    return sorted(found)


def particles(folder: Path, deck: Deck, *, upto: int | None = None) -> pd.DataFrame:
    """Every particle of every frame, sorted by step and id: SI."""
    names = [*PARTICLES, *(SPINS if deck.spins else [])]
    names += [f"delta_max_{p[0]}" for p in deck.planes] if deck.contacts and deck.yields else []
    names += ["plastic_work"] if deck.energy and deck.yields else []
    frames = []
    for step, path in _steps(folder, "particles.*.bin"):
        if upto is not None and step > upto:
            continue
        ((_, data),) = dump.frames(path)
        table = pd.DataFrame(data, columns=names)
        table.insert(0, "step", step)
        frames.append(table)
    if not frames:
        return pd.DataFrame(columns=["step", *names])
    table = pd.concat(frames, ignore_index=True)
    return table.astype({"id": "int64", "type": "int64", "step": "int64"})


def local_frames(folder: Path, pattern: str, names: list[str]) -> pd.DataFrame:
    """Rows of a `dump local` text file per step."""
    frames = []
    for step, path in _steps(folder, pattern):
        data = dump.local(path)
        if not data.size:
            continue
        table = pd.DataFrame(data)
        if table.shape[1] != len(names):
            raise EngineError(f"{path}: {table.shape[1]} columns, expected {len(names)}")
        table.columns = names
        table.insert(0, "step", step)
        frames.append(table)
    return pd.concat(frames, ignore_index=True) if frames else pd.DataFrame(columns=["step", *names])
