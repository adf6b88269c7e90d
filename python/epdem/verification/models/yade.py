# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE's own laws of Luding and of Hertz and Mindlin on the same plans, for comparison."""

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...engines.yade.classes import DeckMaterial
from ...engines.yade.deck import Anvil, ImpactDeck
from ...engines.yade.engine import Yade
from ...impacts.plan import Plan
from ...jobs.engine import Feature, Report, silent
from ...scenes.plan.model import Model
from ...scenes.plan.plan import ScenePlan
from .theories import Luding, OtherLaw


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

    def deck(self, plan: Plan, model: Model | None = None) -> ImpactDeck:
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
        anvil = Anvil(x.body.radius, x.target.material, -x.body.radius) if wall else None
        return replace(deck, contact=contact, wall_material=None, anvil=anvil)
