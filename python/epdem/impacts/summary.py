# SPDX-License-Identifier: GPL-2.0-or-later
"""Summary of a run for the terminal and as JSON."""

from dataclasses import replace

import numpy as np
import pandas as pd
from rich.table import Table

from ..base.terminal import Shown, frame_table, warned
from .measurement import CHECKED
from .prediction import predict
from .prediction_report import costs, plain, sentence, yielding
from .run import Outcome

# heads of the table of a run, by column
NORMAL = {
    "speed": "v [m/s]",
    "engine": "engine",
    "law": "law",
    "e_n": "e_n",
    "e_n_theory": "theory",
    "e_n_error": "error",
    "t_c": "t_c [us]",
    "force_max": "F_max [N]",
    "overlap": "overlap [um]",
    "steps_in_contact": "steps",
    "passed": "pass",
}
OBLIQUE = {
    "speed": "v_n [m/s]",
    "degrees": "angle",
    "spin_before": "spin [rad/s]",
    "engine": "engine",
    "e_n": "e_n",
    "e_t": "e_t",
    "e_t_theory": "theory",
    "psi_1": "psi_1",
    "psi_2": "psi_2",
    "psi_2_theory": "theory",
    "psi_2_error": "error",
    "ratio": "f/mu",
    "regime": "regime",
    "rebound": "rebound",
    "spin": "spin",
    "passed": "pass",
}
FEW = 10  # impacts of each engine and law in the short table


def records(rows: pd.DataFrame) -> list[dict[str, object]]:
    """The rows of a table for JSON."""
    return [{str(k): plain(value) for k, value in row.items()} for row in rows.to_dict("records")]


def document(outcome: Outcome) -> dict[str, object]:
    """The JSON document of a run."""
    return {
        "case": outcome.case.name,
        "passed": outcome.passed,
        "seconds": outcome.seconds,
        "yields": {law: list(p.yields) for law, p in outcome.predictions.items()},
        "warnings": outcome.warnings,
        "cost": {law: cost for law, (_, cost) in _costs(outcome).items()},
        "rows": records(outcome.results.comparison),
    }


def select_rows(outcome: Outcome, full: bool) -> pd.DataFrame:
    """The printed rows: all, or FEW impacts over the whole range of every engine and law."""
    rows = outcome.results.comparison
    place = rows.groupby(["law", "engine"]).cumcount()
    if full or place.max() < FEW:
        return rows
    return rows[place.isin(np.linspace(0, place.max(), FEW).round().astype(int))]


def run_table(outcome: Outcome, *, full: bool = False) -> Table:
    """One row per speed and engine, and per angle and spin of oblique impacts; FEW of them unless `full`."""
    rows = select_rows(outcome, full)
    title, order = outcome.case.case.title, ["law", "speed", "engine"]
    if outcome.case.impact.oblique:
        columns, order = OBLIQUE, ["law", "speed", "angle", "spin_before", "engine"]
        rows = _with_regimes(outcome, rows)
    else:
        columns = {name: head for name, head in NORMAL.items() if name != "law" or rows["law"].nunique() > 1}
        title += f" ({'; '.join(f'{law}: {yielding(p)}' for law, p in outcome.predictions.items())})"
        rows = rows.assign(t_c=1e6 * rows["contact_time"], overlap=1e6 * rows["overlap_max"])
    return frame_table(title, rows.sort_values(order, kind="stable"), columns)


def _with_regimes(outcome: Outcome, rows: pd.DataFrame) -> pd.DataFrame:
    """Rows of oblique impacts with their regimes, which theory predicts, the ratio f/mu and angles in degrees."""
    friction = outcome.case.contact.friction if outcome.case.contact else 0.0
    regimes = {law: p.rebound.regimes(friction) for law, p in outcome.predictions.items() if p.rebound}
    place = outcome.results.comparison.groupby(["law", "engine"]).cumcount()[rows.index]
    return rows.assign(
        regime=[regimes[law][k] for law, k in zip(rows["law"], place, strict=True)],
        ratio=rows["impulse_ratio"] / friction,
        degrees=np.degrees(rows["angle"]),
        rebound=np.degrees(rows["rebound_angle"]),
    )


