# SPDX-License-Identifier: GPL-2.0-or-later
"""Pairs of spheres for YADE in variants of the set-up with the same physics."""

from pathlib import Path
from typing import Any

import numpy as np

from ..base import rendering as decks
from ..base.processes import call
from ..errors import EngineError
from ..impacts.pairs import Pairs
from .deck import Deck
from .launcher import command, environment, write_deck_modules


def velocities(deck: Deck, pairs: Pairs, variant: str, folder: Path) -> np.ndarray:
    """After the impacts, shape (2, n, 3), the body first. Raises EngineError; ValueError if bodies are lost."""
    p = pairs.plan
    folder.mkdir(parents=True, exist_ok=True)
    if not deck.native:
        write_deck_modules(folder)
    sides = [(f"side{k}.data", side) for k, side in enumerate(pairs.ordered(variant == "swap"))]
    for name, side in sides:
        lines = [" ".join(map(decks.number, row)) for row in np.hstack([side.place, side.velocity])]
        (folder / name).write_text("\n".join(["# x y z v_x v_y v_z, SI", *lines, ""]), encoding="utf-8")
    context: dict[str, Any] = {
        "deck": deck,
        "variant": variant,
        "sides": [(n, s.body.radius, s.body.material) for n, s in sides],
        "steps": p.steps,
        "load": None,
        "save": None,
    }
    parts = [context]
    if variant == "restart":
        parts = [
            context | {"steps": pairs.stop, "save": "middle.yade.gz"},
            context | {"steps": p.steps - pairs.stop, "load": "middle.yade.gz"},
        ]
    (folder / deck.path).unlink(missing_ok=True)
    for k, part in enumerate(parts):
        (folder / f"pairs{k}.py").write_text(decks.render("yade/pairs.py.j2", **part), encoding="utf-8")
        call([command(), "-n", "-x", f"pairs{k}.py"], folder, log=f"out{k}.yade", seconds=120, env=environment())
    try:
        v = np.asarray(np.load(folder / deck.path)).reshape(2, p.n, 3)
    except OSError as error:
        raise EngineError(f"{folder / deck.path}: the run left no result ({error}); see out{k}.yade beside") from None
    return np.flip(v, axis=0) if variant == "swap" else np.asarray(v)
