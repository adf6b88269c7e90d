# SPDX-License-Identifier: GPL-2.0-or-later
"""Prescribed motions of two spheres in LIGGGHTS: every step sets both, then runs once."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ...base import rendering as decks
from ...base.files import write_texts
from ...engines.host import Host
from ...engines.input_script import data_text, equal_spheres
from ...engines.liggghts import dump, launcher
from ...engines.liggghts.engine import Liggghts
from ...errors import EngineError
from ...impacts.plan import Group
from ...laws.library import Array
from .prescribed import Loads, Motion, Touch, summary

DECK, STEPS, DATA = "in.motion", "motion.steps", "motion.data"
SET = " ".join(f"{name}{axis} {{}}" for name in ("", "v", "omega") for axis in "xyz")


class LiggghtsMotions:
    """LIGGGHTS with a law and a friction of ours. words: of `set` for place, velocity and spin of a sphere."""

    name = Liggghts.name
    host: type[Host] = Liggghts
    laws: tuple[str, ...] | None = None
    features = Liggghts.features
    template, path, words = "verification/liggghts/motion.in.j2", "path.bin", SET
    launcher: Any = launcher

    def missing(self) -> str | None:
        reason: str | None = self.launcher.missing()
        return reason

    def loads(self, touch: Touch, motion: Motion, folder: Path) -> Loads:
        write_texts(folder, self.files(touch, motion))
        path = folder / self.path
        path.unlink(missing_ok=True)
        self.launcher.run(DECK, folder, seconds=120 + 0.01 * motion.steps)
        found = self.read(path, motion.steps)[1:].reshape(motion.steps, 2, 2, 3)  # the first frame is the start
        return Loads(found[:, :, 0], found[:, :, 1])

    def deck(self, touch: Touch, motion: Motion) -> Any:
        """The deck of a motion. Raises CaseError for what the engine cannot do."""
        plan = touch.plan(motion)
        return self.host().deck(plan, touch.model(plan))

    def read(self, path: Path, steps: int) -> Array:
        """Forces and torques of the start and of every step. Raises EngineError."""
        try:
            return dump.series(path).reshape(steps + 1, 2, -1)
        except ValueError as error:
            raise EngineError(
                f"{path}: the run left an incomplete dump ({error}); see {launcher.OUT} beside it"
            ) from None

    def files(self, touch: Touch, motion: Motion) -> dict[str, str]:
        """Deck, start and steps of a motion by name; they run by hand in one folder. Raises CaseError."""
        deck = self.deck(touch, motion)
        return {
            DECK: decks.render(self.template, deck=deck, summary=summary(touch, motion), steps=STEPS),
            STEPS: "".join(self._steps(motion)),
            DATA: data(touch, motion, len(deck.types)),
        }

    def _steps(self, motion: Motion) -> Iterator[str]:
        table = np.concatenate([motion.place, motion.velocity, motion.spin], axis=2).tolist()
        for bodies in table:
            for id, values in enumerate(bodies, 1):
                yield f"set atom {id} {self.words.format(*map(decks.number, values))}\n"
            yield "run 1 pre no post no\n"


def data(touch: Touch, motion: Motion, types: int) -> str:
    """The data file of both spheres at the start; the target is of the last type."""
    x = touch.experiment
    reach = 4 * max(touch.radii)
    box = [float(x) for a in motion.place.reshape(-1, 3).T for x in (a.min() - reach, a.max() + reach)]
    sides = [Group(b, motion.place[:1, k], motion.velocity[:1, k]) for k, b in enumerate((x.body, x.target))]
    rows = [row for kind, g in zip((1, types), sides, strict=True) for row in equal_spheres(kind, g)]
    return data_text(motion.name, types, box, rows)
