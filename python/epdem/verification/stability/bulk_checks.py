# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks of stiff bulk scenes: no energy is created, no sphere is lost, ranks agree."""

import shutil
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from .assembly import Assembly, AssemblyPlan
from .assembly_liggghts import LiggghtsAssemblies, assembly_engine
from .bulk import FRAMES, energy_balance
from .scenes import SCENES, with_law

# Of the energy brought in, what the total may move: velocity Verlet lets the energy of a contact in progress swing by
# (omega dt)^2/4 = share^2 of the stability limit, 4e-4 at 2 %.
SWING = 4e-4
GROWTH = 1e6  # by which a difference may grow from frame to frame: exponential, no jump
AGREE = 0.02  # of the kinetic energy, in which ranks may differ when paths have nothing in common any more


@dataclass
class BulkVerdict:
    """One scene with one law. Energies over the energy brought in, differences over the radius."""

    scene: str
    law: str
    spheres: int
    steps: int
    seconds: float
    lost: int
    rise: float  # largest rise of the total energy, plastic work included, between two frames
    off: float  # largest distance of the total from that at the start
    plastic: float  # work lost for good
    first_difference: float  # between 1 and 2 ranks, largest over the spheres, a quarter through the scene
    last_difference: float
    energy_difference: float
    passed: bool = True
    reason: str = ""


def differences(one: np.ndarray, two: np.ndarray, radius: float) -> np.ndarray:
    """Largest distance of the same sphere in two runs, over the radius, per frame."""
    return np.asarray(np.abs(one[:, :, 1:4] - two[:, :, 1:4]).max(axis=(1, 2)) / radius)


def judge_scene(scene: Assembly, tool: LiggghtsAssemblies, folder: Path, *, ranks: int = 2) -> BulkVerdict:
    """Run a scene on 1 and on `ranks` ranks and check it. Raises EngineError if the engine fails."""
    plan = AssemblyPlan(scene, scene.time_step(), FRAMES)
    tool.write(plan, folder)
    begin = time.perf_counter()
    tool.run(folder)
    seconds = time.perf_counter() - begin
    table, one = energy_balance(plan, tool, folder), tool.frames(folder)
    tool.write(replace(plan, contacts=False), folder / "ranks")
    tool.run(folder / "ranks", ranks=ranks)
    two = tool.frames(folder / "ranks")
    brought = table["kinetic"].iloc[0] + table["brought"].iloc[-1]
    apart = differences(one, two, scene.radius)
    kinetic = [(0.5 * scene.mass * run[-1, :, 4:7] ** 2).sum() for run in (one, two)]
    v = BulkVerdict(
        scene.name,
        scene.law,
        len(scene.position),
        plan.steps,
        seconds,
        len(scene.position) - one.shape[1],
        float(table["total"].diff().max() / brought),
        float((table["total"] - table["total"].iloc[0]).abs().max() / brought),
        float(table["plastic"].iloc[-1] / brought),
        float(apart[len(apart) // 4]),
        float(apart[-1]),
        float(abs(kinetic[1] / kinetic[0] - 1)),
    )
    reasons = []
    if v.lost:
        reasons.append(f"{v.lost} spheres lost")
    if not v.rise <= SWING:
        reasons.append(f"total energy rises by {v.rise:.2g}")
    if not v.off <= SWING:
        reasons.append(f"total energy is off by {v.off:.2g}")
    growth = apart[1:] / np.maximum(apart[:-1], 1e-16)
    if not growth.max() <= GROWTH:
        reasons.append(f"ranks part by a factor {growth.max():.2g} from one frame to the next")
    if not v.energy_difference <= AGREE:
        reasons.append(f"kinetic energies of the ranks differ by {v.energy_difference:.2g}")
    v.passed, v.reason = not reasons, "; ".join(reasons)
    return v


def run(laws: list[str], *, progress: Callable[[str], None] = lambda text: None) -> pd.DataFrame:
    """The verdicts on every scene with every law, one row each. Raises EngineError."""
    tool, rows = assembly_engine(), []
    with tempfile.TemporaryDirectory(prefix="epdem-bulk-") as scratch:
        for name, build in SCENES.items():
            for law in laws:
                progress(f"{name}, {law}")
                rows.append(vars(judge_scene(with_law(build(), law), tool, Path(scratch))))
                shutil.rmtree(scratch)
                Path(scratch).mkdir()
    return pd.DataFrame(rows)
