# SPDX-License-Identifier: GPL-2.0-or-later
"""One contact again and again: drift over 1e9 steps, 10^4 reloads, a sphere squeezed between two walls."""

import time

import numpy as np

from ..errors import EpdemError
from ..theory.backbones import Backbone
from .cases import Extreme
from .running import BROKEN, CREATED, LEAST_ORDER, Setting, Verdict, setting, slope

BOUNCE_SHARE = 0.01  # of the stability limit: about 200 steps in contact
DRIFT = 1e-3  # of the speed over 1e9 steps; it goes with dt^3 (6e-11 a bounce at 1 % of the limit)
SQUEEZE = (0.16, 0.08, 0.04, 0.02, 0.01)  # shares of the limit of two springs, 1/sqrt(2) of that of one
GAUSS_X, GAUSS_W = np.polynomial.legendre.leggauss(40)


def bounces(v: Verdict, s: Setting, total: int) -> None:
    """Bounce one contact for `total` steps: its plastic work is done once, then it must neither gain nor lose."""
    dt = BOUNCE_SHARE * s.limit
    one = dict(R_star=s.x.R_star, m_star=s.x.m_star, speed=float(s.x.speed[0]), time_step=dt,
               steps=int(1.5 * s.contact_time / dt) + 20)  # fmt: skip
    law = s.x.native_law()
    trial, _ = law.bounces(200, **one)
    count = int(np.ceil(200 * total / trial["steps"]))
    out, speeds = law.bounces(count, **one)
    # the first bounce yields for good; what comes after it should be elastic
    v.steps, v.e_n_error = int(out["steps"]), float(np.abs(speeds / speeds[0] - 1).max())
    v.created = float(speeds.max() ** 2 / speeds[0] ** 2 - 1)
    v.notes.append(f"{count} bounces, speed off by {speeds[-1] / speeds[0] - 1:+.1e} after the last")
    if not v.e_n_error <= DRIFT:
        v.fail(f"speed drifts by {v.e_n_error:.2g}")
    if not v.created <= CREATED:
        v.fail(f"energy created: {v.created:.2g}")


def reloads(v: Verdict, s: Setting, cycles: int) -> None:
    """Load a contact to alpha_max, then unload and reload it in 64 samples a cycle: a cycle must do no work."""
    law, R = s.x.native_law(), s.x.R_star
    up = np.linspace(0.0, s.overlap_max, 33)
    delta = np.concatenate([up[::-1], up[1:]])
    _, _, memory = law.step(R_star=R, delta_max=0.0, delta=s.overlap_max)
    first, worst, drift = None, 0.0, 0.0
    for _ in range(cycles):
        force, _, after = law.step(R_star=R, delta_max=memory, delta=delta)
        memory = after[-1:]
        first = force if first is None else first
        drift = max(drift, float(np.abs(force - first).max()))
        worst = max(worst, abs(float(np.trapezoid(force, delta))))
    v.steps = cycles * delta.size
    v.e_n_error, v.created = drift / float(first.max()), worst / s.energy
    if drift or memory[0] != s.overlap_max:
        v.fail("force or memory change from cycle to cycle")
    if not v.created <= 1e-12:
        v.fail(f"work of a cycle: {v.created:.2g} of the energy")


def stored(theory: Backbone, alpha: np.ndarray, top: np.ndarray) -> np.ndarray:
    """Elastic and plastic work in a contact [J] at overlap alpha that reached `top`; arrays of one shape.

    On the elastic branch: what was put in less what came back from `top` to alpha, by Gauss points in an angle in
    which the branch is smooth at both of its ends.
    """
    alpha, top = np.maximum(alpha, 0.0), np.maximum(top, 1e-300)
    recovered = theory.recovered_overlap(top)
    # alpha = top - recovered sin^2(angle)
    last = np.arcsin(np.sqrt(np.clip((top - alpha) / recovered, 0.0, 1.0)))
    angle = last[..., None] * (GAUSS_X + 1) / 2
    points = top[..., None] - recovered[..., None] * np.sin(angle) ** 2
    force = theory.unloading_force(np.maximum(points, 0.0), top[..., None])
    back = (force * np.sin(2 * angle)) @ GAUSS_W * recovered * last / 2
    work = theory.work(top)
    return np.where(top <= theory.yield_overlap, theory.work(alpha), work - back)


