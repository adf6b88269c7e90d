# SPDX-License-Identifier: GPL-2.0-or-later
"""Run time of a case with a target error beside LIGGGHTS's own `hertz` with the same error."""

import csv
from dataclasses import replace

from ..base import paths
from ..laws.strengths import default_numbers
from .experiment import Experiment, pair_of
from .plan import matched_step
from .prediction import predict


def step_times() -> dict[tuple[str, str], float]:
    """Time of a contact and step by engine and law over that of LIGGGHTS's own `hertz` (docs/cost.py measures it)."""
    with (paths.beside("data") / "step_times.csv").open(encoding="utf-8") as stream:
        return {(row["engine"], row["law"]): float(row["ratio"]) for row in csv.DictReader(stream)}


def costs(x: Experiment, time_step: float, error: float) -> dict[str, float]:
    """Run time at `time_step` [s] for the same physical time over that of `hertz` with the same error, by engine."""
    elastic = replace(x, law=pair_of(default_numbers("hertz"), x.body, x.target))
    hertz = matched_step(elastic, predict(elastic), error).time_step
    return {engine: ratio * hertz / time_step for (engine, law), ratio in step_times().items() if law == x.law.name}


def sentence(found: dict[str, float]) -> str:
    """Costs by engine in one line."""
    shown = ", ".join(f"{name} {cost:.2g}" for name, cost in found.items())
    return f"run time over that of LIGGGHTS's hertz with the same error: {shown or 'not measured'}"
