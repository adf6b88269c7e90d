# SPDX-License-Identifier: GPL-2.0-or-later
"""Every contact of a frame: overlap and largest overlap from the engine, all other quantities from the law."""

import math
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd

from ..case.scene import SceneCase
from ..errors import EngineError
from ..laws.library import Law
from ..theory.adhesion import plastic_work
from ..theory.backbones import JKR
from ..theory.numerics import gauss
from .model import pair_law
from .plan import ScenePlan

Array = npt.NDArray[np.float64]

BY_LAW = ["force", "residual_overlap", "dent_radius", "plastic_work", "elastic_energy"]
_NODES, _WEIGHTS = gauss(16)  # on [0, 1]


def columns(p: ScenePlan) -> list[str]:
    """The columns of the table of contacts."""
    return ["step", "wall", "i", "j", "overlap", "delta_max", *["added_overlap"] * p.model.compaction, *BY_LAW]


def complete(p: ScenePlan, raw: pd.DataFrame, spheres: pd.DataFrame, folder: Path) -> pd.DataFrame:
    """One row per contact and frame, with all that follows by the law, sorted; SI.

    raw: step, wall, i, j, overlap, delta_max; i < j are ids of spheres, or j = 0 and `wall` the name of a wall; with
    adhesion also whether the bodies are attached, for they may overlap in a dent without a contact; with compaction
    added_overlap, with which the law's overlaps are larger than those of the spheres.
    spheres: the particles' table. Raises EngineError, which names `folder`, for a contact of spheres that it lacks.
    """
    if raw.empty:
        return pd.DataFrame(columns=columns(p))
    known = spheres.set_index(["step", "id"])[["radius", "type"]]
    first = known.reindex(pd.MultiIndex.from_frame(raw[["step", "i"]].astype("int64")))
    second = known.reindex(pd.MultiIndex.from_frame(raw[["step", "j"]].astype("int64")))
    unknown = first["radius"].isna().to_numpy() | (second["radius"].isna().to_numpy() & (raw["j"] != 0).to_numpy())
    unknown |= (raw["j"] == 0).to_numpy() & (raw["wall"] == "").to_numpy()
    if unknown.any():
        step = int(raw["step"][unknown].iloc[0])
        raise EngineError(f"{folder}: the contacts of step {step} are damaged: no such spheres; run the case again")
    radius_j = second["radius"].fillna(math.inf).to_numpy()
    type_j = np.where(raw["j"] == 0, raw["wall"].map(p.wall_types), second["type"]).astype(int)
    radius_i, type_i = first["radius"].to_numpy(), first["type"].to_numpy(int)
    R_star = 1.0 / (1.0 / radius_i + 1.0 / radius_j)
    attached = raw["attached"].to_numpy(bool) if "attached" in raw else np.ones(len(raw), bool)
    added = raw["added_overlap"].to_numpy() if p.model.compaction else 0.0
    overlap, largest = raw["overlap"].to_numpy() + added, raw["delta_max"].to_numpy() + added
    law = energies(p, type_i, type_j, R_star, overlap, largest, attached)
    table = raw[columns(p)[: -len(BY_LAW)]].reset_index(drop=True).join(law)
    table = table.astype({"step": "int64", "i": "int64", "j": "int64"})
    return table.sort_values(["step", "wall", "i", "j"], kind="stable").reset_index(drop=True)


def energies(
    p: ScenePlan,
    type_i: Array,
    type_j: Array,
    R_star: Array,
    overlap: Array,
    delta_max: Array,
    attached: npt.NDArray[np.bool_],
) -> pd.DataFrame:
    """force, residual_overlap, dent_radius, plastic_work, elastic_energy of contacts; arrays of shape (n,)."""
    out = pd.DataFrame(0.0, index=range(len(overlap)), columns=BY_LAW)
    material = ["", *(t.material for t in p.model.types)]
    low, high = np.minimum(type_i, type_j), np.maximum(type_i, type_j)
    keys = pd.DataFrame({"a": low, "b": high})
    for (a, b), rows in keys.groupby(["a", "b"]).groups.items():
        at = rows.to_numpy()
        values = _one_kind(p.case, material[a], material[b], R_star[at], overlap[at], delta_max[at], attached[at])
        for name, value in values.items():
            out.loc[at, name] = value
    return out


def _one_kind(
    case: SceneCase, a: str, b: str, R: np.ndarray, overlap: np.ndarray, largest: np.ndarray, attached: np.ndarray
) -> dict[str, np.ndarray]:
    """Contacts of one pair of materials; R* [m] and the other arrays have the shape (n,)."""
    spec, E_star = pair_law(case, a, b)
    theory = spec.theory(E_star=E_star, R_star=R)
    if isinstance(theory, JKR):
        return _with_adhesion(theory, overlap, np.maximum(largest, overlap), attached)
    law = Law(spec.name, E_star=E_star, **spec.parameters)
    largest = np.maximum(largest, overlap)
    force, _, _ = law.step(R_star=R, delta_max=largest, delta=overlap)
    _, dent, _, plastic = law.backbone(R_star=R, delta=largest)
    residual = np.asarray(theory.residual_overlap(largest), float) * (plastic > 0.0)
    # elastic energy: the force below delta_max, integrated from where it begins; squared nodes take its root away there
    way = np.maximum(overlap - residual, 0.0)
    delta = residual[:, None] + way[:, None] * _NODES**2
    at_nodes = [np.broadcast_to(x[:, None], delta.shape).ravel() for x in (R, largest)]
    F, _, _ = law.step(R_star=at_nodes[0], delta_max=at_nodes[1], delta=delta.ravel())
    elastic = 2.0 * (F.reshape(delta.shape) * _NODES * _WEIGHTS).sum(axis=1) * way  # 2 from the square
    return {
        "force": force,
        "residual_overlap": residual,
        "dent_radius": np.where(plastic > 0.0, dent, 0.0),
        "plastic_work": plastic,
        "elastic_energy": elastic,
    }


def _with_adhesion(law: JKR, overlap: np.ndarray, largest: np.ndarray, attached: np.ndarray) -> dict[str, np.ndarray]:
    top = np.maximum(law.radius(largest), law.touch_radius)
    branch, dent = law.branch(top)
    dented = dent > 0
    a = np.where(attached, branch.radius(overlap - dent), 0.0)
    return {
        "force": np.where(attached, branch.force(a), 0.0),
        "residual_overlap": dent,
        "dent_radius": np.where(dented, top, 0.0),
        "plastic_work": plastic_work(law, top),
        "elastic_energy": np.where(attached, branch.energy(a), 0.0),
    }
