# SPDX-License-Identifier: GPL-2.0-or-later
"""Restitution, times, peaks and energies of the impacts of a trajectory; independent of engines."""

import numpy as np
import pandas as pd

from ..case.impact import Check
from ..errors import EngineError
from . import oblique
from .engine import Trajectory
from .plan import Plan
from .prediction import Prediction

CHOSEN = 3  # speeds: the lowest, that in the middle, the highest
SAMPLES = 200  # of each, about


def _last(valid: np.ndarray) -> np.ndarray:
    return np.asarray(valid.shape[1] - 1 - np.argmax(valid[:, ::-1], axis=1))


def measure(plan: Plan, path: Trajectory) -> pd.DataFrame:
    """One row per impact: speed, gap, the rebound of oblique ones, and what is measured; SI.

    energy_residual compares the sampled work in and out with the law's work lost at the sampled peak, relative to the
    kinetic energy: unlike the sum of F d alpha against the change of kinetic energy, which velocity Verlet fulfils for
    any force, it is evidence for the law. NaN with a dashpot, whose work does not follow from the samples, and for
    another law than the plan's. With adhesion bodies that are still in contact at the end stick: e_n = 0, no end.
    Raises EngineError if a contact never began, or without adhesion never ended.
    """
    x, dt, row, adheres = plan.experiment, path.time_step, np.arange(plan.n), plan.experiment.law.adheres
    overlap, force, velocity = path.overlap, path.force, path.velocity
    sampled = np.isfinite(force)
    loaded = sampled & ((force != 0) if adheres else (force > 0))
    touched, last, end = loaded.any(axis=1), _last(loaded), _last(sampled)
    stuck = last == end
    for bad, what in (
        (~touched, "never touched"),
        (touched & stuck & (not adheres), "was still in contact at the end"),
    ):
        if bad.any():
            raise EngineError(f"the impact at {plan.speed[bad][0]:.6g} m/s {what}; the run is too short or went wrong")
    own = path.end_power is None and x.viscous_number == 0
    before = np.maximum(last - 1, 0)
    way = overlap[row, last] - overlap[row, before]
    if adheres:
        # The last step with a force, of either sign, is the first apart: the bodies part within it. By the momentum of
        # the pull, which it then has for the share s of a step, m* (v_after - v_before) = -F_last s dt.
        push, gained = force[row, before] * dt / x.m_star, velocity[row, before] - velocity[row, end]
        last, share = before, np.divide(gained, push, out=np.full(plan.n, 0.5), where=push != 0)
    else:
        # Contact ends where F, not the overlap, reaches 0. Near the end F^(2/3) falls linearly with overlap and time;
        # with a dashpot, which cuts the force off early, F itself does.
        power = path.end_power or (2 / 3 if own else 1.0)
        root, earlier = (np.abs(force[row, k]) ** power for k in (last, before))
        share = np.divide(root, earlier - root, out=np.full(plan.n, 0.5), where=earlier > root)
    share = np.clip(share, 0.0, 1.0)  # the next sample is apart
    peak = np.where(sampled, overlap, -np.inf).max(axis=1)
    # at the dent, between two samples, the force is 0 and so is the last piece of work, to third order
    work = force[:, 1:] + force[:, :-1]
    work *= overlap[:, 1:] - overlap[:, :-1]
    residual = (0.5 * np.nansum(work, axis=1) - x.theory().lost_work(peak)) / (0.5 * x.m_star * plan.speed**2)
    e_n = np.where(stuck, 0.0, -velocity[row, end] / plan.speed)
    columns = {"speed": plan.speed, "gap": plan.gap}
    if path.tangential is not None and path.spin is not None:
        columns |= oblique.rebound(x, e_n, tangential=path.tangential, spin=path.spin).columns()
    columns |= {
        "e_n": e_n,
        "contact_time": np.where(stuck, np.inf, (last + share) * dt - plan.gap / plan.speed),
        "force_max": np.where(loaded, force, -np.inf).max(axis=1),
        "overlap_max": peak,
        "residual_overlap": np.where(stuck, np.nan, overlap[row, last] + share * way),
        "energy_residual": np.where(stuck | (not own), np.nan, residual),
        "steps_in_contact": loaded.sum(axis=1),
    }
    return pd.DataFrame(columns)


def sample_impacts(plan: Plan, path: Trajectory) -> pd.DataFrame:
    """speed [m/s], time [s] since first touch, overlap [m], force [N] of the first phase at the chosen speeds.

    From the sample before the contact to that after it; at most 2 SAMPLES a speed.
    """
    _, first = np.unique(plan.speed, return_index=True)
    places = np.unique(np.linspace(0, first.size - 1, CHOSEN).round().astype(int))
    tables = []
    for row in first[places]:
        force = path.force[row]
        loaded = np.flatnonzero(np.isfinite(force) & (force != 0))
        begin, end = max(loaded[0] - 1, 0), min(loaded[-1] + 2, np.isfinite(force).sum())
        kept = np.arange(begin, end)[:: max(1, (end - begin) // SAMPLES)]
        time = kept * path.time_step - plan.gap[row] / plan.speed[row]
        columns = {"speed": plan.speed[row], "time": time, "overlap": path.overlap[row, kept], "force": force[kept]}
        tables.append(pd.DataFrame(columns))
    return pd.concat(tables, ignore_index=True)


CHECKED = ("e_n", "contact_time", "force_max", "overlap_max", "residual_overlap")
OBLIQUE = ("psi_2", "e_t", "impulse_ratio", "rebound_angle", "spin")
UNITS = {  # of the columns that have one
    f"{column}{of}": unit
    for unit, columns in {
        "m/s": "speed",
        "m": "gap overlap_max residual_overlap radius_max overlap",
        "s": "contact_time time",
        "N": "force_max force",
        "J": "work_in work_out plastic_work",
        "rad": "angle rebound_angle",
        "rad/s": "spin_before spin",
    }.items()
    for column in columns.split()
    for of in ("", "_theory")
}


def compare(engine: str, law: str, impacts: pd.DataFrame, prediction: Prediction, check: Check) -> pd.DataFrame:
    """One row per speed: means over the phases, theory, errors (max over the phases), and whether all checks hold.

    An error is relative to theory; the error of the residual overlap is relative to overlap_max (theory is 0 below
    yield), errors of oblique quantities are absolute. Bodies that stick (`stuck` of the phases) have e_n = 0; if theory
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
