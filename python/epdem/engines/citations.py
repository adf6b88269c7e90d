# SPDX-License-Identifier: GPL-2.0-or-later
"""Sources to cite for a case, its laws and engines."""

from collections.abc import Sequence

from ..base import __version__
from ..case.impact import Case
from ..case.scene import SceneCase
from ..laws.strengths import find_law
from ..theory.sources import CHAPTER, SOURCES
from . import ENGINES

PROGRAM = f"The epdem developers, epdem {__version__} (CITATION.cff)"


def citations(case: Case | SceneCase, laws: Sequence[str], engines: Sequence[str]) -> dict[str, str]:
    """Sources to cite for a case that runs with `laws` on `engines`, by what each is cited for."""
    found = {"epdem": PROGRAM, "equations 8.xx": CHAPTER} | of_laws(laws)
    if case.viscous is not None:
        found["dashpot"] = SOURCES["Tsuji, Tanaka and Ishida 1992"]
    if isinstance(case, Case) and case.impact.oblique:
        found["oblique impacts"] = SOURCES["Maw, Barber and Fawcett 1976"]
    if case.contact is not None and case.contact.tangential != "history":
        names = ("Jaeger 1993", "Popov and Hess 2015")
        found |= {f"partial slip, {name}": SOURCES[name] for name in names}
    programs = {name: ENGINES[name].source for name in engines if name in ENGINES}
    return found | {name: source for name, source in programs.items() if source}


def of_laws(laws: Sequence[str]) -> dict[str, str]:
    """The sources of laws, by law and short name."""
    return {f"law {law}, {name}": SOURCES[name] for law in laws for name in find_law(law).sources}
