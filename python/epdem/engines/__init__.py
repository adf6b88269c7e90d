# SPDX-License-Identifier: GPL-2.0-or-later
"""The engines by name. A new engine is a module here and one line below."""

from ..errors import CaseError
from ..impacts.engine import Engine, OwnTheory, Trajectory
from ..lammps.impacts import LammpsMdr
from ..liggghts.builtin import BuiltinEdinburgh, BuiltinHertz, BuiltinLuding, ThorntonNing
from ..liggghts.impacts import Liggghts
from ..yade.builtin import YadeLuding
from ..yade.impacts import Yade
from .embedded import Embedded

ENGINES: dict[str, type[Engine]] = {"embedded": Embedded, "liggghts": Liggghts, "yade": Yade}
# LIGGGHTS's own models, for comparisons; `run` takes them by name as well.
OTHERS: dict[str, type[Engine]] = {tool.name: tool for tool in (BuiltinHertz, ThorntonNing)}
# Laws of other codes that are none of ours, each with a theory of its own: for `crosscheck`.
FOREIGN: dict[str, type[OwnTheory]] = {
    tool.name: tool for tool in (BuiltinLuding, BuiltinEdinburgh, YadeLuding, LammpsMdr)
}


def engine(name: str) -> Engine:
    """The engine of that name. Raises CaseError."""
    known = ENGINES | OTHERS
    if name in FOREIGN:
        raise CaseError(f"--engine {name!r} has a law of its own, not the case's; see 'epdem crosscheck'")
    if name not in known:
        raise CaseError(f"--engine {name!r} does not exist; there are {', '.join(known)}")
    return known[name]()


__all__ = ["ENGINES", "FOREIGN", "OTHERS", "Engine", "OwnTheory", "Trajectory", "engine"]
