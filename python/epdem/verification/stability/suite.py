# SPDX-License-Identifier: GPL-2.0-or-later
"""The whole set on the given engines, and its tables."""

import tempfile
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import pandas as pd

from ...engines import DEFAULT_ENGINE, ImpactEngine, scene_engine
from ...engines.embedded import Embedded
from ...engines.yade.engine import Yade
from ...errors import CaseError
from ...jobs.engine import check_law, has_law, require
from ...theory.backbones import ADHESIVE, LAWS
from ..models import engine
from ..runner import STUDIES, Progress, Row, silent
from . import bulk
from .cases import Extreme, extremes
from .kinds import bounces, floors, reloads, two_walls
from .running import Bench, impact, judge

BOUNCE_STEPS, RELOADS = 10**9, 10**4
LAW_OF_SLOW = "thornton"  # if it is among those given; a slow engine runs the first and last case of each group
STATUS = ("passed", "failed", "not representable", "embedded only")
NUMBERS = ["e_n_error", "created", "order", "useless_at", "breaks_at", "seconds"]  # of the summary; NaN: not asked


@dataclass(frozen=True)
class Outcome:
    """verdicts: one row per case, engine and law; roundoff: per law and speed; bulk: per stiff scene and law.

    Empty where they did not run.
    """

    verdicts: pd.DataFrame
    roundoff: pd.DataFrame
    bulk: pd.DataFrame

    @property
    def passed(self) -> bool:
        """Whether no case failed, and every bulk scene passed."""
        return bool((self.verdicts["status"] != "failed").all() and (self.bulk.empty or self.bulk["passed"].all()))


def verdict(extreme: Extreme, law: str, bench: Bench, *, steps: int = BOUNCE_STEPS, reloaded: int = RELOADS) -> Row:
    """The judged row of a case of any kind; bounces run in the embedded engine alone."""
    if bench.positions and extreme.kind == "bounces":
        reason = "not run: 1e9 steps take hours in an engine with positions"
        about = {"case": extreme.name, "group": extreme.group, "engine": bench.name, "law": law}
        return about | {"status": "embedded only", "reason": reason, "large_deformation": False}
    kinds = {
        "impact": impact,
        "bounces": lambda s, bench: bounces(s, steps),
        "reloads": lambda s, bench: reloads(s, bench, reloaded),
        "two_walls": two_walls,
    }
    return judge(extreme, law, bench, kinds[extreme.kind])


def run(
    engines: list[str],
    laws: list[str],
    *,
    groups: list[str] | None = None,
    every: int = 1,
    steps: int | None = None,
    progress: Progress = silent,
) -> Outcome:
    """Judge every `every`-th case of the `groups` (none: all) with every law in every engine (none: embedded).

    `steps` is the length of the drift by bounces (1e9). Laws none given: all that the engine has. Without `groups` the
    round-off floor is measured, and the stiff bulk scenes run if LIGGGHTS is among the engines. Raises CaseError for a
    law or group that does not exist, a law that an engine does not have and a choice that leaves an engine no case,
    EngineError for an engine that is not here.
    """
    for option, given, known in (
        ("--law", laws, {**LAWS, **ADHESIVE}),
        ("--group", groups or [], dict.fromkeys(e.group for e in extremes())),
    ):
        if wrong := [name for name in given if name not in known]:
            raise CaseError(f"{option} {wrong[0]!r} does not exist; there are {', '.join(known)}")
    tools = {name: engine(name) for name in engines or [Embedded.name]}
    for tool, law in product(tools.values(), laws):
        check_law(tool, law)
    laws = list(dict.fromkeys(laws)) or [*LAWS, *ADHESIVE]
    plain = [law for law in laws if law in LAWS]
    chosen = [e for e in extremes() if not groups or e.group in groups][::every]
    if steps is not None and not any(e.kind == "bounces" for e in chosen):
        raise CaseError(
            "--steps is the length of the drift by bounces, which --group or --every leaves out; leave it out"
        )
    work = {name: _work(tool, laws, chosen) for name, tool in tools.items()}
    if idle := [name for name in tools if not work[name]]:
        raise CaseError(f"--engine {idle[0]}: --law, --group and --every leave it no case; leave one of them out")
    require(*tools.values())
    rows, rounded, scenes = [], pd.DataFrame(), pd.DataFrame()
    with tempfile.TemporaryDirectory(prefix="epdem-stability-") as scratch:
        benches = [Bench(tool, Path(scratch) / name) for name, tool in tools.items()]
        for bench in benches:
            for law, extreme in work[bench.name]:
                progress(f"{bench.name}, {law}: {extreme.name}")
                rows.append(verdict(extreme, law, bench, steps=steps or BOUNCE_STEPS))
        if plain and not groups:
            progress("round-off")
            rounded = pd.concat([floors(law, benches) for law in plain], ignore_index=True)
    if plain and not groups and DEFAULT_ENGINE in tools:
        scenes = bulk.run(plain, scene_engine(DEFAULT_ENGINE), progress=progress)
    verdicts = pd.DataFrame(rows)
    verdicts[NUMBERS] = verdicts.reindex(columns=NUMBERS).astype(float)
    return Outcome(verdicts, rounded, scenes)


def _work(tool: ImpactEngine, laws: list[str], chosen: list[Extreme]) -> list[tuple[str, Extreme]]:
    """The laws and cases of an engine."""
    known = [law for law in laws if has_law(tool, law)]
    if isinstance(tool, Yade):  # seconds for a plan
        groups = [[e for e in chosen if e.group == name] for name in dict.fromkeys(e.group for e in chosen)]
        known = [LAW_OF_SLOW] if LAW_OF_SLOW in known else known
        chosen = [e for group in groups for e in dict.fromkeys((group[0], group[-1]))]
    return [(law, x) for law in known for extreme in chosen if extreme.suits(law) for x in extreme.variants(law)]


def tables(outcome: Outcome) -> dict[str, pd.DataFrame]:
    """The summary by engine and law, and the stiff bulk scenes if they ran, by title."""
    found = {"extreme cases; steps as shares of the stability limit": summary(outcome.verdicts)}
    return found if outcome.bulk.empty else found | {STUDIES["bulk"].title: outcome.bulk}


def summary(verdicts: pd.DataFrame) -> pd.DataFrame:
    """One row per engine and law: how many of each status, and the worst numbers."""
    impacts = verdicts["e_n_error"].where(verdicts["group"] != "two_walls")  # an impact has an e_n
    ran = verdicts.assign(impacts=impacts)[verdicts["status"].isin(STATUS[:2])]
    ran = ran[~ran["group"].isin(["bounces", "reloads"])]
    by = ["engine", "law"]
    count = verdicts.groupby([*by, "status"], sort=False).size().unstack(fill_value=0)
    worst = ran.groupby(by, sort=False).agg(
        **{
            "largest error of e_n": ("impacts", "max"),
            "largest energy gain": ("created", "max"),
            "smallest order": ("order", "min"),
            "error above 10 % at": ("useless_at", "min"),
            "unstable at": ("breaks_at", "min"),
        }
    )
    longest = verdicts.groupby(by)["seconds"].max().rename("longest run [s]")
    return count.reindex(columns=STATUS, fill_value=0).join(worst).join(longest).reset_index()
