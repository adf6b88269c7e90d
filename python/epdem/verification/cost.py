# SPDX-License-Identifier: GPL-2.0-or-later
"""Error against run time: the same impacts at 10 to 3000 steps in contact, by every given engine and law.

Absolute times are noisy; the figure of merit is the ratio to LIGGGHTS's own elastic `hertz` in the same run.
"""

import math
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ..base.tables import write_csv
from ..case.impact import Case, load
from ..case.toml import error_context
from ..engines import ImpactEngine
from ..engines.embedded import Embedded, numbers
from ..engines.host import Host
from ..engines.liggghts.engine import Liggghts
from ..engines.log import loop_seconds
from ..errors import EngineError
from ..impacts.experiment import experiment, pair_of
from ..impacts.measurement import CHECKED
from ..impacts.plan import Plan, plan
from ..impacts.prediction import Prediction, predict
from ..jobs.engine import require
from ..laws.strengths import default_numbers, find_law
from ..report.chart import GREY, INK, PALETTE, Axis, Chart, Dash, Panel, Series, save
from .models import ELASTIC, OWN_LAW, REFERENCE, SAME_LAW, engine, only_law
from .runner import STUDIES, Progress, compare_impacts, silent
from .stability.cases import HARDENING

TIMED = 300  # least steps in contact of the runs that are timed
STEPS = (10, 17, 30, 55, 100, 170, 300, 550, 1000, 1700, 3000)
QUANTITIES = ("e_n", "contact_time", "force_max")
TARGETS = (1e-2, 1e-3, 1e-4)
LEAST_PHASES = 8
EXPONENT = 0.25  # of a law that hardens, where the case has another law


@dataclass(frozen=True)
class Model:
    """An engine with a law, and the plan of each number of steps."""

    engine: ImpactEngine
    law: str
    prediction: Prediction
    plans: dict[int, Plan]

    @property
    def label(self) -> str:
        own = only_law(self.engine) or hasattr(self.engine, "own")
        return self.engine.name if own else f"{self.engine.name}, {self.law}"


@dataclass(frozen=True)
class Outcome:
    """rows: one per model and number of steps; models: one per model."""

    case: Case
    rows: pd.DataFrame
    models: pd.DataFrame
    seconds: float


def models(case: Case, engines: list[str], laws: list[str], steps: tuple[int, ...]) -> list[Model]:
    """Pairs of engine and law. With a host come its own models; LIGGGHTS's own hertz is the reference."""
    theirs: dict[str, type[ImpactEngine]] = {**SAME_LAW, **ELASTIC, "lammps-mdr": OWN_LAW["lammps-mdr"]}
    if all(find_law(law).adheres for law in laws or [case.law.name]):
        theirs = {REFERENCE: SAME_LAW[REFERENCE]}
    engines = [*engines, *(name for name in theirs if name.split("-")[0] in engines)]
    numerics = case.numerics.model_copy(update={"phases": max(case.numerics.phases, LEAST_PHASES), "error": None})
    chosen = []
    for name in dict.fromkeys(engines):
        tool = theirs[name]() if name in theirs else engine(name)
        require(tool)
        only = case.law.name if name in OWN_LAW else only_law(tool)
        for law in [only] if only else laws or [case.law.name]:
            # the case's own law keeps the case's parameters
            x = replace(experiment(case, None if law == case.law.name else law), numerics=numerics)
            if law != case.law.name and HARDENING in (defaults := default_numbers(law)).ratios:
                hardens = replace(defaults, ratios=defaults.ratios | {HARDENING: EXPONENT})
                x = replace(x, law=pair_of(hardens, x.body, x.target))
            prediction = predict(x)
            shortest = float(prediction.duration.min())
            plans = {n: plan(x, prediction, time_step=shortest / n) for n in steps}
            chosen.append(Model(tool, law, prediction, plans))
    return chosen


def converged(c: Model, folder: Path) -> Model:
    """The model with its own limit in place of theory: means over the phases at half the finest step."""
    p = c.plans[max(c.plans)]
    fine = plan(p.experiment, c.prediction, time_step=0.5 * p.time_step)
    rows, _ = compare_impacts(replace(fine, steps=2 * fine.steps), c.prediction, c.engine, folder)
    return replace(c, prediction=replace(c.prediction, **{name: rows[name].to_numpy() for name in CHECKED}))


