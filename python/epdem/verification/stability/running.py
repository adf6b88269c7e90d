# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts of extreme cases in one engine: finite, no energy created, second order, and the steps at which they fail."""

import math
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ...engines import ImpactEngine
from ...engines.yade.engine import Yade
from ...errors import CaseError, EngineError, EpdemError
from ...impacts.engine import EPS, Trajectory, not_representable
from ...impacts.experiment import Experiment
from ...impacts.measurement import measure
from ...impacts.plan import Plan, stability_limit, starting_phases
from ...impacts.prediction import predict
from ...jobs.engine import Feature
from ...theory.validity import SMALL_DEFORMATION
from ..runner import STUDIES, Row
from .cases import Extreme

FINE = (0.16, 0.08, 0.04, 0.02, 0.01)  # shares of the stability limit: convergence
COARSE = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.35, 1.5)  # and beyond: where it breaks
POSITION_COARSE = (0.3, 0.5, 0.7, 1.0, 1.5)  # an engine's start-up costs more than its steps
FINEST = 1e-4
ERROR, CREATED = 1e-3, 1e-4  # accepted at 1 % of the limit: 10 times what velocity Verlet leaves there at worst
BROKEN = 0.01  # share of the energy created at which a run counts as broken
WRONG = 0.1  # error of e_n at which it is useless
LEAST_ORDER = 1.7
MOST_STEPS = 20_000  # of an impact in an engine with positions


@dataclass(frozen=True)
class Bench:
    """An engine, and the folder in which it runs."""

    tool: ImpactEngine
    folder: Path

    @property
    def name(self) -> str:
        return self.tool.name

    @property
    def positions(self) -> bool:
        """Whether an overlap is a difference of positions; then a start-up costs more than the steps."""
        return Feature.POSITIONS in self.tool.features

    def run(self, p: Plan) -> Trajectory:
        """Raises EngineError, FloatingPointError for a force or velocity that is no number."""
        self.tool.write(p, self.folder)
        path = self.tool.run(p, self.folder)
        force = path.force
        there = self.positions | ~np.isnan(force)  # NaN follows the end of an embedded impact, where the force is 0
        torn = np.isnan(force[:, 1:]) & (np.nan_to_num(force[:, :-1]) != 0)
        if torn.any() or any(not np.isfinite(a[there]).all() for a in (force, path.velocity, path.overlap)):
            raise FloatingPointError(f"not finite at a time step of {p.time_step:g} s")
        return path

    def impacts(self, x: Experiment, time_step: float, gap: np.ndarray, steps: int) -> tuple[np.ndarray, np.ndarray]:
        """Rebound over approach speed and largest overlap [m] of impacts with one speed from the gaps [m], shape (n,).

        A negative gap is an overlap at the start. Raises as `run`, EngineError also for a contact that never ended.
        """
        speed = np.full(gap.size, x.speed[0])
        if isinstance(self.tool, Yade):
            # its velocity belongs to half a step before the position: a force at t = 0 has acted in that half step too
            force, _, _ = x.native_law().step(R_star=x.R_star, delta_max=0.0, delta=-gap)
            speed = speed + 0.5 * time_step * force / x.m_star
        p = Plan(x, time_step, steps, gap.size, speed, gap)
        found = measure(p, self.run(p))
        return found["e_n"].to_numpy() * speed / x.speed[0], found["overlap_max"].to_numpy()


@dataclass(frozen=True)
class Setting:
    """A case as an initial-value problem with its theory: energies [J], overlaps [m], times [s]."""

    x: Experiment
    start: float | None  # overlap at t = 0, None: apart
    energy: float  # kinetic and stored at t = 0
    overlap_max: float
    recovered: float  # elastic recovery delta_e
    e_n: float
    limit: float
    contact_time: float
    strain: float
    lost: Callable[[np.ndarray], Any]  # work [J] that a contact loses which reaches an overlap [m]

    def steps(self, time_step: float) -> int:
        """Of a time step [s] up to beyond the end of the contact."""
        return int(1.5 * self.contact_time / time_step) + 20