def squeeze_path(s: Setting, shares: np.ndarray, steps: int) -> tuple[np.ndarray, ...]:
    """A sphere between two walls that overlap it by alpha_max/2 each, thrown at one of them: velocity Verlet.

    Returns overlap with both walls (2, samples, shares), largest overlaps so far (same), velocity (samples, shares).
    """
    x, law = s.x, s.x.native_law()
    m, d = x.m_star, s.overlap_max / 2
    dt = shares * s.limit / np.sqrt(2.0)
    z, v = np.zeros_like(dt), np.full_like(dt, float(x.speed[0]))
    memory = [np.zeros_like(dt), np.zeros_like(dt)]
    alphas, tops, speeds = [], [], []
    for n in range(steps + 1):
        pair, force = (d + z, d - z), np.zeros_like(dt)
        for k, (alpha, sign) in enumerate(zip(pair, (-1.0, 1.0), strict=True)):
            F, _, memory[k] = law.step(R_star=x.R_star, delta_max=memory[k], delta=alpha)
            force += sign * F
        if n:
            v = v + 0.5 * dt / m * force
        alphas.append(pair)
        tops.append(tuple(memory))
        speeds.append(v)
        v = v + 0.5 * dt / m * force
        z = z + dt * v
    return np.moveaxis(np.array(alphas), 1, 0), np.moveaxis(np.array(tops), 1, 0), np.array(speeds)


def balance(s: Setting, alphas: np.ndarray, tops: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Kinetic, stored and plastic energy over that at the start, shape of `velocity`."""
    total = 0.5 * s.x.m_star * velocity**2 + sum(stored(s.x.theory(), a, t) for a, t in zip(alphas, tops, strict=True))
    return total / total[0]


def squeeze(v: Verdict, s: Setting) -> None:
    """The energy balance of the squeezed sphere holds to second order, through ten periods of the coarsest step."""
    shares = np.array(SQUEEZE)
    drift = []
    for share in shares:
        steps = int(20.0 / share)
        total = balance(s, *squeeze_path(s, np.array([share]), steps))
        drift.append(float(np.abs(total - 1).max()))
        v.created = float((total - 1).max())
        v.steps += steps
    v.e_n_error, v.order = drift[-1], slope(list(shares), drift, 1e-13)
    if not v.created <= CREATED:
        v.fail(f"energy created: {v.created:.2g} at {shares[-1]:g} of the limit")
    if v.order < LEAST_ORDER:
        v.fail(f"order of convergence {v.order:.2f}")
    for share in np.arange(0.2, 1.51, 0.1):
        path = squeeze_path(s, np.array([share]), int(20.0 / share))
        if not (balance(s, *path) - 1).max() <= BROKEN:
            v.breaks_at = round(float(share), 2)
            break


def judge_repeats(extreme: Extreme, law: str, engine: str, *, steps: int, cycles: int) -> Verdict:
    """The verdict on bounces, reloads or a squeeze; these run in the embedded engine."""
    v, begin = Verdict(extreme.name, extreme.group, engine, law), time.perf_counter()
    if engine != "embedded":
        v.status = "embedded only"
        return v
    try:
        s = setting(extreme, law)
        v.e_n_theory, v.strain_ratio = s.e_n, s.strain_ratio
        {"bounces": lambda: bounces(v, s, steps), "reloads": lambda: reloads(v, s, cycles),
         "squeeze": lambda: squeeze(v, s)}[extreme.kind]()  # fmt: skip
    except EpdemError as error:
        v.fail(str(error))
    v.seconds = time.perf_counter() - begin
    return v
