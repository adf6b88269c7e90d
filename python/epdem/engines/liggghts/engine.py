# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS with our plugin: impacts side by side in one deck, whose dump is a trajectory, and bulk scenes."""

import math
import re
from pathlib import Path
from typing import Any, ClassVar

from ...base import paths
from ...base.processes import most_ranks
from ...errors import EngineError
from ...impacts.engine import check_features
from ...impacts.plan import Plan
from ...jobs.engine import Feature
from ...scenes.plan.model import Model
from .. import log
from ..host import Host
from ..input_script import impact_model
from . import deck, launcher, tables
from .deck import ImpactDeck, contact_words


class Liggghts(Host):
    """LIGGGHTS with a model of epdem."""

    name, title = "liggghts", "LIGGGHTS"
    template = "liggghts/impact.in.j2"
    ranks = most_ranks()
    mpirun = launcher.MPIRUN
    mpi_package = "apt-get install openmpi-bin"
    features = frozenset(Feature) - {Feature.SPHERE_FRICTION}
    left_out: ClassVar[dict[str, str]] = {"balance": "the borders of ranks in LIGGGHTS do not move"}
    launcher, scene_deck, tables = launcher, deck, tables

    def parts(self) -> list[Path]:
        found = (paths.native("libepdem_liggghts.so"), paths.launcher())
        return [path for path in found if path]

    def deck(self, plan: Plan, model: Model | None = None) -> ImpactDeck:
        """The deck of a plan. Raises CaseError for what LIGGGHTS cannot do."""
        x, m = plan.experiment, model or impact_model(plan)
        check_features(self, x)
        return ImpactDeck(
            plan=plan,
            contact=contact_words(m),
            skin=0.2 * min(x.body.radius, x.target.radius),
            types=tuple(t.material for t in m.types),
            wall_type=len(m.types) if math.isinf(x.target.radius) else None,
        )

    def start(self, script: str, folder: Path, **how: Any) -> float:
        try:
            return super().start(script, folder, **how)
        except EngineError as error:
            lost = re.search(r"Mesh \(id (?:wall_)?(\w+)\): Mesh elements have been lost", str(error))
            if lost is None:
                raise
            out = folder / launcher.OUT
            raise EngineError(
                f"scene.wall.{lost[1]}: the wall has left scene.room after step {log.rows(out)['Step'].iloc[-1]}; "
                f"enlarge the room, or stop the wall before by the duration or the 'until' of its phase ({out})"
            ) from None
