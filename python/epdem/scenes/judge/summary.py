# SPDX-License-Identifier: GPL-2.0-or-later
"""Summary of a scene for the terminal, as JSON and in sentences: checks, measures, stages."""

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from ...base import readable
from ...base.readable import in_words
from ...base.terminal import Shown, cell, frame_table, heads, warned
from ...case.parts import MEASURES, Histogram, Load, Repose
from ...case.scene import SceneCase
from ...impacts.summary import records
from ...jobs.stage import Tables
from ..plan.plan import ScenePlan
from ..tables import stages
from ..tables.columns import units
from ..tables.results import SceneResults
from . import checks
from .measures import curve, values_of

FIRST = ("phase", "asked", "reached", "error", "passed", "relative_density", "springback", "height")  # of stages
SHARES = ("error", "springback")  # in percent for readers
CHECKED = {name: name for name in ("check", "value", "expected", "unit", "error", "tolerance")} | {"passed": "pass"}


@dataclass
class SceneOutcome:
    """Outcome of a scene run."""

    plan: ScenePlan
    folder: Path
    results: SceneResults
    seconds: float
    reused: bool = False
    resumed_from: int | None = None
    warnings: list[str] = field(default_factory=list)

    @property
    def case(self) -> SceneCase:
        return self.plan.case

    @property
    def passed(self) -> bool:
        checks = self.results.tables.get("checks")
        return checks is None or bool(checks["passed"].all())


def document(outcome: SceneOutcome) -> dict[str, object]:
    """The JSON document of a run of a scene; a measure has its last frame, or of a force or torque its last row."""
    tables, measured = outcome.results.tables, list[dict[str, object]]()
    if outcome.plan.scene.measure:
        row = records(tables["measures"].tail(1)) or records(tables["rows"][["step", "time"]].tail(1))
        loads = [m for m in outcome.plan.scene.measure if isinstance(m, Load)]
        measured = [row[0] | {m.name: float(curve(m, tables)[1][-1]) for m in loads}]
    return {
        "case": outcome.case.name,
        "kind": outcome.case.kind,
        "passed": outcome.passed,
        "steps": outcome.plan.steps,
        "time_step": outcome.plan.time_step,
        "seconds": outcome.seconds,
        "reused": outcome.reused,
        "resumed_from": outcome.resumed_from,
        "warnings": outcome.warnings,
        "checks": records(tables["checks"]),
        "measures": measured,
        "stages": records(tables["stages"]) if "stages" in tables else [],
        "last_row": records(tables["rows"].tail(1))[0],
        "units": units(tables["rows"]),
    }


def shown(outcome: SceneOutcome) -> list[Shown]:
    """Checks, measures, stages, warnings and a summary line."""
    p, tables = outcome.plan, outcome.results.tables
    found: list[Shown] = []
    if len(tables["checks"]):
        found.append(frame_table(outcome.case.case.title, checked(tables["checks"]), CHECKED))
    if p.scene.measure:
        found.append(frame_table("measures", measured(p, tables)))
    if "stages" in tables:
        table, known = stages_shown(tables["stages"])
        found.append(frame_table("stages", table, heads(table, known)))
    came = " (from results.h5)" if outcome.reused else ""
    if outcome.resumed_from is not None:
        came = f" (continued from step {outcome.resumed_from})"
    summary = (
        f"{outcome.case.name}: {int(tables['rows']['particles'].iloc[-1])} spheres, {p.steps} steps of "
        f"{p.time_step:g} s, {outcome.seconds:.1f} s{came}; see {outcome.folder}/report.html"
    )
    return [*found, *stages.against_measured(p, tables), *warned(outcome.warnings), summary]


def checked(table: pd.DataFrame) -> pd.DataFrame:
    """The checks in units that readers know."""
    return readable.rows(table, ("value", "expected"))[[*CHECKED]]


def stages_shown(table: pd.DataFrame) -> tuple[pd.DataFrame, dict[str, str]]:
    """The stages of a press with what a reader asks for first, and the units of their columns; shares in percent."""
    names = [*FIRST, *(name for name in table if name not in (*FIRST, "step", "time", "porosity"))]
    shown = table.assign(**{name: 100.0 * table[name] for name in SHARES})
    good = (table["error"].abs() <= checks.STAGE) & (table["relative_density"] < 1.0)
    shown["passed"] = [bool(x) if asked else math.nan for x, asked in zip(good, table["asked"].notna(), strict=True)]
    return readable.columns(shown[names], units(table) | dict.fromkeys(SHARES, "%"))


def results(p: ScenePlan, tables: Tables) -> list[str]:
    """A sentence for each measure with its last value, and one on the stages of a press."""
    said = []
    if p.scene.measure:
        for row in measured(p, tables).to_dict("records"):
            value = f"{cell(row['value'])} {row['unit']}".rstrip()
            at = "" if row["kind"].endswith(", mean") else f" at {row['time [s]']:.4g} s"
            said.append(f"{row['measure']} ({row['kind']}): {value}{at}.")
    if "stages" in tables:
        known = stages.loaded(p, tables["stages"])
        ends = [f"{d:.3f} at {in_words(x, 'Pa')}" for d, x in known[["relative_density", "pressure"]].to_numpy()]
        back = tables["stages"]["springback"].dropna()
        percent = ", ".join(f"{100.0 * x:.3g}" for x in back)
        said.append(f"Relative density: {', '.join(ends)}." + f" Springback: {percent} %." * bool(percent))
    return said


def measured(p: ScenePlan, tables: Tables) -> pd.DataFrame:
    """The last value of each measure and its limits, in units that readers know."""
    found = []
    for m in p.scene.measure:
        if isinstance(m, Histogram):
            values = values_of(p, m, tables)
            kind, value = f"{m.kind}, mean", float(values.mean()) if values.size else math.nan
            time = tables["measures"]["time"].iloc[-1]
        else:
            times, values = curve(m, tables)
            kind, value, time = m.kind, float(values[-1]), times[-1]
            if isinstance(m, Repose):
                kind += f" of {tables['measures'][f'{m.name}_rings'].iloc[-1]:.0f} rings"
        known = values[np.isfinite(values)]
        limits = (known.min(), known.max()) if known.size else (math.nan, math.nan)
        found.append((m.name, kind, time, value, *limits, MEASURES[m.kind].unit))
    numbers = ("value", "smallest", "largest")
    return readable.rows(pd.DataFrame(found, columns=["measure", "kind", "time [s]", *numbers, "unit"]), numbers)
