# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS's `mdr` on the same plans, for comparison."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from ...base import rendering as decks
from ...engines.lammps import launcher
from ...engines.lammps.deck import ImpactDeck
from ...engines.lammps.engine import Lammps
from ...impacts.engine import check_features
from ...impacts.plan import Plan
from ...jobs.engine import Feature, Report, silent
from ...scenes.plan.model import Model
from .theories import Mdr, OtherLaw

BULK = 0.5  # share of free surface below which mdr's bulk responds; one contact stays far above


class LammpsMdr(Lammps):
    """Sphere on a rigid flat under mdr, which has no other wall, with the case's E*; its theory is in `theories`."""

    name = "lammps-mdr"
    template = "verification/lammps/impact.in.j2"
    ranks = 1
    features = frozenset({Feature.DECK, Feature.POSITIONS})
    own: type[OtherLaw] = Mdr

    def missing(self) -> str | None:
        return launcher.missing_program()

    def deck(self, plan: Plan, model: Model | None = None) -> ImpactDeck:
        """The deck of a plan. Raises CaseError for cases outside mdr."""
        x = plan.experiment
        check_features(self, x)
        law = Mdr.of(x)
        numbers = (law.young_modulus, law.poisson_ratio, law.yield_stress, 0.0, BULK, 0.0)
        contact = f"mdr {' '.join(map(decks.number, numbers))} tangential linear_history 0.0 0.0 0.0 damping mdr 1"
        return ImpactDeck(
            plan=plan,
            skin=0.2 * x.body.radius,
            types=(x.body.material,),
            pairs=(contact,),
            wall=contact,
        )

    def run(self, job: Any, folder: Path, *, ranks: int = 1, report: Report = silent) -> Any:
        return replace(super().run(job, folder, ranks=ranks, report=report), end_power=2 / 3)
