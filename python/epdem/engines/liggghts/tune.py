# SPDX-License-Identifier: GPL-2.0-or-later
"""Which neighbour skin, sorting of spheres and cut of the room among ranks a scene is fastest with: trials, and lines
for its case.

A trial runs the scene with one cut and one interval of sorting, and changes the skin every few hundred steps, forth and
back through the candidates: each of them sees every part of the scene, and what else the machine does hits all of them.
The stages of a scene count by their steps in the scene. The seconds are LIGGGHTS's own of its loop, without output and
set-up.
"""

import contextlib
import math
import re
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import tomlkit

from ...base.files import atomic, write_texts
from ...case.scene import Output, SceneCase, load
from ...case.toml import named, text_of
from ...errors import CaseError, EngineError
from ...scenes.engine import check_run
from ...scenes.plan import ScenePlan, plan
from .. import log
from . import launcher, scene_deck
from .engine import Liggghts

SHARES = (0.25, 0.5, 0.75, 1.0, 1.5)  # of the smallest radius: skins that are tried
SORTS = (200, 5000)  # steps between sortings that are tried beside the present ones
TURNS, SHORTEST, LONGEST = 10, 200, 2000  # turns through all skins in a scene, and steps with one of them
WORTH = 0.02  # of the time: nobody changes a case for less
CERTAIN = 3.0  # standard errors that a saving must exceed
Progress = Callable[[str], None]
Loops = list[tuple[float, int]]  # (seconds, steps) of pieces of a run
_MARK = "epdem: a piece begins"  # runs without it end a phase by a condition
_RUN = re.compile(r"^run (\d+) upto(?:  # (.*))?$", re.MULTILINE)
Turns = dict[str, tuple[float, ...]]  # stage -> a number per turn


@dataclass(frozen=True)
class Piece:
    """Steps of a stage of a scene with one skin [m], and the number of the turn through all skins."""

    stage: str
    steps: int
    turn: int
    skin: float


@dataclass(frozen=True)
class Choice:
    """What a trial sets: neighbour skin [m], axes along which ranks divide the room, steps between sortings of spheres;
    None: as LIGGGHTS chooses."""

    skin: float
    processors: str | None = None
    sort_interval: int | None = None

    @property
    def keys(self) -> dict[str, str | int | None]:
        """Keys of [numerics] and their values."""
        skin = f"{self.skin * 1e3:.4g} mm"
        return {"skin": skin, "processors": self.processors, "sort_interval": self.sort_interval}

    def __str__(self) -> str:
        words = [f"skin {self.skin * 1e3:.3g} mm"]
        words += [f"ranks along {self.processors}"] if self.processors else []
        words += [f"sorted every {self.sort_interval} steps"] if self.sort_interval else []
        return ", ".join(words)


@dataclass(frozen=True)
class Trial:
    """A choice, the seconds per step that it took in each turn of a stage, and the steps of the stages in the scene."""

    choice: Choice
    turns: Turns
    steps: dict[str, int]

    def _mean(self, turns: Turns) -> tuple[float, float]:
        """(mean over the scene, its standard error) of a number per turn."""
        share = {stage: self.steps[stage] / sum(self.steps[s] for s in turns) for stage in turns}
        mean = sum(share[s] * float(np.mean(x)) for s, x in turns.items())
        return mean, math.sqrt(sum(share[s] ** 2 * float(np.var(x, ddof=1)) / len(x) for s, x in turns.items()))

    @property
    def seconds(self) -> float:
        """Seconds per step, the mean over the stages that were reached."""
        return self._mean(self.turns)[0]

    def saves(self, before: "Trial") -> tuple[float, float]:
        """(share of the time that it saves over another choice, standard error), turn by turn."""
        saved = {s: tuple(np.subtract(before.turns[s], x) / before.seconds) for s, x in self.turns.items()}
        return self._mean(saved)


@dataclass(frozen=True)
class Tuned:
    """All trials, the present choice first."""

    trials: tuple[Trial, ...]
    ranks: int

    @property
    def best(self) -> Trial:
        """The fastest, if it saves more than WORTH over the first, and more than chance; else the first."""
        first = self.trials[0]
        best = min(self.trials, key=lambda t: t.seconds)
        saved, error = best.saves(first)
        return best if saved > max(WORTH, CERTAIN * error) else first

    @property
    def stages(self) -> dict[str, Choice | None]:
        """The fastest choice in each stage; None: the trials did not reach it."""
        reached = self.trials[0].turns
        return {
            stage: min(self.trials, key=lambda t: np.mean(t.turns[stage])).choice if stage in reached else None
            for stage in self.trials[0].steps
        }

    @property
    def changes(self) -> dict[str, str | int]:
        """Keys of [numerics] that save time for certain."""
        now = self.trials[0].choice.keys
        return {key: value for key, value in self.best.choice.keys.items() if value is not None and value != now[key]}

    @property
    def reason(self) -> str:
        """Why the changes are made, a comment of the case."""
        saved, _ = self.best.saves(self.trials[0])
        ranks = "1 rank" if self.ranks == 1 else f"{self.ranks} ranks"
        return f"epdem tune: {saved:.0%} less time than {self.trials[0].choice}, {ranks}"

    @property
    def lines(self) -> list[str]:
        """The changes as lines of a case file, each with its reason."""
        return [f"{key} = {tomlkit.item(value).as_string()} # {self.reason}" for key, value in self.changes.items()]


