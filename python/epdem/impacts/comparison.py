# SPDX-License-Identifier: GPL-2.0-or-later
"""Measured against predicted, and against the case's tolerances: one row per speed, engine and law."""

import numpy as np
import pandas as pd

from ..case.impact import DEFAULT_CHECKS, Check
from .measurement import Measured
from .plan import Plan
from .prediction import Prediction

CHECKED = tuple(DEFAULT_CHECKS)
OBLIQUE = ("psi_2", "e_t", "impulse_ratio", "rebound_angle", "spin")
UNITS = {
    "speed": "m/s",
    "gap": "m",
    "angle": "rad",
    "rebound_angle": "rad",
    "spin": "rad/s",
    "spin_before": "rad/s",
    "contact_time": "s",
    "time": "s",
    "overlap": "m",
    "force": "N",
    "force_max": "N",
    "overlap_max": "m",
    "residual_overlap": "m",
    "radius_max": "m",
    "work_in": "J",
    "work_out": "J",
    "plastic_work": "J",
}


def impacts_table(plan: Plan, measured: Measured) -> pd.DataFrame:
    """One row per impact: speed, gap and all measured quantities."""
    columns = {"speed": plan.speed, "gap": plan.gap}
    if measured.rebound:
        columns |= measured.rebound.columns()
    return pd.DataFrame(columns | {name: getattr(measured, name) for name in Measured.COLUMNS})


def compare(engine: str, law: str, impacts: pd.DataFrame, prediction: Prediction, check: Check) -> pd.DataFrame:
    """One row per speed: means over the phases, theory, errors (max over the phases), and whether all checks hold.

    An error is relative to theory; that of the residual overlap is relative to overlap_max (it is 0 below yield), those
    of the quantities of oblique impacts are absolute. Bodies that stick (`stuck` of the phases) have e_n = 0; if theory
    says so, too, there is no end to compare.
    """
    n, rebound = prediction.speed.size, prediction.rebound
    row: dict[str, object] = {"engine": engine, "law": law, "speed": prediction.speed}
    if rebound:
        row |= {"angle": rebound.angle, "spin_before": rebound.spin_before}
    passed = np.ones(n, bool)
    stuck = impacts["e_n"].to_numpy().reshape(n, -1) == 0.0
    for name in CHECKED:
        theory = getattr(prediction, name)
        scale = prediction.overlap_max if name == "residual_overlap" else np.where(theory > 0, theory, 1.0)
        value = impacts[name].to_numpy().reshape(n, -1)
        with np.errstate(invalid="ignore"):  # of infinite contact times
            deviation = np.abs(value - theory[:, None]) / scale[:, None]
        if name in ("contact_time", "residual_overlap"):
            deviation = np.where(stuck & prediction.sticks[:, None], 0.0, deviation)
        row[name], row[name + "_theory"] = value.mean(axis=1), theory
        row[name + "_error"], row[name + "_rms"] = deviation.max(axis=1), np.sqrt((deviation**2).mean(axis=1))
        passed &= row[name + "_error"] <= getattr(check, name)  # NaN does not pass
    if rebound:
        for name in OBLIQUE:
            theory, value = getattr(rebound, name), impacts[name].to_numpy().reshape(n, -1)
            row[name], row[name + "_theory"] = value.mean(axis=1), theory
            row[name + "_error"] = np.abs(value - theory[:, None]).max(axis=1)
        row["psi_1"] = rebound.psi_1
        passed &= np.abs(impacts["psi_2"].to_numpy().reshape(n, -1) - rebound.psi_2[:, None]).max(axis=1) <= check.psi_2
    residual = impacts["energy_residual"].to_numpy().reshape(n, -1)
    row["energy_residual"] = residual[np.arange(n), np.abs(residual).argmax(axis=1)]
    row["stuck"] = stuck.sum(axis=1)
    row["steps_in_contact"] = impacts["steps_in_contact"].to_numpy().reshape(n, -1).min(axis=1)
    row["passed"] = passed
    return pd.DataFrame(row)
