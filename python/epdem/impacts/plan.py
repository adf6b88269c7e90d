# SPDX-License-Identifier: GPL-2.0-or-later
"""The impacts to run: every speed from every starting phase with one time step for all, and the places of the bodies.

The time step for a target error of e_n comes from runs of the embedded engine: no constant is fitted, because the error
at a given number of steps in contact varies 300-fold with v/v_y."""

import math
from dataclasses import dataclass

import numpy as np

from ..case.impact import MOST_STEPS
from ..errors import CaseError
from ..theory import timestep as times
from .experiment import Body, Experiment
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
class FoundStep:
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


def search(x: Experiment, prediction: Prediction, target: float) -> FoundStep:
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
            last = FoundStep(dt, worst, float(np.sqrt((errors**2).mean())), target, ref.contact / dt, ref)
        elif last.time_step > 1.9 * dt:  # a factor of two of good steps below it is evidence
            return last
        dt /= LADDER**rungs
    raise CaseError(
        f"error = {target:g} is not reached by every step near {MOST_STEPS} in contact; the best is {best:.2g}; "
        "give a larger one"
    )


FINE = LADDER**0.25  # ratio of the steps that `matched_step` tries: the error changes by 9 %
TRIED = 13  # of them, up to 1.7 times the step of `search`
AIM = 0.85  # of the target: fewer phases than PHASES find 0.6 to 1.1 of what these find


def matched_step(x: Experiment, prediction: Prediction, target: float) -> FoundStep:
    """The step whose own error of e_n is nearest to the target: measured with 8 phases, 0.5 to 1.5 of it.

    It is coarser than that of `search`; contacts have five steps at least, with which the error may be lower. Raises
    CaseError as `search`.
    """
    safe = search(x, prediction, target)
    ref = safe.reference
    steps = safe.time_step * FINE ** np.arange(TRIED)
    steps = steps[steps <= max(safe.time_step, min(ref.stability, ref.contact / 5.0))]
    errors = [restitution_errors(x, prediction, float(dt)) for dt in steps]
    best = int(np.argmin([abs(math.log(max(e.max(), 1e-300) / (AIM * target))) for e in errors]))
    dt, error, rms = float(steps[best]), float(errors[best].max()), float(np.sqrt((errors[best] ** 2).mean()))
    return FoundStep(dt, error, rms, target, ref.contact / dt, ref)


MAX_SAMPLES = 1e8  # of a trajectory: three numbers each, 2.4 GB


@dataclass(frozen=True)
class Plan:
    """n = speeds x phases impacts, speed by speed; arrays of shape (n,), SI.

    The body starts `gap` before first touch; a phase is the share of a step at which the contact then begins.
    One step serves all speeds (contact time goes only as v^-0.2): the fastest has steps_in_contact, or all of them
    the step that keeps e_n within the case's target error.
    """

    experiment: Experiment
    time_step: float
    steps: int
    phases: int
    speed: np.ndarray
    gap: np.ndarray

    def each(self, values: np.ndarray) -> np.ndarray:
        """Values of the experiment's rows for every impact, shape (n,)."""
        return np.repeat(values, self.phases)

    @property
    def n(self) -> int:
        return self.speed.size

    @property
    def spheres(self) -> int:
        """Number of spheres of all impacts: the bodies, and the targets unless they are planes."""
        return self.n if math.isinf(self.experiment.target.radius) else 2 * self.n

    @property
    def summary(self) -> str:
        """One line for the head of a deck."""
        speeds, law = self.experiment.speed.size, self.experiment.law.name
        return f"{speeds} speeds x {self.phases} phases = {self.n} independent impacts, law {law}"


