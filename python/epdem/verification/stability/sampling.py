# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts of one extreme case in one engine at one time step; those that it cannot represent are only reported."""

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from ...engines import ImpactEngine
from ...engines.embedded import Embedded
from ...engines.yade.engine import Yade
from ...impacts.experiment import Experiment
from ...impacts.plan import Plan


@dataclass(frozen=True)
class Sample:
    """n impacts: rebound over approach speed, NaN where a contact never ended; largest overlap [m].

    `finite`: no force, overlap or velocity was anything but a number.
    """

    e_n: np.ndarray
    overlap_max: np.ndarray
    steps: int
    finite: bool


class Sampler(Protocol):
    """Runs impacts of an experiment with one speed from the gaps [m] (negative: overlap at the start)."""

    name: str
    positions: bool  # its overlap is a difference of positions
    most_steps: int  # of one impact: keeps every run within the time limit of a case
    phases: int
    slow: bool  # seconds for a plan: long studies give it fewer

    def __call__(self, x: Experiment, time_step: float, gap: np.ndarray, steps: int) -> Sample: ...


class EmbeddedSampler:
    """Impacts in the C library, where overlaps are no differences of positions."""

    name, positions, most_steps, phases, slow = Embedded.name, False, 20_000_000, 16, False

    def __call__(self, x: Experiment, time_step: float, gap: np.ndarray, steps: int) -> Sample:
        out = x.native_law().impacts(
            R_star=x.R_star, m_star=x.m_star, speed=x.speed[0], time_step=time_step, gap=gap, steps=steps
        )
        ended = (out["steps"] < steps) & (out["last"] >= 0)
        e_n = np.where(ended, out["rebound_speed"] / x.speed[0], np.nan)
        finite = all(np.isfinite(out[n]).all() for n in ("rebound_speed", "force_max", "overlap_max"))
        return Sample(e_n, out["overlap_max"], int(out["steps"].sum()), finite)


class PositionSampler:
    """An engine whose overlap is a difference of positions."""

    positions, most_steps, phases = True, 20_000, 8

    def __init__(self, engine: ImpactEngine, folder: Path):
        self.engine, self.folder, self.name, self.slow = engine, folder, engine.name, isinstance(engine, Yade)

    def __call__(self, x: Experiment, time_step: float, gap: np.ndarray, steps: int) -> Sample:
        speed = np.full(gap.size, x.speed[0])
        if isinstance(self.engine, Yade):
            # its velocity belongs to half a step before the position: a force at t = 0 has acted in that half step too
            force, _, _ = x.native_law().step(R_star=x.R_star, delta_max=0.0, delta=-gap)
            speed = speed + 0.5 * time_step * force / x.m_star
        plan = Plan(x, time_step, steps, gap.size, speed, gap)
        self.engine.write(plan, self.folder)
        path = self.engine.run(plan, self.folder)
        force, velocity = path.force, path.velocity
        loaded = np.where(np.isfinite(force), force, 0.0) != 0  # what adheres pulls
        end = path.force.shape[1] - 1 - np.argmax(np.isfinite(force)[:, ::-1], axis=1)
        row = np.arange(gap.size)
        ended = loaded.any(axis=1) & ~loaded[row, end]
        e_n = np.where(ended, -velocity[row, end] / x.speed[0], np.nan)
        peak = np.nanmax(np.where(loaded, path.overlap, 0.0), axis=1)
        # an engine with positions samples every step to the end: a NaN is a fault, not the end of an impact
        finite = all(np.isfinite(a).all() for a in (force, velocity, path.overlap))
        return Sample(e_n, peak, int(steps * gap.size), finite)
