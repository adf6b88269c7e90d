# SPDX-License-Identifier: GPL-2.0-or-later
"""Restart files of LIGGGHTS and LAMMPS: which of them are whole, and from which one a run continues."""

import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

from ..base.files import stored_results
from ..base.processes import ROW
from ..errors import CaseError
from ..jobs.engine import Report
from ..scenes.plan.plan import ScenePlan
from . import log
from .frames import Frames
from .input_script import StopCondition


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
    share = _share(out, step) if gone else stop.share
    return replace(stop, first=max(0, stop.first - steps), rows=stop.rows - gone // every, gone=gone, share=share)


def _share(out: Path, step: int) -> str:
    """The share of its speed that a wall near its force had after the step of a restart file, as the run printed it."""
    found = re.findall(rf"^share_at_{step}:(\S+)$", out.read_text(encoding="utf-8", errors="replace"), re.M)
    return found[-1] if found else "1.0"
