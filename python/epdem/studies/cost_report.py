# SPDX-License-Identifier: GPL-2.0-or-later
"""Output of error against run time: table, work-precision figure, data file."""

from pathlib import Path

import numpy as np
import pandas as pd
from rich.console import Console

from ..base.files import atomic
from ..base.terminal import frame_table
from .cost import TARGETS, Outcome


def write(outcome: Outcome, folder: Path) -> list[Path]:
    """cost.csv (one row per model and number of steps) and cost.png in `folder`."""
    data = folder / "cost.csv"
    with atomic(data) as temporary:
        outcome.rows.to_csv(temporary, index=False)
    return [data, figure(outcome, folder / "cost.png")]


def figure(outcome: Outcome, path: Path) -> Path:
    """The work-precision figure: error of e_n against stepping time and against steps, log-log."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    fig, (left, right) = plt.subplots(1, 2, sharey=True, figsize=(10, 4.5), layout="constrained")
    for k, (label, part) in enumerate(outcome.rows.groupby("model", sort=False)):
        style = {"color": f"C{k}", "marker": "os^Dv<>"[k % 7], "ms": 4, "label": label}
        left.loglog(part["ns_per_impact"], part["e_n_error"], **style)
        right.loglog(part["steps"], part["e_n_error"], **style)
        right.loglog(part["steps"], part["e_n_rms"], ":", color=f"C{k}", lw=1)
    n = np.array([outcome.rows["steps"].min(), outcome.rows["steps"].max()], float)
    right.loglog(n, 5 * n**-2.0, "--", color="0.5", lw=1, label="order 2")
    left.set(xlabel="stepping time per impact [ns]", ylabel="error of e_n (max over speeds and phases)")
    right.set(xlabel="steps in the shortest contact", title="dotted: rms")
    left.set_title(outcome.case.case.title, parse_math=False)
    right.legend(fontsize=8)
    for axes in (left, right):
        axes.grid(alpha=0.3)
    with atomic(path) as temporary:
        fig.savefig(temporary, dpi=130)
    plt.close(fig)
    return path


def _cell(steps: float, nanoseconds: float) -> str:
    return "not reached" if np.isnan(steps) else f"{steps:.0f} steps, {nanoseconds / 1000:.3g} us"


def cheapest_table(models: pd.DataFrame) -> pd.DataFrame:
    """One row per model, in words."""
    rows = []
    for _, c in models.iterrows():
        hertz = "" if np.isnan(c["ratio_to_hertz"]) else f"{c['ratio_to_hertz']:.2f} +- {c['ratio_spread'] / 2:.2f}"
        row = {
            "model": c["model"],
            "order": "none" if np.isnan(c["order"]) else f"{c['order']:.2f}",
            "smallest error": f"{c['best_error']:.1e}",
            "ns per step": f"{c['ns_per_step']:.3g}",
            "over built-in hertz": hertz,
        }
        row |= {f"for {100 * t:g} %": _cell(c[f"steps_for_{t:g}"], c[f"ns_for_{t:g}"]) for t in TARGETS}
        row |= {"start-up": f"{c['startup'] * 1000:.0f} ms", "set-up": f"{c['setup'] * 1000:.1f} ms"}
        rows.append(row)
    return pd.DataFrame(rows)


def error_table(rows: pd.DataFrame) -> pd.DataFrame:
    """Errors of every model at every number of steps, largest and rms over speeds and phases."""
    names = {"e_n": "e_n", "contact_time": "time", "force_max": "peak force"}
    columns = {"model": "model", "steps": "steps"}
    columns |= {
        f"{q}_{kind}": f"{text} {short}"
        for q, text in names.items()
        for kind, short in (("error", "max"), ("rms", "rms"))
    }
    frame = rows[[*columns, "ns_per_impact"]].rename(columns=columns | {"ns_per_impact": "ns per impact"})
    return frame.map(lambda v: f"{v:.2g}" if isinstance(v, float) else str(v))


def bulk_table(bulk: pd.DataFrame) -> pd.DataFrame:
    """One row per model and step of a bulk scene, in words."""

    def number(value: float, digits: str = ".2g") -> str:
        return "-" if np.isnan(value) else f"{value:{digits}}"

    rows = []
    for b in bulk.itertuples():
        rows.append(
            {
                "model": b.model,
                "share of the limit": f"{b.share:g}",
                "error of the mean": number(b.error),
                "rms error of a sphere": number(b.rms),
                "order": number(b.order, ".2f"),
                "seconds": f"{b.seconds:.3g} +- {b.seconds_spread / 2:.1g}",
                "over built-in hertz": f"{b.ratio:.2f} +- {b.ratio_spread / 2:.2f}",
            }
        )
    return pd.DataFrame(rows)


def show(outcome: Outcome, bulk: pd.DataFrame | None, console: Console) -> None:
    """Print all tables; `bulk` is that of a bulk scene, if it ran."""
    tables = [
        (f"{outcome.case.case.title}: errors (max and rms over speeds and phases)", error_table(outcome.rows)),
        ("cheapest setting for an error of e_n (stepping time per impact)", cheapest_table(outcome.models)),
    ]
    if bulk is not None:
        tables.append((f"{bulk['spheres'].iloc[0]} spheres in LIGGGHTS: dissipated energy", bulk_table(bulk)))
    for title, frame in tables:
        console.print(frame_table(title, frame))
