# SPDX-License-Identifier: GPL-2.0-or-later
"""The engines by name. A new engine is a module here and one line below."""

from ..base.paths import DEFAULT_ENGINE
from ..base.rendering import with_reasons
from ..errors import CaseError
from ..impacts.engine import ImpactEngine, Trajectory
from ..impacts.plan import Plan
from ..jobs.engine import KINDS
from ..scenes.plan.plan import SceneEngine, ScenePlan
from .embedded import Embedded
from .lammps.engine import Lammps
from .liggghts.engine import Liggghts
from .yade.engine import Yade

ENGINES: dict[str, type[ImpactEngine]] = {tool.name: tool for tool in (Embedded, Liggghts, Yade, Lammps)}
# Engines of bulk scenes.
SCENES: dict[str, type[SceneEngine]] = {tool.name: tool for tool in (Liggghts, Yade, Lammps)}
KINDS.update({Plan: ENGINES, ScenePlan: SCENES})


def engine(name: str) -> ImpactEngine:
    """The engine of that name. Raises CaseError."""
    if name not in ENGINES:
        raise CaseError(
            f"--engine {name!r} does not exist; there are {', '.join(ENGINES)}, and 'epdem verify crosscheck' runs "
            "models of other codes"
        )
    return ENGINES[name]()


def scene_engine(name: str) -> SceneEngine:
    """The engine of bulk scenes of that name. Raises CaseError."""
    if name not in SCENES:
        raise CaseError(f"--engine {name}: a scene runs on {' or '.join(SCENES)}")
    return SCENES[name]()


def texts_with_reasons(name: str, job: Plan | ScenePlan) -> dict[str, str]:
    """The text files of a deck with the reason of each line as its comment; empty for templates without reasons."""
    if name != DEFAULT_ENGINE:
        return {}
    with with_reasons():
        return Liggghts().files(job)


__all__ = [
    "DEFAULT_ENGINE",
    "ENGINES",
    "SCENES",
    "ImpactEngine",
    "Trajectory",
    "engine",
    "scene_engine",
    "texts_with_reasons",
]
