# SPDX-License-Identifier: GPL-2.0-or-later
"""The frames that a run of a scene writes, one file for each step: read, and looked through for what is damaged."""

from collections.abc import Callable, Collection
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from ..errors import EngineError
from ..scenes.plan.plan import ScenePlan

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
