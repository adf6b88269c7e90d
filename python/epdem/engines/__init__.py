# SPDX-License-Identifier: GPL-2.0-or-later
"""The engines by name. A new engine is a module here and one line below."""

from collections.abc import Callable

from ..base.settings import DEFAULT_ENGINE
from ..errors import CaseError
from ..impacts.engine import Engine, OwnTheory, Trajectory, require
from ..impacts.motion import MotionEngine
from ..lammps.impacts import LammpsMdr
from ..liggghts.assemblies import LiggghtsAssemblies
from ..liggghts.builtin import BuiltinEdinburgh, BuiltinHertz, BuiltinLuding, ThorntonNing
from ..liggghts.impacts import Liggghts
from ..liggghts.motions import LiggghtsMotions
from ..liggghts.scenes import LiggghtsScenes
from ..scenes.assembly import AssemblyEngine
from ..scenes.engine import SceneEngine
from ..yade.builtin import YadeLuding
from ..yade.impacts import Yade
from ..yade.motions import YadeMotions
from ..yade.scenes import YadeScenes
from .embedded import Embedded
from .embedded_motion import EmbeddedMotions

ENGINES: dict[str, type[Engine]] = {tool.name: tool for tool in (Embedded, Liggghts, Yade)}
# LIGGGHTS's own models, for comparisons; `run` takes them by name as well.
OTHERS: dict[str, type[Engine]] = {tool.name: tool for tool in (BuiltinHertz, ThorntonNing)}
# Laws of other codes that are none of ours, each with a theory of its own: for `crosscheck`.
FOREIGN: dict[str, type[OwnTheory]] = {
    tool.name: tool for tool in (BuiltinLuding, BuiltinEdinburgh, YadeLuding, LammpsMdr)
}
# Engines of bulk scenes.
SCENES: dict[str, type[SceneEngine]] = {tool.name: tool for tool in (LiggghtsScenes, YadeScenes)}
# Engines of prescribed motions.
MOTIONS: dict[str, type[MotionEngine]] = {tool.name: tool for tool in (EmbeddedMotions, LiggghtsMotions, YadeMotions)}
# Engines of assemblies.
ASSEMBLIES: dict[str, type[AssemblyEngine]] = {LiggghtsAssemblies.name: LiggghtsAssemblies}
REFERENCE = BuiltinHertz.name  # over whose time those of all others are given


def engine(name: str, *, stay: bool = False) -> Engine:
    """The engine of that name; with `stay` its process stays for the next plan where it can. Raises CaseError."""
    known = ENGINES | OTHERS
    if name in FOREIGN:
        raise CaseError(f"--engine {name!r} has a law of its own, not the case's; see 'epdem crosscheck'")
    if name not in known:
        raise CaseError(f"--engine {name!r} does not exist; there are {', '.join(known)}")
    kind: Callable[..., Engine] = known[name]
    return kind(stay=True) if stay and known[name].can.stays else kind()


def scene_engine(name: str) -> SceneEngine:
    """The engine of bulk scenes of that name. Raises CaseError."""
    if name not in SCENES:
        raise CaseError(f"--engine {name}: a scene runs on {' or '.join(SCENES)}")
    return SCENES[name]()


def assembly_engine() -> AssemblyEngine:
    """The first engine of assemblies. Raises EngineError if it cannot run here."""
    tool = next(iter(ASSEMBLIES.values()))()
    require(tool)
    return tool


__all__ = [
    "ASSEMBLIES",
    "DEFAULT_ENGINE",
    "ENGINES",
    "FOREIGN",
    "MOTIONS",
    "OTHERS",
    "REFERENCE",
    "SCENES",
    "Engine",
    "OwnTheory",
    "Trajectory",
    "assembly_engine",
    "engine",
    "scene_engine",
]
