# SPDX-License-Identifier: GPL-2.0-or-later
"""The trajectory of impacts and the tables of a scene from LIGGGHTS's files, whose formats are in `dump`."""

import math
from collections.abc import Collection
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from ...errors import EngineError
from ...impacts import engine as impacts
from ...impacts.engine import Trajectory
from ...impacts.plan import Plan
from ...scenes import columns
from ...scenes.plan import ScenePlan
from .. import log
from ..host import frames
from . import dump
from .deck import PATH
from .launcher import OUT
from .primitives import overlaps, tubes, walls

PARTICLES, PAIRS, MESHES = "particles.{}.bin", "contacts.{}.txt", "wall_contacts.{}.txt"
FILES = "stress_{}.{}.vtk"  # wall, step
COLUMNS = {"meshid": "triangle", "area": "area", "normal_stress_average": "normal_stress"}
COLUMNS |= {"shear_stress_average": "shear_stress", "wear": "wear"}

END = "end.bin"  # dump of impacts at their end


def trajectory(plan: Plan, folder: Path, seconds: dict[str, float]) -> Trajectory:
    """Overlap, force and approach velocity from z, vz, fz of every body. Raises EngineError if samples are missing."""
    path = folder / PATH
    try:
        place, velocity, force = np.moveaxis(dump.series(path), 2, 0)[:, None]
        found, bodies = place.shape[1:], plan.n if math.isinf(plan.experiment.target.radius) else 2 * plan.n
        if found != (plan.steps + 1, bodies):
            raise ValueError(f"{found[0]} frames of {found[1]} bodies, expected {plan.steps + 1} of {bodies}")
        vx, spin = dump.series(folder / END)[-1].T if plan.experiment.oblique else (None, None)
    except (ValueError, IndexError) as error:
        raise EngineError(f"{path}: the run left an incomplete dump ({error}); see {OUT} beside it") from None
    return impacts.trajectory(plan, place, velocity, force, seconds, vx, spin)


def _frame(path: Path, count: int) -> np.ndarray:
    """(n, count) of a binary dump of one frame, sorted by id. Raises EngineError if it is not whole."""
    found = dump.frames(path)
    if len(found) != 1 or found[0][1].shape[1] != count:
        raise EngineError(f"{path}: not one frame of {count} columns; run the case again")
    return found[0][1]


def rows(p: ScenePlan, out: Path) -> pd.DataFrame:
    """The rows of a run; the log has the forces of primitives on the spheres. Raises EngineError."""
    return log.scene_rows(p, out, {w.name for w in walls(p)} & {*p.measured_walls})


def _meshes(p: ScenePlan) -> list[str]:
    """Names of the walls of triangles, in the order of their numbers."""
    formulas = tubes(p)
    return [name for name in p.scene.meshes if name not in formulas]


def damaged(p: ScenePlan, folder: Path, upto: int) -> list[int]:
    """Steps up to `upto` of which a frame is missing or not whole."""
    steps, kinds = set(), {PARTICLES: p.frames, PAIRS: p.contacts, MESHES: p.contacts if _meshes(p) else 0}
    for kind, every in kinds.items():
        for step in (n for n in (p.frame_steps(every) if every else []) if n <= upto):
            path = folder / kind.format(step)
            try:
                _frame(path, len(_particle_names(p))) if kind == PARTICLES else dump.local(path)
            except EngineError:
                steps.add(step)
    return sorted(steps)


def _particle_names(p: ScenePlan) -> list[str]:
    names = [*columns.PARTICLES, *(columns.SPINS if p.model.spins else [])]
    values = [*_slots(p), *columns.FORCE]
    names += [f"{value}_{w.name}" for w in walls(p) for value in values] if p.contacts else []
    return [*names, *p.works]


def _slots(p: ScenePlan) -> list[str]:
    """The columns of `deck.history_columns`."""
    return ["delta_max"] * p.model.yields + ["attached"] * p.model.adheres + [*columns.GROWTH] * p.model.compaction


def particles(p: ScenePlan, folder: Path, without: Collection[int] = ()) -> pd.DataFrame:
    """Every particle of every frame, without the steps `without`, sorted by step and id.

    Raises EngineError for a frame that is not whole.
    """
    names = _particle_names(p)

    def read(path: Path) -> pd.DataFrame:
        return pd.DataFrame(_frame(path, len(names)), columns=names)

    return columns.whole(p, frames(p, folder, PARTICLES, p.frames, read, without), folder)


def _local(p: ScenePlan, kind: str, folder: Path, ids: list[str], without: Collection[int]) -> pd.DataFrame:
    """The rows of a `dump local`, by step: `ids`, delta_max and overlap [m], force [N] on the first body, at walls the
    normal; what only comes near is left out."""
    names = [*ids, *_slots(p), "overlap", *columns.FORCE, *(columns.NORMAL if kind == MESHES else [])]

    def read(path: Path) -> pd.DataFrame:
        values = dump.local(path)
        if len(values) and values.shape[1] != len(names):
            raise EngineError(f"{path}: {values.shape[1]} columns, expected {len(names)}")
        return pd.DataFrame(values.reshape(-1, len(names)), columns=names)

    table = frames(p, folder, kind, p.contacts, read, without)
    return _in_contact(table if p.model.yields else table.assign(delta_max=table["overlap"]))


