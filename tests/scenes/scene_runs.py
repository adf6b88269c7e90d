# SPDX-License-Identifier: GPL-2.0-or-later
"""Case files, decks and runs for the tests of scenes."""

import json
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from epdem.base.files import write_texts
from epdem.case.scene import SceneCase
from epdem.engines import scene_engine
from epdem.engines.frames import restart_files
from epdem.jobs.engine import silent
from epdem.scenes import run as scene_run
from epdem.scenes.plan.plan import ScenePlan, plan

LIGGGHTS = pytest.param("liggghts", marks=pytest.mark.liggghts)
LAMMPS = pytest.param("lammps", marks=pytest.mark.lammps)
YADE = pytest.param("yade", marks=pytest.mark.yade("module"))
HOSTS = [LIGGGHTS, LAMMPS, YADE]
PRESSES = [LIGGGHTS, LAMMPS]  # where a force, height or density drives a wall or ends a phase


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


def ran(data: dict, folder: Path, engine: str = "liggghts", **options) -> scene_run.SceneOutcome:
    """Write the case of `data` into a folder and run it there."""
    return run(write_case(data, folder), engine, out=folder / "out", **options)


def assert_goes_on(
    p: ScenePlan, folder: Path, engine: str = "liggghts", *, ranks: int = 1, of: slice = slice(None)
) -> tuple[dict[str, pd.DataFrame], list[int]]:
    """Run a plan, and let it go on from its restart files: every table has the same bits. (tables, steps).

    of: which of the files but the last, beside those at ends of phases. Frames after a file are removed."""
    tool = scene_engine(engine)
    write_texts(folder, tool.files(p))
    tool.start(tool.scripts[1], folder, ranks=ranks)
    whole = tool.read(p, folder)
    kept = {step: path.read_bytes() for step, path in restart_files(folder) if step < whole["rows"]["step"].max()}
    steps = sorted({*sorted(kept)[of]} | ({*kept} & {*whole["phases"]["end"]}))
    assert steps
    for step in steps:
        for path in [x for x in folder.iterdir() if re.fullmatch(r"\w+\.\d+\.\w+", x.name)]:
            if path.name.startswith("restart") or int(re.findall(r"\d+", path.name)[0]) > step:
                path.unlink()
        (folder / f"restart.{step}.bin").write_bytes(kept[step])
        again, begun, _ = tool.resume(p, folder, ranks=ranks, report=silent)
        assert begun == step
        for name, table in whole.items():
            assert table.equals(again[name]), f"{name} from {step}"
    return whole, steps


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
