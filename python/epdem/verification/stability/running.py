# SPDX-License-Identifier: GPL-2.0-or-later
"""Run extreme cases and judge them: finite, no energy created, second order, and the steps at which they fail."""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...errors import EngineError, EpdemError
from ...impacts.engine import EPS, not_representable
from ...impacts.experiment import Experiment
from ...impacts.plan import stability_limit, starting_phases
from ...impacts.prediction import predict
from ...theory.validity import SMALL_DEFORMATION
from .cases import Extreme
from .sampling import Sampler

FINE = (0.16, 0.08, 0.04, 0.02, 0.01)  # shares of the stability limit: convergence
COARSE = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.35, 1.5)  # and beyond: where it breaks
FINEST = 1e-4
ERROR, CREATED = 1e-3, 1e-4  # accepted at 1 % of the limit: 10 times what velocity Verlet leaves there at worst
BROKEN = 0.01  # share of the energy created at which a run counts as broken
WRONG = 0.1  # error of e_n at which it is useless
LEAST_ORDER = 1.7


@dataclass
class Verdict:
    """One case in one engine with one law. Shares are of the stability limit; NaN: not reached or not asked."""

    case: str
    group: str
    engine: str
    law: str
    status: str = "passed"  # passed, failed, not representable, embedded only
    reason: str = ""
    large_deformation: bool = False
    strain: float = np.nan  # w a_max/R*, w: share of the weaker body
    e_n_theory: float = np.nan
    e_n_error: float = np.nan  # largest over the phases at the finest share of the ladder
    created: float = np.nan  # energy from nothing over the energy at the start, the same
    order: float = np.nan
    useless_at: float = np.nan  # smallest share with e_n wrong by more than 10 %
    breaks_at: float = np.nan  # smallest share with energy created, no end or no number
    steps: int = 0
    seconds: float = 0.0
    notes: list[str] = field(default_factory=list)

    def fail(self, reason: str) -> None:
        """Note that the case failed, with one more reason."""
        self.status = "failed"
        self.reason = f"{self.reason}; {reason}" if self.reason else reason


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


@dataclass(frozen=True)
class Rung:
    """One share of the limit: largest error of e_n and largest energy created; inf: a contact did not end, or the
    engine died (`message`: its last one), as it may when a sphere is thrown out of the box.
    """

    share: float
    error: float
    created: float
    steps: int
    finite: bool = True
    message: str = ""


def measure(s: Setting, sampler: Sampler, share: float, phases: int | None = None) -> Rung | None:
    """Run the case at a share of the limit; None if it would take too long.

    The balance takes the law's plastic work at the peak that was sampled: evidence for the law, unlike the work of
    the sampled forces, which velocity Verlet balances for any force.
    """
    dt = share * s.limit
    steps = int(1.5 * s.contact_time / dt) + 20
    if steps > sampler.most_steps:
        return None
    try:
        got = [sampler(s.x, h, gap, int(steps * dt / h)) for h, gap in phased(s, dt, phases or sampler.phases)]
    except EngineError as stopped:
        return Rung(share, np.inf, np.inf, 0, message=str(stopped))
    e_n, peak = (np.concatenate([getattr(g, name) for g in got]) for name in ("e_n", "overlap_max"))
    kinetic = 0.5 * s.x.m_star * float(s.x.speed[0]) ** 2
    with np.errstate(all="ignore"):
        error = np.abs(e_n / s.e_n - 1.0)
        created = (e_n**2 * kinetic + s.lost(peak)) / s.energy - 1.0
    whole = np.isfinite(error) & np.isfinite(created)
    worst = [float(np.where(whole, value, np.inf).max()) for value in (error, created)]
    return Rung(share, worst[0], worst[1], sum(g.steps for g in got), all(g.finite for g in got))


def position_floor(*, radius: float, recovered: float, steps: float) -> float:
    """Relative error of e_n left by overlaps that are differences of positions as large as `radius` [m].

    Every step rounds a position to ulp(R) <= eps R: a displacement r outside the velocity, which does the work F r.
    N independent r, uniform in +-ulp/2, leave sqrt(N/12) ulp F_rms, over twice the energy of the rebound,
    2/5 F_max delta_e: for a Hertz force (F_rms = 0.66 F_max) 0.24 sqrt(N) ulp/delta_e as a standard deviation, and
    twice that as the largest of ten phases. `recovered`: the elastic recovery delta_e [m] (below yield alpha_max).
    """
    return 0.5 * math.sqrt(steps) * EPS * radius / recovered


