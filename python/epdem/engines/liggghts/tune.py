# SPDX-License-Identifier: GPL-2.0-or-later
"""Which neighbour skin and which cut of the room among ranks a scene is fastest with: trials, and lines for its case.

A trial runs the scene and changes the skin every few hundred steps, forth and back through the candidates: each of them
sees every part of the scene, and what else the machine does hits all of them. The seconds are LIGGGHTS's own of its
loop, without output and set-up.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import tomlkit

from ...base.files import atomic
from ...case.scene import Output, SceneCase, load
from ...case.toml import named, text_of
from ...errors import CaseError, EngineError
from ...scenes.engine import check_run
from ...scenes.plan import ScenePlan, plan
from . import scene_deck, trials
from .engine import Liggghts
from .trials import Loops

SHARES = (0.25, 0.5, 0.75, 1.0, 1.5)  # of the smallest radius: skins that are tried
TURNS, SHORTEST, LONGEST = 10, 200, 2000  # turns through all skins in a scene, and steps with one of them
WORTH = 0.02  # of the time: nobody changes a case for less
CERTAIN = 3.0  # standard errors that a saving must exceed
Progress = Callable[[str], None]


@dataclass(frozen=True)
class Trial:
    """A choice, and the seconds per step that it took in each turn; value: a skin [m] or the axes of a cut."""

    name: str
    value: float | str
    turns: tuple[float, ...]

    @property
    def seconds(self) -> float:
        """Seconds per step, the mean over all turns."""
        return float(np.mean(self.turns))

    def saves(self, before: "Trial") -> tuple[float, float]:
        """(share of the time that it saves over another choice, standard error), turn by turn."""
        saved = np.subtract(before.turns, self.turns) / before.seconds
        return float(saved.mean()), float(saved.std(ddof=1) / math.sqrt(len(saved)))


@dataclass(frozen=True)
class Tuned:
    """All trials, the present choice first; steps: those that each skin took, of scene_steps in all."""

    skins: tuple[Trial, ...]
    cuts: tuple[Trial, ...]
    steps: int
    scene_steps: int
    ranks: int

    @property
    def choices(self) -> dict[str, tuple[str, str]]:
        """Key of [numerics] -> (value, reason) of what saves time for certain."""
        choices = {}
        if best := _better(self.skins):
            choices["skin"] = f"{float(best.value) * 1e3:.4g} mm", self._reason(best, self.skins[0])
        if best := _better(self.cuts):
            choices["processors"] = str(best.value), self._reason(best, self.cuts[0])
        return choices

    @property
    def lines(self) -> list[str]:
        """The choices as lines of a case file, each with its reason."""
        return [f'{key} = "{value}" # {reason}' for key, (value, reason) in self.choices.items()]

    def _reason(self, best: Trial, before: Trial) -> str:
        ranks = "1 rank" if self.ranks == 1 else f"{self.ranks} ranks"
        return f"epdem tune: {best.saves(before)[0]:.0%} less time than {before.name}, {self.steps} steps, {ranks}"


def _better(trials: tuple[Trial, ...]) -> Trial | None:
    """The fastest, if it saves more than WORTH over the first, and more than chance."""
    best = min(trials, key=lambda t: t.seconds, default=None)
    if best is None or best is trials[0]:
        return None
    saved, error = best.saves(trials[0])
    return best if saved > max(WORTH, CERTAIN * error) else None


def _silent(case: SceneCase) -> ScenePlan:
    """The plan of a scene without output but rows, which report its progress."""
    silent = Output(rows=100, particles=0).model_copy(
        update={"energy": case.output.energy}
    )  # of contacts without frames
    return plan(case.model_copy(update={"output": silent}))


def _of_skins(order: list[float], loops: Loops, skins: list[float]) -> tuple[list[Trial], int]:
    """A trial of each skin over whole turns, and the steps that each skin took."""
    turns = min(len(loops), len(order)) // len(skins)
    if turns < 2:
        raise EngineError("the trial ended before each skin had two turns; give it more time (--seconds)")
    taken: dict[float, list[tuple[float, int]]] = {skin: [] for skin in skins}
    for skin, piece in list(zip(order, loops, strict=False))[: turns * len(skins)]:
        taken[skin].append(piece)
    trials = [Trial(f"skin {skin * 1e3:.3g} mm", skin, tuple(t / n for t, n in its)) for skin, its in taken.items()]
    return trials, sum(n for _, n in taken[skins[0]])


def _of_cuts(runs: dict[str, Loops]) -> list[Trial]:
    """A trial of each cut over the pieces that all of them have."""
    if (pieces := min(map(len, runs.values()))) < 2:
        raise EngineError("a trial ended before its second piece; give it more time (--seconds)")
    return [Trial(_axes(cut), cut, tuple(t / n for t, n in loops[:pieces])) for cut, loops in runs.items()]


def _axes(cut: str) -> str:
    return f"ranks along {cut or 'axes that LIGGGHTS chooses'}"


def _cuts(ranks: int) -> list[str]:
    """The ways to cut a room for a number of ranks that are worth a trial."""
    several = any(ranks % d == 0 for d in range(2, math.isqrt(ranks) + 1))
    return ["x", "y", "z", *(["xy", "xz", "yz"] if several else []), *(["xyz"] if several and ranks >= 8 else [])]


def tune(path: Path, *, ranks: int = 1, seconds: float = 60.0, progress: Progress = lambda text: None) -> Tuned:
    """Trials of the scene in `path` of at most `seconds` in all. Raises CaseError, EngineError."""
    tool = Liggghts()
    with named(path):
        case = load(path)
        p = _silent(case)
        tool.check(p)
        texts = tool.files(p)
    check_run(tool, ranks=ranks)
    present = float(scene_deck.deck(p).skin)
    others = sorted({float(f"{share * p.smallest:.2e}") for share in SHARES} - {present})
    skins = [present, *others]
    length = max(SHORTEST, min(LONGEST, p.steps // (TURNS * len(skins))))
    progress(f"{len(skins)} skins")
    deck, order = trials.pieces(texts, skins, p.steps, length)
    if len(order) < 2 * len(skins):
        least = 2 * length * len(skins)
        raise CaseError(
            f"{path}: the scene has {p.steps} steps, two turns through its skins {least}; it is short as it is"
        )
    cuts = list(dict.fromkeys([case.numerics.processors or "", *_cuts(ranks)])) if ranks > 1 else []
    share = seconds / (1 + len(cuts))
    of_skins, steps = _of_skins(order, trials.run(deck, ranks, share), skins)
    result = Tuned(tuple(of_skins), (), steps, p.steps, ranks)
    if not cuts:
        return result
    best = float((_better(result.skins) or of_skins[0]).value)
    runs: dict[str, Loops] = {}
    for cut in cuts:
        progress(_axes(cut))
        numerics = case.numerics.model_copy(update={"processors": cut or None})
        texts = tool.files(_silent(case.model_copy(update={"numerics": numerics})))
        runs[cut] = trials.run(trials.pieces(texts, [best], steps * len(skins), length)[0], ranks, share)
    return replace(result, cuts=tuple(_of_cuts(runs)))


def write(path: Path, result: Tuned) -> None:
    """Put the choices into [numerics] of the case file; its other comments and its order stay."""
    if not result.choices:
        return
    document = tomlkit.parse(text_of(path))
    numerics = document.setdefault("numerics", tomlkit.table())
    for key, (value, reason) in result.choices.items():
        numerics[key] = tomlkit.item(value).comment(reason)
    with atomic(path.resolve()) as temporary:  # the path may be a link
        temporary.write_text(document.as_string(), encoding="utf-8")
