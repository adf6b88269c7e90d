# SPDX-License-Identifier: GPL-2.0-or-later
"""Engines of impacts: the plan of impacts goes in, a trajectory comes out."""

from dataclasses import dataclass, field

import numpy as np

from ..jobs.engine import Engine, Feature, Unsupported, check, check_law, refusal, refuse_ranks
from .experiment import Experiment
from .plan import Plan, approach
from .prediction import Prediction

EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Trajectory:
    """Samples of n impacts, every step; arrays of shape (n, samples), SI. Force and overlap belong together.

    overlap [m] is negative while apart, force [N] is never negative, velocity [m/s] is positive on approach.
    NaN after the end of an impact. `seconds` is the engine's own account of its time. tangential: velocity [m/s] of the
    centres against each other after oblique impacts, spin: of the body then [rad/s], shape (n,). end_power: of
    another law than the plan's, the power of the force that falls linearly with the overlap at the end.
    """

    time_step: float
    overlap: np.ndarray
    force: np.ndarray
    velocity: np.ndarray
    seconds: dict[str, float] = field(default_factory=dict)
    tangential: np.ndarray | None = None
    spin: np.ndarray | None = None
    end_power: float | None = None


def oblique_pairs(
    plan: Plan, place: np.ndarray, velocity: np.ndarray, force: np.ndarray, spin: np.ndarray, seconds: dict[str, float]
) -> Trajectory:
    """Oblique impacts of two spheres, along and across their line of centres, until the first sample apart.

    place [m], velocity [m/s], force [N]: x and z of every body, shape (2, samples, bodies). spin [rad/s]: of the body.
    """
    n, x = plan.n, plan.experiment
    between, speed = (a[:, :, :n] - a[:, :, n:] for a in (place, velocity))
    distance = np.hypot(*between)
    normal = between / distance
    along = (force[:, :, :n] * normal).sum(axis=0)
    sample = np.arange(len(along))[:, None]
    apart = np.minimum(np.where(along > 0, sample, -1).max(axis=0) + 1, len(along) - 1)
    overlap, load, approach = (
        np.where(sample <= apart, a, np.nan).T
        for a in (x.body.radius + x.target.radius - distance, along, -(speed * normal).sum(axis=0))
    )
    across = (speed[0] * normal[1] - speed[1] * normal[0])[apart, np.arange(n)]
    return Trajectory(plan.time_step, overlap, load, approach, seconds, across, spin)


def trajectory(
    plan: Plan,
    place: np.ndarray,
    velocity: np.ndarray,
    force: np.ndarray,
    seconds: dict[str, float],
    tangential: np.ndarray | None = None,
    spin: np.ndarray | None = None,
) -> Trajectory:
    """From samples of every body along z, or along x and z of spheres that meet obliquely: (axes, samples, bodies)."""
    if len(place) > 1 and spin is not None:
        return oblique_pairs(plan, place, velocity, force, spin[: plan.n], seconds)
    overlap, speed = approach(plan, place[0], velocity[0])
    return Trajectory(plan.time_step, overlap, force[0, :, : plan.n].T, speed, seconds, tangential, spin)


ImpactEngine = Engine[Plan, Trajectory]


def check_features(tool: ImpactEngine, x: Experiment) -> None:
    """Raise Unsupported if an experiment needs a law or a feature that the engine does not have."""
    check_law(tool, x.law.name)
    if x.oblique and Feature.FRICTION not in tool.features:
        raise Unsupported(f"impact.angles: engine {tool.name} runs normal impacts only")
    if x.oblique and np.isfinite(x.target.radius) and Feature.SPHERE_FRICTION not in tool.features:
        raise Unsupported(f"impact.angles: engine {tool.name} runs oblique impacts on walls only")
    if x.oblique and x.oblique.restitution is not None and Feature.TANGENTIAL_DASHPOT not in tool.features:
        raise Unsupported(f"contact.tangential_restitution: engine {tool.name} has no tangential dashpot")
    if x.viscous_restitution is not None and Feature.DASHPOT not in tool.features:
        raise Unsupported(f"viscous: engine {tool.name} does not have this dashpot")


def check_plan(tool: ImpactEngine, plan: Plan, prediction: Prediction, *, ranks: int = 1) -> list[str]:
    """Sentences on what `tool` leaves out or replaces. `prediction` belongs to the plan's experiment.

    Raises CaseError if `tool` cannot run `plan` as it is, EngineError if its ranks cannot be started.
    """
    refuse_ranks(tool, ranks)
    notes = check(tool, plan)
    for speed, overlap in zip(prediction.speed, prediction.overlap_max, strict=True):
        if Feature.POSITIONS in tool.features and (why := not_representable(plan.experiment, float(overlap))):
            reason = f"{speed:.4g} m/s is not representable by positions ({why})"
            raise refusal(tool, plan, reason, fits=lambda features: Feature.POSITIONS not in features)
    return notes


def not_representable(x: Experiment, overlap_max: float) -> str | None:
    """Why a position-based engine cannot hold this contact, or None.

    Overlap is a difference of numbers as large as the larger radius: it is known to eps R. Beyond half the smaller
    radius the spheres' centres come so near that contact detection and normal lose their sense.
    """
    radii = [r for r in (x.body.radius, x.target.radius) if np.isfinite(r)]
    if overlap_max > min(radii) / 2:
        return f"alpha_max = {overlap_max:.2g} m exceeds half the smaller radius"
    if overlap_max < 1e4 * EPS * max(radii):
        return f"alpha_max = {overlap_max:.2g} m is below 1e4 eps R = {1e4 * EPS * max(radii):.2g} m"
    return None
