# SPDX-License-Identifier: GPL-2.0-or-later
"""Oblique impacts of solid spheres in a plane: tangential velocities, spins and their rebound.

Angles are measured from the normal, and speeds are along it. A spin is positive as friction turns the body. psi is the
velocity of the surfaces against each other, over the speed, times kappa/mu (Maw, Barber and Fawcett 1976).
"""

import math
from dataclasses import dataclass, fields

import numpy as np

from ..theory import partial_slip
from .experiment import Experiment

SLIDING = 1e-3  # how far below mu the ratio of impulses of an impact that slides throughout may lie


@dataclass(frozen=True)
class Rebound:
    """Angles [rad] and spins [rad/s] of impacts before and after, and what follows; arrays of shape (n,)."""

    angle: np.ndarray
    spin_before: np.ndarray
    impulse_ratio: np.ndarray  # f = P_t/P_n
    e_t: np.ndarray  # of the centres' tangential velocity; NaN for a normal impact
    rebound_angle: np.ndarray
    spin: np.ndarray
    psi_1: np.ndarray
    psi_2: np.ndarray

    def columns(self) -> dict[str, np.ndarray]:
        """The values by their names."""
        return {f.name: getattr(self, f.name) for f in fields(self)}

    def regimes(self, friction: float) -> np.ndarray:
        """The regime of each impact: sliding, sticking or partial slip."""
        slides = np.abs(self.impulse_ratio) > (1 - SLIDING) * friction
        return np.where(slides, "sliding", np.where(np.abs(self.psi_1) < 1, "sticking", "partial slip"))


def unit(x: Experiment) -> float:
    """mu/kappa: psi times this and the speed is a velocity."""
    o = x.friction_of_oblique()
    return o.friction * x.E_star / (4 * x.G_star)


def slip_before(x: Experiment, *, phases: int = 1) -> np.ndarray:
    """Velocity of the surfaces against each other before the impacts [m/s], each row `phases` times."""
    o = x.friction_of_oblique()
    return np.repeat(x.speed * np.tan(o.angle) - x.body.radius * o.spin, phases)


def rebound(x: Experiment, e_n: np.ndarray, *, tangential: np.ndarray, spin: np.ndarray) -> Rebound:
    """From the tangential velocity of the centres [m/s] and the body's spin [rad/s] after impacts of any phases."""
    o, phases = x.friction_of_oblique(), e_n.size // x.speed.size
    speed, angle, before = (np.repeat(a, phases) for a in (x.speed, o.angle, o.spin))
    v_t = speed * np.tan(angle)
    impulse = x.m_star * (v_t - tangential)
    slip = tangential - x.body.radius * spin - 2.5 * impulse / x.target.mass  # the target's spin follows
    scale = unit(x) * speed
    return Rebound(
        angle=angle,
        spin_before=before,
        impulse_ratio=impulse / (x.m_star * speed * (1 + e_n)),
        e_t=np.divide(tangential, v_t, out=np.full(v_t.shape, math.nan), where=v_t > 0),
        rebound_angle=np.arctan2(tangential, e_n * speed),
        spin=spin,
        psi_1=slip_before(x, phases=phases) / scale,
        psi_2=slip / scale,
    )


def after_slip(x: Experiment, slip: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(tangential velocity [m/s] of the centres, spin [rad/s] of the body) after impacts that leave `slip` [m/s]."""
    o, phases = x.friction_of_oblique(), slip.size // x.speed.size
    change = 2 / 7 * (slip_before(x, phases=phases) - slip)  # of the centres' velocity
    v_t, before = (np.repeat(a, phases) for a in (x.speed * np.tan(o.angle), o.spin))
    return v_t - change, before + 2.5 * change * x.m_star / (x.body.mass * x.body.radius)


def predict(x: Experiment, e_n: np.ndarray) -> Rebound:
    """Theory with partial slip: springs along the line of contact, for every law."""
    o, slip, law = x.friction_of_oblique(), slip_before(x), x.backbone()
    after = np.empty(slip.shape)
    for speed in np.unique(x.speed):
        rows = x.speed == speed
        after[rows] = partial_slip.rebound(
            law,
            m_star=x.m_star,
            m_tangential=2 / 7 * x.m_star,
            mu=o.friction,
            G_star=x.G_star,
            v_n=float(speed),
            slip=slip[rows],
            steps=1000,
            springs=200,
        )
    tangential, spin = after_slip(x, after)
    return rebound(x, e_n, tangential=tangential, spin=spin)
