# SPDX-License-Identifier: GPL-2.0-or-later
"""Output of the programs: rows, ends of phases, and the time of the loop."""

import math
import re
from collections.abc import Collection
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ..errors import EngineError
from ..scenes.plan import quantities
from ..scenes.plan.phases import NO_VOID, NOT_REACHED
from ..scenes.plan.plan import ScenePlan
from ..scenes.tables import columns

_LOOP = r"Loop time of (\S+) on \d+ procs for (\d+) steps"
_INSERTED = re.compile(r"INFO: Particle insertion (\w+): inserted .* at step (\d+)$")
# thermo words of the deck and their columns; for the loads of walls see `_column`
ROWS = {x.words["thermo"]: name for name, x in quantities.ROWS.items() if "thermo" in x.words}
_LOAD, _WAY = re.compile(r"load(\d+)\[(\d)\]"), re.compile(r"(?:v_)?way(\d+)")
_HEAT = re.compile(r"flow(\d+)")
_TOTAL = re.compile(r" - a total of (\d+) particle templates ")


def rows(log: Path) -> pd.DataFrame:
    """All thermo rows in the order of the log; empty if there are none.

    Columns: "run", which counts the tables from 0, "Step", and the rest by the engine's names (NaN in tables without).
    A step stands twice where one run ends and the next one begins.
    """
    names: list[str] = []
    table: list[dict[str, float]] = []
    run = -1
    for line in log.read_text(errors="replace").splitlines() if log.exists() else []:
        fields = line.split()
        if fields[:1] == ["Step"]:
            names, run = fields, run + 1
        elif fields[:2] == ["Loop", "time"]:
            names = []  # the rows of this run are over
        elif names and len(fields) == len(names) and fields[0].isdigit():
            with suppress(ValueError):
                values = map(float, fields[1:])
                table.append({"run": run, "Step": int(fields[0])} | dict(zip(names[1:], values, strict=True)))
    return pd.DataFrame(table)


def _column(p: ScenePlan, word: str) -> str | None:
    """The column of a word of the rows, with LAMMPS's f_ or without, which in YADE is the column; None: no column."""
    if way := _WAY.fullmatch(word):
        return p.way_columns[int(way[1]) - 1]
    word = word.removeprefix("f_")
    if load := _LOAD.fullmatch(word):
        return f"{p.measured_walls[int(load[1]) - 1]}_{columns.LOADS[int(load[2]) - 1]}"
    if flow := _HEAT.fullmatch(word):
        return f"{p.heat_flows[int(flow[1])]}_heat_flow"
    loads = {f"{wall}_{load}" for wall in p.measured_walls for load in columns.LOADS}
    return ROWS.get(word, word if word in {*ROWS.values(), *loads} else None)


def scene_rows(p: ScenePlan, out: Path, on_spheres: Collection[str] = ()) -> pd.DataFrame:
    """The rows: one per step. Raises EngineError if one is missing or damaged, or holds a number that is not finite.

    on_spheres: walls whose forces in the log act on the spheres.

    A run that continues another one begins again at the step of its restart file: what the earlier run wrote beyond
    that step is replaced, but not the row of that step itself, whose means over an interval only the earlier run has.
    """
    every = rows(out)
    if every.empty:
        raise EngineError(f"{out}: no rows; the run ended before its first step")
    table: dict[int, list[float]] = {}
    words = {name: column for name in every if (column := _column(p, name))}  # and LIGGGHTS's own default
    for _, part in every.groupby("run"):
        steps, values = part["Step"].astype(int).to_list(), part[[*words]].to_numpy().tolist()
        known = {step: row for step, row in table.items() if step <= steps[0]}
        table = known | {step: row for step, row in zip(steps, values, strict=True) if step not in known}
    if (last := max(table)) != p.steps:
        raise EngineError(f"{out}: the rows end at step {last} of {p.steps}; run the case again")
    for step in range(0, p.steps, p.every):
        if not all(map(math.isfinite, table.get(step, [math.nan]))):
            raise EngineError(f"{out}: the row of step {step} is missing or damaged; run the case again")
    table = {step: row for step, row in table.items() if step % p.every == 0}  # means belong to these steps
    found = columns.rows(p, table, [*words.values()])
    opposite = [name for wall in on_spheres for load in columns.LOADS if (name := f"{wall}_{load}") in found]
    found[opposite] = -found[opposite]
    return found


def said(out: Path, pattern: str) -> list[Any]:
    """What the lines of a log say in the form of a pattern, as `re.findall` gives it; nothing without a log."""
    return re.findall(pattern, out.read_text(encoding="utf-8", errors="replace"), re.M) if out.exists() else []


def ends(out: Path, upto: float = math.inf) -> dict[str, int]:
    """The step at the end of each phase, of a scene in which one may end early, up to a step."""
    found = said(out, r"^phase (\w+) ended at step (\d+)")
    return {name: int(step) for name, step in found if int(step) <= upto}


def held(out: Path) -> dict[str, tuple[int, float, float, float]]:
    """Of each phase with a condition the step at which it was last looked at, its value, the forces [N] on the opposite
    wall of a press and, where a height or density was awaited, on its punch, else NaN."""
    found = said(out, r"^phase (\w+) held at step (\d+): (\S+)(?: (\S+))?(?: (\S+))?$")
    numbers = ((name, int(step), [float(x or "nan") for x in values]) for name, step, *values in found)
    return {name: (step, value, opposite, force) for name, step, (value, opposite, force) in numbers}


def ways(out: Path) -> dict[tuple[str, str], np.ndarray]:
    """(phase, wall): the way [m] that a force has driven the wall before the phase, shape (3,)."""
    found = said(out, r"^phase (\w+) begins, wall (\w+) has moved by (\S+) (\S+) (\S+) m")
    return {(phase, wall): np.array(way, float) for phase, wall, *way in found}


def not_reached(out: Path) -> dict[str, str]:
    """NOT_REACHED of the phases whose condition did not hold in any row; NO_VOID of a phase that left no void."""
    words = {"was not ended by its condition": NOT_REACHED, "left no void": NO_VOID}
    return {name: words[found] for name, found in said(out, rf"^phase (\w+) ({'|'.join(words)})")}


def inserted(log: Path, step: int) -> dict[str, int]:
    """The spheres that each insertion has put in up to a step; what a run did beyond the step from which another one
    went on is not counted."""
    found: list[tuple[int, str, int]] = []
    name, at, begins = "", 0, False
    for line in log.read_text(errors="replace").splitlines() if log.exists() else []:
        fields = line.split()
        if match := _INSERTED.match(line):
            name, at = match[1], int(match[2])
        elif match := _TOTAL.match(line):
            found.append((at, name, int(match[1])))
        elif fields[:1] == ["Step"]:
            begins = True
        elif begins and fields and fields[0].isdigit():
            found, begins = [x for x in found if x[0] <= int(fields[0])], False
    return {name: total for at, name, total in found if at <= step}


def loops(log: Path) -> list[tuple[float, int]]:
    """(seconds, steps) of every run in a log, by the engine's own clock."""
    return [(float(seconds), int(steps)) for seconds, steps in said(log, _LOOP)]


def loop_seconds(log: Path) -> float:
    """The engine's own time for the steps of its last run [s]; NaN if the log does not contain it."""
    times = loops(log)
    return times[-1][0] if times else math.nan
