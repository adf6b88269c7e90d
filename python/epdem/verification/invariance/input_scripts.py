# SPDX-License-Identifier: GPL-2.0-or-later
"""Pairs of spheres for LIGGGHTS and LAMMPS in variants of the set-up with the same physics."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...base import rendering as decks
from ...base.files import write_texts
from ...engines.input_script import data_text, equal_spheres
from ...engines.lammps.engine import Lammps
from ...engines.lammps.tables import impact_frames
from ...engines.liggghts import dump
from ...engines.liggghts.engine import Liggghts
from .pairs import Pairs


def _box(pairs: Pairs) -> tuple[float, ...]:
    """x = 0 is the border between two ranks, z = 0 one of bins."""
    s, y = pairs.spread, pairs.sides[0].place[:, 1]
    return -s, s, -s, float(y.max()) + s, -s, s


def data(pairs: Pairs, types: Sequence[str], swap: bool) -> str:
    """The data file of the pairs; `swap`: the targets have the lower ids."""
    rows = [row for g in pairs.ordered(swap) for row in equal_spheres(1 + types.index(g.body.material), g)]
    return data_text("pairs", len(types), _box(pairs), rows)


def _ranks(variant: str) -> int:
    return 2 if variant == "migration" else 1


def scripts(deck: object, pairs: Pairs, variant: str, engine: str = "liggghts") -> list[str]:
    """The decks of a variant in the order in which they run."""
    sort = 0.499 * _box(pairs)[-1] if variant == "sort" else None
    template, common = f"verification/{engine}/invariance.in.j2", {"deck": deck, "ranks": _ranks(variant), "sort": sort}
    return [decks.render(template, **common, **run) for run in pairs.runs(variant, "middle.restart")]


def velocities(tool: Liggghts | Lammps, pairs: Pairs, variant: str, folder: Path) -> np.ndarray:
    """After the impacts, shape (2, n, 3), the body first. Raises EngineError; ValueError if bodies are lost."""
    in_lammps, n = isinstance(tool, Lammps), pairs.plan.n
    deck = tool.deck(pairs.plan)
    found = scripts(deck, pairs, variant, "lammps" if in_lammps else "liggghts")
    texts = {f"in.{k}": text for k, text in enumerate(found)}
    write_texts(folder, texts | {"impact.data": data(pairs, deck.types, variant == "swap")})
    path = folder / ("out.txt" if in_lammps else "out.bin")
    for k in range(len(texts)):
        path.unlink(missing_ok=True)
        tool.launcher.run(f"in.{k}", folder, ranks=_ranks(variant), out=f"out.{k}", seconds=120)
    v = (impact_frames(path, 1, 2 * n) if in_lammps else dump.series(path)[-1]).reshape(2, n, 3)
    return np.flip(v, axis=0) if variant == "swap" else v
