# SPDX-License-Identifier: GPL-2.0-or-later
"""Every contact of a frame: overlap and its largest value from the engine's memory; what follows by the law."""

import math
from pathlib import Path

import numpy as np
import pandas as pd

from ..case.scene import SceneCase
from ..laws.library import laws
from ..liggghts import scene_tables as tables
from ..liggghts.scene_deck import Deck
from ..theory import backbones, pair
from .model import pair_law, strengths

COLUMNS = [
    "step",
    "wall",
    "i",
    "j",
    "overlap",
    "delta_max",
    "force",
    "residual_overlap",
    "dent_radius",
    "plastic_work",
    "elastic_energy",
]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)


def contacts(case: SceneCase, deck: Deck, folder: Path, spheres: pd.DataFrame) -> pd.DataFrame:
    """One row per contact and frame, SI; i < j, or `j` = 0 and `wall` its name for a wall.

    `spheres` is the particles' table.
    """
    parts = [_pairs(deck, folder), *_planes(deck, spheres)]
    if deck.meshes:
        parts.append(_meshes(deck, folder))
    raw = pd.concat([p for p in parts if len(p)], ignore_index=True) if any(len(p) for p in parts) else None
    if raw is None:
        return pd.DataFrame(columns=COLUMNS)
    return complete(case, deck, raw, spheres)


def complete(case: SceneCase, deck: Deck, raw: pd.DataFrame, spheres: pd.DataFrame) -> pd.DataFrame:
    """`raw` (step, wall, i, j, overlap, delta_max) with all that follows by the law, sorted."""
    known = spheres.set_index(["step", "id"])[["radius", "type"]]
    first = known.reindex(pd.MultiIndex.from_frame(raw[["step", "i"]].astype("int64")))
    second = known.reindex(pd.MultiIndex.from_frame(raw[["step", "j"]].astype("int64")))
    radius_j = second["radius"].fillna(math.inf).to_numpy()
    type_j = second["type"].fillna(deck.wall_type).to_numpy(int)
    radius_i, type_i = first["radius"].to_numpy(), first["type"].to_numpy(int)
    R_star = 1.0 / (1.0 / radius_i + 1.0 / radius_j)
    law = energies(case, deck, type_i, type_j, R_star, raw["overlap"].to_numpy(), raw["delta_max"].to_numpy())
    table = raw[["step", "wall", "i", "j", "overlap", "delta_max"]].reset_index(drop=True).join(law)
    table = table.astype({"step": "int64", "i": "int64", "j": "int64"})
    return table[COLUMNS].sort_values(["step", "wall", "i", "j"], kind="stable").reset_index(drop=True)


def energies(case: SceneCase, deck: Deck, type_i, type_j, R_star, overlap, delta_max) -> pd.DataFrame:
    """force, residual_overlap, dent_radius, plastic_work, elastic_energy of contacts; arrays of shape (n,)."""
    out = pd.DataFrame(0.0, index=range(len(overlap)), columns=COLUMNS[6:])
    material = [None, *(_material(case, name) for name in deck.types)]
    low, high = np.minimum(type_i, type_j), np.maximum(type_i, type_j)
    keys = pd.DataFrame({"a": low, "b": high, "R": R_star})
    for (a, b, R), rows in keys.groupby(["a", "b", "R"]).groups.items():
        at = rows.to_numpy()
        values = _one_kind(case, material[a], material[b], float(R), overlap[at], delta_max[at])
        for name, value in values.items():
            out.loc[at, name] = value
    return out


def _material(case: SceneCase, name: str) -> str:
    return case.scene.walls if name == "wall" else name


def _theory(case: SceneCase, a: str, b: str, R_star: float):
    first, second = case.materials[a], case.materials[b]
    elastic = (first.young_modulus, first.poisson_ratio, second.young_modulus, second.poisson_ratio)
    cls, strong = backbones.LAWS[case.law.name], strengths(case)
    values = {p.name: case.law.parameters().get(p.name, p.default) for p in laws()[case.law.name].parameters}
    for p in laws()[case.law.name].parameters:
        if p.unit == "Pa":
            values[p.name] = min(strong[a], strong[b])
    keywords = {cls.keywords[name]: float(value) for name, value in values.items()}
    return cls(E_star=float(pair.E_star(*elastic)), R_star=R_star, **keywords)


def _one_kind(case: SceneCase, a: str, b: str, R: float, overlap: np.ndarray, largest: np.ndarray) -> dict:
    """Contacts of one pair of materials and one R* [m]."""
    law = pair_law(case, a, b)
    largest = np.maximum(largest, overlap)
    force, _, _ = law.step(R_star=R, delta_max=largest, delta=overlap)
    _, dent, _, plastic = law.backbone(R_star=R, delta=largest)
    residual = np.asarray(_theory(case, a, b, R).residual_overlap(largest), float) * (plastic > 0.0)
    # elastic energy: the force below delta_max, integrated from where it begins; u^2 takes its root away there
    way = np.maximum(overlap - residual, 0.0)
    u = 0.5 * (_NODES + 1.0)
    delta = residual[:, None] + way[:, None] * u**2
    F, _, _ = law.step(R_star=R, delta_max=np.broadcast_to(largest[:, None], delta.shape).ravel(), delta=delta.ravel())
    elastic = (F.reshape(delta.shape) * u * _WEIGHTS).sum(axis=1) * way  # 0.5 from the nodes, 2 from d(u^2)
    return {
        "force": force,
        "residual_overlap": residual,
        "dent_radius": np.where(plastic > 0.0, dent, 0.0),
        "plastic_work": plastic,
        "elastic_energy": elastic,
    }


def _pairs(deck: Deck, folder: Path) -> pd.DataFrame:
    names = ["i", "j", *(["delta_max"] if deck.yields else []), "overlap"]
    table = tables.local_frames(folder, "contacts.*.txt", names)
    if not deck.yields:
        table["delta_max"] = table.get("overlap")
    table["wall"] = ""
    # which of the two comes first is LIGGGHTS's own affair, and another one after a restart
    table["i"], table["j"] = table[["i", "j"]].min(axis=1), table[["i", "j"]].max(axis=1)
    return table[table["overlap"] > 0]


def _meshes(deck: Deck, folder: Path) -> pd.DataFrame:
    names = ["i", *(["delta_max"] if deck.yields else []), "overlap"]
    table = tables.local_frames(folder, "wall_contacts.*.txt", names)
    if not deck.yields:
        table["delta_max"] = table.get("overlap")
    table["j"], table["wall"] = 0, deck.meshes[0]
    return table[table["overlap"] > 0]


def _planes(deck: Deck, spheres: pd.DataFrame) -> list[pd.DataFrame]:
    """Contacts with flat walls: overlap by geometry, its largest value from LIGGGHTS's memory of the wall."""
    found = []
    for name, style, place in deck.planes:
        distance = (spheres[style[0]] - place).abs()
        touching = spheres[distance < spheres["radius"]]
        overlap = touching["radius"] - (touching[style[0]] - place).abs()
        largest = np.maximum(touching[f"delta_max_{name}"], overlap) if deck.yields else overlap
        found.append(
            pd.DataFrame(
                {
                    "step": touching["step"],
                    "wall": name,
                    "i": touching["id"],
                    "j": 0,
                    "overlap": overlap,
                    "delta_max": largest,
                }
            )
        )
    return found
