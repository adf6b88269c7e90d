# SPDX-License-Identifier: GPL-2.0-or-later
"""Pairs of spheres for LIGGGHTS in variants of the set-up with the same physics."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...base import rendering as decks
from ...base.files import write_texts
from ...engines.input_script import Spheres, text
from ...engines.liggghts import dump, launcher
from ...engines.liggghts.engine import Liggghts
from .pairs import Pairs

VARIANTS: tuple[str, ...] = ("swap", "sort", "migration", "restart")


def _box(pairs: Pairs) -> list[tuple[float, float]]:
    """x = 0 is the border between two ranks, z = 0 one of bins."""
    s, y = pairs.spread, pairs.sides[0].place[:, 1]
    return [(-s, s), (-s, float(y.max()) + s), (-s, s)]


def data(pairs: Pairs, types: Sequence[str], swap: bool) -> str:
    """The data file of the pairs; `swap`: the targets have the lower ids."""
    groups = [
        Spheres(1 + types.index(g.body.material), 2 * g.body.radius, g.body.density, g.place, g.velocity)
        for g in pairs.ordered(swap)
    ]
    return text("pairs", len(types), _box(pairs), groups)


def scripts(deck: object, pairs: Pairs, variant: str, engine: str = "liggghts") -> list[str]:
    """The decks of a variant in the order in which they run."""
    steps = pairs.plan.steps
    context: dict[str, Any] = {
        "deck": deck,
        "variant": variant,
        "ranks": ranks_of(variant),
        "restart": None,
        "stop": None,
        "steps": steps,
        "sort": 0.499 * _box(pairs)[2][1] if variant == "sort" else None,
    }
    parts = [context]
    if variant == "restart":
        parts = [
            context | {"steps": pairs.stop, "stop": "middle.restart"},
            context | {"steps": steps - pairs.stop, "restart": "middle.restart"},
        ]
    return [decks.render(f"verification/{engine}/invariance.in.j2", **part) for part in parts]


def ranks_of(variant: str) -> int:
    """The number of ranks of a variant."""
    return 2 if variant == "migration" else 1


def velocities(tool: Liggghts, pairs: Pairs, variant: str, folder: Path) -> np.ndarray:
    """After the impacts, shape (2, n, 3), the body first. Raises EngineError; ValueError if bodies are lost."""
    deck = replace(tool.deck(pairs.plan), path="out.bin")
    texts = {f"in.{k}": text for k, text in enumerate(scripts(deck, pairs, variant))}
    write_texts(folder, texts | {deck.data: data(pairs, deck.types, variant == "swap")})
    for k in range(len(texts)):
        (folder / deck.path).unlink(missing_ok=True)
        launcher.run(f"in.{k}", folder, ranks=ranks_of(variant), out=f"out.{k}", seconds=120)
    v = dump.series(folder / deck.path)[-1].reshape(2, pairs.plan.n, 3)
    return np.flip(v, axis=0) if variant == "swap" else v
