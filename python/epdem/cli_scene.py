# SPDX-License-Identifier: GPL-2.0-or-later
"""Commands for bulk scenes: functions of a few lines that call the library."""

import json
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from .case import read_toml
from .scene import case as scene_case


def is_scene(path: Path) -> bool:
    """Whether a case file describes a bulk scene. Raises CaseError if it cannot be read."""
    return scene_case.is_scene(read_toml(path))


def run_scene(case: Path, *, out: Path | None = None, ranks: int = 1, fresh: bool = False, resume: bool = False,
              as_json: bool = False) -> int:  # fmt: skip
    """Run a scene with a progress bar; print its checks. Exit code: 0, or 1 if a check failed."""
    from .scene import report
    from .scene.run import run

    bar = Progress(TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed}/{task.total} steps"),
                   TimeElapsedColumn(), TimeRemainingColumn(), console=Console(stderr=True))  # fmt: skip
    with bar:
        task = bar.add_task(Path(case).stem, total=None)
        outcome = run(case, out=out, ranks=ranks, fresh=fresh, resume=resume,
                      tell=lambda step, steps: bar.update(task, completed=step, total=steps))  # fmt: skip
    report.figures(outcome)
    if as_json:
        print(report.as_json(outcome))
    else:
        console = Console()
        report.show(outcome, console if console.is_terminal else Console(width=140))
    return 0 if outcome.passed else 1


def deck_scene(case: Path, out: Path, *, as_json: bool = False) -> None:
    """Write the deck of a scene; it runs by hand."""
    from .scene.deck import write

    names = [str(f) for f in write(scene_case.load(case), out)]
    print(json.dumps({"files": names}) if as_json else "\n".join(names))