class _Enough(Exception):
    """The time of a trial is over."""


def pieces(texts: dict[str, str], skins: list[float], length: int) -> tuple[dict[str, str], list[Piece]]:
    """The deck with its runs cut into pieces of `length` steps and one skin each, and the pieces in order: in each run
    forth and back through `skins`."""
    order: list[Piece] = []

    def cut(match: re.Match[str]) -> str:
        begin, end, lines = sum(piece.steps for piece in order), int(match[1]), []
        first = order[-1].turn + 1 if order else 0
        for n, at in enumerate(range(begin, end, length)):
            turn, place = divmod(n, len(skins))
            skin = skins[place] if turn % 2 == 0 else skins[-1 - place]
            order.append(Piece(match[2] or f"up to step {end}", min(length, end - at), first + turn, skin))
            lines += [f"neighbor {skin!r} bin", f'print "{_MARK}"', f"run {at + order[-1].steps} upto"]
        return "\n".join(lines)

    return texts | {"in.scene": _RUN.sub(cut, texts["in.scene"])}, order


def run(texts: dict[str, str], ranks: int, seconds: float) -> Loops:
    """The pieces that ended within `seconds`."""
    end = time.monotonic() + seconds

    def watch(step: int) -> None:
        if time.monotonic() > end:
            raise _Enough

    with tempfile.TemporaryDirectory(prefix="epdem_tune_") as name:
        folder = Path(name)
        write_texts(folder, texts)
        with contextlib.suppress(_Enough):
            launcher.run("in.scene", folder, ranks=ranks, report=watch)
        text = (folder / launcher.OUT).read_text(errors="replace")
        return [loop for piece in text.split(_MARK)[1:] for loop in log.loops_in(piece)[:1]]


def _silent(case: SceneCase) -> ScenePlan:
    """The plan of a scene without output but rows, which report its progress."""
    energy = {"energy": case.output.energy}  # of contacts without frames
    silent = Output(rows=100, particles=0).model_copy(update=energy)
    return plan(case.model_copy(update={"output": silent}))


def _trials(order: list[Piece], runs: dict[Choice, Loops], skins: list[float]) -> list[Trial]:
    """A trial of each skin in each run, over the turns that all runs have whole, of stages with two of them."""
    reached = order[: min(map(len, runs.values()))]
    whole = {turn for turn, n in Counter(piece.turn for piece in reached).items() if n == len(skins)}
    two = {s for s, n in Counter(p.stage for p in reached if p.turn in whole).items() if n >= 2 * len(skins)}
    if not two:
        raise EngineError("the trials ended before each skin had two turns; give them more time (--seconds)")
    steps = Counter[str]()
    for piece in order:
        steps[piece.stage] += piece.steps
    found = []
    for choice, loops in runs.items():
        for skin in skins:
            turns: dict[str, list[float]] = {}
            for piece, (seconds, n) in zip(reached, loops, strict=False):
                if piece.skin == skin and piece.turn in whole and piece.stage in two:
                    turns.setdefault(piece.stage, []).append(seconds / n)
            found.append(Trial(replace(choice, skin=skin), {s: tuple(x) for s, x in turns.items()}, dict(steps)))
    return found


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
    check_run(tool, ranks=ranks)
    now = Choice(float(scene_deck.deck(p).skin), case.numerics.processors, case.numerics.sort_interval)
    skins = [now.skin, *sorted({float(f"{share * p.smallest:.2e}") for share in SHARES} - {now.skin})]
    length = max(SHORTEST, min(LONGEST, p.steps // (TURNS * len(skins))))
    if p.steps < 2 * length * len(skins):
        raise CaseError(
            f"{path}: the scene has {p.steps} steps, two turns through its skins {2 * length * len(skins)}; it is "
            "short as it is"
        )
    cuts = [replace(now, processors=cut) for cut in _cuts(ranks)] if ranks > 1 else []
    choices = list(dict.fromkeys([now, *cuts, *(replace(now, sort_interval=n) for n in SORTS)]))
    runs: dict[Choice, Loops] = {}
    for n, choice in enumerate(choices, 1):
        progress(f"trial {n} of {len(choices)}")
        change = {"processors": choice.processors, "sort_interval": choice.sort_interval}
        texts = tool.files(_silent(case.model_copy(update={"numerics": case.numerics.model_copy(update=change)})))
        deck, order = pieces(texts, skins, length)
        runs[choice] = run(deck, ranks, seconds / len(choices))
    return Tuned(tuple(_trials(order, runs, skins)), ranks)


def write(path: Path, result: Tuned) -> None:
    """Put the changes into [numerics] of the case file; its other comments and its order stay."""
    if not result.changes:
        return
    document = tomlkit.parse(text_of(path))
    numerics = document.setdefault("numerics", tomlkit.table())
    for key, value in result.changes.items():
        numerics[key] = tomlkit.item(value).comment(result.reason)
    with atomic(path.resolve()) as temporary:  # the path may be a link
        temporary.write_text(document.as_string(), encoding="utf-8")
