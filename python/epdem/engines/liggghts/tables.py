# SPDX-License-Identifier: GPL-2.0-or-later
"""The trajectory of impacts and the tables of a scene from LIGGGHTS's files, whose formats are in `dump`."""

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from ...case.walls import CylinderWall, PlaneWall
from ...errors import EngineError
from ...impacts import engine as impacts
from ...impacts.engine import Trajectory
from ...impacts.plan import Plan
from ...scenes.plan.plan import ScenePlan
from ...scenes.tables import columns
from .. import log
from ..frames import Frames, Kinds, text_frame
from . import dump
from .deck import PATH, history
from .launcher import OUT
from .primitives import overlaps, tubes, walls

COLUMNS = {"meshid": "triangle", "area": "area", "normal_stress_average": "normal_stress"}
COLUMNS |= {"shear_stress_average": "shear_stress", "wear": "wear"}

# of a contact with a triangle: where it is, and the centre of the sphere [m]
POINTS = [f"{x}_{point}" for point in ("contact", "sphere") for x in "xyz"]
END = "end.bin"  # dump of impacts at their end


def trajectory(plan: Plan, folder: Path, seconds: dict[str, float]) -> Trajectory:
    """Overlap, force and approach velocity from z, vz, fz of every body. Raises EngineError if samples are missing."""
    path = folder / PATH
    try:
        place, velocity, force = np.moveaxis(dump.series(path), 2, 0)[:, None]
        found = place.shape[1:]
        if found != (plan.steps + 1, plan.spheres):
            raise ValueError(f"{found[0]} frames of {found[1]} bodies, expected {plan.steps + 1} of {plan.spheres}")
        vx, spin = dump.series(folder / END)[-1].T if plan.experiment.oblique else (None, None)
    except (ValueError, IndexError) as error:
        raise EngineError(f"{path}: the run left an incomplete dump ({error}); see {OUT} beside it") from None
    return impacts.trajectory(plan, place, velocity, force, seconds, vx, spin)


def _frame(path: Path, names: list[str]) -> pd.DataFrame:
    """A binary dump of one frame, sorted by id. Raises EngineError if it is cut, ValueError if it has other columns."""
    ((_, rows),) = dump.frames(path)
    return pd.DataFrame(rows, columns=names)


def rows(p: ScenePlan, out: Path) -> pd.DataFrame:
    """The rows of a run; the log has the forces of primitives on the spheres. Raises EngineError."""
    return log.scene_rows(p, out, {w.name for w in walls(p)} & {*p.measured_walls})


def _meshes(p: ScenePlan) -> list[str]:
    """Names of the walls of triangles, in the order of their numbers."""
    formulas = tubes(p)
    return [name for name in p.scene.meshes if name not in formulas]


def kinds(p: ScenePlan) -> Kinds:
    """The files of frames: spheres; contacts between them and with walls of triangles, which have the columns of the
    law, the overlap [m], the force [N] on the first body and, at walls, the points POINTS; stresses on triangles."""
    found: dict[str, tuple[str, int, Callable[[Path], pd.DataFrame]]] = {}
    found["particles"] = "particles.{}.bin", p.frames, partial(_frame, names=_particle_names(p))
    values, meshes = [*history(p.model), "overlap", *columns.FORCE], _meshes(p)
    pairs, touched = ["i", "j", *values], [*["mesh"] * (len(meshes) > 1), "i", *values, *POINTS]
    found["contacts"] = "contacts.{}.txt", p.contacts, partial(text_frame, names=pairs)
    found["wall_contacts"] = "wall_contacts.{}.txt", p.contacts * (len(meshes) > 0), partial(text_frame, names=touched)
    for name in p.stress_walls:
        found[f"stress_{name}"] = f"stress_{name}.{{}}.vtk", p.frames, partial(_stresses, p, name)
    return {kind: (file, p.frame_steps(every), read) for kind, (file, every, read) in found.items() if every}


def _formulas(p: ScenePlan) -> dict[str, PlaneWall | CylinderWall]:
    """The walls that are a formula, last those that are not always there."""
    return {w.name: w for w in (*walls(p), *p.scene.gates)}


def _particle_names(p: ScenePlan) -> list[str]:
    names = columns.columns_of_spheres(p)
    values = [*history(p.model), *columns.FORCE]
    names += [f"{value}_{name}" for name in _formulas(p) for value in values] if p.contacts else []
    return [*names, *p.works]


def _primitives(p: ScenePlan, in_frames: pd.DataFrame) -> list[pd.DataFrame]:
    """Contacts with walls that are a formula: overlap by it, its largest value from LIGGGHTS's memory of the wall."""
    found, gates = [], {w.name for w in p.scene.gates}
    for w in _formulas(p).values():
        there = in_frames["step"].isin(p.frame_steps_with(w.name, p.frames))
        spheres = in_frames[there] if w.name in gates else in_frames
        overlap, normal = overlaps(w, spheres)
        values = {"step": spheres["step"], "wall": w.name, "i": spheres["id"], "j": 0, "overlap": overlap}
        others = {name: spheres[f"{name}_{w.name}"] for name in [*history(p.model), *columns.FORCE]}
        others |= {column: normal[:, k] for k, column in enumerate(columns.NORMAL)}
        found.append(columns.touching(p, pd.DataFrame(values | others)))  # of all spheres in all frames few do
    return found


def contacts(frames: Frames, spheres: pd.DataFrame) -> list[pd.DataFrame]:
    """Every contact of every frame; `spheres` loses the forces of the primitives and all that it has of gates."""
    p = frames.plan
    parts = [frames.table("contacts").assign(wall=""), *_primitives(p, spheres)]
    gates = {w.name for w in p.scene.gates}
    for name in _formulas(p):
        for value in [*history(p.model)] * (name in gates) + columns.FORCE:
            del spheres[f"{value}_{name}"]
    if names := _meshes(p):
        touched = frames.table("wall_contacts")
        wall = [names[int(k)] for k in touched["mesh"]] if len(names) > 1 else names[0]
        off = touched[POINTS[3:]].to_numpy() - touched[POINTS[:3]].to_numpy()
        touched[columns.NORMAL] = off / np.linalg.norm(off, axis=1, keepdims=True)
        parts.append(touched.drop(columns=POINTS).assign(j=0, wall=wall))
    return parts


def _fields(path: Path) -> dict[str, np.ndarray]:
    """The numbers of each triangle in a file of LIGGGHTS's `dump mesh/vtk`, sorted by their ids."""
    blocks = re.split(r"^(?=[a-zA-Z])", path.read_text(encoding="ascii").partition("FieldData")[2], flags=re.M)[1:]
    found = {
        name: np.array(values, float).reshape(int(count), -1)[:, 0]
        for name, _, count, _, *values in map(str.split, blocks)
    }
    order = np.argsort(found["meshid"])
    return {name: values[order] for name, values in found.items()}


def _stresses(p: ScenePlan, wall: str, path: Path) -> pd.DataFrame:
    """The triangles of a wall. Raises EngineError for a file that is not whole."""
    fields = _fields(path)
    count = len(fields["area"])
    if count != len(p.triangles[wall]):
        raise EngineError(f"{path}: {count} triangles, expected {len(p.triangles[wall])}")
    return pd.DataFrame({column: fields.get(field, np.zeros(count)) for field, column in COLUMNS.items()})
