# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem verify cost`."""

import json
from typing import Annotated

import typer

from ...base.terminal import console, status
from ...cli.options import AsJson, CasePath, Engines, Force, Formats, Laws, Out, formats


def cost(
    case: CasePath,
    engine: Engines = None,
    law: Laws = None,
    repetitions: Annotated[int, typer.Option(min=1, max=100, help="repetitions of every timed run, interleaved")] = 5,
    bulk: Annotated[bool, typer.Option(help="also find the error of a bulk scene's plastic work in LIGGGHTS")] = False,
    pictures: Formats = None,
    out: Out = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Measure error against run time at 10 to 3000 steps in contact (default engines: embedded and liggghts)."""
    from ...base.files import claim, results_folder
    from ...case.impact import load
    from ...impacts.report import records
    from .. import cost as study
    from .. import cost_report
    from ..pages import of_cost

    scene, kinds = None, formats(pictures)
    folder = results_folder(out, load(case).name, "cost")
    with claim(folder, force=force, files=["cost.csv"]), status() as progress:
        if bulk:
            from ...engines import DEFAULT_ENGINE, scene_engine
            from ..stability.bulk import convergence

            scene = convergence(law or [load(case).law.name], scene_engine(DEFAULT_ENGINE), progress=progress)
        outcome = study.run(
            case,
            engines=engine or [],
            laws=law or [],
            repetitions=repetitions,
            progress=progress,
        )
        files = [*cost_report.write(outcome, folder, kinds), of_cost(outcome, scene, folder)]
    if as_json:
        document = {
            "case": outcome.case.name,
            "seconds": outcome.seconds,
            "files": [str(f) for f in files],
            "rows": records(outcome.rows),
            "models": records(outcome.models),
        }
        print(json.dumps(document | ({} if scene is None else {"bulk": records(scene)}), indent=1))
    else:
        cost_report.show(outcome, scene, console())
        print(f"see {folder}/report.html")
