# SPDX-License-Identifier: GPL-2.0-or-later
"""What runs the benchmarks of other people: our laws in LIGGGHTS, and LIGGGHTS's own `hertz` on the same deck."""

from pathlib import Path

import numpy as np

from epdem.engines import log
from epdem.engines.liggghts.engine import Liggghts
from epdem.engines.liggghts.launcher import OUT
from epdem.impacts.plan import Plan
from epdem.scenes.plan.plan import ScenePlan

MODELS = {"hertz": "hertz", "ep/hertz": "hertz", "ep/thornton": "thornton"}  # and the law of their plan
YADE = "yade"  # its own model of Hertz and Mindlin
SHORT = 10_000  # steps of a case that is for larger machines
START, SPEED = 0.06, 5.0  # of the impactor: height [m] and speed [m/s] at the time 0
RAIN_FRICTION = 0.05  # of all pairs while a bed falls: a medium dense one; with the cases' own friction it is looser
CURVE, EVERY = "impactor.txt", 100  # steps between two lines


class Recorded(Liggghts):
    """LIGGGHTS with our model of a plan, and the height of the last sphere of its table in a file of its own."""

    leftovers = f"{Liggghts.leftovers} {CURVE}"

    def __init__(self, begin: float = 0.0):
        super().__init__()
        self.begin = begin  # [s] at step 0

    def files(self, job: Plan | ScenePlan) -> dict[str, str]:
        texts = super().files(job)
        if isinstance(job, ScenePlan):
            texts["setup.in"] = self.setup(job, texts["setup.in"])
        return texts

    def setup(self, plan: ScenePlan, text: str) -> str:
        """The deck's common part with the lines that record; `append`: a run that goes on has them again."""
        if not plan.scene.table:
            return text
        last = len(plan.scene.table)
        return text + (
            f"group curve id {last}\nvariable curve_t equal step*dt+{self.begin!r}\n"
            "variable curve_z equal xcm(curve,z)\nvariable curve_v equal vcm(curve,z)\n"
            f'fix curve all print {EVERY} "${{curve_t}} ${{curve_z}} ${{curve_v}}" append {CURVE} screen no\n'
        )


class OwnHertz(Recorded):
    """LIGGGHTS's own `hertz` with its dashpot, on the deck of `ep/hertz`."""

    name = "liggghts-hertz"

    def setup(self, plan: ScenePlan, text: str) -> str:
        return super().setup(plan, text).replace("model ep/hertz", "model hertz").replace(" viscous on", "")


def engine(model: str, begin: float = 0.0) -> Liggghts:
    """The engine of a model, for a run whose step 0 is at time `begin` [s]."""
    return OwnHertz(begin) if model == "hertz" else Recorded(begin)


def curve(folder: Path) -> np.ndarray:
    """(n, 3) time [s], height and velocity [m] of the last sphere; lines that a continued run repeats stand once."""
    path = folder / CURVE
    rows = [line.split() for line in path.read_text().splitlines() if not line.startswith("#")] if path.exists() else []
    rows = [row for row in rows if len(row) == 3]
    table = np.array(rows, dtype=float).reshape(-1, 3)
    _, last = np.unique(table[::-1, 0], return_index=True)
    return table[::-1][last]


def loop(folder: Path) -> tuple[float, int]:
    """(seconds, steps) of all that LIGGGHTS has computed in a folder."""
    found = log.loops(folder / OUT)
    return sum(seconds for seconds, _ in found), sum(steps for _, steps in found)
