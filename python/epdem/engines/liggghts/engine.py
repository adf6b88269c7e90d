# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS with our plugin: impacts side by side in one deck, whose dump is a trajectory, and bulk scenes."""

import math
import re
from pathlib import Path
from typing import Any

from ...base import paths
from ...base.declarations import declarations
from ...base.processes import most_ranks
from ...errors import CaseError, EngineError
from ...impacts.engine import check_features
from ...impacts.plan import Plan
from ...jobs.engine import Feature
from ...scenes.plan import ScenePlan
from ...theory.sources import Source
from .. import log
from ..host import Host, impact_head
from ..input_script import atom_types, finite
from . import deck, launcher, resume, tables
from .deck import ImpactDeck
from .macros import ContactWords
from .properties import HARD, SOFT, Property, of_law, tangential

NO_BALANCE = "numerics.balance: the borders of ranks in LIGGGHTS do not move, it was left out"


class Liggghts(Host):
    """LIGGGHTS with a model of epdem; `model` and more can be replaced to run LIGGGHTS's own models."""

    name, title = "liggghts", "LIGGGHTS"
    source: Source | None = Source(
        "C. Kloss, C. Goniva, A. Hager, S. Amberger, S. Pirker",
        "Models, algorithms and validation for opensource DEM and CFD-DEM",
        "Prog. Comput. Fluid Dyn.",
        "12",
        "140",
        2012,
    )
    template = "liggghts/impact.in.j2"
    ranks = most_ranks()
    mpirun = launcher.MPIRUN
    features = frozenset(Feature) - {Feature.SPHERE_FRICTION}
    launcher, scene_deck, tables, resumed = launcher, deck, tables, resume

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

    def start(self, script: str, folder: Path, **how: Any) -> float:
        try:
            return super().start(script, folder, **how)
        except EngineError as error:
            lost = re.search(r"Mesh \(id (?:wall_)?(\w+)\): Mesh elements have been lost", str(error))
            if lost is None:
                raise
            out = folder / launcher.OUT
            raise EngineError(
                f"scene.wall.{lost[1]}: the wall has left scene.room after step {log.rows(out)['Step'].iloc[-1]}; "
                f"enlarge the room, or stop the wall before by the duration or the 'until' of its phase ({out})"
            ) from None
