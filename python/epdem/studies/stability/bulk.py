# SPDX-License-Identifier: GPL-2.0-or-later
"""Write and run stiff bulk scenes in LIGGGHTS and keep their energy ledger."""

import math
import os
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd

from ... import paths
from ... import rendering as decks
from ...laws import library as claw
from ...liggghts.impacts import SOFT, loop_seconds, numbered, read_dump
from ...processes import call
from .running import plastic
from .scenes import DENSITY, POISSON, STRENGTH, Scene
from .squeezed import stored

FRAMES = 40
LIMIT = 120.0  # seconds a scene may take


def write(
    scene: Scene,
    folder: Path,
    *,
    time_step: float,
    frames: int = FRAMES,
    contacts: bool = True,
    model: str | None = None,
):
    """Deck, data and meshes of a scene; returns what the template saw.

    Without `frames` nothing is recorded or booked. `model`: one of LIGGGHTS's own, elastic ones instead of the law's.
    """
    folder.mkdir(parents=True, exist_ok=True)
    steps = math.ceil(scene.duration / time_step)
    every = max(1, steps // (frames or 1))
    info = claw.laws()[scene.law]
    moduli = [E for E, _ in scene.materials]
    rows = [("youngsModulus", "peratomtype", moduli, "Pa")]
    rows += [("poissonsRatio", "peratomtype", [POISSON] * len(moduli), "1")]
    rows += [
        (p.property, "peratomtype", [STRENGTH[p.property] * p_y for _, p_y in scene.materials], "Pa")
        for p in info.parameters
        if p.unit == "Pa"
    ]
    if model:
        rows.append(("coefficientRestitution", "peratomtypepair", [len(moduli), *[1.0] * len(moduli) ** 2], "undamped"))
    memory = memory_size(scene.law)
    deck = SimpleNamespace(
        title=scene.title,
        plates=scene.plate_speed > 0,
        plate_speed=scene.plate_speed,
        soft=min(moduli) < SOFT,
        skin=0.25 * scene.radius,
        properties=numbered(rows),
        model=model or f"ep/{scene.law}",
        tangential="off",
        time_step=time_step,
        steps=every * math.ceil(steps / every),
        every=every,
        frames=frames,
        contacts=contacts,
        pair_columns=range(1, 6 + memory + (memory > 0) + 2),
        wall_columns=range(1, 6 + memory + 2),
        settings=("computePlasticWork on",) if memory and frames else (),
    )
    environment = decks.environment(Path(__file__).parent)
    (folder / "in.bulk").write_text(environment.get_template("bulk.in.j2").render(deck=deck))
    (folder / "bulk.data").write_text(_data(scene, deck.plates))
    if deck.plates:
        for name, z in (("floor", 0.0), ("plate", float(scene.box[2]))):
            (folder / f"{name}.stl").write_text(_square(name, scene.box[0], scene.box[1], z))
    return deck


def memory_size(law: str) -> int:
    """How many numbers a contact of that law remembers in LIGGGHTS."""
    return {"hertz": 0, "cavity": 4}.get(law, 1)


def _data(scene: Scene, plates: bool) -> str:
    number, R = decks.number, scene.radius
    margin = 0.5 * R if plates else 0.0  # the box is wider than the gap between the plates
    head = [scene.title, "", f"{len(scene.position)} atoms", f"{len(scene.materials)} atom types"]
    head += [
        f"{number(-margin * (a == 'z'))} {number(float(b) + margin * (a == 'z'))} {a}lo {a}hi"
        for a, b in zip("xyz", scene.box, strict=True)
    ]
    atoms = [
        f"{i} {k} {number(2 * R)} {number(DENSITY)} {' '.join(map(number, p))}"
        for i, (k, p) in enumerate(zip(scene.kind, scene.position, strict=True), 1)
    ]
    speeds = [f"{i} {' '.join(map(number, v))} 0 0 0" for i, v in enumerate(scene.velocity, 1)]
    return "\n".join([*head, "", "Atoms", "", *atoms, "", "Velocities", "", *speeds, ""])


def _square(name: str, lx: float, ly: float, z: float) -> str:
    corners = [(0.0, 0.0), (lx, 0.0), (lx, ly), (0.0, ly)]
    lines = [f"solid {name}"]
    for triangle in ((0, 1, 2), (0, 2, 3)):
        vertices = [f"vertex {' '.join(map(decks.number, (*corners[i], z)))}" for i in triangle]
        lines += ["facet normal 0 0 1", "outer loop", *vertices, "endloop", "endfacet"]
    return "\n".join([*lines, f"endsolid {name}", ""])


def execute(folder: Path, *, ranks: int = 1, seconds: float = LIMIT) -> float:
    """Run in.bulk; the engine's own loop time [s]. Raises EngineError if it fails or exceeds the time limit."""
    command = [str(paths.launcher()), "-in", "in.bulk", "-log", "log.liggghts"]
    if ranks > 1:
        extra = ["--allow-run-as-root"] if os.geteuid() == 0 else []
        command = ["mpirun", "-np", str(ranks), "--oversubscribe", *extra, *command]
    # waiting ranks give way: on a busy machine they would otherwise take the time of those that work
    env = dict(os.environ) | {"OMP_NUM_THREADS": "1", "OMPI_MCA_mpi_yield_when_idle": "1"}
    call(command, folder, log="out.liggghts", seconds=seconds, env=env)
    return loop_seconds(folder / "log.liggghts")


def frames(folder: Path, law: str) -> np.ndarray:
    """Type, position (3), velocity (3) and, if the law yields, plastic work [J] of all spheres: (frames, n, 7 or 8)."""
    return read_dump(folder / "atoms.bin", 9 if memory_size(law) else 8)


def _local(folder: Path, kind: str, step: int) -> np.ndarray:
    """Rows of a local dump at a step; empty if there are none."""
    lines = (folder / f"{kind}.{step}.txt").read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("ITEM: ENTRIES")) + 1
    return np.array([line.split() for line in lines[start:]], float)


