# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem verify crosscheck`."""

import json
from collections.abc import Hashable
from pathlib import Path
from typing import Annotated, Any

import typer

from ...base.terminal import console, show_table, status, table
from ...cli.options import AsJson, Engines, Force, Out
from ...errors import CaseError

VALUES = {
    "model": "model",
    "e_n": "e_n",
    "e_n_theory": "its theory",
    "contact_time": "t_c [us]",
    "force_max": "F_max [N]",
    "e_n_error": "error e_n",
    "contact_time_error": "t_c",
    "force_max_error": "F_max",
    "psi_2_error": "psi_2",
    "e_t_error": "e_t",
    "order": "order",
    "seconds": "s",
    "check": "check",
}
CHANGES = {
    "model": "model",
    "unequal_error": "error",
    "swap": "swap",
    "sort": "sort",
    "migration": "migration",
    "restart": "restart",
    "momentum": "momentum",
}
CHECK_NOTE = "check: against the tolerances of the case; deviations of other codes are theirs and fail nothing"
CHANGES_TITLE = "Two spheres of unequal radii and moduli"
CHANGES_NOTE = """error: of e_n; swap to restart: changes of e_n in these variants of the set-up;
momentum: lost, as a share of one body's change. A serial YADE sorts nothing and has no ranks (-);
an embedded contact has neither ids nor restarts."""


def _cell(name: str, value: object) -> str:
    if not isinstance(value, float):
        return str(value)
    if value != value:
        return "-"
    if value == float("inf"):
        return "failed"
    if name == "contact_time":
        return f"{value * 1e6:.4g}"
    if name in ("e_n", "e_n_theory", "force_max", "order", "seconds"):
        return f"{value:.{2 if name in ('order', 'seconds') else 6}{'f' if name != 'force_max' else 'g'}}"
    return "0" if value == 0 else f"{value:.1e}"


def _show(title: str, heads: dict[str, str], rows: list[dict[Hashable, Any]]) -> None:
    heads = {name: head for name, head in heads.items() if name in rows[0]}
    shown = table(title, heads.values(), left=("model",))
    for row in rows:
        shown.add_row(*(_cell(name, row[name]) for name in heads))
    show_table(console(), shown)


def crosscheck(
    cases: Annotated[list[Path], typer.Argument(metavar="CASE...", help="case files (TOML)")],
    engine: Engines = None,
    law: Annotated[str | None, typer.Option("--law", "-l", help="a law instead of the case's")] = None,
    out: Out = None,
    fresh: Annotated[bool, typer.Option("--fresh", help="run again although results are stored")] = False,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Run a case on every installed engine and model, and print errors, order of convergence and invariance.

    Exit code 1: an engine of epdem is outside of the tolerances of the case. Models of other codes are not judged.
    """
    from ...case.impact import load
    from ...impacts import report
    from ..engine_comparison import crosscheck as check
    from ..pages import of_crosscheck

    folders = [out / path.stem for path in cases] if out and len(cases) > 1 else [out for _ in cases]
    if out and len(set(folders)) < len(cases):
        raise CaseError(f"--out {out}: two of the cases have one file name and would share a folder; rename one")
    for path in cases:
        load(path)  # a mistake in the last one is not said after minutes with the first
    results = []
    with status() as progress:
        for path, folder in zip(cases, folders, strict=True):
            results.append(
                check(
                    path,
                    engines=engine or [],
                    law=law,
                    out=folder,
                    fresh=fresh,
                    force=force,
                    progress=progress,
                )
            )
            of_crosscheck(results[-1])
    code = 0 if all(c.passed for c in results) else 1
    if as_json:
        documents = [
            {
                "case": c.outcome.case.name,
                "passed": c.passed,
                "absent": c.absent,
                "notes": c.notes,
                "rows": report.records(c.table),
            }
            for c in results
        ]
        print(json.dumps(documents[0] if len(documents) == 1 else documents, indent=1))
        raise typer.Exit(code)
    for c in results:
        rows, case = c.table.to_dict("records"), c.outcome.case.case
        title = f"{case.title}: values at {rows[0]['speed']:.4g} m/s, largest errors over speeds and phases"
        _show(title, VALUES, rows)
        if changed := [row for row in rows if row["momentum"] == row["momentum"]]:
            _show(CHANGES_TITLE, CHANGES, changed)
            console().print(CHANGES_NOTE, soft_wrap=True)
        console().print(CHECK_NOTE, soft_wrap=True)
        for name, note in c.notes.items():
            console().print(f"{name} has a law and a theory of its own: {note}", soft_wrap=True)
        for name, reason in c.absent.items():
            console().print(f"left out: {name}: {reason}", soft_wrap=True)
        console().print(f"page, figure and data: {c.outcome.folder}/report.html")
    raise typer.Exit(code)
