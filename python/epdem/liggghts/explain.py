# SPDX-License-Identifier: GPL-2.0-or-later
"""The reason of each line of a deck: the templates state it beside the line, and only this module reads it."""

from pathlib import Path

from ..base import rendering
from ..case import impact, scene
from ..case.toml import named, read_toml
from ..impacts.experiment import experiment
from ..impacts.plan import plan
from ..impacts.prediction import predict
from ..scenes.plan import plan as scene_plan
from . import scene_deck
from .impacts import Liggghts

IMPACT = {"in.impact": "liggghts/impact.in.j2"}
SCENE = {"in.scene": "liggghts/scene.in.j2", "setup.in": "liggghts/scene_setup.in.j2"}


def explain(templates: dict[str, str], deck: object) -> list[tuple[str, str, str]]:
    """(file, line, reason) of every line that does something, of the templates by the names of their files.

    The reason is that in the template, else the comment behind the line in the deck; '' if there
    is none (a defect, which a test looks for).
    """
    explained = []
    for file, template in templates.items():
        for text in rendering.render_with_reasons(template, deck=deck).split("\n"):
            line, _, reason = text.partition(rendering.REASON)
            if line.strip() and not line.startswith("#"):
                explained.append((file, line.rstrip(), reason or line.partition("  # ")[2]))
    return explained


def explain_case(path: Path) -> list[tuple[str, str, str]]:
    """`explain` of the deck of the case or scene in a file. Raises CaseError."""
    data = read_toml(path)
    with named(path):
        if scene.is_scene(data):
            return explain(SCENE, scene_deck.deck(scene_plan(scene.parse(data, path))))
        x = experiment(impact.parse(data, path))
        return explain(IMPACT, Liggghts().deck(plan(x, predict(x))))
