# SPDX-License-Identifier: GPL-2.0-or-later
"""Pairs of spheres told to LIGGGHTS in one of the ways that must not matter."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np

from .. import paths
from .. import rendering as decks
from ..impacts.pairs import Pairs
from ..processes import call
from .impacts import Deck, Liggghts, read_dump

WAYS = ("swap", "sort", "migration", "restart")


def _box(pairs: Pairs) -> list[tuple[float, float]]:
    """x = 0 is the border between two ranks, z = 0 one of bins."""
    s, y = pairs.spread, pairs.sides[0].place[:, 1]
    return [(-s, s), (-s, float(y.max()) + s), (-s, s)]


def _data(pairs: Pairs, deck: Deck, swap: bool) -> str:
    rows, speeds, k = [], [], 0
    for side in pairs.told(swap):
        kind = 1 + deck.types.index(side.body.material)
        for xyz, velocity in zip(side.place, side.velocity, strict=True):
            k += 1
            numbers = (2 * side.body.radius, side.body.density, *xyz)
            rows.append(f"{k} {kind} " + " ".join(map(decks.number, numbers)))
            speeds.append(f"{k} " + " ".join(map(decks.number, velocity)) + " 0 0 0")
    box = [f"{decks.number(lo)} {decks.number(hi)} {a}lo {a}hi" for a, (lo, hi) in zip("xyz", _box(pairs), strict=True)]
    head = ["pairs: id type diameter density x y z", "", f"{k} atoms", f"{len(deck.types)} atom types", *box, ""]
    return "\n".join([*head, "Atoms", "", *rows, "", "Velocities", "", *speeds, ""])


def velocities(tool: Liggghts, pairs: Pairs, way: str, folder: Path) -> np.ndarray:
    """After the impacts, shape (2, n, 3), the body first. Raises EngineError; ValueError if bodies are lost."""
    p, deck = pairs.plan, replace(tool.deck(pairs.plan), path="out.bin")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / deck.data).write_text(_data(pairs, deck, way == "swap"))
    words = {
        "deck": deck,
        "way": way,
        "ranks": 2 if way == "migration" else 1,
        "restart": None,
        "stop": None,
        "sort": 0.499 * _box(pairs)[2][1] if way == "sort" else None,
        "steps": p.steps,
    }
    parts = [words]
    if way == "restart":
        parts = [
            words | {"steps": pairs.stop, "stop": "middle.restart"},
            words | {"steps": p.steps - pairs.stop, "restart": "middle.restart"},
        ]
    for k, part in enumerate(parts):
        (folder / f"in.{k}").write_text(decks.render("liggghts/invariance.in.j2", **part))
        command = [str(paths.launcher()), "-in", f"in.{k}", "-log", f"log.{k}"]
        if part["ranks"] > 1:
            extra = ["--allow-run-as-root"] if os.geteuid() == 0 else []
            command = ["mpirun", "-np", "2", "--oversubscribe", *extra, *command]
        (folder / deck.path).unlink(missing_ok=True)
        call(command, folder, log=f"out.{k}", seconds=120)
    v = read_dump(folder / deck.path, 4)[-1].reshape(2, p.n, 3)
    return v[::-1] if way == "swap" else v
