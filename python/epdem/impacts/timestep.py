# SPDX-License-Identifier: GPL-2.0-or-later
"""The time step of a case for a target error of e_n, from runs of the embedded engine.

No constant is fitted: the error at a given number of steps in contact varies 300-fold with v/v_y.
"""

from dataclasses import dataclass

import numpy as np

from ..case.impact import MOST_STEPS
from ..errors import CaseError
from ..theory import timestep as times
from .experiment import Experiment
from .prediction import Prediction

PHASES = 32  # four times the 8 of a case, so that the search does not miss the worst phase
LADDER = 2**0.25  # ratio of neighbouring steps tried; an error of second order changes by 1.41
SAFETY = 0.8  # the share of the target that the search accepts: phases between the tried ones are a little worse


@dataclass(frozen=True)
class Reference:
    """Reference times of a case for its step [s]."""

    stability: float  # 2 sqrt(m*/k_n), k_n = 2E* a_max: velocity Verlet of one normal contact
    rayleigh: float  # pi R sqrt(rho/G)/(0.1631 nu + 0.8766), smallest of the deformable spheres
    hertz: float  # contact time of an elastic impact at the highest speed
    contact: float  # shortest contact time of the law


@dataclass(frozen=True)
class Found:
    """A time step [s] with what it reaches: `error` is the largest relative error of e_n, `rms` their mean square."""

    time_step: float
    error: float
    rms: float
    target: float
    steps_in_contact: float
    reference: Reference

    def shares(self) -> dict[str, float]:
        """The step over each reference time."""
        return {name: self.time_step / t for name, t in vars(self.reference).items()}


def starting_phases(count: int) -> np.ndarray:
    """The shares of a step at which contacts begin, evenly over the step, shape (count,)."""
    return (np.arange(count) + 0.5) / count


def stability_limit(x: Experiment, overlap_max: float) -> float:
    """Largest stable step of velocity Verlet at the stiffest point of a contact [s], by the law's own radius.

    With adhesion the stiffness is 2 E* a (4 y^3/R - 3 c)/(4 y^3/R - c) < 2 E* a, y = sqrt(a); it goes to minus infinity
    where the contact ends, which is not a question of stability but of the error, which the search sees.
    """
    a = float(np.asarray(x.theory().radius(np.array([overlap_max])))[0])
    return float(times.stability_limit(E_star=x.E_star, m_star=x.m_star, radius=a))


def reference(x: Experiment, prediction: Prediction) -> Reference:
    """The reference times of a case."""
    rayleigh = np.inf
    for body in (x.body, x.target):
        if np.isfinite(body.radius) and not body.rigid:
            time = times.rayleigh_time(
                radius=body.radius,
                density=body.density,
                young_modulus=body.young_modulus,
                poisson_ratio_=body.poisson_ratio,
            )
            rayleigh = min(rayleigh, float(time))
    hertz = times.hertz_time(E_star=x.E_star, R_star=x.R_star, m_star=x.m_star, speed=x.speed.max())
    return Reference(
        stability=float(stability_limit(x, prediction.overlap_max.max())),
        rayleigh=float(rayleigh),
        hertz=float(hertz),
        contact=float(prediction.duration.min()),
    )


def restitution_errors(x: Experiment, prediction: Prediction, time_step: float, phases: int = PHASES) -> np.ndarray:
    """Relative errors of e_n at one time step [s] in the embedded engine, (speeds, phases); inf where it broke.

    Where theory lets the bodies stick the error is e_n itself.
    """
    gap = starting_phases(phases)[None, :] * x.speed[:, None] * time_step
    speed = np.broadcast_to(x.speed[:, None], gap.shape)
    steps = int(np.ceil(1.5 * prediction.duration.max() / time_step)) + 20
    out = x.native_law().impacts(
        R_star=x.R_star,
        m_star=x.m_star,
        speed=speed.ravel(),
        time_step=time_step,
        gap=gap.ravel(),
        steps=steps,
        viscous=x.viscous_number,
    )
    e_n = (out["rebound_speed"] / speed.ravel()).reshape(gap.shape)
    sticks = prediction.sticks[:, None]
    ended = (out["last"] >= 0) & ((out["steps"] < steps).reshape(gap.shape) | (e_n == 0.0)).ravel()
    error = np.abs(e_n - prediction.e_n[:, None]) / np.where(sticks, 1.0, prediction.e_n[:, None])
    return np.where(ended.reshape(gap.shape) & np.isfinite(error), error, np.inf)


def search(x: Experiment, prediction: Prediction, target: float) -> Found:
    """The largest step below which every step tried keeps e_n within `target` (relative, all speeds and phases).

    Raises CaseError if no step down to MOST_STEPS in contact reaches the target.
    """
    if not 0.0 < target < 1.0:
        raise CaseError(f"error = {target!r}, must lie in (0, 1)")
    ref = reference(x, prediction)
    dt, last = min(ref.stability, ref.contact / 5.0), None
    best = np.inf
    while ref.contact / dt <= MOST_STEPS:
        errors = restitution_errors(x, prediction, dt)
        worst = float(errors.max())
        best = min(best, worst)
        rungs = 1
        if worst > SAFETY * target:
            last = None  # a single good coarse step is no evidence
            # far off, half of the reduction expected from second order can be skipped
            rungs = max(1, int(np.log2(worst / target))) if np.isfinite(worst) else 1
        elif last is None:
            last = Found(dt, worst, float(np.sqrt((errors**2).mean())), target, ref.contact / dt, ref)
        elif last.time_step > 1.9 * dt:  # a factor of two of good steps below it is evidence
            return last
        dt /= LADDER**rungs
    raise CaseError(
        f"error = {target:g} is not reached by every step near {MOST_STEPS} in contact; the best is {best:.2g}; "
        "give a larger one"
    )
