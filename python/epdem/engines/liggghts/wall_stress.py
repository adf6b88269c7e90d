# SPDX-License-Identifier: GPL-2.0-or-later
"""Pressure and wear of walls of triangles: LIGGGHTS's words, and the table from its files."""

from collections.abc import Collection
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from ...errors import CaseError, EngineError
from ...scenes.plan import ScenePlan
from ..host import frames
from .properties import Property, per_pair

FILES = "stress_{}.{}.vtk"  # wall, step
COLUMNS = {"meshid": "triangle", "area": "area", "normal_stress_average": "normal_stress"}
COLUMNS |= {"shear_stress_average": "shear_stress", "wear": "wear"}


def properties(p: ScenePlan) -> tuple[Property, ...]:
    """Finnie's constant [m^2/N] of each pair of a sphere's type and a wall's, the same in both orders.

    Raises CaseError for two values of one pair.
    """
    spheres = {p.model.type_of(particles.material) for particles in p.scene.filled}
    of_pair = dict[frozenset[int], tuple[str, float]]()  # the wall that gives the value, the value
    for name, mesh in p.scene.meshes.items():
        if not mesh.wear:
            continue
        for sphere in spheres:
            other, wear = of_pair.setdefault(frozenset((sphere, p.wall_types[name])), (name, mesh.wear))
            if wear != mesh.wear:
                raise CaseError(
                    f"scene.wall.{name}.wear = {mesh.wear:g} m^2/N: wall {other} has {wear:g} m^2/N, and LIGGGHTS has "
                    "one value for each pair of materials; give both walls one value, or each its own material"
                )
    if not of_pair:
        return ()
    types = range(1, len(p.model.types) + 1)
    values = [of_pair.get(frozenset((a, b)), ("", 0.0))[1] for a in types for b in types]
    return (per_pair("k_finnie", len(types), values, "m^2/N"),)


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
