# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE with our laws: impacts side by side in one Python deck, and bulk scenes.

A deck has a copy of the module epdem_yade. Without the module a deck of normal impacts has a copy of the C library.
"""

from math import isinf
from pathlib import Path
from typing import Any, ClassVar

from ...base.declarations import declarations, library_path
from ...impacts.engine import check_features
from ...impacts.experiment import Experiment
from ...impacts.plan import Plan, side_by_side
from ...jobs.engine import Feature, Unsupported
from ...scenes.plan.model import Model
from ...scenes.plan.plan import ScenePlan
from ..host import Host
from ..input_script import impact_model
from . import deck, launcher, tables
from .classes import ContactClasses, DeckMaterial, functors, materials
from .deck import ImpactDeck, axes, body_tables
from .launcher import copy_part, deck_modules
from .scene_parts import edges, table_text


class Yade(Host):
    """YADE with the classes of epdem_yade or the C library in the deck; a run has one core."""

    name, title = "yade", "YADE"
    ranks, mpirun = 1, ""
    features = frozenset({Feature.DECK, Feature.POSITIONS})
    of_classes = frozenset(  # with epdem_yade only
        {Feature.ADHESION, Feature.DASHPOT, Feature.FRICTION, Feature.SPHERE_FRICTION, Feature.TANGENTIAL_DASHPOT}
    )
    own_law = False  # a law of YADE, which needs no module
    template = "yade/impact.py.j2"
    scripts = ("impact.py", deck.SCRIPT)
    left_out: ClassVar[dict[str, str]] = {
        "processors": "a scene in YADE has one rank",
        "balance": "a scene in YADE has one rank",
        "sort_interval": "YADE does not sort the spheres in memory",
    }
    launcher, scene_deck, tables = launcher, deck, tables

    def __init__(self) -> None:
        self.classes = launcher.module() is not None
        self.features = type(self).features | (self.of_classes if self.classes else set())

    def require_module(self, job: Plan | ScenePlan) -> None:
        """Raise Unsupported without epdem_yade for all but normal impacts without adhesion and dashpot."""
        if self.classes or self.own_law:
            return
        if isinstance(job, ScenePlan):
            place = "scene"
        elif job.experiment.law.adheres:
            place = f"law.name = {job.experiment.law.name!r}"
        elif job.experiment.oblique:
            place = "impact.angles"
        elif job.experiment.viscous_restitution is not None:
            place = "viscous"
        else:
            return
        raise Unsupported(f"{place}: YADE has it with the module epdem_yade, which is not built", launcher.BUILD)

    def parts(self) -> list[Path]:
        return [launcher.module() or library_path()]

    def of_pair(self, x: Experiment) -> dict[str, float]:
        """Numbers of the pair for the C library; none with the module or YADE's own law."""
        if self.classes or self.own_law:
            return {}
        given = {p.name: p.default for p in declarations()[x.law.name].parameters} | x.law.parameters
        values = {"E_star": x.E_star, "R_star": x.R_star, **given, "share": x.curvature_share}
        return {name: value for name, value in values.items() if value is not None}

    def deck(self, plan: Plan, model: Model | None = None) -> ImpactDeck:
        """The deck of a plan. Raises CaseError for what YADE cannot do."""
        x, m, wall = plan.experiment, model or impact_model(plan), isinf(plan.experiment.target.radius)
        self.require_module(plan)
        check_features(self, x)
        of_types, with_classes = materials(m), functors(m, ("Wall" if wall else "Sphere",))
        if not self.classes:  # with the C library the mass alone counts
            of_types = tuple(DeckMaterial(t.name, {"density": t.density}) for t in m.types)
        return ImpactDeck(
            plan=plan,
            contact=ContactClasses(
                m.law, with_classes if self.classes else None, of_types, self.of_pair(x), native=self.own_law
            ),
            anvil=None,
            wall_material=x.target.material if wall else None,
            bodies=side_by_side(plan),
            axes=axes(plan),
            skin=0.1 * min(x.body.radius, x.target.radius),
            samples=plan.steps + 2,
        )

    def check(self, job: Plan | ScenePlan) -> list[str]:
        self.require_module(job)
        return super().check(job)

    def notes(self, plan: ScenePlan) -> list[str]:
        return super().notes(plan) + edges(plan)

    def data(self, deck: Any) -> dict[str, str]:
        head = "# x y z v_z v_x omega_y, SI" if deck.plan.experiment.oblique else "# x y z v_z, SI"
        tables = [table_text(head, table.tolist()) for table in body_tables(deck.plan)]
        return dict(zip(("body.data", "target.data"), tables, strict=False))

    def files(self, job: Plan | ScenePlan) -> dict[str, str]:
        texts, scene = super().files(job), isinstance(job, ScenePlan)
        return texts if self.own_law else texts | deck_modules(classes=self.classes, scene=scene)

    def put(self, files: dict[str, str], folder: Path) -> list[Path]:
        written = super().put(files, folder)
        return written if self.own_law else [*written, copy_part(folder, classes=self.classes)]
