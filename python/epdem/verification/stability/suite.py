# SPDX-License-Identifier: GPL-2.0-or-later
"""The whole set on the given engines, and its tables."""

import tempfile
from collections.abc import Callable
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path

import pandas as pd

from ...engines import DEFAULT_ENGINE, ImpactEngine, scene_engine
from ...engines.embedded import Embedded
from ...engines.yade.engine import Yade
from ...errors import CaseError
from ...jobs.engine import Feature, check_law, has_law, require
from ...theory.backbones import ADHESIVE, LAWS
from ..models import engine
from ..runner import STUDIES
from . import bulk
from .cases import Extreme, extremes
from .repeats import judge_repeats
from .roundoff import floors
from .running import COARSE, judge
from .sampling import EmbeddedSampler, PositionSampler, Sampler

POSITION_COARSE = (0.3, 0.5, 0.7, 1.0, 1.5)  # an engine's start-up costs more than its steps
BOUNCE_STEPS = 10**9
LAW_OF_SLOW = "thornton"  # if it is among those given; a slow engine runs the first and last case of each group


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


def samplers(names: list[str], folder: Path) -> list[Sampler]:
    """A sampler per engine. Raises EngineError if one cannot run here."""
    chosen: list[Sampler] = []
    for name in names:
        tool = engine(name)
        require(tool)
        chosen.append(PositionSampler(tool, folder / name) if Feature.POSITIONS in tool.features else EmbeddedSampler())
    return chosen


def run(
    engines: list[str],
    laws: list[str],
    *,
    groups: list[str] | None = None,
    every: int = 1,
    steps: int | None = None,
    cycles: int = 10_000,
    progress: Callable[[str], None] = lambda text: None,
) -> Outcome:
    """Judge every `every`-th case of the `groups` (none: all) with every law in every engine (none: embedded).

    `steps` is the length of the drift by bounces (1e9), `cycles` the number of reloads. Laws none given: all that the
    engine has. Without `groups` the round-off floor is measured, and the stiff bulk scenes run if LIGGGHTS is among the
    engines. Raises CaseError for a law or group that does not exist,
    a law that an engine does not have and a choice that leaves an engine no case, EngineError for an engine that is not
    here.
    """
    for option, given, known in (
        ("--law", laws, {**LAWS, **ADHESIVE}),
        ("--group", groups or [], dict.fromkeys(e.group for e in extremes())),
    ):
        if wrong := [name for name in given if name not in known]:
            raise CaseError(f"{option} {wrong[0]!r} does not exist; there are {', '.join(known)}")
    engines = list(dict.fromkeys(engines)) or [Embedded.name]
    for name, law in product(engines, laws):
        check_law(engine(name), law)
    laws = list(dict.fromkeys(laws)) or [*LAWS, *ADHESIVE]
    plain = [law for law in laws if law in LAWS]
    chosen = [e for e in extremes() if not groups or e.group in groups][::every]
    if steps is not None and not any(e.kind == "bounces" for e in chosen):
        raise CaseError(
            "--steps is the length of the drift by bounces, which --group or --every leaves out; leave it out"
        )
    work = {name: _work(engine(name), laws, chosen) for name in engines}
    if idle := [name for name in engines if not work[name]]:
        raise CaseError(f"--engine {idle[0]}: --law, --group and --every leave it no case; leave one of them out")
    rows, tables = [], []
    with tempfile.TemporaryDirectory(prefix="epdem-stability-") as scratch:
        for sampler in samplers(engines, Path(scratch)):
            coarse = COARSE if not sampler.positions else POSITION_COARSE
            for law, extreme in work[sampler.name]:
                progress(f"{sampler.name}, {law}: {extreme.name}")
                if extreme.kind == "impact":
                    rows.append(judge(extreme, law, sampler, coarse))
                else:
                    rows.append(judge_repeats(extreme, law, sampler, steps=steps or BOUNCE_STEPS, cycles=cycles))
        if not groups:
            progress("round-off")
            others = [s for s in samplers(engines, Path(scratch)) if s.positions]
            tables = [floors(law, others) for law in plain]
    verdicts = pd.DataFrame([asdict(v) for v in rows])
    verdicts["notes"] = verdicts["notes"].map("; ".join)
    stiff = plain and not groups and DEFAULT_ENGINE in engines
    scenes = bulk.run(plain, scene_engine(DEFAULT_ENGINE), progress=progress) if stiff else pd.DataFrame()
    return Outcome(verdicts, pd.concat(tables, ignore_index=True) if tables else pd.DataFrame(), scenes)


def _work(tool: ImpactEngine, laws: list[str], chosen: list[Extreme]) -> list[tuple[str, Extreme]]:
    """The laws and cases of an engine."""
    known = [law for law in laws if has_law(tool, law)]
    if isinstance(tool, Yade):  # seconds for a plan
        known, chosen = [LAW_OF_SLOW] if LAW_OF_SLOW in known else known, ends(chosen)
    return [(law, x) for law in known for extreme in chosen if extreme.suits(law) for x in extreme.variants(law)]


def ends(chosen: list[Extreme]) -> list[Extreme]:
    """The first and the last case of each group."""
    groups: dict[str, list[Extreme]] = {}
    for extreme in chosen:
        groups.setdefault(extreme.group, []).append(extreme)
    return [e for group in groups.values() for e in ([group[0]] if len(group) == 1 else [group[0], group[-1]])]


def tables(outcome: Outcome) -> dict[str, pd.DataFrame]:
    """The summary by engine and law, and the stiff bulk scenes if they ran, by title."""
    found = {"extreme cases; steps as shares of the stability limit": summary(outcome.verdicts)}
    return found if outcome.bulk.empty else found | {STUDIES["bulk"].title: outcome.bulk}


def summary(verdicts: pd.DataFrame) -> pd.DataFrame:
    """One row per engine and law: how many passed, and the worst numbers."""
    rows = []
    for (name, law), part in verdicts.groupby(["engine", "law"], sort=False):
        count = part["status"].value_counts()
        ran = part[part["status"].isin(["passed", "failed"]) & ~part["group"].isin(["bounces", "reloads"])]
        hit = ran[ran["group"] != "two_walls"]  # an impact has an e_n
        rows.append(
            {
                "engine": name,
                "law": law,
                "passed": count.get("passed", 0),
                "failed": count.get("failed", 0),
                "not representable": count.get("not representable", 0),
                "embedded only": count.get("embedded only", 0),
                "largest error of e_n": hit["e_n_error"].max(),
                "largest energy gain": ran["created"].max(),
                "smallest order": ran["order"].min(),
                "error above 10 % at": ran["useless_at"].min(),
                "unstable at": ran["breaks_at"].min(),
                "longest run [s]": part["seconds"].max(),
            }
        )
    return pd.DataFrame(rows)