def largest_errors(outcome: Outcome) -> list[str]:
    """One line for every engine and law: its largest errors, and how many rows are outside tolerance."""
    lines = []
    rows = outcome.results.comparison
    checked = [*CHECKED, *(["psi_2"] if "psi_2_error" in rows else [])]
    for (engine, law), part in rows.groupby(["engine", "law"], sort=False):
        errors = ", ".join(f"{name} {part[name + '_error'].max():.1e}" for name in checked)
        failed = int((~part["passed"]).sum())
        verdict = f"{failed} of {len(part)} rows outside tolerance" if failed else "within tolerance"
        lines.append(f"{engine}, {law}: {verdict}; largest errors: {errors}")
    return lines


def summary(outcome: Outcome) -> str:
    """One line: verdict, worst errors, times, place."""
    rows = outcome.results.comparison
    failed = int((~rows["passed"]).sum())
    times = ", ".join(f"{k} {v:.2f} s" for k, v in outcome.seconds.items())
    many = f"{len(outcome.reused)} of {len(outcome.results.runs)}"
    stored = f" ({many} from {outcome.folder}/results.h5)" if outcome.reused else ""
    verdict = "all within tolerance" if not failed else f"{failed} of {len(rows)} rows outside tolerance"
    worst = f"largest e_n error {rows['e_n_error'].max():.1e}"
    worst += f", of psi_2 {rows['psi_2_error'].max():.1e}" if "psi_2_error" in rows else ""
    if stuck := int(rows["stuck"].sum()):
        worst += f"; {stuck} impacts stick"
    return f"{outcome.case.name}: {verdict}; {worst}; {times}{stored}; see {outcome.folder}/report.html"


def against_measured(outcome: Outcome) -> list[str]:
    """One line for every law: how far theory is from the measured restitution of the case, if it has any."""
    if (known := outcome.case.measured) is None:
        return []
    lines = []
    for law, p in outcome.plans.items():
        found = predict(replace(p.experiment, speed=np.array(known.speeds))).e_n - np.array(known.e_n)
        lines.append(
            f"theory, {law}: e_n less the measured one is {found.mean():+.3f} in the mean, {found.min():+.3f} to "
            f"{found.max():+.3f} over {found.size} values ({known.source})"
        )
    return lines


def _costs(outcome: Outcome) -> dict[str, tuple[float, dict[str, float]]]:
    """Steps in the shortest contact and cost by engine of the run, of laws whose step was found for an error."""
    if (error := outcome.case.numerics.error) is None:
        return {}
    found = {}
    for law, p in outcome.plans.items():
        cost = {name: c for name, c in costs(p.experiment, p.time_step, error).items() if name in outcome.seconds}
        found[law] = float(outcome.predictions[law].duration.min() / p.time_step), cost
    return found


def cost_lines(outcome: Outcome) -> list[str]:
    """One line for every law whose step was found for an error."""
    error = outcome.case.numerics.error
    return [
        f"{law}: {steps:.0f} steps in the shortest contact for e_n within {error:g}; {sentence(cost)}"
        for law, (steps, cost) in _costs(outcome).items()
    ]


def shown(outcome: Outcome, *, full: bool = False) -> list[Shown]:
    """Table, errors, warnings and summary."""
    few, all_rows = len(select_rows(outcome, full)), len(outcome.results.comparison)
    cut = [f"{few} of {all_rows} rows; --full prints all"] if few < all_rows else []
    lines = [*cut, *largest_errors(outcome), *cost_lines(outcome), *against_measured(outcome)]
    return [run_table(outcome, full=full), *lines, *warned(outcome.warnings), summary(outcome)]