def setting(extreme: Extreme, law: str) -> Setting:
    """Theory of an extreme case, with the work already stored in an overlap at t = 0."""
    x = extreme.experiment(law)
    p, kinetic = predict(x), 0.5 * x.m_star * float(x.speed[0]) ** 2
    names = ("overlap_max", "residual_overlap", "e_n", "contact_time", "strain")
    top, residual, e_n, contact_time, strain = (float(getattr(p, name)[0]) for name in names)
    lost = x.theory().lost_work
    limit = float(stability_limit(x, top))
    found = Setting(x, None, kinetic, top, top - residual, e_n, limit, contact_time, strain, lost)
    if extreme.start is None:
        return found
    theory, start = x.backbone(), extreme.start * top
    energy = kinetic + float(theory.work(start)) if start else kinetic
    top = float(theory.overlap_of_work(energy)) if start else top
    elastic = top <= theory.yield_overlap
    out = energy if elastic else float(theory.recovered_work(top))
    return replace(
        found,
        start=start,
        energy=energy,
        overlap_max=top,
        recovered=top if elastic else float(theory.recovered_overlap(top)),
        e_n=float(np.sqrt(out / kinetic)),
        limit=float(stability_limit(x, top)),
        strain=float(x.law.share * theory.radius(top) / x.R_star),
    )


def phased(s: Setting, dt: float, phases: int) -> list[tuple[float, np.ndarray]]:
    """The runs (time step [s], distances to first touch [m]) over which an error is a maximum.

    A contact that is there at t = 0 has no phase at its beginning: steps up to a fifth smaller vary that of its end.
    """
    if s.start is not None:
        return [(dt * (1 - 0.2 * k / phases), np.array([-s.start])) for k in range(0, phases, 2)]
    return [(dt, starting_phases(phases) * s.x.speed[0] * dt)]


def ladder(s: Setting, bench: Bench, shares: Iterable[float], phases: int | None = None) -> pd.DataFrame:
    """One row per share of the limit that does not take too long: largest `error` of e_n, largest energy `created`.

    inf: a contact did not end, or the engine died (`message`: its last one), as it may when a sphere is thrown out of
    the box. The balance takes the law's plastic work at the peak that was sampled: evidence for the law, unlike the
    work of the sampled forces, which velocity Verlet balances for any force.
    """
    rows, kinetic = [], 0.5 * s.x.m_star * float(s.x.speed[0]) ** 2
    phases = phases or (8 if bench.positions else 16)
    for dt in (share * s.limit for share in shares):
        if bench.positions and s.steps(dt) > MOST_STEPS:
            continue
        row = {"share": dt / s.limit, "error": np.inf, "created": np.inf, "message": ""}
        try:
            runs = [bench.impacts(s.x, h, gap, int(s.steps(dt) * dt / h)) for h, gap in phased(s, dt, phases)]
            e_n, peak = (np.concatenate(values) for values in zip(*runs, strict=True))
            created = (e_n**2 * kinetic + s.lost(peak)) / s.energy - 1.0
            row |= {"error": np.abs(e_n / s.e_n - 1.0).max(), "created": created.max()}
        except EngineError as stopped:
            row["message"] = str(stopped)
        rows.append(row)
    return pd.DataFrame(rows, columns=["share", "error", "created", "message"])


def position_floor(*, radius: float, recovered: float, steps: float) -> float:
    """Relative error of e_n left by overlaps that are differences of positions as large as `radius` [m].

    Every step rounds a position to ulp(R) <= eps R: a displacement r outside the velocity, which does the work F r.
    N independent r, uniform in +-ulp/2, leave sqrt(N/12) ulp F_rms, over twice the energy of the rebound,
    2/5 F_max delta_e: for a Hertz force (F_rms = 0.66 F_max) 0.24 sqrt(N) ulp/delta_e as a standard deviation, and
    twice that as the largest of ten phases. `recovered`: the elastic recovery delta_e [m] (below yield alpha_max).
    """
    return 0.5 * math.sqrt(steps) * EPS * radius / recovered


