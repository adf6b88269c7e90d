# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS with our plugin: impacts side by side in one deck, whose dump is a trajectory, and bulk scenes."""

import math
from pathlib import Path

from ...base import paths
from ...base.declarations import declarations
from ...base.processes import most_ranks
from ...errors import CaseError
from ...impacts.engine import Trajectory, check_features
from ...impacts.plan import Plan
from ...jobs.engine import Feature, Report
from ...scenes.plan import ScenePlan
from .. import log
from ..host import Host, impact_head
from ..input_script import atom_types, finite, impact_files
from . import deck, launcher, resume, tables
from .deck import ImpactDeck
from .macros import ContactWords
from .properties import HARD, SOFT, Property, of_law, tangential

NO_BALANCE = "numerics.balance: the borders of ranks in LIGGGHTS do not move, it was left out"


class Liggghts(Host):
    """LIGGGHTS with a model of epdem; `model` and more can be replaced to run LIGGGHTS's own models."""

    name, title = "liggghts", "LIGGGHTS"
    source: str | None = "C. Kloss, C. Goniva, A. Hager, S. Amberger, S. Pirker, Prog. Comput. Fluid Dyn. 12 (2012) 140"
    template = "liggghts/impact.in.j2"
    ranks = most_ranks()
    mpirun = launcher.MPIRUN
    features = frozenset(Feature) - {Feature.SPHERE_FRICTION}
    out = launcher.OUT
    scene_deck, scene_tables = deck, tables
    leftovers: tuple[str, ...] = (
        "particles.*.bin",
        "contacts.*.txt",
        "wall_contacts.*.txt",
        "restart.*.bin",
        "stress_*.vtk",
        "in.resume",
    )

    def missing(self) -> str | None:
        return launcher.missing()

    def version(self) -> str:
        path = paths.launcher()
        return (launcher.version(path) if path else "") or "LIGGGHTS (version unknown)"

    def parts(self) -> list[Path]:
        found = (paths.native("libepdem_liggghts.so"), paths.launcher())
        return [path for path in found if path]

    def model(self, plan: Plan) -> str:
        return f"ep/{plan.experiment.law.name}"

    def tangential(self, plan: Plan) -> str | None:
        """The tangential model of a case; None: no friction."""
        return plan.experiment.oblique.tangential if plan.experiment.oblique else None

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        """The material properties of the deck, for this model."""
        return of_law(plan)

    def check_scene(self, plan: ScenePlan) -> list[str]:
        super().check_scene(plan)
        return [NO_BALANCE] if plan.case.numerics.balance else []

    def impact_files(self, plan: Plan) -> dict[str, str]:
        return impact_files(self.template, self.deck(plan), plan)

    def deck(self, plan: Plan) -> ImpactDeck:
        """The deck of a plan. Raises CaseError for what LIGGGHTS cannot do."""
        x, types = plan.experiment, atom_types(plan)
        check_features(self, x)
        for b, _ in types:
            if b.poisson_ratio < 0:
                raise CaseError(
                    f"materials.{b.material}.poisson_ratio = {b.poisson_ratio}, LIGGGHTS takes [0, 0.5] "
                    "only; use --engine embedded"
                )
        moduli = [finite(b.young_modulus) for b, _ in types]
        return ImpactDeck(
            plan=plan,
            head=impact_head(plan),
            contact=ContactWords(
                hard=max(moduli) > HARD,
                soft=min(moduli) < SOFT,
                has_history=declarations()[x.law.name].memory > 0 or x.oblique is not None,
                properties=self.properties(plan),
                model=self.model(plan),
                tangential=tangential(self.tangential(plan)),
                settings=("viscous on",) if x.viscous_restitution is not None else (),
            ),
            data="impact.data",
            skin=0.2 * min(x.body.radius, x.target.radius),
            types=tuple(b.material for b, _ in types),
            oblique=x.oblique is not None,
            wall_type=len(types) if math.isinf(x.target.radius) else None,
            path=deck.PATH,
        )

    def run_impacts(self, plan: Plan, folder: Path, ranks: int) -> Trajectory:
        path = folder / deck.PATH
        path.unlink(missing_ok=True)
        (folder / tables.END).unlink(missing_ok=True)
        allowed = 120 + 2e-6 * plan.n * plan.steps
        wall = launcher.run("in.impact", folder, ranks=ranks, log=launcher.LOG, seconds=allowed)
        result = tables.trajectory(plan, path, {"total": wall, "stepping": log.loop_seconds(folder / launcher.LOG)})
        path.unlink()  # large
        return result

    def run_scene(self, plan: ScenePlan, folder: Path, ranks: int, report: Report) -> None:
        resume.run(plan, folder, ranks=ranks, report=report)

    def continue_scene(self, plan: ScenePlan, folder: Path, step: int, ranks: int, report: Report) -> None:
        resume.run_on(plan, folder, step, ranks=ranks, report=report)