def floor(s: Setting, sampler: Sampler, share: float) -> float:
    """Round-off of e_n (relative): eps per step, or that of overlaps which are differences of positions."""
    steps = s.contact_time / (share * s.limit)
    own = 10 * EPS * math.sqrt(steps)
    if not sampler.positions:
        return own
    radius = max(r for r in (s.x.body.radius, s.x.target.radius) if np.isfinite(r))
    return own + position_floor(radius=radius, recovered=s.recovered, steps=steps)


def slope(shares: list[float], errors: list[float], noise: float) -> float:
    """Observed order: slope of log error over log dt where the error is above the noise; NaN below three points."""
    good = [(h, e) for h, e in zip(shares, errors, strict=True) if 5 * noise < e < 0.1]
    step, error = np.log(np.array(good).reshape(-1, 2)).T
    return float(np.polyfit(step, error, 1)[0]) if len(good) > 2 else np.nan


def judge(extreme: Extreme, law: str, sampler: Sampler, coarse: Sequence[float] = COARSE) -> Verdict:
    """The verdict on an impact case."""
    return judged(extreme, law, sampler, lambda v, s: _ladder(v, s, sampler, coarse))


def judged(
    extreme: Extreme, law: str, sampler: Sampler, judges: Callable[[Verdict, Setting], None], *, reach: float = 1.0
) -> Verdict:
    """The verdict of `judges` on a case, if the sampler can represent overlaps of `reach` times the largest."""
    v, begin = Verdict(extreme.name, extreme.group, sampler.name, law), time.perf_counter()
    try:
        s = setting(extreme, law)
        v.e_n_theory, v.strain = s.e_n, s.strain
        v.large_deformation = s.strain > SMALL_DEFORMATION
        if sampler.positions and (why := not_representable(s.x, reach * s.overlap_max)):
            v.status, v.reason = "not representable", why
        else:
            judges(v, s)
    except EpdemError as error:
        v.fail(str(error))
    v.seconds = time.perf_counter() - begin
    return v


def _ladder(v: Verdict, s: Setting, sampler: Sampler, coarse: Sequence[float]) -> None:
    fine = [rung for share in FINE if (rung := measure(s, sampler, share))]
    if not fine:
        v.fail("even 16 % of the limit would take too many steps")
        return
    last = fine[-1]
    noise = 2 * floor(s, sampler, last.share)
    v.e_n_error, v.created = last.error, last.created
    v.order = slope([r.share for r in fine], [r.error for r in fine], noise)
    scale = (last.share / FINE[-1]) ** 2  # where the ladder had to stop early its error is larger, by the order 2
    if not v.e_n_error <= ERROR * scale + noise:
        v.fail(f"e_n off by {v.e_n_error:.2g} at {last.share:.2g} of the limit")
    if not v.created <= CREATED * scale + 2 * noise:
        v.fail(f"energy created: {v.created:.2g} at {last.share:.2g} of the limit")
    if v.order < LEAST_ORDER:
        v.fail(f"order of convergence {v.order:.2f}")
    if last.share > FINE[-1]:
        v.notes.append(f"finest share {last.share:g}: more would take too many steps")
    finest = measure(s, sampler, FINEST, phases=1)
    if finest is None:
        v.notes.append(f"dt = {FINEST:g} of the limit would take too many steps")
    elif not finest.error <= ERROR:
        v.fail(f"e_n off by {finest.error:.2g} at {FINEST:g} of the limit")
    rungs = [rung for share in coarse if (rung := measure(s, sampler, share))]
    v.useless_at = min((r.share for r in rungs if not r.error <= WRONG), default=np.nan)
    v.breaks_at = min((r.share for r in rungs if not r.created <= BROKEN), default=np.nan)
    for rung in fine:
        if rung.message:
            v.fail(f"at {rung.share:g} of the limit: {rung.message}")
    v.notes += [f"at {r.share:g} of the limit: {r.message}" for r in rungs if r.message]
    everything = [*fine, *rungs, *filter(None, [finest])]
    v.steps = sum(r.steps for r in everything)
    if wild := [r.share for r in everything if not r.finite]:
        v.fail(f"not finite at {min(wild):g} of the limit")
