# SPDX-License-Identifier: GPL-2.0-or-later
"""The embedded engine: two-body impacts by velocity Verlet inside the C library."""

import time
from pathlib import Path

from ..base import paths
from ..base.declarations import library_path
from ..case.fields import NODES
from ..impacts import oblique
from ..impacts.engine import Trajectory, check_features
from ..impacts.plan import Plan
from ..jobs.engine import Engine, Feature, Report, silent
from ..laws import library as claw
from ..laws.library import ImpactNumbers


class Embedded(Engine[Plan, Trajectory]):
    """Impacts inside the C library, without any other program."""

    name = "embedded"
    laws: tuple[str, ...] | None = None
    ranks, mpirun = 1, ""
    features = frozenset({Feature.ADHESION, Feature.DASHPOT, Feature.FRICTION, Feature.SPHERE_FRICTION})

    def missing(self) -> str | None:
        if paths.native("libepdem.so") is None:
            return "the C library is not built; run 'make setup' (or 'pip install .')"
        return None

    def version(self) -> str:
        return f"epdem {claw.version()}"

    def parts(self) -> list[Path]:
        return [library_path()]

    def check(self, job: Plan) -> list[str]:
        check_features(self, job.experiment)
        return []

    def files(self, job: Plan) -> dict[str, str]:
        return {}  # nothing to run by hand

    def run(self, job: Plan, folder: Path, *, ranks: int = 1, report: Report = silent) -> Trajectory:
        x = job.experiment
        start = time.perf_counter()
        law = x.native_law()
        _, overlap, force, velocity = law.impact_paths(steps=job.steps, **numbers(job))
        tangential = spin = None
        if x.oblique:
            slip = law.oblique(
                oblique.slip_before(x, phases=job.phases),
                G_star=x.G_star,
                mu=x.oblique.friction,
                nodes=NODES[x.oblique.tangential],
                steps=job.steps,
                **numbers(job),
            )
            tangential, spin = oblique.after_slip(x, slip)
        seconds = {"stepping": time.perf_counter() - start}
        return Trajectory(job.time_step, overlap, force, velocity, seconds, tangential, spin)


def numbers(plan: Plan) -> ImpactNumbers:
    """Common numbers of the impacts of a plan for the C library."""
    x = plan.experiment
    return {
        "R_star": x.R_star,
        "m_star": x.m_star,
        "speed": plan.speed,
        "time_step": plan.time_step,
        "gap": plan.gap,
        "viscous": x.viscous_number,
    }
