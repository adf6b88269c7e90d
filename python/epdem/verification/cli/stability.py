# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem verify stability`."""

import json
from pathlib import Path
from typing import Annotated

import typer

from ...base.terminal import console, show_table, status
from ...cli.options import AsJson, Engines, Laws, Replace, refuse_options
from ...errors import CaseError
from ..tables import frame_table


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
    from ...base.files import refuse_existing
    from ...base.tables import write_csv
    from ...impacts.report import records
    from .. import stability as suite
    from ..stability.suite import summary

    if out:
        if out.suffix == ".html":
            raise CaseError(f"--out {out}: the page beside the table has this name; name the table {out.stem}.csv")
        refuse_existing(out, force=force)
        refuse_existing(out.with_suffix(".html"), force=force)
    else:
        refuse_options("stability", "it goes with --out", force=force)
    with status() as progress:
        outcome = suite.run(engine or [], law or [], groups=group, every=every, steps=steps, progress=progress)
    if out:
        from ..pages import of_stability

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
