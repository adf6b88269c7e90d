# SPDX-License-Identifier: GPL-2.0-or-later
"""Sources to cite for a case, its laws and engines."""

from collections.abc import Sequence
from pathlib import Path

from ..base import __version__
from ..case.impact import Case
from ..case.scene import SceneCase
from ..laws.strengths import find_law
from ..theory.sources import CHAPTER, SOURCES, Source, read_sources

PROGRAM = Source("The epdem developers", f"epdem {__version__}", "CITATION.cff", kind="misc")


class Citations(dict[str, str]):
    """Sources as lines of text, by what each is cited for; `bibtex` gives the same sources as entries of BibTeX."""

    def __init__(self, sources: dict[str, Source]):
        super().__init__({what: str(source) for what, source in sources.items()})
        self._sources = sources

    def bibtex(self) -> str:
        """One entry for each source, separated by empty lines."""
        return "\n".join(source.bibtex() for source in dict.fromkeys(self._sources.values()))


def citations(case: Case | SceneCase, laws: Sequence[str], engines: Sequence[str]) -> Citations:
    """Sources to cite for a case that runs with `laws` on `engines`."""
    found = {"epdem": PROGRAM, "equations 8.xx": CHAPTER} | of_laws(laws)
    if case.viscous is not None:
        found["dashpot"] = SOURCES["Tsuji, Tanaka and Ishida 1992"]
    if isinstance(case, Case) and case.impact.oblique:
        found["oblique impacts"] = SOURCES["Maw, Barber and Fawcett 1976"]
    if case.contact is not None and case.contact.tangential != "history":
        names = ("Jaeger 1993", "Popov and Hess 2015")
        found |= {f"partial slip, {name}": SOURCES[name] for name in names}
    programs = read_sources(Path(__file__).with_name("programs.toml"))
    return Citations(found | {name: programs[name] for name in engines if name in programs})


def of_laws(laws: Sequence[str]) -> dict[str, Source]:
    """The sources of laws, by law and short name."""
    return {f"law {law}, {name}": SOURCES[name] for law in laws for name in find_law(law).sources}
