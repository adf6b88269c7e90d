# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact models of the hosts themselves on the same plans, for comparison; no force is epdem's."""

import math
import re
from abc import abstractmethod
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...base import rendering as decks
from ...engines.input_script import impact_model
from ...engines.lammps import deck as lammps_deck
from ...engines.lammps import launcher
from ...engines.lammps.engine import Lammps
from ...engines.liggghts import deck as liggghts_deck
from ...engines.liggghts.engine import Liggghts
from ...engines.liggghts.properties import Property, elastic, per_pair, per_type, scalar
from ...engines.yade import deck as yade_deck
from ...engines.yade.classes import DeckMaterial
from ...engines.yade.engine import Yade
from ...errors import CaseError
from ...impacts.engine import check_features
from ...impacts.experiment import Experiment
from ...impacts.plan import Plan
from ...jobs.engine import Feature, Report, silent
from ...scenes.plan.model import Model
from ...scenes.plan.plan import ScenePlan
from .theories import EXPONENT, STIFFENING, Edinburgh, Luding, Mdr, OtherLaw


class _Builtin(Liggghts):
    """A model of LIGGGHTS with its own tangential spring, whatever model of ours the case has."""

    features = Liggghts.features - {Feature.DASHPOT, Feature.FRICTION, Feature.RESTART}
    model: str  # LIGGGHTS's name

    def properties(self, plan: Plan, types: int) -> tuple[Property, ...]:
        """Beside those of elastic contacts without a dashpot, for a number of atom types."""
        return ()

    def deck(self, plan: Plan, model: Model | None = None) -> liggghts_deck.ImpactDeck:
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

    def deck(self, plan: Plan, model: Model | None = None) -> liggghts_deck.ImpactDeck:
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

    def deck(self, plan: Plan, model: Model | None = None) -> lammps_deck.ImpactDeck:
        """The deck of a plan. Raises CaseError for cases outside the model."""
        x = plan.experiment
        check_features(self, x)
        contact = self.contact(x)
        return lammps_deck.ImpactDeck(
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


class YadeMindlin(Yade):
    """YADE's `Law2_ScGeom_MindlinPhys_Mindlin` without damping in the deck of `hertz`: the elastic limit."""

    name = "yade-mindlin"
    laws: tuple[str, ...] | None = ("hertz",)
    features = frozenset({Feature.DECK, Feature.POSITIONS})
    of_classes = frozenset()

    def files(self, job: Plan | ScenePlan) -> dict[str, str]:
        names = {r"from epdem_yade import .*": "from yade.wrapper import FrictMat, Ip2_FrictMat_FrictMat_MindlinPhys\n"}
        names[r"Law2_ScGeom_EpPhys_Hertz\(.*?\)"] = "Law2_ScGeom_MindlinPhys_Mindlin()"
        names |= {r"Ip2_EpMat_EpMat_EpPhys\(.*?\)\]": "Ip2_FrictMat_FrictMat_MindlinPhys()]", r"\bEpMat\(": "FrictMat("}
        names[r"    InteractionLoop,"] = "    InteractionLoop,\n    Law2_ScGeom_MindlinPhys_Mindlin,"
        names[r"Ig2_Wall_Sphere_ScGeom\(\)"] = "Ig2_Wall_Sphere_ScGeom(hertzian=True)"  # R* = R
        texts = super().files(job)
        for pattern, text in names.items():
            texts["impact.py"] = re.sub(pattern, text, texts["impact.py"])
        return texts


class YadeLuding(Yade):
    """YADE's `Law2_ScGeom_LudingPhys_Basic` without adhesion and damping; its numbers and theory are in `theories`.

    At walls YADE 2023.02a takes its plasticity depth as 0 and rebounds elastically. There a fixed sphere of the same
    radius stands for the wall, with the depth of the contact with the wall.
    """

    name = "yade-luding"
    laws: tuple[str, ...] | None = None
    of_classes = frozenset()
    own_law = True
    own: type[OtherLaw] = Luding

    def run(self, job: Any, folder: Path, *, ranks: int = 1, report: Report = silent) -> Any:
        path = super().run(job, folder, ranks=ranks, report=report)
        return replace(path, end_power=1.0)  # the force falls linearly with the overlap

    def deck(self, plan: Plan, model: Model | None = None) -> yade_deck.ImpactDeck:
        x, deck, wall = plan.experiment, super().deck(plan, model), math.isinf(plan.experiment.target.radius)
        law = Luding.of(x)
        values = {
            "k1": law.k_1,
            "kp": law.k_p,
            "kc": 0.0,
            "ks": 0.0,
            "PhiF": 2 * law.phi_f if wall else law.phi_f,  # YADE multiplies it by 2 R*, here half that of the wall
            "G0": 0.0,
            "frictionAngle": 0.0,
        }
        materials = tuple(
            DeckMaterial(m.name, {"density": x.body.density if wall else m.values["density"]} | values)
            for m in deck.contact.materials
        )
        contact = replace(deck.contact, law="Luding", functors=None, materials=materials)
        anvil = yade_deck.Anvil(x.body.radius, x.target.material, -x.body.radius) if wall else None
        return replace(deck, contact=contact, wall_material=None, anvil=anvil)
