# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts of one extreme case in one engine at one time step."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...engines import ImpactEngine
from ...engines.yade.engine import Yade
from ...impacts.engine import Trajectory
from ...impacts.experiment import Experiment
from ...impacts.measurement import measure
from ...impacts.plan import Plan
from ...jobs.engine import Feature


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
