# SPDX-License-Identifier: GPL-2.0-or-later
"""`epdem cite`: what to cite for the law of a case and for the engines that ran it."""

import inspect

from .. import __version__
from ..laws.strengths import law_named
from ..theory.sources import CHAPTER, SOURCES
from . import ENGINES, FOREIGN, OTHERS


def citations(laws: list[str], engines: list[str], *, dashpot: bool) -> dict[str, str]:
    """What is to be cited, by what it is for; the sources of a law are those that its theory names."""
    found = {"epdem": f"The epdem developers, epdem {__version__} (CITATION.cff)", "equations 8.xx": CHAPTER}
    for law in laws:
        theory = law_named(law)
        text_of_law = inspect.getsource(inspect.getmodule(theory) or theory)
        found |= {f"law {law}, {name}": text for name, text in SOURCES.items() if name in text_of_law}
    if dashpot:
        found["dashpot"] = SOURCES["Tsuji, Tanaka and Ishida 1992"]
    known = ENGINES | OTHERS | FOREIGN
    return found | {name: known[name].source for name in engines if known[name].source}
