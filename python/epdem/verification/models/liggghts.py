# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS's own contact models on the same plans, for comparison; their forces do not involve the plugin."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...engines.liggghts.deck import ImpactDeck
from ...engines.liggghts.engine import Liggghts
from ...engines.liggghts.properties import Property, of_friction, of_impacts, per_pair, per_type, scalar
from ...impacts.plan import Plan
from ...jobs.engine import Feature, Report, silent
from .theories import EXPONENT, STIFFENING, Edinburgh, Luding, OtherLaw


def _elastic(plan: Plan) -> tuple[int, list[Property]]:
    """Number of atom types; their elastic properties and the restitution of a model without a dashpot."""
    elastic = of_impacts(plan)
    types = len(elastic[0].values)
    return types, [*elastic, per_pair("coefficientRestitution", types, 1.0, "-", "no viscous damping")]


WITHOUT_OURS = Liggghts.features - {Feature.DASHPOT, Feature.FRICTION, Feature.RESTART}


class _Rubbing(Liggghts):
    """A model with LIGGGHTS's own tangential spring, whatever tangential model the case has."""

    features = WITHOUT_OURS | {Feature.FRICTION}

    def tangential(self, plan: Plan) -> str | None:
        return "history" if plan.experiment.oblique else None


class BuiltinHertz(_Rubbing):
    """LIGGGHTS's `hertz` without damping: the elastic limit."""

    name = "liggghts-hertz"
    laws: tuple[str, ...] | None = ("hertz",)

    def model(self, plan: Plan) -> str:
        return "hertz"

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        types, elastic = _elastic(plan)
        return (*elastic, *of_friction(plan, types))


class ThorntonNing(_Rubbing):
    """LIGGGHTS's `thornton_ning` without adhesion, with the yield pressure of the plan's `thornton` law."""

    name = "liggghts-thornton_ning"
    laws: tuple[str, ...] | None = ("thornton",)

    def model(self, plan: Plan) -> str:
        return "thornton_ning"

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        x, (types, elastic) = plan.experiment, _elastic(plan)
        # its yield pressure is 2 E* R_i yield_ratio/(pi R*) (the wall: R_i = R*)
        radius = x.body.radius if math.isfinite(x.target.radius) else x.R_star
        ratio = math.pi * x.law.parameters["yield_pressure"] * x.R_star / (2 * x.E_star * radius)
        return (
            *elastic,
            *of_friction(plan, types),
            per_type("coefficientYieldRatio", [ratio] * types, "-", "pi p_y R*/(2 E* R_i)"),
            per_pair("surfaceEnergy", types, 0.0, "J/m^2"),
        )


class _OwnTheory(Liggghts):
    """A model whose numbers and theory are in `theories`."""

    features = WITHOUT_OURS

    def run(self, job: Any, folder: Path, *, ranks: int = 1, report: Report = silent) -> Any:
        path = super().run(job, folder, ranks=ranks, report=report)
        return replace(path, end_power=1.0)  # the force falls linearly with the overlap

    def deck(self, plan: Plan) -> ImpactDeck:
        deck = super().deck(plan)
        return replace(deck, contact=replace(deck.contact, has_history=True))


class BuiltinLuding(_OwnTheory):
    """LIGGGHTS's `luding` without adhesion and damping."""

    name = "liggghts-luding"
    own: type[OtherLaw] = Luding

    def model(self, plan: Plan) -> str:
        return "luding"

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        (types, elastic), law = _elastic(plan), Luding.of(plan.experiment)
        return (
            *elastic,
            per_pair("LoadingStiffness", types, law.k_1, "N/m", "k_1"),
            per_pair("UnloadingStiffness", types, law.k_p / law.k_1, "-", "k_p/k_1"),
            per_pair("coefficientPlasticityDepth", types, law.phi_f, "-", "phi_f"),
            per_pair("coefficientAdhesionStiffness", types, 0.0, "-", "k_c/k_1"),
            per_pair("pullOffForce", types, 0.0, "N"),
        )


class BuiltinEdinburgh(_OwnTheory):
    """LIGGGHTS's `edinburgh` without adhesion and damping."""

    name = "liggghts-edinburgh"
    own: type[OtherLaw] = Edinburgh

    def model(self, plan: Plan) -> str:
        return "edinburgh"

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        types, elastic = _elastic(plan)
        return (
            *elastic,
            per_pair("UnloadingStiffness", types, STIFFENING, "-", "k_2/k_1"),
            scalar("overlapExponent", EXPONENT, "-", "n"),
            per_pair("coefficientAdhesionStiffness", types, 0.0, "-", "k_c/k_1"),
            scalar("adhesionExponent", 1.0, "-", "without adhesion of no effect"),
            per_pair("pullOffForce", types, 0.0, "N"),
            per_pair("surfaceEnergy", types, 0.0, "J/m^2"),
        )
