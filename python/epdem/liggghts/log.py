# SPDX-License-Identifier: GPL-2.0-or-later
"""What LIGGGHTS says while it runs: thermo rows and the time of its loop."""

import math
import re
from pathlib import Path

import pandas as pd

_LOOP = re.compile(r"Loop time of (\S+) on \d+ procs for (\d+) steps")


def rows(log: Path) -> pd.DataFrame:
    """All thermo rows in the order of the log, columns by LIGGGHTS's words, "Step" first; empty if there are none.

    A step stands twice where one run ends and the next one begins. Rows of other columns begin a new table: of a log
    that changes them the columns that are missing are NaN.
    """
    names: list[str] = []
    found = []
    for line in log.read_text(errors="replace").splitlines() if log.exists() else []:
        words = line.split()
        if words[:1] == ["Step"]:
            names = words
        elif names and len(words) == len(names) and words[0].isdigit():
            try:
                found.append(dict(zip(names, [int(words[0]), *map(float, words[1:])], strict=True)))
            except ValueError:
                names = []  # the rows of this run are over
    return pd.DataFrame(found)


def loops(log: Path) -> list[tuple[float, int]]:
    """(seconds, steps) of every run in a log, by the engine's own clock."""
    text = log.read_text(errors="replace") if log.exists() else ""
    return [(float(seconds), int(steps)) for seconds, steps in _LOOP.findall(text)]


def loop_seconds(log: Path) -> float:
    """The engine's own time for the steps of its last run [s]; NaN if the log does not say."""
    found = loops(log)
    return found[-1][0] if found else math.nan
