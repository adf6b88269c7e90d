# SPDX-License-Identifier: GPL-2.0-or-later
"""Parts that several pages have: the case, decks with reasons, versions, citations."""

import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from ...base import __version__
from ...base.files import claim
from ...base.paths import library_hash, product_hash
from ...engines.reasons import citations, reasons
from ...impacts.plan import Plan
from ...impacts.run import Outcome
from ...report.page import NAME, Facts, Lines, Page, Part, write
from ...scenes.plan import ScenePlan
from ...scenes.run import SceneOutcome


def command() -> str:
    """The command line of this process, if it is a command of epdem."""
    name = Path(sys.argv[0]).name
    return shlex.join(["epdem", *sys.argv[1:]]) if name == "epdem" else ""


def case_lines(text: str) -> Lines:
    """The case file."""
    return Lines("Case file", [(line, "") for line in text.splitlines()])


def decks(engine: str, job: Plan | ScenePlan | None, stored: Mapping[str, str], of: str = "") -> list[Lines]:
    """The files of a deck with the reasons of the engine's templates (a comment that is the reason stands once).

    Without these the `stored` texts by name, their comments as reasons. of: end of the titles.
    """
    lines: dict[str, list[tuple[str, str]]] = {}
    for name, line, why in reasons(engine, job) if job else []:
        lines.setdefault(name, []).append((line.removesuffix(why).rstrip(" #") if why else line, why))
    for name, text in {} if lines else stored.items():
        split = [line.partition("  # ") for line in text.splitlines()]
        lines[name] = [(line.rstrip(), reason) for line, _, reason in split]
    return [Lines(f"Deck {name}{of}", found) for name, found in lines.items()]


def origin(about: Mapping[str, object], hashes: Mapping[str, object]) -> Facts:
    """Versions and hashes of what made the numbers: the engines' versions are in the attributes of a results file."""
    versions = {k.removeprefix("version_"): str(v) for k, v in about.items() if k.startswith("version_")}
    ours = {"epdem": f"{__version__}, sources {product_hash()[:16]}, compiled parts {library_hash()[:16]}"}
    return Facts("Versions and hashes", ours | versions | {f"inputs of {k}": str(v) for k, v in hashes.items()})


def page_of(
    outcome: Outcome | SceneOutcome,
    sentences: list[str],
    parts: Sequence[Part],
    *,
    hashes: Mapping[str, object],
    laws: Sequence[str],
    engines: Sequence[str],
    command: str,
) -> Page:
    """The page of a case: these parts, then versions, `hashes` of the inputs by run, and what to cite."""
    return Page(
        outcome.case.case.title,
        sentences,
        [
            *parts,
            origin(outcome.results.attributes, hashes),
            Facts("What to cite", citations(outcome.case, laws, engines)),
        ],
        passed=outcome.passed,
        command=command or f"epdem verify rerun {outcome.folder}/results.h5",
        warnings=outcome.warnings,
    )


def written(page: Page, folder: Path) -> Path:
    """Write a page into the folder of its study; its path."""
    with claim(folder, force=True):
        return write(folder / NAME, lambda: page)
