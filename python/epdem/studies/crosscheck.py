# SPDX-License-Identifier: GPL-2.0-or-later
"""One case on every engine and model at hand: theory, ours, and what others bring along, in one table and figure."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from ..case.impact import load
from ..engines import ENGINES, FOREIGN, OTHERS, Engine, OwnTheory
from ..errors import CaseError
from ..folders import claim
from ..impacts import report
from ..impacts.comparison import compare
from ..impacts.experiment import Experiment, experiment
from ..impacts.foreign import prediction as predict
from ..impacts.plan import plan
from ..impacts.run import Outcome, run, run_plan
from ..tables import write_csv
from .invariance import WAYS, examine

COARSER = 4  # the order of convergence is seen between steps/4 and steps
SHOWN = ("e_n", "contact_time", "force_max")


@dataclass(frozen=True)
class Crosscheck:
    """The table of a case (one row per contender), the run behind it, who could not take part, and what to know."""

    table: pd.DataFrame
    outcome: Outcome
    absent: dict[str, str]
    notes: dict[str, str]


def contenders(x: Experiment) -> tuple[dict[str, Engine], dict[str, str]]:
    """Engines that can run this case here, and why the others cannot. FOREIGN ones have a theory of their own."""
    same = {"thornton": ["liggghts-thornton_ning"], "hertz": ["liggghts-hertz"]}.get(x.law.name, [])
    tools = {n: kind() for n, kind in (ENGINES | OTHERS | FOREIGN).items() if n not in OTHERS or n in same}
    absent = {name: reason for name, tool in tools.items() if (reason := tool.missing())}
    for name, tool in tools.items():
        try:
            if name not in absent:
                tool.check(plan(_with_steps(x, 100), predict(tool, x)))
        except CaseError as error:
            absent[name] = str(error)
    return {n: t for n, t in tools.items() if n not in absent}, absent


def _own_theory(tool: OwnTheory, x: Experiment, folder: Path) -> tuple[pd.DataFrame, float]:
    """An engine with a law of its own against its own theory: (one row per speed, seconds)."""
    prediction = tool.predict(x)
    stage = run_plan(plan(x, prediction), tool, folder, end_power=tool.end_power)
    return compare(tool.name, tool.name, stage.impacts, prediction, x.check), stage.seconds["seconds"]


def _row(tool: Engine, fine: pd.DataFrame, coarse: pd.DataFrame, x: Experiment, folder: Path) -> dict[str, object]:
    middle = fine.iloc[len(fine) // 2]
    row: dict[str, object] = {"model": tool.name, "speed": middle["speed"]}
    row |= {name: middle[name] for q in SHOWN for name in (q, q + "_theory")}
    row |= {f"{q}_error": float(fine[f"{q}_error"].max()) for q in SHOWN}
    row["order"] = math.log(float(coarse["e_n_error"].max()) / row["e_n_error"]) / math.log(COARSER)
    found = examine(tool, x, folder / "invariance" / tool.name)
    row["unequal_error"] = found.unequal_error if found else math.nan
    for way in WAYS:
        row[way] = found.e_n[way] if found else math.nan
    row["momentum"] = float(np.nanmax(list(found.momentum.values()))) if found else math.nan
    return row


def crosscheck(
    path: Path,
    *,
    law: str | None = None,
    out: Path | None = None,
    fresh: bool = False,
    progress: Callable[[str], None] = lambda text: None,
) -> Crosscheck:
    """Run a case on all contenders. Raises CaseError or EngineError; engines that are not here are left out."""
    case = load(path)
    x = experiment(case, law)
    tools, absent = contenders(x)
    folder = out or Path("runs") / "crosscheck" / case.name
    with claim(folder):
        return _crosscheck(path, case, x, law, folder, tools, absent, fresh, progress)


def _crosscheck(path, case, x, law, folder, tools, absent, fresh, progress) -> Crosscheck:
    steps = case.numerics.steps_in_contact
    few = max(10, steps // COARSER)
    ours = [tool for name, tool in tools.items() if name not in FOREIGN]
    words = {"engines": ours, "laws": [law] if law else [], "fresh": fresh, "progress": progress}
    fine = run(path, out=folder, steps=steps, **words)
    coarse = run(path, out=folder / "coarse", steps=few, **words)
    prediction, middle = fine.predictions[x.law.name], x.speed.size // 2
    rows = [{"model": "theory", "speed": x.speed[middle]} | {q: getattr(prediction, q)[middle] for q in SHOWN}]
    for name, tool in tools.items():
        progress(f"{name}: invariance")
        if name in FOREIGN:
            many, seconds = _own_theory(tool, _with_steps(x, steps), folder / name)
            less, _ = _own_theory(tool, _with_steps(x, few), folder / "coarse" / name)
        else:
            many, less = (t[t["engine"] == name] for t in (fine.results.comparison, coarse.results.comparison))
            seconds = fine.seconds[name]
        rows.append(_row(tool, many, less, x, folder) | {"seconds": seconds})
    table = pd.DataFrame(rows)
    write_csv(folder / "crosscheck.csv", table)
    report.figure(fine)
    notes = {name: tool.note(x) for name, tool in tools.items() if name in FOREIGN}
    return Crosscheck(table, fine, absent, notes)


def _with_steps(x: Experiment, steps: int) -> Experiment:
    return replace(x, numerics=x.numerics.model_copy(update={"steps_in_contact": steps, "error": None}))
