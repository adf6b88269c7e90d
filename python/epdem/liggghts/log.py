# SPDX-License-Identifier: GPL-2.0-or-later
"""The log of LIGGGHTS: thermo rows and the time of its loop."""

import math
import re
from pathlib import Path

import pandas as pd

_LOOP = re.compile(r"Loop time of (\S+) on \d+ procs for (\d+) steps")


def rows(log: Path) -> pd.DataFrame:
    """All thermo rows in the order of the log; empty if there are none.

    Columns: "run", which counts the tables from 0, "Step", and the rest by LIGGGHTS's names (NaN in tables without).
    A step stands twice where one run ends and the next one begins.
    """
    names: list[str] = []
    found: list[dict[str, float]] = []
    run = -1
    for line in log.read_text(errors="replace").splitlines() if log.exists() else []:
        words = line.split()
        if words[:1] == ["Step"]:
            names, run = words, run + 1
        elif names and len(words) == len(names) and words[0].isdigit():
            try:
                values = map(float, words[1:])
                found.append({"run": run, "Step": int(words[0])} | dict(zip(names[1:], values, strict=True)))
            except ValueError:
                names = []  # the rows of this run are over
    return pd.DataFrame(found)


def loops(log: Path) -> list[tuple[float, int]]:
    """(seconds, steps) of every run in a log, by the engine's own clock."""
    text = log.read_text(errors="replace") if log.exists() else ""
    return [(float(seconds), int(steps)) for seconds, steps in _LOOP.findall(text)]


def loop_seconds(log: Path) -> float:
    """The engine's own time for the steps of its last run [s]; NaN if the log does not contain it."""
    found = loops(log)
    return found[-1][0] if found else math.nan
