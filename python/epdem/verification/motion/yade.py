# SPDX-License-Identifier: GPL-2.0-or-later
"""Prescribed motions of two spheres in YADE: no integrator, every step sets both."""

from pathlib import Path

import numpy as np

from ...base import rendering as decks
from ...engines.yade import launcher
from ...engines.yade.deck import ImpactDeck
from ...engines.yade.engine import Yade
from ...errors import EngineError
from .prescribed import Loads, Motion, Touch, summary

SCRIPT, STEPS = "motion.py", "motion.txt"


class YadeMotions:
    """YADE with the classes of epdem_yade."""

    name = Yade.name
    laws: tuple[str, ...] | None = None

    def __init__(self) -> None:
        self.features = Yade().features

    def missing(self) -> str | None:
        if reason := Yade().missing():
            return reason
        return None if Yade().classes else f"motions need the module epdem_yade, which is not built; {launcher.BUILD}"

    def loads(self, touch: Touch, motion: Motion, folder: Path) -> Loads:
        Yade().put(files(touch, motion), folder)
        path = folder / "path.npy"
        path.unlink(missing_ok=True)
        launcher.run(SCRIPT, folder, seconds=300)
        try:
            table = np.load(path).reshape(motion.steps, 13)
        except (OSError, ValueError) as error:
            raise EngineError(f"{path}: the run left no result ({error}); see out.yade beside it") from None
        found = table[:, 1:].reshape(motion.steps, 2, 2, 3)
        return Loads(found[:, :, 0], found[:, :, 1], table[:, 0])


def deck(touch: Touch, motion: Motion) -> ImpactDeck:
    """The deck of a motion. Raises CaseError for what YADE cannot do."""
    plan = touch.plan(motion)
    return Yade().deck(plan, touch.model(plan))


def files(touch: Touch, motion: Motion) -> dict[str, str]:
    """Script and steps of a motion by name; they run beside the modules of a deck. Raises CaseError."""
    table = np.concatenate([motion.place, motion.velocity, motion.spin], axis=2).reshape(motion.steps, 18)
    lines = ["# of i, then of j: x y z [m], v [m/s], omega [rad/s]"]
    lines += [" ".join(map(decks.number, row)) for row in table.tolist()]
    template, said = "verification/yade/motion.py.j2", summary(touch, motion)
    script = decks.render(template, deck=deck(touch, motion), summary=said, steps=STEPS)
    return {SCRIPT: script, STEPS: "\n".join([*lines, ""])}
