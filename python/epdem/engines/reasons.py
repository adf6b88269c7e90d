# SPDX-License-Identifier: GPL-2.0-or-later
"""What epdem says about a case: the reason of each line of its deck, and what to cite for its law and engines."""

from collections.abc import Sequence
from pathlib import Path

from ..base import __version__, rendering
from ..base.paths import DEFAULT_ENGINE
from ..case.impact import Case
from ..case.scene import SceneCase
from ..impacts.plan import Plan
from ..laws.strengths import law_named
from ..scenes.plan import ScenePlan
from ..theory.sources import CHAPTER, SOURCES, Source
from . import ENGINES
from .host import job_of
from .liggghts import scene_deck
from .liggghts.engine import Liggghts

Lines = list[tuple[str, str, str]]  # file, line, reason
IMPACT = {"in.impact": "liggghts/impact.in.j2"}
SCENE = {"in.scene": "liggghts/scene.in.j2", "setup.in": "liggghts/scene_setup.in.j2"}


def explain(templates: dict[str, str], deck: object) -> Lines:
    """(file, line, reason) of every line that does something, of the templates by the names of their files.

    The reason is that in the template, else the comment behind the line in the deck; '' if there
    is none (a defect, which a test looks for).
    """
    explained = []
    for file, template in templates.items():
        for text in rendering.render(template, reasons=True, deck=deck).split("\n"):
            line, _, reason = text.partition(rendering.REASON)
            if line.strip() and not line.startswith("#"):
                explained.append((file, line.rstrip(), reason or line.partition("  # ")[2]))
    return explained


def reasons(engine: str, job: Plan | ScenePlan) -> Lines:
    """Every line of the deck of a job that does something; empty if the templates of the engine state no reasons."""
    if engine != Liggghts.name:
        return []
    if isinstance(job, ScenePlan):
        return explain(SCENE, scene_deck.deck(job))
    return explain(IMPACT, Liggghts().deck(job))


def explain_case(path: Path) -> Lines:
    """`reasons` of the case or scene in a file, on the default engine. Raises CaseError."""
    return reasons(DEFAULT_ENGINE, job_of(path))


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
    """What to cite for a case that runs with `laws` on `engines`."""
    found = {"epdem": PROGRAM, "equations 8.xx": CHAPTER} | of_laws(laws)
    if case.viscous is not None:
        found["dashpot"] = SOURCES["Tsuji, Tanaka and Ishida 1992"]
    if isinstance(case, Case) and case.impact.oblique:
        found["oblique impacts"] = SOURCES["Maw, Barber and Fawcett 1976"]
    if case.contact is not None and case.contact.tangential != "history":
        names = ("Jaeger 1993", "Popov and Hess 2015")
        found |= {f"partial slip, {name}": SOURCES[name] for name in names}
    programs = {name: ENGINES[name].source for name in engines if name in ENGINES}
    return Citations(found | {name: source for name, source in programs.items() if source})


def of_laws(laws: Sequence[str]) -> dict[str, Source]:
    """The sources of laws, by law and short name."""
    return {f"law {law}, {name}": SOURCES[name] for law in laws for name in law_named(law).sources}