def _elastic(theory, alpha: np.ndarray, top: np.ndarray) -> float:
    """Elastic energy in contacts of one pair of types [J]."""
    return float((stored(theory, alpha, top) - plastic(theory, top)).sum())


def ledger(scene: Scene, deck: SimpleNamespace, folder: Path) -> pd.DataFrame:
    """Energies at every frame [J]: kinetic, elastic (theory's, from overlap and memory of each contact), plastic (what
    the plugin has booked), brought in by the plate; no term is the remainder. `total` is their sum.
    """
    memory = memory_size(scene.law)
    atoms = frames(folder, scene.law)
    rows, brought = [], 0.0
    push = _pushes(folder) if deck.plates else {}
    for k, frame in enumerate(atoms):
        step = k * deck.every
        kinetic = 0.5 * scene.mass * float((frame[:, 4:7] ** 2).sum())
        elastic = 0.0
        for kind, first in (("pairs", 6), ("walls", 6)):
            if kind == "walls" and not deck.plates:
                continue
            table = _local(folder, kind, step)
            if not table.size:
                continue
            alpha = table[:, -1]
            top = np.maximum(table[:, first] if memory else alpha, alpha)
            ids = table[:, :2].astype(int) - 1 if kind == "pairs" else None
            i = frame[ids[:, 0], 0] if kind == "pairs" else frame[table[:, 2].astype(int) - 1, 0]
            j = frame[ids[:, 1], 0] if kind == "pairs" else np.ones_like(i)
            for a, b in {(int(p), int(q)) for p, q in zip(i, j, strict=True)}:
                chosen = (i == a) & (j == b)
                elastic += _elastic(scene.theory(a, b, plate=kind == "walls"), alpha[chosen], top[chosen])
        if k and deck.plates:
            # trapezoids: the mean is over the steps since the last frame, the two ends count half
            ends = 0.5 * (push[step][1] - push[step - deck.every][1])
            brought += (push[step][0] * deck.every - ends) * scene.plate_speed * deck.time_step
        rows.append(
            {
                "step": step,
                "spheres": len(frame),
                "kinetic": kinetic,
                "elastic": elastic,
                "plastic": float(frame[:, 7].sum()) if memory else 0.0,
                "brought": brought,
            }
        )
    table = pd.DataFrame(rows)
    table["total"] = table["kinetic"] + table["elastic"] + table["plastic"] - table["brought"]
    return table


def _pushes(folder: Path) -> dict[int, tuple[float, float]]:
    """Force of the spheres on the plate [N] by step, upward positive: mean since the last frame, and now."""
    found = {}
    for line in (folder / "log.liggghts").read_text().splitlines():
        words = line.split()
        if len(words) == 5 and words[0].isdigit() and words[1].isdigit():
            found[int(words[0])] = (float(words[3]), float(words[4]))
    return found
