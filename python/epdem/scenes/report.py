# SPDX-License-Identifier: GPL-2.0-or-later
"""The output of a scene: checks, summary, JSON, figures."""

import json

from rich.console import Console

from ..base.files import atomic
from ..base.folders import claim
from ..base.terminal import table
from ..impacts.report import records
from . import key_figures, pictures
from .measures import unit
from .run import SceneOutcome


def as_json(outcome: SceneOutcome) -> str:
    """The document of `epdem run --json` for a scene."""
    return json.dumps(
        {
            "case": outcome.case.name,
            "kind": outcome.case.scene.kind,
            "passed": outcome.passed,
            "steps": outcome.plan.steps,
            "time_step": outcome.plan.time_step,
            "seconds": outcome.seconds,
            "reused": outcome.reused,
            "resumed_from": outcome.resumed_from,
            "warnings": outcome.warnings,
            "checks": records(outcome.results.tables["checks"]),
            "measures": records(outcome.results.tables["measures"].tail(1)) if outcome.case.scene.measure else [],
            "last_row": records(outcome.results.tables["rows"].tail(1))[0],
        },
        indent=1,
    )


def show(outcome: SceneOutcome, console: Console) -> None:
    """Print checks and a summary line."""
    heads = ("check", "value", "expected", "error", "tolerance", "pass")
    shown = table(outcome.case.case.title, heads, left=("check",))
    for row in outcome.results.tables["checks"].to_dict("records"):
        shown.add_row(
            row["check"],
            f"{row['value']:.5g}",
            f"{row['expected']:.5g}",
            f"{row['error']:.1e}",
            f"{row['tolerance']:.1e}",
            "yes" if row["passed"] else "NO",
            style=None if row["passed"] else "red",
        )
    console.print(shown)
    _show_measures(outcome, console)
    for warning in outcome.warnings:
        console.print(f"warning: {warning}", style="yellow", markup=False, highlight=False)
    p, rows = outcome.plan, outcome.results.tables["rows"]
    came = " (from results.h5)" if outcome.reused else ""
    if outcome.resumed_from is not None:
        came = f" (continued from step {outcome.resumed_from})"
    console.print(
        f"{outcome.case.name}: {int(rows['particles'].iloc[-1])} spheres, {p.steps} steps of {p.time_step:g} s, "
        f"{outcome.seconds:.1f} s{came}; see {outcome.folder}/",
        markup=False,
        highlight=False,
        soft_wrap=True,
    )


def _show_measures(outcome: SceneOutcome, console: Console) -> None:
    """Print the last value of each curve and the mean of each histogram."""
    curves, histograms = (outcome.results.tables.get(name) for name in ("measures", "histograms"))
    if curves is None or histograms is None:
        return
    shown = table("measures", ("measure", "kind", "at the end", "unit"), left=("measure", "kind"))
    for m in outcome.case.scene.measure:
        if m.name in curves:
            value = float(curves[m.name].iloc[-1])
        else:
            part = histograms[histograms["measure"] == m.name]
            value = float((0.5 * (part["low"] + part["high"]) * part["number"]).sum() / max(part["number"].sum(), 1))
        shown.add_row(m.name, m.kind if m.name in curves else f"{m.kind}, mean", f"{value:.5g}", unit(m))
    console.print(shown)


def figures(outcome: SceneOutcome) -> None:
    """scene.png, key.png, bed.png and, if there is a ledger, energy.png in the folder of a run."""
    tables = outcome.results.tables
    with claim(outcome.folder, force=True):
        _rows_figure(outcome)
        key_figures.key(outcome.plan, tables, outcome.folder / "key.png")
        if "particles" in tables and len(tables["particles"]):
            pictures.bed(outcome.plan, tables["particles"], outcome.folder / "bed.png")
        if "ledger" in outcome.results.tables:
            _ledger_figure(outcome)


def _rows_figure(outcome: SceneOutcome) -> None:
    """scene.png: what the rows hold against time."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    rows = outcome.results.tables["rows"]
    shown = [c for c in ("kinetic_energy", "floor_load", "plate_force") if c in rows]
    fig, axes = plt.subplots(
        len(shown), 1, sharex=True, figsize=(7, 2.4 * len(shown) + 0.6), layout="constrained", squeeze=False
    )
    for axis, name in zip(axes[:, 0], shown, strict=True):
        axis.plot(rows["time"], rows[name], lw=1.2)
        axis.set(
            ylabel={
                "kinetic_energy": "kinetic energy [J]",
                "floor_load": "floor load [N]",
                "plate_force": "plate force [N]",
            }[name]
        )
        axis.grid(alpha=0.3)
    axes[0, 0].set_title(outcome.case.case.title, parse_math=False)
    axes[-1, 0].set_xlabel("time [s]")
    path = outcome.folder / "scene.png"
    with atomic(path) as temporary:
        fig.savefig(temporary, dpi=130)
    plt.close(fig)


def _ledger_figure(outcome: SceneOutcome) -> None:
    """energy.png: every term of the ledger against time."""
    import matplotlib.pyplot as plt

    rows = outcome.results.tables["ledger"]
    colors = {"kinetic": "C0", "rotation": "C9", "elastic": "C2", "plastic": "C3", "friction": "C1", "springs": "C6"}
    colors["left"] = "C5"
    terms = [name for name in colors if name in rows and rows[name].abs().max() > 0]
    fig, axis = plt.subplots(figsize=(7, 4), layout="constrained")
    gravity = rows["gravity"] - rows["gravity"].min()
    if gravity.max() > 0:
        axis.plot(rows["time"], gravity, color="C4", label="gravity, above its lowest")
    for name in terms:
        label = "friction (remainder)" if name == "friction" and "springs" not in rows else name
        axis.plot(rows["time"], rows[name], color=colors[name], label=label)
    if rows["work"].abs().max() > 0:
        axis.plot(rows["time"], rows["work"], "k--", lw=0.8, label="work of the walls")
    if "friction" not in rows or "springs" in rows:
        axis.plot(rows["time"], rows["balance"], color="0.5", lw=0.8, label="left over")
    axis.set(xlabel="time [s]", ylabel="energy [J]")
    axis.set_title(outcome.case.case.title, parse_math=False)
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8)
    with atomic(outcome.folder / "energy.png") as temporary:
        fig.savefig(temporary, dpi=130)
    plt.close(fig)
