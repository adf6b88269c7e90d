# SPDX-License-Identifier: GPL-2.0-or-later
"""Commands about accuracy, cost and stability; `main.py` registers them."""

import json
from pathlib import Path
from typing import Annotated

import typer

from ..base.terminal import console, frame_table, show_table, status
from ..errors import CaseError
from .options import AsJson, CasePath, Engines, Force, Formats, Laws, Out, Replace, formats, laws_or_own, refuse


def timestep(
    case: CasePath,
    error: Annotated[float, typer.Option(min=1e-9, max=0.1, help="largest relative error of e_n")] = 1e-3,
    law: Laws = None,
    as_json: AsJson = False,
) -> None:
    """Find the time step of a case for a target error, with the embedded engine."""
    from ..case.impact import load
    from ..case.toml import named
    from ..impacts.experiment import experiment
    from ..impacts.prediction import predict
    from ..impacts.timestep import search

    searches = []
    with status() as progress, named(case):
        for name in laws_or_own(law):
            x = experiment(load(case), name)
            progress(f"{x.name}, {x.law.name}")
            searches.append((x, search(x, predict(x), error)))
    if as_json:
        documents = [
            {
                "case": x.name,
                "law": x.law.name,
                "target": f.target,
                "time_step": f.time_step,
                "error": f.error,
                "rms": f.rms,
                "steps_in_contact": f.steps_in_contact,
                "reference": vars(f.reference),
                "share": f.shares(),
            }
            for x, f in searches
        ]
        print(json.dumps(documents[0] if len(documents) == 1 else documents, indent=1))
        return
    for x, f in searches:
        share = f.shares()
        print(
            f"{x.name}, law {x.law.name}: timestep {f.time_step:.4g} s for e_n within {f.target:g} "
            f"(largest {f.error:.2g}, rms {f.rms:.2g}; {f.steps_in_contact:.0f} steps in the shortest contact)\n"
            f"  {share['stability']:.2%} of the stability limit, {share['rayleigh']:.2%} of the Rayleigh time, "
            f"{share['hertz']:.2%} of the elastic contact time"
        )


def stability(
    engine: Engines = None,
    law: Laws = None,
    group: Annotated[
        list[str] | None, typer.Option("--group", "-g", help="run only these groups of cases; repeat for more")
    ] = None,
    every: Annotated[int, typer.Option(min=1, help="run only every n-th case")] = 1,
    steps: Annotated[
        int | None, typer.Option(min=1000, help="steps of the drift by repeated bounces (default: 1e9)")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="CSV file of all verdicts; its page is beside it, as .html")
    ] = None,
    force: Replace = False,
    as_json: AsJson = False,
) -> None:
    """Test stiff and extreme cases, and find the time step at which each fails (default engine: embedded)."""
    from ..base.folders import refuse_existing
    from ..base.tables import write_csv
    from ..impacts.report import records
    from ..studies import stability as suite
    from ..studies.stability.suite import summary

    if out:
        if out.suffix == ".html":
            raise CaseError(f"--out {out}: the page beside the table has this name; name the table {out.stem}.csv")
        refuse_existing(out, force=force)
        refuse_existing(out.with_suffix(".html"), force=force)
    else:
        refuse("stability", "it goes with --out", force=force)
    with status() as progress:
        outcome = suite.run(engine or [], law or [], groups=group, every=every, steps=steps, progress=progress)
    if out:
        from ..studies.pages.tables import of_stability

        write_csv(out, outcome.verdicts)
        of_stability(outcome, out.with_suffix(".html"))
    if as_json:
        print(
            json.dumps(
                {
                    "passed": outcome.passed,
                    "rows": records(outcome.verdicts),
                    "roundoff": records(outcome.roundoff),
                    "bulk": records(outcome.bulk),
                    "precisions": records(outcome.precisions),
                },
                indent=1,
            )
        )
    else:
        screen = console()
        show_table(
            screen, frame_table("extreme cases; steps as shares of the stability limit", summary(outcome.verdicts))
        )
        for v in outcome.verdicts[outcome.verdicts["status"] == "failed"].itertuples():
            screen.print(f"failed: {v.engine}, {v.law}, {v.case}: {v.reason}", style="red")
        if not outcome.bulk.empty:
            show_table(screen, frame_table("stiff bulk scenes in LIGGGHTS", outcome.bulk))
    raise typer.Exit(0 if outcome.passed else 1)


def cost(
    case: CasePath,
    engine: Engines = None,
    law: Laws = None,
    repetitions: Annotated[int, typer.Option(min=1, max=100, help="repetitions of every timed run, interleaved")] = 5,
    bulk: Annotated[bool, typer.Option(help="run a bulk scene in LIGGGHTS as well")] = False,
    pictures: Formats = None,
    out: Out = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Measure error against run time at 10 to 3000 steps in contact (default engines: embedded and liggghts)."""
    from ..base.folders import claim, results_folder
    from ..case.impact import load
    from ..impacts.report import records
    from ..studies import cost as study
    from ..studies import cost_report
    from ..studies.pages.tables import of_cost

    scene, kinds = None, formats(pictures)
    folder = results_folder(out, load(case).name, "cost")
    with claim(folder, force=force, files=["cost.csv"]), status() as progress:
        outcome = study.run(
            case,
            engines=engine or [],
            laws=law or [],
            repetitions=repetitions,
            progress=progress,
        )
        if bulk:
            from ..studies.stability import bulk_cost

            scene = bulk_cost.run(law or [outcome.case.law.name], progress=progress)
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
