# SPDX-License-Identifier: GPL-2.0-or-later
"""Error of the dissipated energy of a bulk scene against run time, with the engine's own elastic model as reference."""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from ...base.declarations import declarations as declared
from ..cost import over_reference, spread
from ..models import REFERENCE
from .assembly import SHARE, Assembly, AssemblyPlan
from .assembly_liggghts import LiggghtsAssemblies, assembly_engine
from .scenes import shock, with_law

SHARES = (0.4, 0.2, 0.1, 0.05, 0.025)  # of the stability limit at the highest speed
FINEST = 0.25  # share of the finest step, of the run that errors are against: an error of order 2 is known to 1/16


@dataclass(frozen=True)
class Model:
    """A scene with a law, by our model or (`model`) by one of the engine's own."""

    label: str
    scene: Assembly
    tool: LiggghtsAssemblies
    model: str | None = None

    def dissipated(self, time_step: float, folder: Path) -> np.ndarray:
        """Plastic work of every sphere at the end [J], shape (spheres,)."""
        self.tool.write(AssemblyPlan(self.scene, time_step, frames=1, contacts=False), folder)
        self.tool.run(folder)
        return np.asarray(self.tool.frames(folder)[-1][:, 7])

    def seconds(self, time_step: float, folder: Path) -> float:
        """The engine's loop time [s] of a run that records nothing, not even its plastic work."""
        self.tool.write(AssemblyPlan(self.scene, time_step, frames=0), folder, model=self.model)
        return self.tool.run(folder)


def errors(c: Model, steps: dict[float, float], folder: Path, progress: Callable[[str], None]) -> pd.DataFrame:
    """Error of the mean dissipated energy, and `rms` error of a sphere's, both over the mean; a row per share.

    `steps`: time step [s] of each share. The mean's error may pass through zero, as those of single spheres have
    either sign; `order` is that of the rms between neighbouring shares. NaN where the law dissipates nothing.
    """
    table = pd.DataFrame({"model": c.label, "spheres": len(c.scene.position), "share": list(steps)})
    if declared()[c.scene.law].memory == 0:
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
    Raises EngineError without an engine of assemblies.
    """
    scene, tool, rows = shock((8, 8, 8)), assembly_engine(), []
    chosen = [Model(f"{tool.name}, {law}", with_law(scene, law), tool) for law in laws]
    chosen.append(Model(REFERENCE, with_law(scene, "hertz"), tool, tool.own_elastic))
    limit = min(c.scene.time_step() for c in chosen) / SHARE
    steps = {share: share * limit for share in shares}
    with tempfile.TemporaryDirectory(prefix="epdem-bulk-") as scratch:
        folder = Path(scratch)
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
