# SPDX-License-Identifier: GPL-2.0-or-later
"""Write and run stiff bulk scenes in LIGGGHTS and compute their energy balance."""

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd

from ...base import rendering as decks
from ...lammps import data_file
from ...laws.library import laws
from ...liggghts import dump, launcher, log, stl
from ...liggghts.properties import SOFT, elastic, per_pair, strength
from .scenes import DENSITY, POISSON, Scene
from .two_walls import stored

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
) -> SimpleNamespace:
    """Deck, data and meshes of a scene; returns what the template saw.

    Without `frames` nothing is recorded or booked. `model`: one of LIGGGHTS's own, elastic ones instead of the law's.
    """
    folder.mkdir(parents=True, exist_ok=True)
    steps = math.ceil(scene.duration / time_step)
    every = max(1, steps // (frames or 1))
    law = laws()[scene.law]
    moduli = [E for E, _ in scene.materials]
    properties = [*elastic(moduli, [POISSON] * len(moduli))]
    if law.strength:
        properties += strength(scene.law, [scene.strength(p_y) for _, p_y in scene.materials])
    if model:
        properties.append(per_pair("coefficientRestitution", len(moduli), 1.0, "-", "undamped"))
    memory = law.memory
    deck = SimpleNamespace(
        title=scene.title,
        plates=scene.plate_speed > 0,
        plate_speed=scene.plate_speed,
        soft=min(moduli) < SOFT,
        skin=0.25 * scene.radius,
        properties=properties,
        model=model or f"ep/{scene.law}",
        tangential="off",
        time_step=time_step,
        steps=every * math.ceil(steps / every),
        every=every,
        frames=frames,
        contacts=contacts,
        history=memory > 0,
        pair_columns=range(1, 6 + memory + (memory > 0) + 2),
        wall_columns=range(1, 6 + memory + 2),
        settings=("computePlasticWork on",) if memory and frames else (),
    )
    (folder / "in.bulk").write_text(decks.render("liggghts/stiff_bulk.in.j2", deck=deck), encoding="utf-8")
    (folder / "bulk.data").write_text(_data(scene, deck.plates), encoding="utf-8")
    if deck.plates:
        for name, z in (("floor", 0.0), ("plate", float(scene.box[2]))):
            (folder / f"{name}.stl").write_text(
                stl.text(name, _square(float(scene.box[0]), float(scene.box[1]), z)), encoding="utf-8"
            )
    return deck


def _data(scene: Scene, plates: bool) -> str:
    margin = 0.5 * scene.radius if plates else 0.0  # the box is wider than the gap between the plates
    (lx, ly, lz), kinds = map(float, scene.box), len(scene.materials)
    box = [(0.0, lx), (0.0, ly), (-margin, lz + margin)]
    return data_file.text(
        scene.title,
        kinds,
        box,
        [
            data_file.Spheres(int(kind), 2 * scene.radius, DENSITY, place[None], velocity[None])
            for kind, place, velocity in zip(scene.kind, scene.position, scene.velocity, strict=True)
        ],
    )


def _square(lx: float, ly: float, z: float) -> np.ndarray:
    """Two triangles of the rectangle from the origin to (lx, ly) at height z."""
    corners = np.array([[0.0, 0.0, z], [lx, 0.0, z], [lx, ly, z], [0.0, ly, z]])
    return corners[[[0, 1, 2], [0, 2, 3]]]


def execute(folder: Path, *, ranks: int = 1, seconds: float = LIMIT) -> float:
    """Run in.bulk; the engine's own loop time [s]. Raises EngineError if it fails or exceeds the time limit."""
    launcher.run("in.bulk", folder, ranks=ranks, log=launcher.LOG, seconds=seconds)
    return log.loop_seconds(folder / launcher.LOG)


def frames(folder: Path) -> np.ndarray:
    """Type, position (3), velocity (3) and, if the law yields, plastic work [J] of all spheres: (frames, n, 7 or 8)."""
    return dump.series(folder / "atoms.bin")


def _elastic(scene: Scene, folder: Path, step: int, frame: np.ndarray, kind: str) -> float:
    """Elastic energy [J] in the contacts of a frame; kind: pairs or walls."""
    table = dump.local(folder / f"{kind}.{step}.txt")
    if not table.size:
        return 0.0
    alpha, walls = table[:, -1], kind == "walls"
    top = np.maximum(table[:, 6] if laws()[scene.law].memory else alpha, alpha)
    spheres = table[:, [2]] if walls else table[:, :2]
    types = frame[spheres.astype(int) - 1, 0].astype(int)
    if walls:
        types = np.hstack([types, np.ones_like(types)])
    energy = 0.0
    for i, j in {(int(i), int(j)) for i, j in types}:
        theory, here = scene.theory(i, j, plate=walls), (types == (i, j)).all(axis=1)
        energy += float((stored(theory, alpha[here], top[here]) - theory.plastic_work(top[here])).sum())
    return energy


def ledger(scene: Scene, deck: SimpleNamespace, folder: Path) -> pd.DataFrame:
    """Energies at every frame [J]: kinetic, elastic (theory's, from overlap and memory of each contact), plastic (what
    the plugin has booked), brought in by the plate; no term is the remainder. `total` is their sum.
    """
    memory = laws()[scene.law].memory
    atoms = frames(folder)
    rows, brought = [], 0.0
    push = _pushes(folder) if deck.plates else {}
    for k, frame in enumerate(atoms):
        step = k * deck.every
        kinetic = 0.5 * scene.mass * float((frame[:, 4:7] ** 2).sum())
        kinds = ("pairs", "walls") if deck.plates else ("pairs",)
        elastic = sum(_elastic(scene, folder, step, frame, kind) for kind in kinds)
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
    rows = log.rows(folder / launcher.LOG)
    return {int(step): (mean, now) for step, mean, now in rows[["Step", "push", "plate[3]"]].to_numpy()}
