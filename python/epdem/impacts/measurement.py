# SPDX-License-Identifier: GPL-2.0-or-later
"""Restitution, times, peaks and energies of the impacts of a trajectory; independent of engines."""

from dataclasses import dataclass, fields

import numpy as np
import pandas as pd

from ..errors import EngineError
from . import oblique
from .engine import Trajectory
from .plan import Plan

CHOSEN = 3  # speeds: the lowest, that in the middle, the highest
SAMPLES = 200  # of each, about


@dataclass(frozen=True)
class Measurement:
    """One value per impact, arrays of shape (n,), SI.

    energy_residual compares the sampled work in and out with the law's plastic work at the sampled peak,
    relative to the kinetic energy: unlike the sum of F d alpha against the change of kinetic energy, which velocity
    Verlet fulfils for any force, it is evidence for the law. NaN with a dashpot, whose work does not follow from the
    samples, and for a law that is not the plan's.
    """

    e_n: np.ndarray
    contact_time: np.ndarray
    force_max: np.ndarray
    overlap_max: np.ndarray
    residual_overlap: np.ndarray
    energy_residual: np.ndarray
    steps_in_contact: np.ndarray
    rebound: oblique.Rebound | None = None  # of oblique impacts


COLUMNS = tuple(f.name for f in fields(Measurement) if f.type is np.ndarray)


def _last(valid: np.ndarray) -> np.ndarray:
    return np.asarray(valid.shape[1] - 1 - np.argmax(valid[:, ::-1], axis=1))


def measure(plan: Plan, path: Trajectory) -> Measurement:
    """The impacts of a trajectory. Raises EngineError if a contact never began or never ended."""
    law = plan.experiment.theory()
    if plan.experiment.law.adheres:
        return _with_adhesion(plan, path)
    overlap, force, velocity = path.overlap, path.force, path.velocity
    row = np.arange(plan.n)
    sampled = np.isfinite(force)
    loaded = sampled & (force > 0)
    touched = loaded.any(axis=1)
    last, end = _last(loaded), _last(sampled)
    for bad, what in ((~touched, "never touched"), (touched & (last == end), "was still in contact at the end")):
        if bad.any():
            raise EngineError(f"the impact at {plan.speed[bad][0]:.6g} m/s {what}; the run is too short or went wrong")

    # Contact ends where F, not the overlap, reaches 0. Near the end F^(2/3) falls linearly with overlap and time;
    # with a dashpot, which cuts the force off early, F itself does.
    own = path.end_power is None and plan.experiment.viscous_number == 0
    power = path.end_power or (2 / 3 if own else 1.0)
    before = np.maximum(last - 1, 0)
    root_last, root_before = (np.abs(force[row, k]) ** power for k in (last, before))
    share = np.divide(root_last, root_before - root_last, out=np.full(plan.n, 0.5), where=root_before > root_last)
    share = np.minimum(share, 1.0)  # the next sample is unloaded
    contact_time = (last + share) * path.time_step - plan.gap / plan.speed
    residual = overlap[row, last] - share * (overlap[row, before] - overlap[row, last])

    force_max = np.where(loaded, force, 0.0).max(axis=1)
    peak = np.where(sampled, overlap, -np.inf).max(axis=1)
    energy = 0.5 * plan.experiment.m_star * plan.speed**2
    # at the dent, between two samples, the force is 0 and so is the last piece of work, to third order
    work = force[:, 1:] + force[:, :-1]
    work *= overlap[:, 1:] - overlap[:, :-1]
    work[~(loaded[:, 1:] | loaded[:, :-1])] = 0.0
    lost = law.lost_work(peak)
    e_n = -velocity[row, end] / plan.speed
    rebound = None
    if path.tangential is not None and path.spin is not None:
        rebound = oblique.rebound(plan.experiment, e_n, tangential=path.tangential, spin=path.spin)
    return Measurement(
        e_n=e_n,
        contact_time=contact_time,
        force_max=force_max,
        overlap_max=peak,
        residual_overlap=residual,
        energy_residual=(0.5 * work.sum(axis=1) - lost) / energy if own else np.full(plan.n, np.nan),
        steps_in_contact=loaded.sum(axis=1),
        rebound=rebound,
    )


def _with_adhesion(plan: Plan, path: Trajectory) -> Measurement:
    """As `measure`: in contact as long as there is a force, of either sign; the last step with one is the first apart.

    The bodies part within that step. By the momentum of the pull, which it then has for the share s of a step,
    m* (v_after - v_before) = -F_last s dt. Those still in contact at the end stick: e_n = 0, no end.
    """
    x, dt, row = plan.experiment, path.time_step, np.arange(plan.n)
    overlap, force, velocity = path.overlap, path.force, path.velocity
    sampled = np.isfinite(force)
    loaded = sampled & (force != 0)
    if not loaded.any(axis=1).all():
        bad = plan.speed[~loaded.any(axis=1)][0]
        raise EngineError(f"the impact at {bad:.6g} m/s never touched; the run is too short or went wrong")
    apart, end = _last(loaded), _last(sampled)
    stuck, last = apart == end, np.maximum(apart - 1, 0)
    push = force[row, last] * dt / x.m_star
    gained = velocity[row, last] - velocity[row, end]
    share = np.clip(np.divide(gained, push, out=np.full(plan.n, 0.5), where=push != 0), 0.0, 1.0)
    between = overlap[row, last] + share * (overlap[row, apart] - overlap[row, last])
    peak = np.where(sampled, overlap, -np.inf).max(axis=1)
    work = 0.5 * (force[:, 1:] + force[:, :-1]) * np.diff(overlap)
    lost = x.theory().lost_work(peak)
    nothing = np.full(plan.n, np.nan)
    return Measurement(
        e_n=np.where(stuck, 0.0, -velocity[row, end] / plan.speed),
        contact_time=np.where(stuck, np.inf, (last + share) * dt - plan.gap / plan.speed),
        force_max=np.where(loaded, force, -np.inf).max(axis=1),
        overlap_max=peak,
        residual_overlap=np.where(stuck, nothing, between),
        energy_residual=np.where(stuck, nothing, (np.nansum(work, axis=1) - lost) / (0.5 * x.m_star * plan.speed**2)),
        steps_in_contact=loaded.sum(axis=1),
    )


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
