# SPDX-License-Identifier: GPL-2.0-or-later
"""The embedded engine: two-body impacts by velocity Verlet inside the C library."""

import time
from pathlib import Path

from .. import paths
from ..impacts.engine import Trajectory
from ..impacts.plan import Plan
from ..laws import library as claw


class Embedded:
    name = "embedded"

    def missing(self) -> str | None:
        if paths.native("libepdem.so") is None:
            return "the C library is not built; run 'make setup' (or 'pip install .')"
        return None

    def version(self) -> str:
        return f"epdem {claw.version()}"

    def write(self, plan: Plan, folder: Path) -> list[Path]:
        return []  # nothing to run by hand

    def run(self, plan: Plan, folder: Path, *, ranks: int = 1) -> Trajectory:
        x = plan.experiment
        start = time.perf_counter()
        _, overlap, force, velocity = x.native_law().impact_paths(
            R_star=x.R_star,
            m_star=x.m_star,
            speed=plan.speed,
            time_step=plan.time_step,
            gap=plan.gap,
            steps=plan.steps,
            viscous=x.viscous_number,
        )
        return Trajectory(plan.time_step, overlap, force, velocity, {"stepping": time.perf_counter() - start})
