# SPDX-License-Identifier: GPL-2.0-or-later
"""The embedded engine: two-body impacts by velocity Verlet inside the C library."""

import time
from pathlib import Path

from ..base import paths
from ..case.fields import NODES
from ..impacts import oblique
from ..impacts.engine import Abilities, Trajectory, check_abilities
from ..impacts.plan import Plan
from ..laws import library as claw
from ..laws.native import ImpactNumbers
from ..theory.sources import Source


class Embedded:
    """Impacts inside the C library, without any other program."""

    name = "embedded"
    source: Source | None = None
    can = Abilities(dashpot=True, friction=tuple(NODES), oblique_spheres=True, deck=False, positions=False)

    def missing(self) -> str | None:
        if paths.native("libepdem.so") is None:
            return "the C library is not built; run 'make setup' (or 'pip install .')"
        return None

    def version(self) -> str:
        return f"epdem {claw.version()}"

    def check(self, plan: Plan) -> None:
        check_abilities(self, plan.experiment)

    def write(self, plan: Plan, folder: Path) -> list[Path]:
        return []  # nothing to run by hand

    def run(self, plan: Plan, folder: Path, *, ranks: int = 1) -> Trajectory:
        x = plan.experiment
        start = time.perf_counter()
        law = x.native_law()
        _, overlap, force, velocity = law.impact_paths(steps=plan.steps, **numbers(plan))
        tangential = spin = None
        if x.oblique:
            slip = law.oblique(
                oblique.slip_before(x, phases=plan.phases),
                G_star=x.G_star,
                mu=x.oblique.friction,
                nodes=oblique.nodes(x),
                steps=plan.steps,
                **numbers(plan),
            )
            tangential, spin = oblique.after_slip(x, slip)
        seconds = {"stepping": time.perf_counter() - start}
        return Trajectory(plan.time_step, overlap, force, velocity, seconds, tangential, spin)


def numbers(plan: Plan) -> ImpactNumbers:
    """What the impacts of a plan have in common, as the C library takes it."""
    x = plan.experiment
    return {
        "R_star": x.R_star,
        "m_star": x.m_star,
        "speed": plan.speed,
        "time_step": plan.time_step,
        "gap": plan.gap,
        "viscous": x.viscous_number,
    }
