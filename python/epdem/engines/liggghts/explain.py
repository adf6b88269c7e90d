# SPDX-License-Identifier: GPL-2.0-or-later
"""The reason of each line of a deck: the templates state it beside the line, and only this module reads it."""

from ...base import rendering
from ...impacts.plan import Plan
from ...scenes.plan import ScenePlan
from . import scene_deck
from .engine import Liggghts

IMPACT = {"in.impact": "liggghts/impact.in.j2"}
SCENE = {"in.scene": "liggghts/scene.in.j2", "setup.in": "liggghts/scene_setup.in.j2"}


def explain(templates: dict[str, str], deck: object) -> list[tuple[str, str, str]]:
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


def reasons(job: Plan | ScenePlan) -> list[tuple[str, str, str]]:
    """`explain` of the deck of a job. Raises CaseError."""
    if isinstance(job, ScenePlan):
        return explain(SCENE, scene_deck.deck(job))
    return explain(IMPACT, Liggghts().deck(job))