def errors(c: Model, p: Plan, folder: Path) -> dict[str, float]:
    """Largest and rms errors over all speeds and phases, relative to theory; NaN where a contact did not end."""
    try:  # coarse steps stretch contacts
        rows, _ = compare_impacts(replace(p, steps=2 * p.steps), c.prediction, c.engine, folder)
    except EngineError:
        return {f"{q}_{kind}": np.nan for q in QUANTITIES for kind in ("error", "rms")}
    return {f"{q}_error": float(rows[f"{q}_error"].max()) for q in QUANTITIES} | {
        f"{q}_rms": float(np.sqrt((rows[f"{q}_rms"] ** 2).mean())) for q in QUANTITIES
    }


def order(steps: np.ndarray, error: np.ndarray) -> float:
    """Observed order: minus the slope of log error over log steps while the error still falls; NaN below 3 points."""
    good = np.isfinite(error) & (error < 0.2) & (error > 3 * np.nanmin(error))
    return float(-np.polyfit(np.log(steps[good]), np.log(error[good]), 1)[0]) if good.sum() > 2 else np.nan


def cheapest(rows: pd.DataFrame, target: float) -> pd.Series | None:
    """The coarsest row from which on all finer ones keep e_n within `target`; None if there is none."""
    rows = rows.sort_values("steps", ascending=False)
    good = (rows["e_n_error"] <= target).cumprod().astype(bool)
    return rows[good].iloc[-1] if good.any() else None


def seconds(tool: ImpactEngine, plan: Plan, folder: Path) -> dict[str, float]:
    """Times of one run with the least possible output [s]: startup, setup, stepping; NaN where unknown."""
    if isinstance(tool, Embedded):
        x, begin = plan.experiment, time.perf_counter()
        law = x.native_law()
        ready = time.perf_counter()
        law.impacts(steps=plan.steps, **numbers(plan))
        return {"startup": 0.0, "setup": ready - begin, "stepping": time.perf_counter() - ready}
    assert isinstance(tool, Host)
    deck, *_ = tool.write(plan, folder)
    lines = deck.read_text(encoding="utf-8").splitlines(keepends=True)
    # stepping, not writing
    kept = (line for line in lines if not line.startswith(("dump", '    PyRunner(command="record()"')))
    deck.write_text("".join(kept), encoding="utf-8")
    startup = math.nan
    if isinstance(tool, Liggghts):
        (folder / "in.empty").write_text("# nothing\n", encoding="utf-8")
        startup = tool.start("in.empty", folder, out="out.empty", seconds=120)
    total = tool.start(deck.name, folder, seconds=600)
    stepping = loop_seconds(folder / tool.launcher.OUT)
    setup = total - stepping - (0.0 if math.isnan(startup) else startup)
    return {"startup": startup, "setup": max(setup, 0.0), "stepping": stepping}


def _timings(chosen: list[Model], steps: list[int], repetitions: int, folder: Path, progress: Progress) -> pd.DataFrame:
    """One row per repetition, model and steps. Models alternate, so that drifts of the machine hit all."""
    rows: list[dict[str, Any]] = []
    for k in range(repetitions):
        for n in steps:
            for c in chosen:
                progress(f"time {k + 1}/{repetitions}: {c.label}, {n} steps")
                rows.append({"repetition": k, "model": c.label, "steps": n} | seconds(c.engine, c.plans[n], folder))
                rows[-1]["ns_per_step"] = rows[-1]["stepping"] / (c.plans[n].n * c.plans[n].steps) * 1e9
    return pd.DataFrame(rows)


def over_reference(times: pd.DataFrame, value: str, keys: list[str]) -> pd.Series:
    """Column `value` over that of the reference in the row with the same `keys`; NaN without a reference."""
    reference = times[times["model"] == REFERENCE].set_index(keys)[value]
    return times[value] / reference.reindex(pd.MultiIndex.from_frame(times[keys])).to_numpy()


def run(
    case_path: Path | str,
    *,
    engines: list[str],
    laws: list[str],
    steps: tuple[int, ...] = STEPS,
    repetitions: int = 5,
    progress: Progress = silent,
) -> Outcome:
    """Errors and times of every model at every number of steps in the shortest contact (no engines: the study's)."""
    case, begin = load(case_path), time.perf_counter()
    with error_context(case_path):
        chosen = models(case, engines or [*STUDIES["cost"].engines], laws, steps)
    rows = []
    with tempfile.TemporaryDirectory(prefix="epdem-cost-") as scratch:
        folder = Path(scratch)
        for c in chosen:
            progress(f"limit: {c.label}")
            c = converged(c, folder) if hasattr(c.engine, "own") else c
            for n in steps:
                progress(f"error: {c.label}, {n} steps")
                row = {"model": c.label, "engine": c.engine.name, "law": c.law, "steps": n, "impacts": c.plans[n].n}
                rows.append(row | errors(c, c.plans[n], folder))
        timed = [n for n in steps if n >= min(TIMED, max(steps))]
        times = _timings(chosen, timed, repetitions, folder, progress)
    return Outcome(case, *_combine(pd.DataFrame(rows), times), time.perf_counter() - begin)


