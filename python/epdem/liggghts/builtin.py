# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS's own contact models on the same plans, to compare with: no plugin is involved in their forces."""

import math
from dataclasses import replace

from ..errors import CaseError
from ..impacts import foreign
from ..impacts.experiment import Experiment
from ..impacts.plan import Plan
from ..impacts.prediction import Prediction
from .impacts import Deck, Liggghts, Property, elastic_rows, numbered


def _pairs(types: int, value: float) -> list[float]:
    """One value for every pair of types."""
    return [types, *[value] * types**2]


class BuiltinHertz(Liggghts):
    """LIGGGHTS's `hertz` without damping: the elastic limit."""

    name = "liggghts-hertz"
    takes_dashpot = False

    def model(self, plan: Plan) -> str:
        return "hertz"

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        rows = elastic_rows(plan)
        ones = _pairs(len(rows[0][2]), 1.0)
        return numbered([*rows, ("coefficientRestitution", "peratomtypepair", ones, "no damping")])


class ThorntonNing(Liggghts):
    """LIGGGHTS's `thornton_ning` without adhesion, with the yield pressure of the plan's `thornton` law."""

    name = "liggghts-thornton_ning"
    takes_dashpot = False

    def model(self, plan: Plan) -> str:
        if plan.experiment.law.name != "thornton":
            raise CaseError(f"engine {self.name} knows law thornton only, not {plan.experiment.law.name}")
        return "thornton_ning"

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        x, rows = plan.experiment, elastic_rows(plan)
        types = len(rows[0][2])
        # its yield pressure is 2 E* R_i yield_ratio/(pi R*) (the wall: R_i = R*)
        radius = x.body.radius if math.isfinite(x.target.radius) else x.R_star
        ratio = math.pi * x.law.parameters["yield_pressure"] * x.R_star / (2 * x.E_star * radius)
        return numbered(
            [
                *rows,
                ("coefficientRestitution", "peratomtypepair", _pairs(types, 1.0), "no viscous damping"),
                ("coefficientYieldRatio", "peratomtype", [ratio] * types, "pi p_y R*/(2 E* R_i)"),
                ("surfaceEnergy", "peratomtypepair", _pairs(types, 0.0), "J/m^2"),
            ]
        )


class _OwnTheory(Liggghts):
    """A model whose numbers and theory are in `foreign`."""

    takes_dashpot = False
    end_power = 1.0  # the force falls linearly with the overlap

    def deck(self, plan: Plan) -> Deck:
        return replace(super().deck(plan), remembers=True)


class BuiltinLuding(_OwnTheory):
    """LIGGGHTS's `luding` without adhesion and damping."""

    name = "liggghts-luding"

    def predict(self, x: Experiment) -> Prediction:
        return foreign.predict_luding(x)

    def note(self, x: Experiment) -> str:
        return foreign.luding_note(x)

    def model(self, plan: Plan) -> str:
        return "luding"

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        rows, law = elastic_rows(plan), foreign.luding(plan.experiment)
        types = len(rows[0][2])
        return numbered(
            [
                *rows,
                ("coefficientRestitution", "peratomtypepair", _pairs(types, 1.0), "no viscous damping"),
                ("LoadingStiffness", "peratomtypepair", _pairs(types, law.k_1), "k_1, N/m"),
                ("UnloadingStiffness", "peratomtypepair", _pairs(types, law.k_p / law.k_1), "k_p/k_1"),
                ("coefficientPlasticityDepth", "peratomtypepair", _pairs(types, law.phi_f), "phi_f"),
                ("coefficientAdhesionStiffness", "peratomtypepair", _pairs(types, 0.0), "k_c/k_1"),
                ("pullOffForce", "peratomtypepair", _pairs(types, 0.0), "N"),
            ]
        )


class BuiltinEdinburgh(_OwnTheory):
    """LIGGGHTS's `edinburgh` without adhesion and damping."""

    name = "liggghts-edinburgh"

    def predict(self, x: Experiment) -> Prediction:
        return foreign.predict_edinburgh(x)

    def note(self, x: Experiment) -> str:
        return foreign.edinburgh_note(x)

    def model(self, plan: Plan) -> str:
        return "edinburgh"

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        rows = elastic_rows(plan)
        types = len(rows[0][2])
        return numbered(
            [
                *rows,
                ("coefficientRestitution", "peratomtypepair", _pairs(types, 1.0), "no viscous damping"),
                ("UnloadingStiffness", "peratomtypepair", _pairs(types, foreign.STIFFENING), "k_2/k_1"),
                ("overlapExponent", "scalar", [foreign.EXPONENT], "n"),
                ("coefficientAdhesionStiffness", "peratomtypepair", _pairs(types, 0.0), "k_c/k_1"),
                ("adhesionExponent", "scalar", [1.0], "without adhesion of no effect"),
                ("pullOffForce", "peratomtypepair", _pairs(types, 0.0), "N"),
                ("surfaceEnergy", "peratomtypepair", _pairs(types, 0.0), "J/m^2"),
            ]
        )
