# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS's own contact models on the same plans, to compare with: no plugin is involved in their forces."""

import math

from ..errors import CaseError
from ..plan import Plan
from .liggghts import Liggghts, Property, elastic_rows, numbered


class BuiltinHertz(Liggghts):
    """LIGGGHTS's `hertz` without damping: the elastic limit."""

    name = "liggghts-hertz"
    takes_dashpot = False

    def model(self, plan: Plan) -> str:
        return "hertz"

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        rows = elastic_rows(plan)
        types = len(rows[0][2])
        ones = [types, *[1.0] * types**2]
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

        def pairs(value: float) -> list[float]:
            return [types, *[value] * types**2]

        return numbered(
            [
                *rows,
                ("coefficientRestitution", "peratomtypepair", pairs(1.0), "no viscous damping"),
                ("coefficientYieldRatio", "peratomtype", [ratio] * types, "pi p_y R*/(2 E* R_i)"),
                ("surfaceEnergy", "peratomtypepair", pairs(0.0), "J/m^2"),
            ]
        )