def _combine(rows: pd.DataFrame, times: pd.DataFrame) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Medians of the times beside the errors; then one row per model."""
    times["ratio"] = over_reference(times, "ns_per_step", ["repetition", "steps"])
    middle = times.groupby("model")[["startup", "setup", "ns_per_step", "ratio"]].median()
    rows = rows.merge(middle.reset_index(), on="model")
    rows["ns_per_impact"] = rows["ns_per_step"] * rows["steps"]
    summary = []
    for label, part in rows.groupby("model", sort=False):
        fine = times[times["model"] == label]
        row = {
            "model": label,
            "order": order(part["steps"].to_numpy(), part["e_n_error"].to_numpy()),
            "best_error": part["e_n_error"].min(),
            "ns_per_step": fine["ns_per_step"].median(),
            "ratio_to_hertz": fine["ratio"].median(),
            "ratio_spread": fine["ratio"].quantile(0.75) - fine["ratio"].quantile(0.25),
            "startup": part["startup"].median(),
            "setup": part["setup"].median(),
        }
        for target in TARGETS:
            best = cheapest(part, target)
            row[f"steps_for_{target:g}"] = np.nan if best is None else int(best["steps"])
            row[f"ns_for_{target:g}"] = np.nan if best is None else float(best["ns_per_impact"])
        summary.append(row)
    return rows, pd.DataFrame(summary)


DASHES: tuple[Dash, ...] = ("solid", "dashdot")  # of laws, one after the other when the palette begins again


def write(outcome: Outcome, folder: Path, formats: Sequence[str] = ("png",)) -> list[Path]:
    """cost.csv, a row for each model and number of steps, and the figure cost in `folder`; their paths."""
    write_csv(folder / "cost.csv", outcome.rows)
    return [folder / "cost.csv", *save(chart(outcome.rows, outcome.case.case.title), folder, formats, data=False)]


def chart(rows: pd.DataFrame, title: str) -> Chart:
    """The work-precision figure of an outcome's rows: error of e_n against time per contact and against steps.

    Colour and kind of line are a law, a kind of points an engine; models of other codes are black. Each law has the
    errors of the first engine, which the other engines repeat.
    """
    left: list[Series] = []
    right: list[Series] = []
    engines: list[str] = []
    laws: list[str] = []
    for label, part in rows.groupby("model", sort=False):
        engine, _, law = str(label).partition(", ")
        error, steps = part["e_n_error"].to_numpy(), part["steps"].to_numpy(float)
        is_new = engine not in engines
        engines += [engine] if is_new else []
        k = engines.index(engine)
        colour, line = INK, DASHES[0]
        if law:
            laws += [law] if law not in laws else []
            colour = laws.index(law) % len(PALETTE)
            line = DASHES[laws.index(law) // len(PALETTE)]
        left.append(Series(engine if is_new else "", part["ns_per_impact"].to_numpy(), error, colour, line, k))
        if not law or k == 0:
            right.append(Series(law or engine, steps, error, colour, line if law else "dot", k))
    n = np.array([rows["steps"].min(), rows["steps"].max()], float)
    right.append(Series("order 2", n, 5 * n**-2.0, GREY, "dash"))
    error_axis = Axis("largest error of $e_n$", log=True)
    return Chart(
        "cost",
        f"{title}: error against run time",
        "Error of e_n against the time of a contact, steps times time per step, and against the steps in the shortest "
        "contact, one curve for each model.",
        [
            Panel(Axis("time of a contact", "ns", log=True), error_axis, left),
            Panel(Axis("steps in the shortest contact", log=True), error_axis, right),
        ],
        beside=True,
    )


def tables(outcome: Outcome) -> dict[str, pd.DataFrame]:
    """All tables by title."""
    errors = [f"{q}_{kind}" for q in QUANTITIES for kind in ("error", "rms")]
    return {
        f"{outcome.case.case.title}: errors (max and rms over speeds and phases)": outcome.rows[
            ["model", "steps", *errors, "ns_per_impact"]
        ],
        "coarsest steps for an error of e_n, and their stepping time per impact": outcome.models,
    }
