# SPDX-License-Identifier: GPL-2.0-or-later
"""One case on every installed engine: theory, our laws and those of other codes, in one table and figure."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import pandas as pd

from ..base.files import claim, results_folder
from ..base.tables import write_csv
from ..base.terminal import Shown, frame_table
from ..case.impact import load
from ..case.toml import error_context
from ..engines import ENGINES, ImpactEngine
from ..engines.yade.engine import Yade
from ..errors import CaseError, EngineError
from ..impacts.experiment import Experiment, experiment
from ..impacts.measurement import CHECKED
from ..impacts.plan import plan
from ..impacts.run import Outcome, run
from .models import OWN_LAW, SAME_LAW
from .models.theories import prediction as predict
from .runner import Progress, compare_impacts, silent
from .variants import VARIANTS, examine

COARSER = 4  # the order of convergence is seen between steps/4 and steps
OBLIQUE = ("psi_2_error", "e_t_error")  # absolute, the largest
PASS, FAIL, OTHERS_WITHIN, OTHERS_OUTSIDE = "pass", "fail", "other code: within", "other code: outside"
SHOWN = ("e_n", "contact_time", "force_max")


@dataclass(frozen=True)
class Crosscheck:
    """The table, one row per model; the run behind it; why models are absent; notes on those with own laws.

    Column `check` is PASS or FAIL for epdem's engines, and OTHERS_WITHIN or OTHERS_OUTSIDE for models of other codes,
    whose errors are no fault of epdem.
    """

    table: pd.DataFrame
    outcome: Outcome
    absent: dict[str, str]
    notes: dict[str, str]

    @property
    def passed(self) -> bool:
        """Whether epdem's engines are within the tolerances of the case, in every variant of the set-up."""
        return FAIL not in set(self.table["check"])

    @property
    def others_outside(self) -> list[str]:
        """The models of other codes that are outside of the tolerances of the case."""
        return [str(name) for name in self.table["model"][self.table["check"] == OTHERS_OUTSIDE]]


def models(x: Experiment, chosen: Sequence[str] = ()) -> tuple[dict[str, ImpactEngine], dict[str, str]]:
    """Engines and models (those `chosen`; none: all) that can run this case here, and why the others cannot.

    Raises CaseError for a name that does not exist, EngineError if nothing can run.
    """
    known = ENGINES | SAME_LAW | OWN_LAW
    if wrong := [name for name in chosen if name not in known]:
        raise CaseError(f"--engine {wrong[0]!r} does not exist; there are {', '.join(known)}")
    other_law = {n for n, kind in SAME_LAW.items() if x.law.name not in (kind.laws or ())}
    tools = {n: kind() for n, kind in known.items() if n in chosen or not (chosen or n in other_law)}
    absent = {name: reason for name, tool in tools.items() if (reason := tool.missing())}
    for name, tool in tools.items():
        try:
            if name not in absent:
                tool.check(plan(_with_steps(x, 100), predict(tool, x)))
        except CaseError as error:
            absent[name] = str(error)
    if not (here := {n: t for n, t in tools.items() if n not in absent}):
        raise EngineError("; ".join(f"{name}: {reason}" for name, reason in absent.items()))
    return here, absent


def _compared(tool: ImpactEngine, x: Experiment, folder: Path) -> tuple[pd.DataFrame, float]:
    """An engine against the theory of what it runs: (one row per speed, seconds)."""
    prediction = predict(tool, x)
    return compare_impacts(plan(x, prediction), prediction, tool, folder)


