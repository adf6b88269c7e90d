# SPDX-License-Identifier: GPL-2.0-or-later
"""What a YADE scene wrote, as the tables that every scene has. Its file formats end here."""

from pathlib import Path

import numpy as np
import pandas as pd

from ..case.scene import SceneCase
from ..errors import EngineError
from ..liggghts import scene_tables as tables
from ..liggghts.scene_deck import Deck
from ..scenes import contacts
from .scene_deck import OUT

# of a contact: number of the sphere and of the other body (from 0; walls after the spheres), overlaps [m]
CONTACT = ["i", "j", "overlap", "delta_max"]


def _frames(folder: Path, kind: str, names: list[str]) -> pd.DataFrame:
    """All frames of a kind, one below the other. Raises EngineError for an incomplete one."""
    found = []
    for path in sorted(folder.glob(f"{kind}.*.npy"), key=lambda p: int(p.suffixes[-2][1:])):
        try:
            table = pd.DataFrame(np.load(path), columns=names)
        except (OSError, ValueError) as error:
            raise EngineError(f"{path}: incomplete ({error}); run the case again") from None
        table.insert(0, "step", int(path.suffixes[-2][1:]))
        found.append(table)
    return pd.concat(found, ignore_index=True) if found else pd.DataFrame(columns=["step", *names])


def read(case: SceneCase, d: Deck, folder: Path) -> dict[str, pd.DataFrame]:
    """The tables rows, particles and contacts of a run, SI."""
    found = {"rows": tables.rows(folder / OUT, d.time_step)}
    if d.frames:
        names = [*tables.PARTICLES, *(tables.SPINS if d.spins else [])]
        spheres = _frames(folder, "particles", names)
        if d.boundary.startswith("p"):  # YADE does not put back what leaves its periodic cell
            for axis, length in zip("xy", case.scene.box[:2], strict=True):
                spheres[axis] = (spheres[axis] + length / 2) % length - length / 2
        found["particles"] = spheres.astype({"id": "int64", "type": "int64", "step": "int64"})
    if d.contacts:
        every = _contacts(case, d, folder, found["particles"])
        if d.energy and d.yields:
            found["particles"]["plastic_work"] = _plastic_work(every, found["particles"])
        found["contacts"] = every[every["overlap"] > 0].reset_index(drop=True)
    return found


def _contacts(case: SceneCase, d: Deck, folder: Path, spheres: pd.DataFrame) -> pd.DataFrame:
    """Every contact of every frame; with overlap 0 those that ended since the frame before."""
    raw = _frames(folder, "contacts", CONTACT).astype({"step": "int64", "i": "int64", "j": "int64"})
    raw = raw[raw["overlap"] >= 0].reset_index(drop=True)  # what is only near is no contact yet
    walls = np.array(["", *(p[0] for p in d.planes), *d.meshes])
    beyond = raw["j"] - case.scene.count + 1
    raw["wall"] = walls[beyond.clip(lower=0)]
    raw["i"], raw["j"] = raw["i"] + 1, np.where(beyond > 0, 0, raw["j"] + 1)
    return contacts.complete(case, d, raw, spheres)


def _plastic_work(every: pd.DataFrame, spheres: pd.DataFrame) -> np.ndarray:
    """Plastic work [J] of each sphere up to each frame: half of that of its contacts, all of it at a wall.

    Contacts that are there count as they are, those that have ended with their last value from then on.
    """
    at_wall = every["wall"] != ""
    sides = pd.concat(
        [
            every.assign(id=every["i"], share=np.where(at_wall, 1.0, 0.5)),
            every[~at_wall].assign(id=every["j"], share=0.5),
        ]
    )
    work = (sides["share"] * sides["plastic_work"]).groupby([sides["overlap"] > 0, sides["step"], sides["id"]]).sum()
    frames = spheres.pivot_table(index="step", columns="id", values="mass") * 0.0

    def part(there: bool) -> pd.DataFrame:
        chosen = work[there] if there in work.index.get_level_values(0) else work.iloc[:0].droplevel(0)
        return chosen.unstack().reindex(index=frames.index, columns=frames.columns).fillna(0.0)

    total = part(True) + part(False).cumsum()
    return total.stack().reindex(pd.MultiIndex.from_frame(spheres[["step", "id"]])).to_numpy()
