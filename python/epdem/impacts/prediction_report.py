# SPDX-License-Identifier: GPL-2.0-or-later
"""Document and table of a prediction, on numpy alone: `epdem predict` starts in the time of its imports."""

import csv
import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ..base import paths
from ..base.terminal import Shown, frame_table, heads, warned
from ..laws.strengths import default_numbers
from ..theory.yielding import FIRST_YIELD_ROUNDED
from .experiment import Experiment, pair_of
from .plan import matched_step
from .prediction import Prediction, predict

Pair = tuple[Experiment, Prediction]


def plain(value: Any) -> Any:
    """A value for JSON: numpy scalars as Python's, NaN and infinity as null."""
    value = value.item() if hasattr(value, "item") else value
    return None if isinstance(value, float) and not math.isfinite(value) else value


def yielding(prediction: Prediction) -> str:
    """The materials that yield, or the common strength at which the pair yields, as a sentence."""
    if prediction.yields and prediction.yields[0].startswith("law."):
        return f"the pair yields at {prediction.yields[0]}"
    return f"yields: {', '.join(prediction.yields)}" if prediction.yields else "nothing yields"


def predictions(pairs: list[Pair], warnings: list[str], *, full: bool = False) -> tuple[object, Iterator[Shown]]:
    """Predictions of one case by several laws, with the warnings about the case: document, and table with lines.

    full: the table has the estimated share of waves, as the document has.
    """
    tables = [
        p.columns() | {"wave_share": np.full(x.speed.size, np.nan) if p.wave_share is None else p.wave_share}
        for x, p in pairs
    ]
    documents = [
        {
            "case": x.name,
            "law": x.law.name,
            "parameters": x.law.shown(),
            "yields": p.yields,
            "yield_speeds": {k: plain(v) for k, v in p.yield_speeds.items()},
            "warnings": [*warnings, *p.warnings],
            "rows": [dict(zip(table, map(plain, row), strict=True)) for row in zip(*table.values(), strict=True)],
        }
        for (x, p), table in zip(pairs, tables, strict=True)
    ]
    return documents[0] if len(documents) == 1 else documents, _shown(pairs, tables, warnings, full)


def _shown(pairs: list[Pair], tables: list[dict[str, np.ndarray]], warnings: list[str], full: bool) -> Iterator[Shown]:
    laws = {"law": np.repeat([x.law.name for x, _ in pairs], [x.speed.size for x, _ in pairs])}
    names = [name for name in tables[0] if full or name != "wave_share"]
    frame = laws | {name: np.concatenate([table[name] for table in tables]) for name in names}
    yield frame_table(f"{pairs[0][0].title} (SI units)", frame, heads(frame, {}), digits=6)
    for x, p in pairs:
        yield f"{x.law.name}: {yielding(p)}"
        for material, speed in p.yield_speeds.items():
            never = "never: the softer body limits the pressure"
            when = f"from {speed:.4g} m/s on" if math.isfinite(speed) else never
            yield f"{x.law.name}: {material} yields beneath its surface ({FIRST_YIELD_ROUNDED:.2f} Y) {when}"
        yield from warned(f"{x.law.name}: {warning}" for warning in p.warnings)
    yield from warned(warnings)


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