def _row(
    tool: ImpactEngine, fine: pd.DataFrame, coarse: pd.DataFrame, x: Experiment, folder: Path
) -> dict[str, object]:
    middle, worst = fine.iloc[len(fine) // 2], fine.max(numeric_only=True)
    row: dict[str, object] = {"model": tool.name, "speed": middle["speed"]}
    row |= {name: middle[name] for q in SHOWN for name in (q, q + "_theory")}
    row |= {f"{q}_error": worst[f"{q}_error"] for q in SHOWN}
    row["order"] = math.log(coarse["e_n_error"].max() / worst["e_n_error"]) / math.log(COARSER)
    row |= {k: worst[k] for k in OBLIQUE if k in fine}
    changes = examine(tool, x, folder / "invariance" / tool.name)
    # psi_2 counts where the friction is the case's, not the host's own
    checked = [*CHECKED, *(["psi_2"] if "psi_2_error" in fine and not isinstance(tool, Yade) else [])]
    within = all(bool((fine[f"{name}_error"] <= getattr(x.check, name)).all()) for name in checked)
    # e_n of unequal spheres is that of theory, and changes in no variant by more than the tolerance of e_n
    within &= not any(changes.get(name, math.nan) > x.check.e_n for name in ("unequal_error", *VARIANTS))
    names = (PASS, FAIL) if tool.name in ENGINES else (OTHERS_WITHIN, OTHERS_OUTSIDE)
    return row | changes | {"check": names[0] if within else names[1]}


def crosscheck(
    path: Path,
    *,
    engines: Sequence[str] = (),
    law: str | None = None,
    out: Path | None = None,
    fresh: bool = False,
    force: bool = False,
    progress: Progress = silent,
) -> Crosscheck:
    """Run a case on every engine and every model of another code, or on those named by `engines`.

    Engines that are not installed or cannot run the case are left out. Raises CaseError, EngineError.
    """
    case = load(path)
    with error_context(path):
        x = experiment(case, law)
    tools, absent = models(x, engines)
    own = {name: kind.own.of(x).note for name, kind in OWN_LAW.items() if name in tools}
    folder = results_folder(out, "crosscheck", case.name)
    steps, laws = case.numerics.steps_in_contact, [law] if law else []
    fewer = _with_steps(x, max(10, steps // COARSER))
    with claim(folder, force=force):
        ours = [tool for name, tool in tools.items() if name not in own]
        fine = run(path, engines=ours, laws=laws, out=folder, steps=steps, fresh=fresh, progress=progress)
        rows, found = [_theory(fine, x)], fine.results.comparison
        for name, tool in tools.items():
            progress(f"{name}: invariance")
            if name in own:
                many, seconds = _compared(tool, _with_steps(x, steps), folder / name)
            else:
                many, seconds = found[found["engine"] == name], fine.seconds[name]
            few, _ = _compared(tool, fewer, folder / "coarse" / name)
            rows.append(_row(tool, many, few, x, folder) | {"seconds": seconds})
        table = pd.DataFrame(rows)
        write_csv(folder / "crosscheck.csv", table)
    return Crosscheck(table, fine, absent, own)


def _theory(fine: Outcome, x: Experiment) -> dict[str, object]:
    prediction, middle = fine.predictions[x.law.name], x.speed.size // 2
    numbers = {q: getattr(prediction, q)[middle] for q in SHOWN}
    return {"model": "theory", "speed": x.speed[middle], **numbers, "check": ""}


def _with_steps(x: Experiment, steps: int) -> Experiment:
    return replace(x, numerics=x.numerics.model_copy(update={"steps_in_contact": steps, "error": None}))


VALUES = ["model", "check", "e_n", "e_n_theory", "contact_time", "force_max"]
VALUES += ["e_n_error", "contact_time_error", "force_max_error", "psi_2_error", "e_t_error", "order", "seconds"]
CHANGES = ["model", "unequal_error", "swap", "sort", "migration", "restart", "momentum"]
NOTE = """check: against the tolerances of the case; deviations of other codes are theirs and fail nothing.
unequal_error: of e_n of two spheres of unequal radii and moduli; swap to restart: changes of e_n in these variants of
the set-up; momentum: lost, as a share of one body's change. A serial YADE sorts nothing and has no ranks (-);
an embedded contact has neither ids nor restarts; inf: the run died or lost bodies."""


def crosscheck_tables(title: str, frame: pd.DataFrame) -> list[Shown]:
    """The tables of a crosscheck: values and errors, then changes in variants of the set-up, and a note."""
    head = f"{title}: values at {frame['speed'].iloc[0]:.4g} m/s, largest errors over speeds and phases"
    values = frame[[name for name in VALUES if name in frame]].round({"order": 2, "seconds": 2})
    shown: list[Shown] = [frame_table(head, values, digits=6)]
    if not (changed := frame.reindex(columns=CHANGES).dropna(subset="momentum")).empty:
        shown.append(frame_table("Two spheres of unequal radii and moduli", changed, digits=2))
    return [*shown, NOTE]
