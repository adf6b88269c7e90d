# SPDX-License-Identifier: GPL-2.0-or-later
"""The engines by name. A new engine is a module here and one line below."""

from collections.abc import Callable

from ..base.settings import DEFAULT_ENGINE
from ..errors import CaseError
from ..impacts.engine import Engine, Trajectory
from ..liggghts.impacts import Liggghts
from ..liggghts.scenes import LiggghtsScenes
from ..scenes.engine import SceneEngine
from ..yade.impacts import Yade
from ..yade.scenes import YadeScenes
from .embedded import Embedded

ENGINES: dict[str, type[Engine]] = {tool.name: tool for tool in (Embedded, Liggghts, Yade)}
# Engines of bulk scenes.
SCENES: dict[str, type[SceneEngine]] = {tool.name: tool for tool in (LiggghtsScenes, YadeScenes)}


def engine(name: str, *, stay: bool = False) -> Engine:
    """The engine of that name; with `stay` its process stays for the next plan where it can. Raises CaseError."""
    if name not in ENGINES:
        raise CaseError(
            f"--engine {name!r} does not exist; there are {', '.join(ENGINES)}, and 'epdem verify crosscheck' runs "
            "models of other codes"
        )
    kind: Callable[..., Engine] = ENGINES[name]
    return kind(stay=True) if stay and ENGINES[name].can.stays else kind()


def scene_engine(name: str) -> SceneEngine:
    """The engine of bulk scenes of that name. Raises CaseError."""
    if name not in SCENES:
        raise CaseError(f"--engine {name}: a scene runs on {' or '.join(SCENES)}")
    return SCENES[name]()


__all__ = ["DEFAULT_ENGINE", "ENGINES", "SCENES", "Engine", "Trajectory", "engine", "scene_engine"]
