# SPDX-License-Identifier: GPL-2.0-or-later
"""One case on every installed engine: theory, our laws and those of other codes, in one table and figure."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from ..base.folders import claim, results_folder
from ..base.tables import write_csv
from ..case.impact import load
from ..case.toml import named
from ..engines import ENGINES, FOREIGN, OTHERS, Engine, OwnTheory
from ..errors import CaseError
from ..impacts import report
from ..impacts.experiment import Experiment, experiment
from ..impacts.foreign import prediction as predict
from ..impacts.plan import plan
from ..impacts.run import Outcome, run, run_and_compare
from .invariance import VARIANTS, examine

COARSER = 4  # the order of convergence is seen between steps/4 and steps
OBLIQUE = ("psi_2_error", "e_t_error")  # absolute, the largest
SHOWN = ("e_n", "contact_time", "force_max")


@dataclass(frozen=True)
class Crosscheck:
    """The table, one row per model; the run behind it; why models are absent; notes on those with own laws."""

    table: pd.DataFrame
    outcome: Outcome
    absent: dict[str, str]
    notes: dict[str, str]


def models(x: Experiment) -> tuple[dict[str, Engine], dict[str, str]]:
    """Engines that can run this case here, and why the others cannot. FOREIGN ones have a theory of their own."""
    same = {n: kind for n, kind in OTHERS.items() if x.law.name in (kind.can.laws or ())}
    tools = {n: kind() for n, kind in (ENGINES | same | FOREIGN).items()}
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
    p = plan(x, prediction)
    rows, stage = run_and_compare(p, prediction, tool, folder, law=tool.name, end_power=tool.end_power)
    return rows, stage.seconds["seconds"]


def _row(tool: Engine, fine: pd.DataFrame, coarse: pd.DataFrame, x: Experiment, folder: Path) -> dict[str, object]:
    middle = fine.iloc[len(fine) // 2]
    row: dict[str, object] = {"model": tool.name, "speed": middle["speed"]}
    row |= {name: middle[name] for q in SHOWN for name in (q, q + "_theory")}
    row |= {f"{q}_error": float(fine[f"{q}_error"].max()) for q in SHOWN}
    row["order"] = math.log(coarse["e_n_error"].max() / fine["e_n_error"].max()) / math.log(COARSER)
    row |= {k: float(fine[k].max()) for k in OBLIQUE if k in fine}
    invariance = examine(tool, x, folder / "invariance" / tool.name)
    row["unequal_error"] = invariance.unequal_error if invariance else math.nan
    row |= {variant: invariance.e_n[variant] if invariance else math.nan for variant in VARIANTS}
    row["momentum"] = float(np.nanmax(list(invariance.momentum.values()))) if invariance else math.nan
    return row


def crosscheck(
    path: Path,
    *,
    law: str | None = None,
    out: Path | None = None,
    fresh: bool = False,
    force: bool = False,
    progress: Callable[[str], None] = lambda text: None,
) -> Crosscheck:
    """Run a case on all models. Raises CaseError or EngineError; engines that are not here are left out."""
    case = load(path)
    with named(path):
        x = experiment(case, law)
    tools, absent = models(x)
    own = {name: kind() for name, kind in FOREIGN.items() if name in tools}
    folder = results_folder(out, "crosscheck", case.name)
    steps = case.numerics.steps_in_contact
    few = max(10, steps // COARSER)
    with claim(folder, force=force):
        fine, coarse = (
            run(
                path,
                engines=[tool for name, tool in tools.items() if name not in own],
                laws=[law] if law else [],
                out=place,
                steps=n,
                fresh=fresh,
                progress=progress,
            )
            for place, n in ((folder, steps), (folder / "coarse", few))
        )
        prediction, middle = fine.predictions[x.law.name], x.speed.size // 2
        rows = [{"model": "theory", "speed": x.speed[middle]} | {q: getattr(prediction, q)[middle] for q in SHOWN}]
        for name, tool in tools.items():
            progress(f"{name}: invariance")
            if name in own:
                many, seconds = _own_theory(own[name], _with_steps(x, steps), folder / name)
                less, _ = _own_theory(own[name], _with_steps(x, few), folder / "coarse" / name)
            else:
                many, less = (t[t["engine"] == name] for t in (fine.results.comparison, coarse.results.comparison))
                seconds = fine.seconds[name]
            rows.append(_row(tool, many, less, x, folder) | {"seconds": seconds})
        table = pd.DataFrame(rows)
        write_csv(folder / "crosscheck.csv", table)
        report.figure(fine)
    return Crosscheck(table, fine, absent, {name: tool.note(x) for name, tool in own.items()})


def _with_steps(x: Experiment, steps: int) -> Experiment:
    return replace(x, numerics=x.numerics.model_copy(update={"steps_in_contact": steps, "error": None}))
