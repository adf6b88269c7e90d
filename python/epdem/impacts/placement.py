# SPDX-License-Identifier: GPL-2.0-or-later
"""Initial positions of the bodies of a plan: one cell of a grid per impact, contact at z = 0."""

import math
from dataclasses import dataclass

import numpy as np

from .experiment import Body
from .plan import Plan

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

    Spheres meet in their centre-of-mass frame, where each has its share of speed and gap.
    """
    x, n = plan.experiment, plan.n
    wall = math.isinf(x.target.radius)
    across, spacing = math.ceil(math.sqrt(n)), _spacing(plan)
    column = np.arange(n)
    place = (spacing * (column % across), spacing * (column // across))
    share = 1.0 if wall else x.m_star / x.body.mass

    def group(body: Body, z: np.ndarray, vz: np.ndarray, vx: np.ndarray, spin: np.ndarray | None = None) -> Group:
        return Group(body, np.stack([*place, z], axis=1), np.stack([vx, np.zeros(n), vz], axis=1), spin)

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


def room(plan: Plan) -> tuple[tuple[float, float], ...]:
    """(low, high) [m] along x, y and z of a box that holds all bodies to the end: they part no faster than they met."""
    reach, spacing = _reach(plan), _spacing(plan)
    edge = spacing * math.ceil(math.sqrt(plan.n))
    travel = plan.steps * plan.time_step * float(plan.speed.max()) + 4 * reach
    low = -reach if math.isinf(plan.experiment.target.radius) else -travel
    return (-spacing, edge), (-spacing, edge), (low, travel)


def _spacing(plan: Plan) -> float:
    """Distance of two impacts [m]: their bodies never meet, also if they move sideways."""
    o = plan.experiment.oblique
    sideways = 0.0 if o is None else float((plan.experiment.speed * np.tan(o.angle)).max())
    return SPACING * _reach(plan) + plan.steps * plan.time_step * sideways


def _reach(plan: Plan) -> float:
    x = plan.experiment
    return max(r for r in (x.body.radius, x.target.radius) if math.isfinite(r))
