# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS's own contact models on the same plans, for comparison; their forces do not involve the plugin."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...engines.input_script import impact_model
from ...engines.liggghts.deck import ImpactDeck
from ...engines.liggghts.engine import Liggghts
from ...engines.liggghts.properties import Property, elastic, per_pair, per_type, scalar
from ...impacts.plan import Plan
from ...jobs.engine import Feature, Report, silent
from ...scenes.plan.model import Model
from .theories import EXPONENT, STIFFENING, Edinburgh, Luding, OtherLaw


class _Builtin(Liggghts):
    """A model of LIGGGHTS with its own tangential spring, whatever model of ours the case has."""

    features = Liggghts.features - {Feature.DASHPOT, Feature.FRICTION, Feature.RESTART}
    model: str  # LIGGGHTS's name

    def properties(self, plan: Plan, types: int) -> tuple[Property, ...]:
        """Beside those of elastic contacts without a dashpot, for a number of atom types."""
        return ()

    def deck(self, plan: Plan, model: Model | None = None) -> ImpactDeck:
        deck, m = super().deck(plan, model), model or impact_model(plan)
        found = [*elastic(m), per_pair("coefficientRestitution", len(m.types), 1.0, "-", "no viscous damping")]
        if m.sliding:
            found.append(per_pair("coefficientFriction", len(m.types), m.friction, "-"))
        contact = replace(
            deck.contact,
            model=self.model,
            tangential="history" if m.sliding else "off",
            properties=(*found, *self.properties(plan, len(m.types))),
        )
        return replace(deck, contact=contact)


class BuiltinHertz(_Builtin):
    """LIGGGHTS's `hertz` without damping: the elastic limit."""

    name, model = "liggghts-hertz", "hertz"
    laws: tuple[str, ...] | None = ("hertz",)
    features = _Builtin.features | {Feature.FRICTION}


class ThorntonNing(_Builtin):
    """LIGGGHTS's `thornton_ning` without adhesion, with the yield pressure of the plan's `thornton` law."""

    name, model = "liggghts-thornton_ning", "thornton_ning"
    laws: tuple[str, ...] | None = ("thornton",)
    features = _Builtin.features | {Feature.FRICTION}

    def properties(self, plan: Plan, types: int) -> tuple[Property, ...]:
        x = plan.experiment
        # its yield pressure is 2 E* R_i yield_ratio/(pi R*) (the wall: R_i = R*)
        radius = x.body.radius if math.isfinite(x.target.radius) else x.R_star
        ratio = math.pi * x.law.parameters["yield_pressure"] * x.R_star / (2 * x.E_star * radius)
        return (
            per_type("coefficientYieldRatio", [ratio] * types, "-", "pi p_y R*/(2 E* R_i)"),
            per_pair("surfaceEnergy", types, 0.0, "J/m^2"),
        )


class _OwnTheory(_Builtin):
    """A model whose numbers and theory are in `theories`."""

    def run(self, job: Any, folder: Path, *, ranks: int = 1, report: Report = silent) -> Any:
        path = super().run(job, folder, ranks=ranks, report=report)
        return replace(path, end_power=1.0)  # the force falls linearly with the overlap

    def deck(self, plan: Plan, model: Model | None = None) -> ImpactDeck:
        deck = super().deck(plan, model)
        return replace(deck, contact=replace(deck.contact, has_history=True))


class BuiltinLuding(_OwnTheory):
    """LIGGGHTS's `luding` without adhesion and damping."""

    name, model = "liggghts-luding", "luding"
    own: type[OtherLaw] = Luding

    def properties(self, plan: Plan, types: int) -> tuple[Property, ...]:
        law = Luding.of(plan.experiment)
        return (
            per_pair("LoadingStiffness", types, law.k_1, "N/m", "k_1"),
            per_pair("UnloadingStiffness", types, law.k_p / law.k_1, "-", "k_p/k_1"),
            per_pair("coefficientPlasticityDepth", types, law.phi_f, "-", "phi_f"),
            per_pair("coefficientAdhesionStiffness", types, 0.0, "-", "k_c/k_1"),
            per_pair("pullOffForce", types, 0.0, "N"),
        )


class BuiltinEdinburgh(_OwnTheory):
    """LIGGGHTS's `edinburgh` without adhesion and damping."""

    name, model = "liggghts-edinburgh", "edinburgh"
    own: type[OtherLaw] = Edinburgh

    def properties(self, plan: Plan, types: int) -> tuple[Property, ...]:
        return (
            per_pair("UnloadingStiffness", types, STIFFENING, "-", "k_2/k_1"),
            scalar("overlapExponent", EXPONENT, "-", "n"),
            per_pair("coefficientAdhesionStiffness", types, 0.0, "-", "k_c/k_1"),
            scalar("adhesionExponent", 1.0, "-", "without adhesion of no effect"),
            per_pair("pullOffForce", types, 0.0, "N"),
            per_pair("surfaceEnergy", types, 0.0, "J/m^2"),
        )
