# SPDX-License-Identifier: GPL-2.0-or-later
"""Case files, decks and runs for the tests of scenes."""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from epdem.base.files import write_texts
from epdem.case.scene import SceneCase
from epdem.engines import scene_engine
from epdem.engines.restarts import restart_files
from epdem.scenes import run as scene_run
from epdem.scenes.plan.plan import ScenePlan, plan


def value(x: object) -> str:
    """A TOML value."""
    if isinstance(x, dict):
        return "{ " + ", ".join(f"{k} = {value(v)}" for k, v in x.items()) + " }"
    if isinstance(x, list):
        return "[" + ", ".join(map(value, x)) + "]"
    return json.dumps(x)


def write_case(data: dict, folder: Path, name: str = "case.toml") -> Path:
    """The case file of `data`, in `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = [f"[{table}]\n" + "".join(f"{k} = {value(v)}\n" for k, v in keys.items()) for table, keys in data.items()]
    (folder / name).write_text("\n".join(lines))
    return folder / name


def write_deck(case: SceneCase, folder: Path) -> ScenePlan:
    """The plan of a case whose LIGGGHTS deck is written into `folder`."""
    p = plan(case)
    write_texts(folder, scene_engine("liggghts").files(p))
    return p


def run(path: Path, engine: str = "liggghts", **options) -> scene_run.SceneOutcome:
    """Run a case file on an engine."""
    return scene_run.run(path, scene_engine(engine), **options)


def in_hosts(data: dict, folder: Path, *hosts: str) -> list[Any]:
    """The results of a case on each host."""
    path = write_case(data, folder)
    return [run(path, engine=host, out=folder / host).results for host in hosts]


def assert_alike(ours: Any, theirs: Any, names: Iterable[str], limit: float) -> None:
    """The columns of two tables differ by at most `limit` of their largest value."""
    for name in names:
        off, largest = np.abs(ours[name] - theirs[name]).max(), np.abs(theirs[name]).max()
        assert off <= limit * largest, (name, off, largest)


def restart_steps(folder: Path) -> list[int]:
    """Steps of the restart files in a folder."""
    return [step for step, _ in restart_files(folder)]
