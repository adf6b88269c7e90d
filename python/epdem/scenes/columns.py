# SPDX-License-Identifier: GPL-2.0-or-later
"""Columns of the tables of a scene, and which bodies move freely: the same for every engine. SI."""

from pathlib import Path

import numpy as np
import pandas as pd

from ..case.kinds import Compaction
from ..errors import EngineError
from .plan import ScenePlan

UNITS = {
    **dict.fromkeys(("time", "begin_time", "end_time"), "s"),
    "kinetic_energy": "J",
    "floor_load": "N",
    "plate_force": "N",
    "torque": "N m",
    "wall_power": "W",
    "plate_z": "m",
    **dict.fromkeys(("stress", "normal_stress", "shear_stress"), "Pa"),
    "area": "m^2",
    "wear": "m",
    "radius": "m",
    "mass": "kg",
    **dict.fromkeys(("x", "y", "z"), "m"),
    **dict.fromkeys(("vx", "vy", "vz"), "m/s"),
    **dict.fromkeys(("omega_x", "omega_y", "omega_z"), "rad/s"),
    **dict.fromkeys(("overlap", "delta_max", "residual_overlap", "dent_radius"), "m"),
    "force": "N",
    **dict.fromkeys(("plastic_work", "adhesive_work", "elastic_energy", "friction_work", "friction_energy"), "J"),
    **dict.fromkeys(("kinetic", "rotation", "gravity", "elastic", "plastic", "adhesion"), "J"),
    **dict.fromkeys(("friction", "springs", "work", "left", "balance"), "J"),
}
LOADS = ("force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z")  # of a wall NAME: NAME_force_x, ...
SMALLEST = 1e-12  # radius [m]
STRAINS = ("largest_radius_ratio", "largest_overlap_ratio")  # a/R* and overlap/R*, of all contacts since the start
PARTICLES = ["id", "type", "radius", "mass", "x", "y", "z", "vx", "vy", "vz"]
SPINS = ["omega_x", "omega_y", "omega_z"]


def last_frame(table: pd.DataFrame) -> pd.DataFrame:
    """The rows of the last frame of a table."""
    return table[table["step"] == table["step"].max()]


def unit_of_load(column: str) -> str | None:
    """The unit of a column of a wall's mean force or torque; None for another one."""
    return ("N" if column[:-1].endswith("_force_") else "N m") if column.endswith(LOADS) else None


def units(table: pd.DataFrame) -> dict[str, str]:
    """The unit of each column of a table that has one; `attrs["units"]` has those of measures."""
    loads = {str(name): unit for name in table if (unit := unit_of_load(str(name)))}
    dents = {str(name): "m" for name in table if str(name).startswith("delta_max_")}  # of a flat wall NAME
    own: dict[str, str] = table.attrs.get("units", {})
    return UNITS | loads | dents | own


def columns_of_rows(p: ScenePlan) -> set[str]:
    """The names of the columns that the rows of a scene have."""
    some = {"floor_load": p.floor_load, "torque": p.torque, "wall_power": p.writes_wall_power}
    some |= dict.fromkeys(("plate_force", "plate_z", "stress"), p.plates)
    loads = {f"{name}_{load}" for name in p.loads for load in LOADS}
    always = {"step", "time", "particles", "kinetic_energy", *STRAINS}
    return always | {name for name, there in some.items() if there} | loads


def whole(p: ScenePlan, table: pd.DataFrame, folder: Path) -> pd.DataFrame:
    """The particles' table with whole numbers where they belong. Raises EngineError for a frame that is damaged or
    holds numbers that are not finite.
    """
    keys = table[["id", "type"]].to_numpy(float)
    with np.errstate(invalid="ignore"):
        good = ((keys >= 1) & (keys == np.floor(keys)) & (keys <= [2**53, len(p.model.types)])).all(axis=1)
    finite = np.isfinite(table.to_numpy(float)).all(axis=1)
    if (good & ~finite).any():
        first = table[good & ~finite].iloc[0]
        raise EngineError(
            f"{folder}: sphere {first['id']:.0f} has values that are no numbers in the frame of step "
            f"{first['step']:.0f}; give a smaller numerics.time_step, or, if the file is damaged, run the case again"
        )
    good &= finite
    good &= (table["radius"].to_numpy(float) > SMALLEST) & ~table.duplicated(["step", "id"]).to_numpy()
    if not good.all():
        raise EngineError(f"{folder}: the frame of step {table['step'][~good].iloc[0]} is damaged; run the case again")
    return table.astype({"id": "int64", "type": "int64", "step": "int64"})


def rows(p: ScenePlan, values: dict[int, list[float]], names: list[str]) -> pd.DataFrame:
    """The table of rows, sorted, from the values of `names` at each step."""
    table = pd.DataFrame.from_dict(values, orient="index", columns=names).sort_index()
    table.insert(0, "step", table.index.to_numpy())
    table.insert(1, "time", p.time_at(table["step"].to_numpy()))
    strains = [name for name in STRAINS if name in table]
    table[strains] = table[strains].clip(lower=0.0).cummax()  # no sphere is there yet, or the one that held it left
    if isinstance(p.case.scene, Compaction):
        middle = (table["step"] - 0.5 * p.every).clip(lower=0) * p.time_step
        table["plate_z"] = plate_height(p, middle.to_numpy())
        table["stress"] = table["plate_force"] / (p.case.scene.box[0] * p.case.scene.box[1])
    return table.reset_index(drop=True)


def plate_height(p: ScenePlan, time: np.ndarray) -> np.ndarray:
    """Height [m] of the plate at times [s], each the middle of the interval that a force is the mean of."""
    height = np.full(len(time), p.triangles["plate"][0, 0, 2])
    begin = 0.0
    for phase in p.phases:
        end = phase.end * p.time_step
        height += phase.plate * (np.clip(time, begin, end if phase is not p.phases[-1] else None) - begin)
        begin = end
    return height
