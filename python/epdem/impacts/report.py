# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables, JSON and the figure of a run."""

import hashlib
import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd
from rich.console import Console
from rich.table import Table

from ..base.files import atomic
from ..base.folders import claim
from ..base.terminal import table
from . import oblique_report
from .comparison import CHECKED
from .prediction import Prediction
from .run import Outcome

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ROW_KEYS = (
    "engine",
    "law",
    "speed",
    *(k for n in CHECKED for k in (n, n + "_theory", n + "_error")),
    "energy_residual",
    "steps_in_contact",
    "stuck",
    "passed",
)


def _plain(value: Any) -> Any:
    """A value for JSON: numpy scalars as Python's, NaN and infinity as null."""
    value = value.item() if hasattr(value, "item") else value
    return None if isinstance(value, float) and not math.isfinite(value) else value


def records(rows: pd.DataFrame, keys: Sequence[str] | None = None) -> list[dict[str, object]]:
    """The rows of a table for JSON."""
    return [{k: _plain(row[k]) for k in (keys or rows.columns)} for row in rows.to_dict("records")]


def _keys(outcome: Outcome) -> tuple[str, ...]:
    """Columns of the comparison that the document holds."""
    if not outcome.case.impact.oblique:
        return ROW_KEYS
    columns = outcome.results.comparison.columns
    return (*ROW_KEYS, *(k for k in columns if k not in ROW_KEYS and not k.endswith("_rms")))


def run_json(outcome: Outcome) -> str:
    """The document of `epdem run --json`."""
    return json.dumps(
        {
            "case": outcome.case.name,
            "passed": outcome.passed,
            "seconds": outcome.seconds,
            "yields": {law: list(p.yields) for law, p in outcome.predictions.items()},
            "warnings": outcome.warnings,
            "rows": records(outcome.results.comparison, _keys(outcome)),
        },
        indent=1,
    )


def yielding(prediction: Prediction) -> str:
    """The materials that yield, in words."""
    return f"yields: {', '.join(prediction.yields)}" if prediction.yields else "nothing yields"


def run_table(outcome: Outcome) -> Table:
    """One row per speed and engine, and per angle and spin of oblique impacts."""
    if outcome.case.impact.oblique:
        return oblique_report.run_table(outcome)
    yields = "; ".join(f"{law}: {yielding(p)}" for law, p in outcome.predictions.items())
    laws = outcome.results.comparison["law"].nunique() > 1
    heads = [
        "v [m/s]",
        "engine",
        *(["law"] if laws else []),
        "e_n",
        "theory",
        "error",
        "t_c [us]",
        "F_max [N]",
        "overlap [um]",
        "steps",
        "pass",
    ]
    shown = table(f"{outcome.case.case.title} ({yields})", heads, left=("engine", "law"))
    ordered = outcome.results.comparison.sort_values(["law", "speed", "engine"], kind="stable")
    for row in ordered.to_dict("records"):
        cells = [
            f"{row['speed']:.4g}",
            row["engine"],
            *([row["law"]] if laws else []),
            f"{row['e_n']:.6f}",
            f"{row['e_n_theory']:.6f}",
            f"{row['e_n_error']:.1e}",
            f"{row['contact_time'] * 1e6:.4g}",
            f"{row['force_max']:.5g}",
            f"{row['overlap_max'] * 1e6:.4g}",
            str(row["steps_in_contact"]),
            "yes" if row["passed"] else "NO",
        ]
        shown.add_row(*cells, style=None if row["passed"] else "red")
    return shown


def summary(outcome: Outcome) -> str:
    """One line: verdict, worst errors, times, place."""
    rows = outcome.results.comparison
    failed = int((~rows["passed"]).sum())
    times = ", ".join(f"{k} {v:.2f} s" for k, v in outcome.seconds.items())
    stored = (
        f" ({len(outcome.reused)} of {len(outcome.results.runs)} from {outcome.folder}/results.h5)"
        if outcome.reused
        else ""
    )
    verdict = "all within tolerance" if not failed else f"{failed} of {len(rows)} rows outside tolerance"
    worst = f"largest e_n error {rows['e_n_error'].max():.1e}"
    worst += f", of psi_2 {rows['psi_2_error'].max():.1e}" if "psi_2_error" in rows else ""
    if stuck := int(rows["stuck"].sum()):
        worst += f"; {stuck} impacts stick"
    return f"{outcome.case.name}: {verdict}; {worst}; {times}{stored}; see {outcome.folder}/"


def show(outcome: Outcome, console: Console) -> None:
    """Print table, warnings and summary."""
    console.print(run_table(outcome))
    for warning in outcome.warnings:
        console.print(f"warning: {warning}", style="yellow", markup=False, highlight=False)
    console.print(summary(outcome), markup=False, highlight=False, soft_wrap=True)


def figure(outcome: Outcome) -> Path:
    """e_n.png: restitution against speed, theory as lines and engines as points, errors below; psi.png if oblique.

    A picture that shows these very runs already is left as it is: it carries the hash of their inputs.
    """
    slips = outcome.case.impact.oblique
    path = outcome.folder / ("psi.png" if slips else "e_n.png")
    shown = repr(sorted((key, run["inputs"]) for key, run in outcome.results.runs.items()))
    digest = hashlib.sha256(shown.encode()).hexdigest()
    if path.exists() and digest.encode() in path.read_bytes():
        return path
    import matplotlib  # slow to import, and only this function needs it

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    fig = oblique_report.figure(outcome) if slips else _restitutions(outcome)
    with claim(outcome.folder, force=True), atomic(path) as temporary:
        fig.savefig(temporary, dpi=130, metadata={"Comment": f"inputs {digest}"})
    plt.close(fig)
    return path


def _restitutions(outcome: Outcome) -> "Figure":
    """e_n against speed, and its errors."""
    from matplotlib import pyplot as plt

    fig, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(7, 6), height_ratios=(3, 1.3), layout="constrained")
    rows = outcome.results.comparison
    several = len(outcome.predictions) > 1  # colours distinguish laws, or else engines
    for i, (law, prediction) in enumerate(outcome.predictions.items()):
        colour = f"C{i}" if several else "0.3"
        above.plot(prediction.speed, prediction.e_n, "-", color=colour, lw=1.2, label=f"theory, {law}")
        engines = rows[rows["law"] == law].groupby("engine", sort=False)
        for k, ((name, part), marker) in enumerate(zip(engines, "ox+^sD", strict=False)):
            style = {"color": colour if several else f"C{k}", "ls": "none", "marker": marker, "ms": 5, "mfc": "none"}
            above.plot(part["speed"], part["e_n"], label=f"{name}, {law}", **style)
            below.plot(part["speed"], part["e_n_error"], **style)
    below.axhline(outcome.case.check.e_n, color="0.6", lw=0.8, ls="--", label="tolerance")
    above.set(ylabel="coefficient of restitution e_n", xscale="log")
    above.set_title(outcome.case.case.title, parse_math=False)
    below.set(xlabel="impact speed [m/s]", ylabel="error of e_n\n(max over phases)", yscale="log")
    above.legend(fontsize=8)
    for axes in (above, below):
        axes.grid(alpha=0.3)
    return fig