def floor(s: Setting, bench: Bench, share: float) -> float:
    """Round-off of e_n (relative): eps per step, or that of overlaps which are differences of positions."""
    steps = s.contact_time / (share * s.limit)
    own = 10 * EPS * math.sqrt(steps)
    if not bench.positions:
        return own
    radius = max(r for r in (s.x.body.radius, s.x.target.radius) if np.isfinite(r))
    return own + position_floor(radius=radius, recovered=s.recovered, steps=steps)


def order(shares: Iterable[float], errors: Iterable[float], noise: float) -> Row:
    """Observed order: slope of log error over log dt where the error is above the noise; None below three points."""
    good = [(h, e) for h, e in zip(shares, errors, strict=True) if 5 * noise < e < 0.1]
    step, error = np.log(np.array(good).reshape(-1, 2)).T
    found = float(np.polyfit(step, error, 1)[0]) if len(good) > 2 else None
    return {"order": found, "lack_of_order": None if found is None else LEAST_ORDER - found}


def impact(s: Setting, bench: Bench, coarse: Iterable[float] = ()) -> Row:
    """An impact: the ladder of steps that converge, one at FINEST, and the coarse ones (none given: all)."""
    fine, finest = ladder(s, bench, FINE), ladder(s, bench, (FINEST,), phases=1)
    if died := [f"at {r.share:g} of the limit: {r.message}" for r in fine.itertuples() if r.message]:
        raise EngineError("; ".join(died))
    if fine.empty:
        raise EngineError("even 16 % of the limit would take too many steps")
    last = fine.iloc[-1]
    noise = 2 * floor(s, bench, last["share"])
    scale = (last["share"] / FINE[-1]) ** 2  # where the ladder had to stop early its error is larger, by the order 2
    found = ladder(s, bench, coarse or (POSITION_COARSE if bench.positions else COARSE))
    return order(fine["share"], fine["error"], noise) | {
        "finest_share": last["share"],
        "e_n_error": last["error"],
        "e_n_limit": ERROR * scale + noise,
        "created": last["created"],
        "created_limit": CREATED * scale + 2 * noise,
        "finest_error": None if finest.empty else finest["error"].iloc[0],
        "useless_at": found["share"][~(found["error"] <= WRONG)].min(),
        "breaks_at": found["share"][~(found["created"] <= BROKEN)].min(),
    }


def judge(extreme: Extreme, law: str, bench: Bench, measures: Callable[[Setting, Bench], Row] = impact) -> Row:
    """The row of a case, judged. status: passed, failed, or not representable; NaN: not reached or not asked.

    strain: w a_max/R*, w: share of the weaker body. created: energy from nothing over the energy at the start.
    useless_at, breaks_at: smallest share of the limit with e_n wrong by more than 10 %, with energy created, no end or
    no number.
    """
    row: Row = {"case": extreme.name, "group": extreme.group, "engine": bench.name, "law": law}
    row["large_deformation"] = False
    begin, reach = time.perf_counter(), 1.0 if extreme.kind == "impact" else 2.0
    try:
        s = setting(extreme, law)
        row |= {"e_n_theory": s.e_n, "strain": s.strain, "large_deformation": s.strain > SMALL_DEFORMATION}
        if bench.positions and (why := not_representable(s.x, reach * s.overlap_max)):
            return row | {"status": "not representable", "reason": why}
        row = STUDIES[extreme.kind].judged(row | measures(s, bench))
    except CaseError as error:  # of what the engine cannot be given
        return row | {"status": "not representable", "reason": str(error)}
    except (EpdemError, FloatingPointError) as error:
        row |= {"passed": False, "reason": str(error)}
    status = "passed" if row.pop("passed") else "failed"
    return row | {"status": status, "seconds": time.perf_counter() - begin}
