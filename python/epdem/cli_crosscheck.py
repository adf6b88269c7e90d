# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem crosscheck`."""

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from .cli_options import AsJson, Out, console

HEADS = {"model": "model", "e_n": "e_n", "contact_time": "t_c [us]", "force_max": "F_max [N]", "e_n_error": "error e_n",
         "contact_time_error": "t_c", "force_max_error": "F_max", "order": "order", "unequal_error": "unequal R",
         "swap": "swap", "sort": "sort", "migration": "migration", "restart": "restart", "momentum": "momentum",
         "seconds": "s"}  # fmt: skip


def _cell(name: str, value: object) -> str:
    if not isinstance(value, float):
        return str(value)
    if value != value:
        return "-"
    if name == "contact_time":
        return f"{value * 1e6:.4g}"
    if name in ("e_n", "force_max", "order", "seconds"):
        return f"{value:.{2 if name in ('order', 'seconds') else 6}{'f' if name != 'force_max' else 'g'}}"
    return "0" if value == 0 else f"{value:.1e}"


def crosscheck(
    cases: Annotated[list[Path], typer.Argument(metavar="CASE...", help="case files (TOML)")],
    law: Annotated[str | None, typer.Option("--law", "-l", help="replaces the case's law")] = None,
    out: Out = None,
    fresh: Annotated[bool, typer.Option(help="run again what is already stored")] = False,
    as_json: AsJson = False,
) -> None:
    """A case on every engine and model at hand, with order of convergence and invariance, in one table."""
    from rich.markup import escape
    from rich.table import Table

    from . import report
    from .crosscheck import crosscheck as check

    found = []
    with Console(stderr=True).status("") as line:
        for path in cases:
            folder = out / path.stem if out and len(cases) > 1 else out
            found.append(check(path, law=law, out=folder, fresh=fresh, progress=line.update))
    if as_json:
        documents = [{"case": c.outcome.case.name, "absent": c.absent, "rows": report.records(c.table)} for c in found]
        print(json.dumps(documents[0] if len(documents) == 1 else documents, indent=1))
        return
    for c in found:
        speed = c.table["speed"][0]
        title = f"{c.outcome.case.case.title}: values at {speed:.4g} m/s, errors the largest over all speeds and phases"
        table = Table(title=title, caption="changes of e_n; momentum: lost, share of one body's change",
                      caption_justify="left")  # fmt: skip
        for head in HEADS.values():
            table.add_column(escape(head), justify="left" if head == "model" else "right", no_wrap=True)
        for row in c.table.to_dict("records"):
            table.add_row(*(_cell(name, row[name]) for name in HEADS))
        console().print(table)
        for name, reason in c.absent.items():
            console().print(f"left out: {name}: {reason}", highlight=False, soft_wrap=True)
        console().print(f"figure and data: {c.outcome.folder}/", highlight=False)
