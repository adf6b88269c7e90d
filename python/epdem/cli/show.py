# SPDX-License-Identifier: GPL-2.0-or-later
"""Small tables and their JSON for the commands without an engine."""

import json
import math
from dataclasses import asdict

import pandas as pd
from rich.console import Console
from rich.text import Text

from ..base.terminal import show_table, table
from ..engines.doctor import Finding
from ..impacts.experiment import Experiment
from ..impacts.prediction import Prediction
from ..impacts.report import plain, records, yielding
from ..theory.yielding import FIRST_YIELD_ROUNDED


def predictions(
    pairs: list[tuple[Experiment, Prediction]], warnings: list[str], as_json: bool, console: Console
) -> None:
    """Print predictions of one case by several laws, with the warnings about the case."""
    if as_json:
        document = [
            {
                "case": x.name,
                "law": x.law.name,
                "parameters": x.law.parameters,
                "yields": p.yields,
                "yield_speeds": {k: plain(v) for k, v in p.yield_speeds.items()},
                "warnings": [*warnings, *p.warnings],
                "rows": records(p.table()),
            }
            for x, p in pairs
        ]
        print(json.dumps(document[0] if len(document) == 1 else document, indent=1))
        return
    frame = pd.concat([p.table().assign(law=x.law.name) for x, p in pairs])
    columns = ["law", *frame.columns.drop("law")]
    shown = table(f"{pairs[0][0].title} (SI units)", columns, left=("law",))
    for row in frame[columns].itertuples(index=False):
        shown.add_row(*(f"{v:.6g}" if isinstance(v, float) else str(v) for v in row))
    show_table(console, shown)
    for x, p in pairs:
        console.print(f"{x.law.name}: {yielding(p)}")
        for material, speed in p.yield_speeds.items():
            never = "never: the softer body limits the pressure"
            when = f"from {speed:.4g} m/s on" if math.isfinite(speed) else never
            console.print(f"{x.law.name}: {material} yields beneath its surface ({FIRST_YIELD_ROUNDED:.2f} Y) {when}")
        for warning in p.warnings:
            console.print(f"warning: {x.law.name}: {warning}", style="yellow")
    for warning in warnings:
        console.print(f"warning: {warning}", style="yellow")


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
