# SPDX-License-Identifier: GPL-2.0-or-later
"""The reason of each line of a deck, for the engines whose templates state them."""

from pathlib import Path

from ..base.settings import DEFAULT_ENGINE
from ..case import impact, scene
from ..case.toml import named, read_toml
from ..impacts.experiment import experiment
from ..impacts.plan import Plan, plan
from ..impacts.prediction import predict
from ..scenes.plan import ScenePlan
from ..scenes.plan import plan as scene_plan
from .liggghts.engine import Liggghts
from .liggghts.explain import reasons as liggghts_reasons

Lines = list[tuple[str, str, str]]  # file, line, reason


def reasons(engine: str, job: Plan | ScenePlan) -> Lines:
    """Every line of the deck of a job that does something; empty if the templates of the engine state no reasons."""
    return liggghts_reasons(job) if engine == Liggghts.name else []


def explain_case(path: Path) -> Lines:
    """`reasons` of the case or scene in a file, on the default engine. Raises CaseError."""
    data = read_toml(path)
    with named(path):
        if scene.is_scene(data):
            return reasons(DEFAULT_ENGINE, scene_plan(scene.parse(data, path)))
        x = experiment(impact.parse(data, path))
        return reasons(DEFAULT_ENGINE, plan(x, predict(x)))
