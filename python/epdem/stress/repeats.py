# SPDX-License-Identifier: GPL-2.0-or-later
"""One contact again and again: drift over 1e9 steps and 10^4 reloads; and the verdict on these and a squeeze."""

import time

import numpy as np

from ..engines.base import not_representable
from ..errors import EpdemError
from ..predict import SMALL_DEFORMATION
from .cases import Extreme
from .running import Setting, Verdict, setting
from .sampling import Sampler
from .squeezed import SQUEEZERS, squeeze

BOUNCE_SHARE = 0.01  # of the stability limit: about 200 steps in contact
DRIFT = 1e-3  # of the speed over 1e9 steps; it goes with dt^3 (6e-11 a bounce at 1 % of the limit)


def bounces(v: Verdict, s: Setting, total: int) -> None:
    """Bounce one contact for `total` steps: its plastic work is done once, then it must neither gain nor lose."""
    dt = BOUNCE_SHARE * s.limit
    one = dict(R_star=s.x.R_star, m_star=s.x.m_star, speed=float(s.x.speed[0]), time_step=dt,
               steps=int(1.5 * s.contact_time / dt) + 20)  # fmt: skip
    law = s.x.native_law()
    trial, _ = law.bounces(200, **one)
    count = int(np.ceil(1.01 * 200 * total / trial["steps"]))
    out, speeds = law.bounces(count, **one)
    # the first bounce yields for good; what comes after it should be elastic
    v.steps, v.e_n_error = int(out["steps"]), float(np.abs(speeds / speeds[0] - 1).max())
    v.created = float(speeds.max() ** 2 / speeds[0] ** 2 - 1)
    v.notes.append(f"{count} bounces, speed off by {speeds[-1] / speeds[0] - 1:+.1e} after the last")
    if not v.e_n_error <= DRIFT:
        v.fail(f"speed drifts by {v.e_n_error:.2g}")
    if not v.created <= 2 * DRIFT:  # drift has either sign
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


def judge_repeats(extreme: Extreme, law: str, sampler: Sampler, *, steps: int, cycles: int) -> Verdict:
    """The verdict on bounces, reloads or a squeeze; the first two run in the embedded engine alone."""
    v, begin = Verdict(extreme.name, extreme.group, sampler.name, law), time.perf_counter()
    squeezable = extreme.kind == "squeeze" and sampler.name in SQUEEZERS
    if sampler.name != "embedded" and not squeezable:
        v.status = "embedded only"
        return v
    try:
        s = setting(extreme, law)
        v.e_n_theory, v.strain_ratio = s.e_n, s.strain_ratio
        v.large_deformation = s.strain_ratio > SMALL_DEFORMATION
        why = None if sampler.name == "embedded" else not_representable(s.x, 2 * s.overlap_max)
        if why:
            v.status, v.reason = "not representable", why
        elif extreme.kind == "bounces":
            bounces(v, s, steps)
        elif extreme.kind == "reloads":
            reloads(v, s, cycles)
        else:
            squeeze(v, s, sampler)
    except EpdemError as error:
        v.fail(str(error))
    v.seconds = time.perf_counter() - begin
    return v
