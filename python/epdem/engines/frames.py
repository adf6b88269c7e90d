# SPDX-License-Identifier: GPL-2.0-or-later
"""The frames that a run of a scene writes, one file for each step: read, and looked through for what is damaged."""

import re
from collections.abc import Callable, Collection
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd

from ..base.files import stored_results
from ..base.processes import ROW
from ..errors import CaseError, EngineError
from ..jobs.engine import Report
from ..scenes.plan.plan import ScenePlan
from ..scenes.tables import columns
from . import log
from .input_script import StopCondition

# by kind: name of the file of a step, the steps, the table of one file
Kinds = dict[str, tuple[str, list[int], Callable[[Path], pd.DataFrame]]]


@dataclass(frozen=True)
class Frames:
    """The frames of a run of this plan, without some steps; other files of such names are the user's."""

    plan: ScenePlan
    folder: Path
    kinds: Kinds
    without: Collection[int] = ()

    def table(self, kind: str) -> pd.DataFrame:
        """The frames of a kind, one below the other. Raises EngineError for one that is missing or not whole."""
        name, steps, read = self.kinds[kind]
        tables = []
        for step in (n for n in steps if n not in self.without):
            tables.append(_read(self.folder / name.format(step), read))
            tables[-1].insert(0, "step", step)
        return pd.concat(tables, ignore_index=True)

    def spheres(self) -> pd.DataFrame:
        """Every sphere of every frame, SI. Raises EngineError for a frame that is not whole."""
        return columns.whole(self.plan, self.table("particles"), self.folder)

    def whole_at(self, step: int) -> dict[Path, bytes]:
        """The files of a step that are whole: what a run that goes on there computes before its first step differs."""
        paths = [(self.folder / name.format(step), read) for name, _, read in self.kinds.values()]
        found = {}
        for path, read in paths:
            with suppress(EngineError):
                _read(path, read)
                found[path] = path.read_bytes()
        return found

    def damaged(self, upto: int) -> list[int]:
        """Steps up to `upto` of which a frame is missing or not whole."""
        lost = set()
        for name, steps, read in self.kinds.values():
            for step in (n for n in steps if n <= upto):
                try:
                    _read(self.folder / name.format(step), read)
                except EngineError:
                    lost.add(step)
        return sorted(lost)


def _read(path: Path, read: Callable[[Path], pd.DataFrame]) -> pd.DataFrame:
    try:
        table = read(path)
        if path.name.startswith("particles"):  # a sphere without numbers is named by all its frame
            return table
        lost = ~np.isfinite(table.select_dtypes("number").to_numpy(float)).all(axis=1)
        if lost.any():
            raise ValueError(f"row {int(lost.argmax()) + 1} lacks a number")
        return table
    except EngineError:
        raise
    except Exception as error:  # of a damaged head numpy says almost anything
        reason = " ".join(str(error).split()) or type(error).__name__
        raise EngineError(f"{path}: incomplete ({reason}); run the case again") from None


def text_frame(path: Path, names: list[str]) -> pd.DataFrame:
    """The table of a text dump of LIGGGHTS or LAMMPS. Raises OSError, ValueError if it is not whole; its head tells the
    number of its lines."""
    head, lines = (text := path.read_text(encoding="utf-8").split("\n"))[:9], text[9:]
    values = np.array(" ".join(lines).split(), float).reshape(-1, len(names))
    if len(head) < 9 or not len(values) == len(lines) - 1 == int(head[3]):
        raise ValueError(f"{len(lines) - 1} lines of {head[3] if len(head) > 3 else 'a file without a head'}")
    return pd.DataFrame(values, columns=names)


def restart_files(folder: Path) -> list[tuple[int, Path]]:
    """(step, file) of each restart file of a run in a folder."""
    ours = [p for p in folder.glob("restart.*.bin") if p.name not in stored_results(folder).foreign]
    names = [(re.fullmatch(r"restart\.(\d+)\.bin", p.name), p) for p in ours]
    return sorted((int(m[1]), p) for m, p in names if m)


def whole_restarts(folder: Path, out: Path) -> list[int]:
    """Steps of the whole restart files: the engine went on after them, so their rows stand twice in succession."""
    if not out.exists():
        return []
    rows = [int(m.group(1)) for line in out.read_bytes().splitlines() if (m := ROW.match(line))]
    gone_on = {a for a, b in pairwise(rows) if a == b}
    return [step for step, _ in restart_files(folder) if step in gone_on]


def prune(folder: Path, step: int) -> None:
    """Keep the newest restart file from before `step`, which the engine has gone on after, and all later ones."""
    for _, path in [(s, p) for s, p in restart_files(folder) if s < step][:-1]:
        path.unlink(missing_ok=True)


def pruning(folder: Path, report: Report) -> Report:
    """A report of progress that also removes restart files."""

    def row(step: int) -> None:
        prune(folder, step)
        report(step)

    return row


def choose(frames: Frames, out: Path) -> tuple[int, list[int]]:
    """(step to continue from, steps of earlier frames that are missing or not whole and will stay so).

    The newest restart file before the damaged frames, which are written again; else the one in whose step the first of
    them stands, for what an engine computes there before its next step can differ; if there is none, the newest. Raises
    CaseError if there is none at all.
    """
    p, folder = frames.plan, frames.folder
    steps = [step for step in whole_restarts(folder, out) if step < p.steps]  # at the end nothing is left to run
    if not steps:
        raise CaseError(f"{folder}: no restart file to continue from; set output.restarts in the case and run it")
    lost = frames.damaged(steps[-1])
    before = [step for step in steps if not lost or step < lost[0]]
    step = (before or [step for step in steps if step == lost[0]] or steps)[-1]
    return step, [s for s in lost if s < step]


def phase_at(p: ScenePlan, out: Path, step: int) -> tuple[int, int]:
    """(number, first step) of the phase in which a run continues from a step; number len(p.phases): none is left."""
    ends = log.ends(out, step) if p.ends_early else {phase.name: phase.end for phase in p.phases}
    number = next((i for i, phase in enumerate(p.phases) if ends.get(phase.name, step + 1) > step), len(p.phases))
    return number, max([0, *(ends[phase.name] for phase in p.phases[:number])])


def later(stop: StopCondition | None, out: Path, step: int, steps: int, every: int) -> StopCondition | None:
    """The condition of a phase of which `steps` have run up to a step, with rows of `every` steps."""
    if stop is None:
        return None
    gone = max(0, steps - stop.first)
    # the share of its speed that a wall near its force had after the step of a restart file, as the run printed it
    share = (log.said(out, rf"^share_at_{step}:(\S+)$") or ["1.0"])[-1] if gone else stop.share
    return replace(stop, first=max(0, stop.first - steps), rows=stop.rows - gone // every, gone=gone, share=share)
