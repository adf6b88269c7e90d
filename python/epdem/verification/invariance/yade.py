# SPDX-License-Identifier: GPL-2.0-or-later
"""Pairs of spheres for YADE in variants of the set-up with the same physics."""

from pathlib import Path
from typing import Any

import numpy as np

from ...base import rendering as decks
from ...engines.yade import launcher
from ...engines.yade.deck import ImpactDeck
from ...engines.yade.engine import Yade
from ...errors import EngineError
from ...impacts.plan import Group
from .pairs import Pairs

# a serial YADE keeps bodies where they are in memory and has no ranks: sorting and migration do not exist
VARIANTS: tuple[str, ...] = ("swap", "restart")


def _sides(pairs: Pairs, variant: str) -> dict[str, Group]:
    return {f"side{k}.data": side for k, side in enumerate(pairs.ordered(variant == "swap"))}


def scripts(deck: ImpactDeck, pairs: Pairs, variant: str) -> list[str]:
    """The scripts of a variant in the order in which they run."""
    steps = pairs.plan.steps
    context: dict[str, Any] = {
        "deck": deck,
        "variant": variant,
        "sides": [(name, side.body.radius, side.body.material) for name, side in _sides(pairs, variant).items()],
        "steps": steps,
        "load": None,
        "save": None,
    }
    parts = [context]
    if variant == "restart":
        parts = [
            context | {"steps": pairs.stop, "save": "middle.yade.gz"},
            context | {"steps": steps - pairs.stop, "load": "middle.yade.gz"},
        ]
    return [decks.render("verification/yade/pairs.py.j2", **part) for part in parts]


def velocities(tool: Yade, pairs: Pairs, variant: str, folder: Path) -> np.ndarray:
    """After the impacts, shape (2, n, 3), the body first. Raises EngineError; ValueError if bodies are lost."""
    deck = tool.deck(pairs.plan)
    folder.mkdir(parents=True, exist_ok=True)
    if not deck.contact.native:
        launcher.write_deck_modules(folder, classes=tool.classes)
    for name, side in _sides(pairs, variant).items():
        lines = [" ".join(map(decks.number, row)) for row in np.hstack([side.place, side.velocity])]
        (folder / name).write_text("\n".join(["# x y z v_x v_y v_z, SI", *lines, ""]), encoding="utf-8")
    (folder / deck.path).unlink(missing_ok=True)
    for k, text in enumerate(scripts(deck, pairs, variant)):
        (folder / f"pairs{k}.py").write_text(text, encoding="utf-8")
        launcher.run(f"pairs{k}.py", folder, out=f"out{k}.yade", seconds=120)
    try:
        v = np.asarray(np.load(folder / deck.path)).reshape(2, pairs.plan.n, 3)
    except OSError as error:
        raise EngineError(f"{folder / deck.path}: the run left no result ({error}); see out{k}.yade beside") from None
    return np.flip(v, axis=0) if variant == "swap" else np.asarray(v)
