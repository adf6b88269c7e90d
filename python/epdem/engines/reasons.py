# SPDX-License-Identifier: GPL-2.0-or-later
"""The reason of each line of a deck, for the engines whose templates state them."""

from pathlib import Path

from ..base import rendering
from ..base.paths import DEFAULT_ENGINE
from ..impacts.plan import Plan
from ..scenes.plan import ScenePlan
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