def plan(experiment: Experiment, prediction: Prediction, *, time_step: float | None = None) -> Plan:
    """The plan of `experiment`; `time_step` [s] replaces the one that follows from steps_in_contact or error."""
    numerics = experiment.numerics
    if time_step is not None:
        dt = time_step
    elif numerics.error is not None:
        dt = matched_step(experiment, prediction, numerics.error).time_step
    else:
        dt = float(prediction.duration.min() / numerics.steps_in_contact)
    speed = np.repeat(experiment.speed, numerics.phases)
    gap = np.tile(starting_phases(numerics.phases), experiment.speed.size) * speed * dt
    # a few steps more than the longest contact: integration errors stretch it, and its end must be among the samples
    steps = int(np.ceil(1.02 * prediction.duration.max() / dt)) + 8
    if speed.size * steps > MAX_SAMPLES:
        raise CaseError(
            f"{speed.size} impacts of up to {steps} steps are {speed.size * steps:.2g} samples, at most "
            f"{MAX_SAMPLES:.0e} fit; lower steps_in_contact, count or phases, or split the range of speeds"
        )
    return Plan(experiment, dt, steps, numerics.phases, speed, gap)


SPACING = 2.6  # larger radii between two impacts


@dataclass(frozen=True)
class Group:
    """The bodies of one side: places [m] and velocities [m/s], shape (n, 3); spin about y [rad/s], shape (n,)."""

    body: Body
    place: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray | None = None  # none


def side_by_side(plan: Plan) -> tuple[Group, ...]:
    """The bodies, and the targets unless they are planes; impact k of the plan is row k of each group.

    Spheres meet in their centre-of-mass frame, where each has its share of speed and gap, one above the other.
    """
    x, n = plan.experiment, plan.n
    wall = math.isinf(x.target.radius)
    across, spacing = math.ceil(math.sqrt(n)), _spacing(plan)
    column = np.arange(n)
    place = (spacing * (column % across), spacing * (column // across))
    share = 1.0 if wall else x.m_star / x.body.mass

    def group(body: Body, z: np.ndarray, vz: np.ndarray, vx: np.ndarray, spin: np.ndarray | None = None) -> Group:
        left = 0.0 if wall else vx * plan.gap / plan.speed
        centres = np.stack([place[0] - left, place[1], z], axis=1)
        return Group(body, centres, np.stack([vx, np.zeros(n), vz], axis=1), spin)

    vx, spin = np.zeros(n), None
    if x.oblique:
        vx, spin = plan.speed * plan.each(np.tan(x.oblique.angle)), plan.each(x.oblique.spin)
    body = group(x.body, x.body.radius + share * plan.gap, -share * plan.speed, share * vx, spin)
    if wall:
        return (body,)
    return body, group(x.target, -x.target.radius - (1 - share) * plan.gap, (1 - share) * plan.speed, (share - 1) * vx)


def approach(plan: Plan, z: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Overlap [m] and approach velocity [m/s], shape (n, samples), from height and vertical velocity of every body.

    z [m] and v [m/s] have the shape (samples, bodies); targets that move come after all bodies.
    """
    x, n = plan.experiment, plan.n
    if math.isinf(x.target.radius):
        return (x.body.radius - z).T, -v.T
    return (x.body.radius + x.target.radius - (z[:, :n] - z[:, n:])).T, (v[:, n:] - v[:, :n]).T


def room(plan: Plan) -> tuple[float, ...]:
    """xlo xhi ylo yhi zlo zhi [m] of a box that holds all bodies to the end: they part no faster than they met."""
    reach, spacing = _reach(plan), _spacing(plan)
    edge = spacing * math.ceil(math.sqrt(plan.n))
    travel = plan.steps * plan.time_step * float(plan.speed.max()) + 4 * reach
    low = -reach if math.isinf(plan.experiment.target.radius) else -travel
    return -spacing, edge, -spacing, edge, low, travel


def _spacing(plan: Plan) -> float:
    """Distance of two impacts [m]: their bodies never meet, also if they move sideways."""
    o = plan.experiment.oblique
    sideways = 0.0 if o is None else float((plan.experiment.speed * np.tan(o.angle)).max())
    return SPACING * _reach(plan) + plan.steps * plan.time_step * sideways


def _reach(plan: Plan) -> float:
    x = plan.experiment
    return max(r for r in (x.body.radius, x.target.radius) if math.isfinite(r))
