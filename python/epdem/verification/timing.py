# SPDX-License-Identifier: GPL-2.0-or-later
"""Run times of an engine for one plan."""

import math
import time
from pathlib import Path

from ..engines import ImpactEngine
from ..engines.embedded import Embedded, numbers
from ..engines.host import Host
from ..engines.liggghts.engine import Liggghts
from ..engines.log import loop_seconds
from ..impacts.plan import Plan


def seconds(tool: ImpactEngine, plan: Plan, folder: Path) -> dict[str, float]:
    """Times of one run with the least possible output [s]: startup, setup, stepping; NaN where unknown."""
    if isinstance(tool, Embedded):
        return _embedded(plan)
    assert isinstance(tool, Host)
    return _host(tool, plan, folder)


def _embedded(plan: Plan) -> dict[str, float]:
    x, begin = plan.experiment, time.perf_counter()
    law = x.native_law()
    ready = time.perf_counter()
    law.impacts(steps=plan.steps, **numbers(plan))
    return {"startup": 0.0, "setup": ready - begin, "stepping": time.perf_counter() - ready}


def _host(tool: Host, plan: Plan, folder: Path) -> dict[str, float]:
    deck, *_ = tool.write(plan, folder)
    lines = deck.read_text(encoding="utf-8").splitlines(keepends=True)
    # stepping, not writing
    kept = (line for line in lines if not line.startswith(("dump", '    PyRunner(command="record()"')))
    deck.write_text("".join(kept), encoding="utf-8")
    startup = math.nan
    if isinstance(tool, Liggghts):
        (folder / "in.empty").write_text("# nothing\n", encoding="utf-8")
        startup = tool.start("in.empty", folder, out="out.empty", seconds=120)
    total = tool.start(deck.name, folder, seconds=600)
    stepping = loop_seconds(folder / tool.launcher.OUT)
    setup = total - stepping - (0.0 if math.isnan(startup) else startup)
    return {"startup": startup, "setup": max(setup, 0.0), "stepping": stepping}
