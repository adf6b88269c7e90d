# SPDX-License-Identifier: GPL-2.0-or-later
"""One point of a sweep: its case runs, and its numbers are stored; a point that fails is stored with its reason."""

import contextlib
import errno
import shutil
from functools import cache
from pathlib import Path
from typing import Any

import pandas as pd

from ...case import impact, scene
from ...case.toml import named
from ...engines import engine, scene_engine
from ...errors import CaseError, EngineError, EpdemError
from ...impacts.engine import Feature, ImpactEngine, refuse
from ...impacts.experiment import experiment
from ...impacts.plan import plan
from ...impacts.prediction import predict
from ...impacts.run import run_and_compare
from ...scenes.run import run as run_scene
from . import folder as store
from .folder import Sweep
from .table import numbers_of

FULL = 1 << 16  # bytes; with less free space on the disk, a failure is a full disk


def check(sweep: Sweep, number: int) -> CaseError | None:
    """What is wrong with the case of a point, if anything; nothing runs."""
    data, place = sweep.data(number), sweep.place(number)
    try:
        if sweep.scene:
            scene.parse(data, place)
            return None
        case = impact.parse(data, place)
        with named(place):
            for law in sweep.laws or (None,):
                experiment(case, law)
    except CaseError as error:
        return error
    return None


def evaluate(sweep: Sweep, folder: Path, number: int, *, resume: bool = True) -> str:
    """Run a point and store its results; returns the reason of a failure, or "".

    Raises OSError if results cannot be stored, and whatever stops the process; the point is then as if it had not run,
    except that a scene with restart files goes on from them.
    """
    about = store.begin(sweep, folder, number)
    place = store.of(sweep, folder, number)
    try:
        rows = _scene(sweep, place, resume=resume) if sweep.scene else _impacts(sweep, number, place)
    except OSError:
        raise
    except Exception as error:  # of any kind: the other points run
        if shutil.disk_usage(place).free < FULL:
            raise OSError(errno.ENOSPC, "no space left on the disk", str(place)) from None
        reason = str(error) if isinstance(error, EpdemError) else f"{type(error).__name__}: {error}"
        reason = " ".join(reason.replace(f"{place}/", "").split())
        store.end(sweep, folder, number, about, rows=None, reason=reason)
        return reason
    store.end(sweep, folder, number, about, rows=rows)
    return ""


@cache
def _tools(names: tuple[str, ...]) -> tuple[ImpactEngine, ...]:
    """Engines of impacts; a process that works at many points starts each of them once."""
    return tuple(engine(name, stay=True) for name in names)


def _impacts(sweep: Sweep, number: int, place: Path) -> dict[str, list[Any]]:
    """The comparison with theory, a row for every speed, engine and law."""
    case, tables = impact.parse(sweep.data(number), store.CASE), []
    for law in sweep.laws or (None,):
        x = experiment(case, law)
        prediction = predict(x)
        p = plan(x, prediction)
        for tool in _tools(sweep.engines):
            refuse(tool, p, prediction, ranks=sweep.ranks)
            at = place / x.law.name / tool.name if Feature.DECK in tool.features else place
            tables.append(run_and_compare(p, prediction, tool, at, ranks=sweep.ranks)[0])
    table = tables[0] if len(tables) == 1 else pd.concat(tables, ignore_index=True)
    return {str(name): table[name].tolist() for name in table.columns}


def _scene(sweep: Sweep, place: Path, *, resume: bool) -> dict[str, list[Any]]:
    """The named numbers of a scene, in one row; a scene that was interrupted goes on from its last restart file."""
    tool = scene_engine(sweep.engines[0])

    def once(go_on: bool) -> dict[str, list[Any]]:
        outcome = run_scene(place / store.CASE, tool, out=place, ranks=sweep.ranks, resume=go_on, force=True)
        row = {"engine": tool.name, **numbers_of(outcome.results), "passed": outcome.passed}
        return {name: [value] for name, value in row.items()}

    interrupted = any(place.glob("restart.*.bin")) and not (place / "results.h5").exists()
    if resume and interrupted and Feature.RESTART in tool.features:
        with contextlib.suppress(CaseError, EngineError):  # no whole restart file, or one of another deck
            return once(True)
    return once(False)
