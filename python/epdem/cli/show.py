# SPDX-License-Identifier: GPL-2.0-or-later
"""Small tables and their JSON for the commands without an engine."""

import json
import math
from dataclasses import asdict

import pandas as pd
from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..base.terminal import show_table, table
from ..engines.doctor import Finding
from ..impacts.experiment import Experiment
from ..impacts.prediction import Prediction
from ..impacts.report import plain, records, yielding
from ..theory.yielding import FIRST_YIELD_ROUNDED


def _table(title: str, frame: pd.DataFrame) -> Table:
    shown = table(title, frame.columns)
    for row in frame.itertuples(index=False):
        shown.add_row(*(f"{v:.6g}" if isinstance(v, float) else str(v) for v in row))
    return shown


def predictions(
    pairs: list[tuple[Experiment, Prediction]], warnings: list[str], as_json: bool, console: Console
) -> None:
    """Print predictions, one table per law, with the warnings about their case."""
    document = []
    for x, p in pairs:
        frame = p.table()
        if as_json:
            document.append(
                {
                    "case": x.name,
                    "law": x.law.name,
                    "parameters": x.law.parameters,
                    "yields": p.yields,
                    "yield_speeds": {k: plain(v) for k, v in p.yield_speeds.items()},
                    "warnings": [*warnings, *p.warnings],
                    "rows": records(frame),
                }
            )
        else:
            show_table(console, _table(f"{x.title}: law {x.law.name} (SI units; {yielding(p)})", frame))
            for material, speed in p.yield_speeds.items():
                never = "never: the softer body limits the pressure"
                when = f"from {speed:.4g} m/s on" if math.isfinite(speed) else never
                console.print(f"{material} yields beneath its surface ({FIRST_YIELD_ROUNDED:.2f} Y) {when}")
            for warning in [*warnings, *p.warnings]:
                console.print(f"warning: {warning}", style="yellow")
    if as_json:
        print(json.dumps(document[0] if len(document) == 1 else document, indent=1))


def findings(parts: list[Finding], as_json: bool, console: Console) -> None:
    """Print the findings of doctor."""
    if as_json:
        print(json.dumps([asdict(f) for f in parts], indent=1))
        return
    for f in parts:
        state, colour = ("ok", "green") if f.ok else ("missing", "red") if f.needed else ("absent", "yellow")
        console.print(Text.assemble((state, colour), f" {f.part}: {f.detail}"), soft_wrap=True)
        if f.advice:
            console.print(f"   -> {f.advice}", soft_wrap=True)
