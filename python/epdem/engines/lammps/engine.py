# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS with our plugin: impacts side by side in one deck, whose dump is a trajectory, and bulk scenes."""

import math
from pathlib import Path
from typing import ClassVar

from ...base import paths
from ...base.processes import most_ranks
from ...impacts.engine import check_features
from ...impacts.plan import Plan
from ...jobs.engine import Feature
from ...scenes.plan.model import Model
from ..host import Host
from ..input_script import impact_model
from . import deck, launcher, tables
from .deck import ImpactDeck
from .scene_walls import of_type, options


class Lammps(Host):
    """LAMMPS with pair_style ep and fix wall/ep."""

    name, title = "lammps", "LAMMPS"
    template = "lammps/impact.in.j2"
    ranks = most_ranks()
    left_out: ClassVar[dict[str, str]] = {"sort_interval": "LAMMPS sorts the spheres in memory at intervals of its own"}
    launcher, scene_deck, tables = launcher, deck, tables
    features = frozenset(
        {Feature.ADHESION, Feature.DASHPOT, Feature.FRICTION, Feature.SPHERE_FRICTION, Feature.DECK, Feature.POSITIONS}
        | {Feature.RESTART, Feature.TANGENTIAL_DASHPOT}
    )

    @property
    def mpirun(self) -> str:
        return launcher.mpirun()

    @property
    def mpi_package(self) -> str:
        return launcher.mpi_package()

    def parts(self) -> list[Path]:
        plugin = paths.native("lammps/epdemplugin.so")
        return [plugin] if plugin else []

    def deck(self, plan: Plan, model: Model | None = None) -> ImpactDeck:
        """The deck of a plan. Raises CaseError for what the plugin cannot do."""
        x, m = plan.experiment, model or impact_model(plan)
        check_features(self, x)
        wall = math.isinf(x.target.radius)
        contacts = tuple(f"{of_type(m, i)} {options(m, i, i)}".rstrip() for i in range(1, len(m.types) + 1))
        return ImpactDeck(
            plan=plan,
            skin=0.2 * min(x.body.radius, x.target.radius),
            types=tuple(t.material for t in m.types),
            pairs=contacts,
            wall=contacts[-1] if wall else None,
            columns="z vz fz" if wall or not x.oblique else "x z vx vz fx fz",
        )