def _in_contact(table: pd.DataFrame) -> pd.DataFrame:
    """The rows of bodies that overlap, growth included, or are attached; `attached` becomes a bool."""
    if "attached" not in table:
        return table[table["overlap"] + table.get("added_overlap", 0.0) > 0]
    table = table.assign(attached=table["attached"] > 0)
    return table[(table["overlap"] > 0) | table["attached"]]


def _pairs(p: ScenePlan, folder: Path, without: Collection[int]) -> pd.DataFrame:
    table = _local(p, PAIRS, folder, ["i", "j"], without).assign(wall="")
    # LIGGGHTS's order of the two is arbitrary, and another one after a restart
    table.loc[table["i"] > table["j"], columns.FORCE] *= -1.0
    return table.assign(i=table[["i", "j"]].min(axis=1), j=table[["i", "j"]].max(axis=1))


def _primitives(p: ScenePlan, spheres: pd.DataFrame) -> list[pd.DataFrame]:
    """Contacts with walls that are a formula: overlap by it, its largest value from LIGGGHTS's memory of the wall."""
    found = []
    for w in walls(p):
        overlap, normal = overlaps(w, spheres)
        largest = np.maximum(spheres[f"delta_max_{w.name}"], overlap) if p.model.yields else overlap
        values = {"step": spheres["step"], "wall": w.name, "i": spheres["id"], "j": 0, "overlap": overlap}
        others = {slot: spheres[f"{slot}_{w.name}"] for slot in [*_slots(p), *columns.FORCE] if slot != "delta_max"}
        others |= {column: normal[:, k] for k, column in enumerate(columns.NORMAL)}
        found.append(_in_contact(pd.DataFrame(values | {"delta_max": largest} | others)))
    return found


def contact_table(p: ScenePlan, folder: Path, spheres: pd.DataFrame, without: Collection[int] = ()) -> pd.DataFrame:
    """Every contact of every frame; `spheres` is the particles' table, which loses the forces of the primitives.

    Raises EngineError as `particles` does.
    """
    parts = [_pairs(p, folder, without), *_primitives(p, spheres)]
    for name in [f"{force}_{w.name}" for w in walls(p) for force in columns.FORCE]:
        del spheres[name]
    if names := _meshes(p):
        touched = _local(p, MESHES, folder, ["mesh", "i"] if len(names) > 1 else ["i"], without)
        wall = [names[int(k)] for k in touched["mesh"]] if len(names) > 1 else names[0]
        length = np.linalg.norm(touched[columns.NORMAL], axis=1)  # of the normal force: 0 without force
        touched[columns.NORMAL] = touched[columns.NORMAL].div(np.where(length > 0.0, length, 1.0), axis=0)
        parts.append(touched.assign(j=0, wall=wall))
    raw = pd.concat([part for part in parts if len(part)] or parts[:1], ignore_index=True)
    found = columns.complete(p, raw, spheres, folder)
    found.loc[found["wall"].isin(names) & (found["force"] < 0.0), columns.NORMAL] *= -1.0  # attraction
    return found


def _fields(path: Path) -> dict[str, np.ndarray]:
    """The numbers of each triangle in a file of LIGGGHTS's `dump mesh/vtk`, sorted by their ids."""
    lines = path.read_text(encoding="ascii").partition("FieldData")[2].splitlines()[1:]
    words: dict[str, list[str]] = {}
    name = ""
    for line in lines:
        if line[:1].isalpha():
            name = line.split()[0]
            words[name] = []
        else:
            words[name] += line.split()
    count = len(words["area"])
    found = {name: np.array(values, float).reshape(count, -1) for name, values in words.items()}
    order = np.argsort(found["meshid"][:, 0])
    return {name: values[order, 0] for name, values in found.items()}


def wall_table(p: ScenePlan, folder: Path, without: Collection[int] = ()) -> pd.DataFrame:
    """step, wall, triangle, area, normal_stress, shear_stress, wear (0 where not requested) in every frame.

    Raises EngineError for a file that is not whole.
    """

    def read(name: str, path: Path) -> pd.DataFrame:
        fields = _fields(path)
        columns = {ours: fields.get(theirs, np.zeros(len(fields["area"]))) for theirs, ours in COLUMNS.items()}
        if len(columns["area"]) != len(p.triangles[name]):
            raise EngineError(f"{path}: {len(columns['area'])} triangles, expected {len(p.triangles[name])}")
        return pd.DataFrame({"wall": name} | columns)

    files = {name: FILES.format(name, "{}") for name in p.stress_walls}
    walls = [frames(p, folder, file, p.frames, partial(read, name), without) for name, file in files.items()]
    return pd.concat(walls, ignore_index=True).astype({"triangle": int})
