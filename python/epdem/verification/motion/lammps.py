# SPDX-License-Identifier: GPL-2.0-or-later
"""Prescribed motions of two spheres in LAMMPS: every step sets both, then runs once."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...base import rendering as decks
from ...base.files import write_texts
from ...engines.lammps import launcher
from ...engines.lammps.engine import Lammps, frames
from .liggghts import DATA, DECK, STEPS, data
from .prescribed import Loads, Motion, Touch, summary


class LammpsMotions:
    """LAMMPS with a law and a friction of ours."""

    name = Lammps.name
    laws: tuple[str, ...] | None = None
    features = Lammps.features

    def missing(self) -> str | None:
        return launcher.missing()

    def loads(self, touch: Touch, motion: Motion, folder: Path) -> Loads:
        write_texts(folder, files(touch, motion))
        path = folder / "path.txt"
        path.unlink(missing_ok=True)
        launcher.run(DECK, folder, seconds=120 + 0.01 * motion.steps)
        found = frames(path, motion.steps + 1, 2)[1:].reshape(motion.steps, 2, 2, 3)  # the first frame is the start
        return Loads(found[:, :, 0], found[:, :, 1])


def files(touch: Touch, motion: Motion) -> dict[str, str]:
    """Deck, start and steps of a motion by name; they run by hand in one folder. Raises CaseError."""
    plain = Lammps().deck(touch.plan(motion))
    friction = f" tangential {touch.tangential} {decks.number(touch.friction)}"
    pairs = tuple(words.partition(" tangential ")[0] + friction for words in plain.pairs)
    head = replace(plain.head, summary=summary(touch, motion))
    deck = replace(plain, head=head, data=DATA, pairs=pairs, path="path.txt")
    return {
        DECK: decks.render("verification/lammps/motion.in.j2", deck=deck, steps=STEPS),
        STEPS: "".join(_steps(motion)),
        DATA: data(touch, motion, len(deck.types)),
    }


def _steps(motion: Motion) -> Iterator[str]:
    table = np.concatenate([motion.place, motion.velocity, motion.spin], axis=2).tolist()
    for bodies in table:
        for id, values in enumerate(bodies, 1):
            x, y, z, vx, vy, vz, *spin = map(decks.number, values)
            yield f"set atom {id} x {x} y {y} z {z} vx {vx} vy {vy} vz {vz} omega {' '.join(spin)}\n"
        yield "run 1 pre no post no\n"
