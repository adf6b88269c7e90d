# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS's `mdr` and `hertz/material` on the same plans, for comparison."""

import math
from abc import abstractmethod
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...base import rendering as decks
from ...engines.lammps import launcher
from ...engines.lammps.deck import ImpactDeck
from ...engines.lammps.engine import Lammps
from ...errors import CaseError
from ...impacts.engine import check_features
from ...impacts.experiment import Experiment
from ...impacts.plan import Plan
from ...jobs.engine import Feature, Report, silent
from ...scenes.plan.model import Model
from .theories import Mdr, OtherLaw

BULK = 0.5  # share of free surface below which mdr's bulk responds; one contact stays far above


class _Granular(Lammps):
    """Sphere on a flat under a model of LAMMPS's package GRANULAR."""

    template = "verification/lammps/impact.in.j2"
    ranks = 1
    features = frozenset({Feature.DECK, Feature.POSITIONS})

    def missing(self) -> str | None:
        return launcher.missing_program()

    @abstractmethod
    def contact(self, x: Experiment) -> str:
        """Words of the model. Raises CaseError for cases outside it."""

    def deck(self, plan: Plan, model: Model | None = None) -> ImpactDeck:
        """The deck of a plan. Raises CaseError for cases outside the model."""
        x = plan.experiment
        check_features(self, x)
        contact = self.contact(x)
        return ImpactDeck(
            plan=plan,
            skin=0.2 * x.body.radius,
            types=(x.body.material,),
            pairs=(contact,),
            wall=contact,
        )


class LammpsHertz(_Granular):
    """`hertz/material` without damping, with the case's E*: the elastic limit."""

    name = "lammps-hertz"
    laws: tuple[str, ...] | None = ("hertz",)

    def contact(self, x: Experiment) -> str:
        if math.isfinite(x.target.radius):
            raise CaseError("hertz/material is compared on walls")
        nu = x.body.poisson_ratio
        # its walls have the modulus of the spheres: E* = E/(2 (1 - nu^2))
        numbers = " ".join(map(decks.number, (2 * (1 - nu * nu) * x.E_star, 0.0, nu)))
        return f"hertz/material {numbers} tangential linear_nohistory 0.0 0.0 damping velocity"


class LammpsMdr(_Granular):
    """mdr, whose flats are rigid, with the case's E*; its theory is in `theories`."""

    name = "lammps-mdr"
    own: type[OtherLaw] = Mdr

    def contact(self, x: Experiment) -> str:
        law = Mdr.of(x)
        numbers = (law.young_modulus, law.poisson_ratio, law.yield_stress, 0.0, BULK, 0.0)
        return f"mdr {' '.join(map(decks.number, numbers))} tangential linear_history 0.0 0.0 0.0 damping mdr 1"

    def run(self, job: Any, folder: Path, *, ranks: int = 1, report: Report = silent) -> Any:
        return replace(super().run(job, folder, ranks=ranks, report=report), end_power=2 / 3)
