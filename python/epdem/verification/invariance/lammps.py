# SPDX-License-Identifier: GPL-2.0-or-later
"""Pairs of spheres for LAMMPS in variants of the set-up with the same physics."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...base.files import write_texts
from ...engines.lammps import launcher
from ...engines.lammps.engine import Lammps
from ...engines.lammps.tables import impact_frames
from .liggghts import VARIANTS, data, ranks_of, scripts
from .pairs import Pairs

__all__ = ["VARIANTS", "velocities"]


def velocities(tool: Lammps, pairs: Pairs, variant: str, folder: Path) -> np.ndarray:
    """After the impacts, shape (2, n, 3), the body first. Raises EngineError; ValueError if bodies are lost."""
    deck = replace(tool.deck(pairs.plan), path="out.txt")
    texts = {f"in.{k}": text for k, text in enumerate(scripts(deck, pairs, variant, "lammps"))}
    write_texts(folder, texts | {deck.data: data(pairs, deck.types, variant == "swap")})
    for k in range(len(texts)):
        launcher.run(f"in.{k}", folder, ranks=ranks_of(variant), out=f"out.{k}", seconds=120)
    v = impact_frames(folder / deck.path, 1, 2 * pairs.plan.n).reshape(2, pairs.plan.n, 3)
    return np.flip(v, axis=0) if variant == "swap" else v
