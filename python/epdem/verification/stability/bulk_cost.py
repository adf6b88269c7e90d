# SPDX-License-Identifier: GPL-2.0-or-later
"""Error of the dissipated energy and run time of a bulk scene against the time step, for every law."""

import math
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from ...base.declarations import declarations as declared
from ...engines import DEFAULT_ENGINE
from ...engines.liggghts import launcher
from ...engines.liggghts.engine import Liggghts
from ...engines.log import loop_seconds
from ...jobs.engine import require
from ...scenes.run import run_plan
from ..cost import over_reference, spread
from ..models import REFERENCE
from .bulk import limit, scene_case, with_step

SHARES = (0.4, 0.2, 0.1, 0.05, 0.025)  # of the stability limit at the highest speed
FINEST = 0.25  # share of the finest step, of the run that errors are against: an error of order 2 is known to 1/16
LATTICE = (8, 8, 8)
DECK, PARTS = "in.scene", "setup.in"
# out of the deck of a timed run: the largest strain and its rows
STRAIN = (
    " computeContactStrain on",
    "compute ratio all reduce max f_contactStrain[1] f_contactStrain[2]\n",
    " c_ratio[1] c_ratio[2]",
)
ELASTIC = (
    "fix restitution all property/global coefficientRestitution peratomtypepair 1 1.0\npair_style gran model hertz"
)


@dataclass(frozen=True)
class Model:
    """Two blocks that meet, with a law of epdem, or with LIGGGHTS's own hertz."""

    label: str
    law: str
    own: bool = False

    def dissipated(self, time_step: float, folder: Path) -> np.ndarray:
        """Plastic work of every sphere at the end [J], shape (spheres,)."""
        case = scene_case("shock", self.law, folder, lattice=LATTICE, rows=1, particles=1, energy=True)
        frames = run_plan(with_step(case, time_step), Liggghts(), folder)["particles"]
        last = frames[frames["step"] == frames["step"].max()].sort_values("id")
        return np.asarray(last["plastic_work"])

    def seconds(self, time_step: float, folder: Path) -> float:
        """The engine's loop time [s] of a run that records nothing, not even its plastic work."""
        case = scene_case("shock", self.law, folder, lattice=LATTICE, rows=1, particles=0)
        Liggghts().write(with_step(case, time_step), folder)
        text = (folder / PARTS).read_text(encoding="utf-8")
        for words in STRAIN:
            text = text.replace(words, "")
        if self.own:
            text = text.replace("pair_style gran model ep/hertz", ELASTIC)
        (folder / PARTS).write_text(text, encoding="utf-8")
        launcher.run(DECK, folder, log=launcher.LOG, seconds=120)
        return loop_seconds(folder / launcher.LOG)


def errors(c: Model, steps: dict[float, float], folder: Path, progress: Callable[[str], None]) -> pd.DataFrame:
    """Error of the mean dissipated energy, and `rms` error of a sphere's, both over the mean; a row per share.

    `steps`: time step [s] of each share. The mean's error may pass through zero, as those of single spheres have
    either sign; `order` is that of the rms between neighbouring shares. NaN where the law dissipates nothing.
    """
    table = pd.DataFrame({"model": c.label, "spheres": math.prod(LATTICE), "share": list(steps)})
    if declared()[c.law].memory == 0:
        return table.assign(error=np.nan, rms=np.nan, order=np.nan)
    progress(f"bulk error: {c.label}, reference")
    reference = c.dissipated(FINEST * min(steps.values()), folder)
    deviations = []
    for share, time_step in steps.items():
        progress(f"bulk error: {c.label}, {share:g} of the limit")
        deviations.append((c.dissipated(time_step, folder) - reference) / reference.mean())
    off = np.array(deviations)
    table["error"], table["rms"] = np.abs(off.mean(axis=1)), np.sqrt((off**2).mean(axis=1))
    table["order"] = np.log(table["rms"]).diff() / np.log(table["share"]).diff()
    return table


def run(
    laws: list[str],
    *,
    repetitions: int = 3,
    shares: tuple[float, ...] = SHARES,
    progress: Callable[[str], None] = lambda text: None,
) -> pd.DataFrame:
    """One row per law (and the reference) and share: errors, seconds and the ratio to the reference.

    The blocks meet for about two collisions a sphere: long enough to be a bulk, too short for round-off to grow.
    All take the same steps, shares of the smallest of their stability limits at the highest speed.
    `seconds` and `ratio` (to the reference) are medians, `..._spread` their distances of the quartiles; models
    alternate, so that drifts of the machine hit all.
    Raises EngineError without LIGGGHTS.
    """
    require(Liggghts())
    chosen, rows = [Model(f"{DEFAULT_ENGINE}, {law}", law) for law in laws], []
    chosen.append(Model(REFERENCE, "hertz", own=True))
    with tempfile.TemporaryDirectory(prefix="epdem-bulk-") as scratch:
        folder = Path(scratch)
        least = min(limit(scene_case("shock", c.law, folder, lattice=LATTICE)) for c in chosen)
        steps = {share: share * least for share in shares}
        table = pd.concat([errors(c, steps, folder, progress) for c in chosen], ignore_index=True)
        for k in range(repetitions):
            for share, time_step in steps.items():
                for c in chosen:
                    progress(f"bulk time {k + 1}/{repetitions}: {c.label}, {share:g} of the limit")
                    rows.append(
                        {"repetition": k, "share": share, "model": c.label, "seconds": c.seconds(time_step, folder)}
                    )
    times = pd.DataFrame(rows)
    times["ratio"] = over_reference(times, "seconds", ["repetition", "share"])
    groups = times.groupby(["model", "share"])[["seconds", "ratio"]]
    middle = groups.median().join(groups.agg(spread).add_suffix("_spread"))
    return table.merge(middle.reset_index(), on=["model", "share"])
