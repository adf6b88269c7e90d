# SPDX-License-Identifier: GPL-2.0-or-later
"""Run times of an engine for one plan."""

import math
import time
from pathlib import Path

from ..engines import ImpactEngine
from ..engines.embedded import Embedded, numbers
from ..engines.liggghts import launcher
from ..engines.liggghts.engine import Liggghts
from ..engines.log import loop_seconds
from ..impacts.plan import Plan


def seconds(tool: ImpactEngine, plan: Plan, folder: Path) -> dict[str, float]:
    """Times of one run with the least possible output [s]: startup, setup, stepping; NaN where unknown."""
    if isinstance(tool, Embedded):
        return _embedded(plan)
    if isinstance(tool, Liggghts):
        return _liggghts(tool, plan, folder)
    begin = time.perf_counter()  # this engine always writes samples: its own stepping, and the rest as setup
    tool.write(plan, folder)
    stepping = tool.run(plan, folder).seconds.get("stepping", math.nan)
    return {"startup": math.nan, "setup": time.perf_counter() - begin - stepping, "stepping": stepping}


def _embedded(plan: Plan) -> dict[str, float]:
    x, begin = plan.experiment, time.perf_counter()
    law = x.native_law()
    ready = time.perf_counter()
    law.impacts(steps=plan.steps, **numbers(plan))
    return {"startup": 0.0, "setup": ready - begin, "stepping": time.perf_counter() - ready}


def _liggghts(tool: Liggghts, plan: Plan, folder: Path) -> dict[str, float]:
    deck, *_ = tool.write(plan, folder)
    lines = deck.read_text(encoding="utf-8").splitlines(keepends=True)
    # stepping, not writing
    deck.write_text("".join(line for line in lines if not line.startswith("dump ")), encoding="utf-8")
    (folder / "in.empty").write_text("# nothing\n", encoding="utf-8")
    startup = launcher.run("in.empty", folder, out="out.empty", seconds=120)
    total = launcher.run(deck.name, folder, seconds=600)
    stepping = loop_seconds(folder / launcher.OUT)
    return {"startup": startup, "setup": max(total - startup - stepping, 0.0), "stepping": stepping}
