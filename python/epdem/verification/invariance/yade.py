# SPDX-License-Identifier: GPL-2.0-or-later
"""Pairs of spheres for YADE in variants of the set-up with the same physics."""

from pathlib import Path

import numpy as np

from ...base import rendering as decks
from ...engines.yade.deck import ImpactDeck
from ...engines.yade.engine import Yade
from ...engines.yade.launcher import run
from ...engines.yade.scene_parts import table_text
from ...errors import EngineError
from .pairs import Pairs

# a serial YADE keeps bodies where they are in memory and has no ranks: sorting and migration do not exist
VARIANTS: tuple[str, ...] = ("swap", "restart")


def scripts(deck: ImpactDeck, pairs: Pairs, variant: str) -> list[str]:
    """The scripts of a variant in the order in which they run."""
    sides = [(f"side{k}.data", s.body.radius, s.body.material) for k, s in enumerate(pairs.ordered(variant == "swap"))]
    runs = pairs.runs(variant, "middle.yade.gz")
    return [decks.render("verification/yade/pairs.py.j2", deck=deck, sides=sides, **run) for run in runs]


def velocities(tool: Yade, pairs: Pairs, variant: str, folder: Path) -> np.ndarray:
    """After the impacts, shape (2, n, 3), the body first. Raises EngineError; ValueError if bodies are lost."""
    deck = tool.deck(pairs.plan)
    texts = {f"pairs{k}.py": text for k, text in enumerate(scripts(deck, pairs, variant))}
    tables = [np.hstack([side.place, side.velocity]).tolist() for side in pairs.ordered(variant == "swap")]
    data = {f"side{k}.data": table_text("# x y z v_x v_y v_z, SI", table) for k, table in enumerate(tables)}
    tool.put(texts | data, folder)
    path = folder / "path.bin"
    path.unlink(missing_ok=True)
    for k, name in enumerate(texts):
        run(name, folder, out=f"out{k}.yade", seconds=120)
    try:
        v = np.asarray(np.load(path)).reshape(2, pairs.plan.n, 3)
    except OSError as error:
        raise EngineError(f"{path}: the run left no result ({error}); see out{k}.yade beside") from None
    return np.flip(v, axis=0) if variant == "swap" else v
