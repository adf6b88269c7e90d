# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact models of other codes by name, run on the same plans as epdem's engines."""

from typing import Protocol

from ...engines import ENGINES, ImpactEngine
from ...errors import CaseError
from .hosts import (
    BuiltinEdinburgh,
    BuiltinHertz,
    BuiltinLuding,
    LammpsHertz,
    LammpsMdr,
    ThorntonNing,
    YadeLuding,
    YadeMindlin,
)
from .theories import OtherLaw


class OwnLaw(ImpactEngine, Protocol):
    """A model with a law of another code."""

    own: type[OtherLaw]


# Models that have one of epdem's laws: the theory of the case is theirs, too.
SAME_LAW: dict[str, type[ImpactEngine]] = {tool.name: tool for tool in (ThorntonNing, BuiltinHertz)}
ELASTIC: dict[str, type[ImpactEngine]] = {tool.name: tool for tool in (LammpsHertz, YadeMindlin)}  # for `cost`
# Models with a law and a theory of their own: for `crosscheck`.
OWN_LAW: dict[str, type[OwnLaw]] = {
    tool.name: tool for tool in (BuiltinLuding, BuiltinEdinburgh, YadeLuding, LammpsMdr)
}
REFERENCE = BuiltinHertz.name  # run times are given as ratios to the time of this model


def engine(name: str) -> ImpactEngine:
    """The engine or the model of that name. Raises CaseError for a model with a law of its own."""
    known = ENGINES | SAME_LAW | ELASTIC
    if name in OWN_LAW:
        raise CaseError(f"--engine {name!r} has a law of its own, not the case's; see 'epdem verify crosscheck'")
    if name not in known:
        raise CaseError(f"--engine {name!r} does not exist; there are {', '.join(known)}")
    return known[name]()


def only_law(tool: ImpactEngine) -> str | None:
    """The law of epdem for which a model of another code stands; None: the engine has several."""
    return tool.laws[0] if tool.laws and len(tool.laws) == 1 else None
