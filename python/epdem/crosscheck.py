# SPDX-License-Identifier: GPL-2.0-or-later
"""One case on every engine and model at hand: theory, ours, and LIGGGHTS's own, in one table and one figure."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from . import report, store
from .case import load
from .engines import ENGINES, OTHERS, engine
from .engines.liggghts import Liggghts
from .experiment import Experiment, experiment
from .invariance import WAYS, examine
from .run import Outcome, run

COARSER = 4  # the order of convergence is seen between steps/4 and steps


@dataclass(frozen=True)
class Crosscheck:
    """The table of a case (one row per contender), the run behind it, and who could not take part."""

    table: pd.DataFrame
    outcome: Outcome
    absent: dict[str, str]


def contenders(x: Experiment) -> tuple[list[str], dict[str, str]]:
    """Engines that can run this law here, and why the others cannot."""
    names = list(ENGINES) + {"thornton": ["liggghts-thornton_ning"], "hertz": ["liggghts-hertz"]}.get(x.law.name, [])
    absent = {name: reason for name in names if (reason := engine(name).missing())}
    return [n for n in names if n not in absent], absent


def _worst(outcome: Outcome, name: str, quantity: str) -> float:
    rows = outcome.results.comparison
    return float(rows.loc[rows["engine"] == name, quantity + "_error"].max())


def _row(name: str, fine: Outcome, coarse: Outcome, x: Experiment, folder: Path) -> dict[str, object]:
    rows = fine.results.comparison
    mine = rows[rows["engine"] == name].reset_index(drop=True)
    middle = mine.loc[len(mine) // 2]
    ratio = _worst(coarse, name, "e_n") / _worst(fine, name, "e_n")
    row: dict[str, object] = {
        "model": name,
        "speed": middle["speed"],
        "e_n": middle["e_n"],
        "contact_time": middle["contact_time"],
        "force_max": middle["force_max"],
        **{f"{q}_error": _worst(fine, name, q) for q in ("e_n", "contact_time", "force_max")},
        "order": math.log(ratio) / math.log(COARSER),
    }
    tool = engine(name)
    # one contact in the embedded engine has no order, owner or restart to depend on
    found = examine(tool, x, folder / "invariance" / name) if isinstance(tool, Liggghts) else None
    row["unequal_error"] = found.unequal_error if found else math.nan
    for way in WAYS:
        row[way] = found.e_n[way] if found else math.nan
    row["momentum"] = float(np.nanmax(list(found.momentum.values()))) if found else math.nan
    return row | {"seconds": fine.seconds[name]}


def crosscheck(path: Path, *, law: str | None = None, out: Path | None = None, fresh: bool = False,
               progress: Callable[[str], None] = lambda text: None) -> Crosscheck:  # fmt: skip
    """Run a case on all contenders. Raises CaseError or EngineError; engines that are not here are left out."""
    case = load(path)
    x = experiment(case, law)
    names, absent = contenders(x)
    folder = out or Path("runs") / "crosscheck" / case.name
    steps = case.numerics.steps_in_contact
    words = {"engines": names, "laws": [law] if law else [], "fresh": fresh, "progress": progress}
    fine = run(path, out=folder, steps=steps, **words)
    coarse = run(path, out=folder / "coarse", steps=max(10, steps // COARSER), **words)
    rows = [{"model": "theory", "speed": x.speed[x.speed.size // 2]}]
    prediction = fine.predictions[x.law.name]
    for quantity in ("e_n", "contact_time", "force_max"):
        rows[0][quantity] = getattr(prediction, quantity)[x.speed.size // 2]
    for name in names:
        progress(f"{name}: invariance")
        rows.append(_row(name, fine, coarse, x, folder))
    table = pd.DataFrame(rows)
    with store.atomic(folder / "crosscheck.csv") as temporary:
        table.to_csv(temporary, index=False)
    report.figure(fine)
    return Crosscheck(table, fine, absent)


__all__ = ["OTHERS", "Crosscheck", "contenders", "crosscheck"]
