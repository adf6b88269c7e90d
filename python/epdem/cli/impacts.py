# SPDX-License-Identifier: GPL-2.0-or-later
"""Commands for cases of impacts: functions of a few lines that call the library."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.terminal import bar, console

if TYPE_CHECKING:  # slow to import
    from ..impacts.run import Outcome


def run_impacts(
    case: Path, *, engines: list[str], laws: list[str], formats: tuple[str, ...], **options: Any
) -> "Outcome":
    """Run a case with a progress bar; draw its figure and write its page. options: as of `impacts.run.run`."""
    from ..engines import engine as find
    from ..impacts import report
    from ..impacts.run import run
    from ..studies.pages.impacts import of_impacts

    stages = len(set(engines)) * max(len(set(laws)), 1) + 1  # and the figure
    with bar() as progress:
        task = progress.add_task("", total=stages)
        outcome = run(
            case,
            engines=[find(name) for name in engines],
            laws=laws,
            progress=lambda text: progress.update(task, advance=1, description=text),
            **options,
        )
        progress.update(task, advance=1, description="figure")
        report.figure(outcome, formats)
        of_impacts(outcome)
    return outcome


def show_run(outcome: "Outcome", full: bool, as_json: bool) -> None:
    """Print the table of a run, with all rows if `full`, or its JSON."""
    from ..impacts import report

    if as_json:
        print(report.run_json(outcome))
    else:
        report.show(outcome, console(), full=full)
