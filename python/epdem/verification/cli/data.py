# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem verify data`."""

import json
from typing import Annotated

import typer

from ...base.terminal import console, show_table, status
from ...cli.options import AsJson, Engines, Force, Laws, Out
from ..tables import frame_table


def data(
    sets: Annotated[
        list[str] | None, typer.Option("--set", "-s", help="run only this measured set; repeat for more")
    ] = None,
    engine: Engines = None,
    law: Laws = None,
    out: Out = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Run all laws against measured impacts with nothing fitted (default engines: embedded and liggghts)."""
    from ...impacts.report import records
    from ..measured_data import shown
    from ..measured_data import validate as run
    from ..pages import of_validation
    from ..runner import STUDIES

    with status() as progress:
        result = run(sets=sets or [], engines=engine or [], chosen=law or [], out=out, force=force, progress=progress)
        page = of_validation(result)
    if as_json:
        document = {"rows": records(result.points), "summary": records(result.summary), "absent": result.absent}
        print(json.dumps(document | {"page": str(page)}, indent=1))
        return
    show_table(console(), frame_table(STUDIES["data"].title, shown(result.summary)))
    for name, reason in result.absent.items():
        console().print(f"left out: {name}: {reason}", soft_wrap=True)
    print(f"see {page}")
