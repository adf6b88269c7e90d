# SPDX-License-Identifier: GPL-2.0-or-later
"""The log of LIGGGHTS: thermo rows and the time of its loop."""

import math
import re
from pathlib import Path

import pandas as pd

_LOOP = re.compile(r"Loop time of (\S+) on \d+ procs for (\d+) steps")
_INSERTED = re.compile(r"INFO: Particle insertion (\w+): inserted .* at step (\d+)$")
_TOTAL = re.compile(r" - a total of (\d+) particle templates ")


def rows(log: Path) -> pd.DataFrame:
    """All thermo rows in the order of the log; empty if there are none.

    Columns: "run", which counts the tables from 0, "Step", and the rest by LIGGGHTS's names (NaN in tables without).
    A step stands twice where one run ends and the next one begins.
    """
    names: list[str] = []
    table: list[dict[str, float]] = []
    run = -1
    for line in log.read_text(errors="replace").splitlines() if log.exists() else []:
        fields = line.split()
        if fields[:1] == ["Step"]:
            names, run = fields, run + 1
        elif names and len(fields) == len(names) and fields[0].isdigit():
            try:
                values = map(float, fields[1:])
                table.append({"run": run, "Step": int(fields[0])} | dict(zip(names[1:], values, strict=True)))
            except ValueError:
                names = []  # the rows of this run are over
    return pd.DataFrame(table)


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
    return loops_in(log.read_text(errors="replace") if log.exists() else "")


def loops_in(text: str) -> list[tuple[float, int]]:
    """(seconds, steps) of every run in a piece of a log."""
    return [(float(seconds), int(steps)) for seconds, steps in _LOOP.findall(text)]


def loop_seconds(log: Path) -> float:
    """The engine's own time for the steps of its last run [s]; NaN if the log does not contain it."""
    times = loops(log)
    return times[-1][0] if times else math.nan
