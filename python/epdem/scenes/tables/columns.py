# SPDX-License-Identifier: GPL-2.0-or-later
"""Columns of the tables of a scene, which bodies move freely, and every contact of a frame, for every engine. SI.

Overlap and largest overlap of a contact come from the engine, all other quantities from the law.
"""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pandas as pd

from ...errors import EngineError
from ...laws.library import Law
from ...laws.strengths import ADHESION, LawSpec
from ...theory.adhesion import plastic_work
from ...theory.adhesive_curve import AdhesiveCurve
from ...theory.backbones import JKR
from ...theory.cavity_adhesive import CavityAdhesive
from ...theory.numerics import gauss
from ...theory.pair import contact_conductance
from ..plan import quantities
from ..plan.model import Heat, pair_law
from ..plan.plan import ScenePlan
from ..plan.quantities import PARTICLES, ROWS, SPINS, STRAINS, TEMPERATURE

Array = npt.NDArray[np.float64]
UNITS = quantities.UNITS | {  # of the columns that have one
    column: unit
    for unit, columns in {
        "s": "begin_time end_time",
        "m": "overlap added_overlap grown_overlap retreat contact_radius delta_max residual_overlap dent_radius wear "
        "height",
        "m^2": "area",
        "S": "conductance",
        "W": "heat_flow",
        "m/s": "speed",
        "N": "force force_x force_y force_z",
        "Pa": "body_pressure normal_stress shear_stress pressure asked reached peak opposite_pressure radial_pressure",
        "J": "energy elastic_energy kinetic rotation gravity elastic plastic adhesion friction springs work "
        "lost_spheres_energy balance",
    }.items()
    for column in columns.split()
}
LOADS = ("force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z")  # of a wall NAME: NAME_force_x, ...
SMALLEST = 1e-12  # radius [m]


def last_frame(table: pd.DataFrame) -> pd.DataFrame:
    """The rows of the last frame of a table."""
    return table[table["step"] == table["step"].max()]


def unit_of_load(column: str) -> str | None:
    """The unit of a column of a wall's mean force or torque; None for another one."""
    return ("N" if column[:-1].endswith("_force_") else "N m") if column.endswith(LOADS) else None


def units(table: pd.DataFrame) -> dict[str, str]:
    """The unit of each column of a table that has one; `attrs["units"]` has the units of measures."""
    found: dict[str, str] = {}
    for name in map(str, table):
        dent = "m" if name.startswith("delta_max_") or name[:-1].endswith("_way_") else None  # of a wall NAME
        unit = table.attrs.get("units", {}).get(name) or unit_of_load(name) or dent
        if unit := unit or UNITS.get(name):
            found[name] = unit
    return found


def columns_of_rows(p: ScenePlan) -> set[str]:
    """The names of the columns that the rows of a scene have."""
    loads = {f"{name}_{load}" for name in p.loads for load in LOADS}
    named = {row.name for row in p.scene.row} | {*p.way_columns}
    return {*ROWS, *named, *loads} - ({"wall_power"} - {*p.row_columns})


def columns_of_spheres(p: ScenePlan) -> list[str]:
    """The names of the columns that the frames of a scene have beside the step and the works."""
    return [*PARTICLES, *(SPINS if p.model.spins else ()), *(TEMPERATURE if p.heat else ())]


def columns_of_frames(p: ScenePlan) -> list[str]:
    """The names of the columns that the frames of a scene have beside the step."""
    return [*columns_of_spheres(p), *p.works]


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
    return table.reset_index(drop=True)


def named_rows(p: ScenePlan, table: pd.DataFrame) -> pd.DataFrame:
    """The rows with the columns that the scene names, in place of the forces from which alone they follow."""
    for row in p.scene.row:
        if row.position:
            table[row.name] = place(p, row.wall, row.axis, p.middles(table))
        elif row.heat_flow:
            table[row.name] = table[f"{row.wall}_heat_flow"]
        else:
            table[row.name] = row.sign * table[f"{row.wall}_{row.quantity}_{'xyz'[row.axis]}"] / (row.area or 1.0)
    table = table[[name for name in table if name in columns_of_rows(p)]]
    table.attrs["units"] = {row.name: row.unit for row in p.scene.row}
    return table


def place(p: ScenePlan, wall: str, axis: int, time: Array) -> Array:
    """Coordinate [m] of the first corner of a wall along an axis at times [s], each the middle of the interval that a
    force is the mean of; ways by a force, which no table has, are left out."""
    here = np.tile(p.triangles[wall][0, 0], (len(time), 1))
    before, began, so_far = None, here, np.zeros(len(time))
    for phase, seconds in zip(p.phases, p.lasted(time), strict=True):
        move = phase.moves.get(wall)
        goes_on = move == before and move is not None and math.isfinite(move.period)
        began, so_far = (began, so_far + seconds) if goes_on else (here, seconds)
        if move is not None and move.press is None:
            here = move.point_at(so_far[:, None], began)
        before = move
    return here[:, axis]


def work_of_walls(p: ScenePlan, rows: pd.DataFrame) -> np.ndarray:
    """Work [J] that moving walls have done up to each row."""
    if "wall_power" not in p.row_columns:
        return np.zeros(len(rows))
    return np.cumsum(rows["wall_power"].to_numpy() * np.diff(p.time_at(rows["step"].to_numpy()), prepend=0.0))


GROWTH = {"added_overlap": 0.0, "screening": 1.0, "grown_overlap": 0.0, "body_pressure": 0.0, "retreat": 0.0}
"""The columns that an engine gives with compaction, and their values without it."""
NORMAL, FORCE = ([f"{name}_{axis}" for axis in "xyz"] for name in ("normal", "force"))  # of the engine
BY_LAW = ["force", "contact_radius", "residual_overlap", "dent_radius", "plastic_work", "elastic_energy"]
_NODES, _WEIGHTS = gauss(16)  # on [0, 1]


def _columns_of_engine(p: ScenePlan) -> list[str]:
    return ["step", "wall", "i", "j", "overlap", "delta_max", *[*GROWTH] * p.model.compaction, *NORMAL, *FORCE]


def contact_columns(p: ScenePlan) -> list[str]:
    """The columns of the table of contacts."""
    return [*_columns_of_engine(p), *BY_LAW, *["bonded"] * bool(p.model.bond), *["heat_flow"] * (p.heat is not None)]


def touching(p: ScenePlan, raw: pd.DataFrame) -> pd.DataFrame:
    """The rows of an engine's contacts without what is only near: of bodies in contact, or attached.

    Bodies that touch at the start are attached, whose history some engines store from the first step on.
    """
    touch = raw["overlap"] + raw.get("added_overlap", 0.0) > 0
    attached = (raw["attached"] > 0) | (touch & (raw["step"] == 0)) if p.model.adheres else touch
    if p.model.bond:
        whole = raw["broken"] == 0 if "broken" in raw else raw["attached"] > 0
        attached = touch & whole & ~raw["wall"].astype(bool)
    return raw.assign(attached=attached)[touch | attached]


def complete(p: ScenePlan, raw: pd.DataFrame, spheres: pd.DataFrame, folder: Path) -> pd.DataFrame:
    """One row per contact and frame, with all that follows by the law, sorted; SI.

    raw: step, wall, i, j, overlap, of a law that yields delta_max, force on i; i and j are ids of spheres in any order,
    or j = 0 and `wall` the name of a wall, where the normal is given; with adhesion also whether the bodies are
    attached, for they may overlap in a dent without a contact; with compaction added_overlap, with which the law's
    overlaps are larger than those of the spheres, and the rest of GROWTH. What is only near is left out.
    spheres: the particles' table. Raises EngineError, which names `folder`, for a contact of spheres that it lacks.
    """
    raw = touching(p, raw if p.model.compaction else raw.assign(**GROWTH))
    before = raw["delta_max"] if p.model.yields else raw["overlap"]  # engines may give that before the step
    raw = raw.assign(delta_max=np.maximum(before, raw["overlap"] - raw["retreat"]))
    if raw.empty:
        return pd.DataFrame(columns=contact_columns(p))
    turned = (raw["j"] > 0) & (raw["i"] > raw["j"])  # the order of two spheres in an engine is arbitrary
    raw.loc[turned, FORCE] *= -1.0
    raw = raw.assign(i=raw["i"].where(~turned, raw["j"]), j=raw["j"].where(~turned, raw["i"])).reset_index(drop=True)
    first, second = bodies(p, raw, spheres)
    unknown = first["type"].isna() | second["type"].isna()
    if unknown.any():
        step = int(raw["step"][unknown].iloc[0])
        raise EngineError(f"{folder}: the contacts of step {step} are damaged: no such spheres; run the case again")
    between = (raw["j"] != 0).to_numpy()[:, None]
    apart = np.where(between, first[[*"xyz"]].to_numpy() - second[[*"xyz"]].to_numpy(), 0.0)
    for k, period in enumerate(p.scene.periods):
        if period:
            apart[:, k] -= period * np.round(apart[:, k] / period)
    at_walls = raw[NORMAL].to_numpy(float) if NORMAL[0] in raw else np.zeros((len(raw), 3))
    raw = raw.assign(**dict(zip(NORMAL, np.where(between, _unit(apart), at_walls).T, strict=True)))
    known = pd.DataFrame({"i": first["type"], "j": second["type"], "radius": first["radius"]})
    known["R_star"] = reduced(first["radius"], second["radius"])
    known["overlap"] = raw["overlap"] - raw["retreat"] + raw["added_overlap"]
    known["largest"] = raw["delta_max"] + raw["added_overlap"]
    known = known.join(raw[["attached", *GROWTH]])
    known["screening"] = known["screening"].where(known["screening"] > 0.0, 1.0)  # 0: a new contact
    table = raw[_columns_of_engine(p)].join(energies(p, known))
    if p.model.bond:
        table = _with_bonds(table, known)
    if p.heat:
        table["heat_flow"] = _heat_flow(p.heat, raw["wall"], first, second, table["contact_radius"])
    if p.model.cohesion:
        table["elastic_energy"] += cohesive_energy(p.model.cohesion, first["radius"], second["radius"], raw["overlap"])
    table = table.astype({"step": "int64", "i": "int64", "j": "int64"})
    return table.sort_values(["step", "wall", "i", "j"], kind="stable").reset_index(drop=True)


def _with_bonds(table: pd.DataFrame, known: pd.DataFrame) -> pd.DataFrame:
    """The contacts with `bonded` (1: by a bond), which keeps the radius of the dent; its pull is the engine's."""
    bonded = known["attached"] & (table["dent_radius"] > 0.0)
    stretch = (table["residual_overlap"] - known["overlap"]).clip(lower=0.0).where(bonded, 0.0)
    along = pd.Series((table[FORCE].to_numpy() * table[NORMAL].to_numpy()).sum(axis=1), table.index)
    pull = (-along).clip(lower=0.0).where(stretch > 0.0, 0.0)
    return table.assign(
        force=table["force"] - pull,
        contact_radius=table["contact_radius"].where(~bonded, table["dent_radius"]),
        elastic_energy=table["elastic_energy"] + 0.5 * pull * stretch,
        bonded=bonded.astype(float),
    )


def _heat_flow(heat: Heat, wall: pd.Series, one: pd.DataFrame, other: pd.DataFrame, radius: pd.Series) -> Array:
    """Heat flow [W] into the first body of each contact; none from an adiabatic wall."""
    k = np.array([0.0, *heat.conductivities])
    k_i, k_j = (k[body["type"].to_numpy(int)] for body in (one, other))
    drop = other["temperature"].fillna(wall.map(heat.walls)) - one["temperature"]
    flow = contact_conductance(k_i=k_i, k_j=k_j, radius=radius.to_numpy()) * drop.fillna(0.0).to_numpy()
    return np.asarray(flow)


def cohesive_energy(density: float, one: pd.Series, other: pd.Series, overlap: pd.Series) -> Array:
    """Potential [J] of the cohesion sjkr, which pulls by an energy density [J/m^3] times the area of the lens in which
    two spheres overlap, or of the circle in which a sphere cuts a wall; radii (a wall: inf) and overlap [m]."""
    a, b, delta = (x.to_numpy(float)[:, None] for x in (one, other, overlap.clip(lower=0.0)))
    s, wall = delta * _NODES, np.isinf(b)
    b = np.where(wall, a, b)
    r = a + b - s
    lens = math.pi / 4 * s * (2 * (a + b) - s) * (r - a + b) * (r + a - b) / r**2
    area = np.where(wall, math.pi * s * (2 * a - s), lens)
    return np.asarray(-density * delta[:, 0] * (area @ _WEIGHTS))


def with_first_works(p: ScenePlan, spheres: pd.DataFrame, contacts: pd.DataFrame) -> pd.DataFrame:
    """The table of particles whose frame of the start has the works of the contacts that are there from the start, half
    for each sphere; some engines book these works in their first step."""
    begin = contacts[contacts["step"] == 0]
    works = {"plastic_work": begin["plastic_work"]}
    if p.model.adheres and "adhesive_work" in p.works and len(begin):
        works["adhesive_work"] = _lost_at_touch(p, begin, spheres)
    at_walls, start = begin["j"] == 0, spheres["step"] == 0
    for name in (name for name in works if name in p.works and len(begin)):
        part = works[name] * np.where(at_walls, 1.0, 0.5)
        ends = [part.groupby(begin["i"]).sum(), part[~at_walls].groupby(begin["j"][~at_walls]).sum()]
        of_sphere = pd.concat(ends).groupby(level=0).sum()
        spheres.loc[start, name] = spheres["id"][start].map(of_sphere).fillna(0.0)
    return spheres


def _lost_at_touch(p: ScenePlan, contacts: pd.DataFrame, spheres: pd.DataFrame) -> pd.Series:
    """Work [J] that each contact with adhesion lost when it formed: its energy at touch, which nothing held."""
    first, second = bodies(p, contacts, spheres)
    R_star, lost = reduced(first["radius"], second["radius"]), np.zeros(len(contacts))
    for spec, E_star, at in pair_laws(p, first["type"], second["type"]):
        law = spec.adhesive(E_star=E_star, R_star=R_star[at], radius=first["radius"].to_numpy()[at])
        lost[at] = -law.branch(law.touch_radius)[0].energy(law.touch_radius)
    return pd.Series(lost, contacts.index)


def bodies(p: ScenePlan, contacts: pd.DataFrame, spheres: pd.DataFrame) -> tuple[pd.DataFrame, pd.DataFrame]:
    """The two bodies of each contact: their rows of the frames; a wall has its type and endless radius and mass. NaN:
    there is no such sphere."""
    known = spheres.set_index(["step", "id"])[["type", "radius", "mass", *"xyz", *(TEMPERATURE.keys() & {*spheres})]]
    keys = (pd.MultiIndex.from_frame(contacts[["step", body]].astype("int64")) for body in "ij")
    first, second = (known.reindex(key).reset_index(drop=True) for key in keys)
    wall = contacts["wall"].map(p.wall_types).to_numpy()
    second.loc[wall > 0, ["radius", "mass"]] = math.inf
    second["type"] = second["type"].fillna(pd.Series(wall))
    return first, second


def pair_laws(p: ScenePlan, one: pd.Series, other: pd.Series) -> Iterator[tuple[LawSpec, float, npt.NDArray[np.intp]]]:
    """(law, E* [Pa], places of its contacts) of each pair of types, from the types of both bodies of contacts."""
    for (i, j), at in one.groupby([one, other]).indices.items():
        yield *pair_law(p.case, *(p.model.types[int(k) - 1].material for k in (i, j))), at


def reduced(one: pd.Series, other: pd.Series) -> Array:
    """Reduced radius [m] or mass [kg] of two bodies."""
    return np.asarray(1.0 / (1.0 / one + 1.0 / other))


def _unit(vectors: Array) -> Array:
    """The vectors with length 1; zero vectors stay."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0))


def energies(p: ScenePlan, contacts: pd.DataFrame) -> pd.DataFrame:
    """The columns BY_LAW of contacts, of which these are known: i, j (types), R_star, radius of i [m], overlap, largest
    [m], attached, and of GROWTH all but added_overlap, in SI; overlap: of the law, with growth and retreat."""
    out = pd.DataFrame(0.0, index=contacts.index, columns=BY_LAW)
    for spec, E_star, places in pair_laws(p, contacts["i"], contacts["j"]):
        of_types = contacts.iloc[places]
        shares = np.round(spec.curvature_share(of_types["R_star"].to_numpy(), of_types["radius"].to_numpy()), 12)
        for _, at in of_types.groupby(shares):  # a law for each size
            out.loc[at.index, BY_LAW] = np.column_stack(_one_law(spec, E_star, at))
    return out


def _one_law(spec: LawSpec, E_star: float, contacts: pd.DataFrame) -> tuple[Array, ...]:
    """The columns BY_LAW of contacts of one curvature_share.

    Growth changes the largest force by a factor k: the force is k times the force of the contact alone at b - (b -
    overlap)/k, b: largest overlap, the energy that it stores k^2 times its energy there. Of what it recovers, k d, its
    bodies take the part c = (1 - gamma) (1 - alpha_Y/b): the dent is b - (1 - c) k d, and with the retreat e the
    contact holds 3/7 F (c k d - e) less.
    """
    R, radius, overlap, largest, screening, grown, pressure, retreat = (
        contacts[name].to_numpy(float)
        for name in ("R_star", "radius", "overlap", "largest", "screening", "grown_overlap", "body_pressure", "retreat")
    )
    largest = np.maximum(largest, overlap)
    share = float(spec.curvature_share(R[0], radius[0]))
    if spec.adheres:
        adhesive, attached = spec.adhesive(E_star=E_star, R_star=R, radius=radius), contacts["attached"].to_numpy()
        top = np.maximum(adhesive.radius(largest), adhesive.touch_radius)
        if not (isinstance(adhesive, CavityAdhesive) and ((screening < 1.0) | (grown > 0.0)).any()):
            return _with_adhesion(adhesive, adhesive.branch(top), top, overlap, attached)
        body = adhesive.backbone
        law = Law(body.name, E_star=E_star, share=share, **{k: x for k, x in spec.parameters.items() if k != ADHESION})
        b = np.asarray(adhesive.backbone_overlap(top), float)
        yielded = np.asarray(np.maximum(1.0 - body.yield_overlap / b, 0.0))
        k = _of_growth(law, R, b, grown, 2.0 / 3.0 * spec.parameters["yield_stress"] + pressure, yielded)
        branch, dent = adhesive.branch(top, k)
        found = _with_adhesion(adhesive, (branch, dent), top, overlap, attached)
        back = np.where(yielded > 0.0, (1.0 - screening) * yielded * (b - dent), 0.0)  # of its recovery
        return *found[:2], found[2] + back, *found[3:5], found[5] - 3.0 / 7.0 * found[0] * (back - retreat)
    theory = spec.backbone(E_star=E_star, R_star=R, radius=radius)
    law = Law(spec.name, E_star=E_star, share=share, **spec.parameters)
    yielded = np.maximum(1.0 - theory.yield_overlap / np.maximum(largest, 1e-300), 0.0)
    factor = (
        _of_growth(law, R, largest, grown, 2.0 / 3.0 * spec.parameters["yield_stress"] + pressure, yielded)
        if grown.any()
        else np.ones(len(R))
    )
    overlap = largest - (largest - overlap) / factor
    force, radius, _ = law.step(R_star=R, delta_max=largest, delta=overlap)
    _, dent, _, plastic = law.backbone(R_star=R, delta=largest)
    residual = np.asarray(theory.residual_overlap(largest), float) * (plastic > 0.0)
    # elastic energy: the force below delta_max, integrated from where it begins; squared nodes take its root away there
    way = np.maximum(overlap - residual, 0.0)
    delta = residual[:, None] + way[:, None] * _NODES**2
    at_nodes = [np.broadcast_to(x[:, None], delta.shape).ravel() for x in (R, largest)]
    F, _, _ = law.step(R_star=at_nodes[0], delta_max=at_nodes[1], delta=delta.ravel())
    elastic = 2.0 * (F.reshape(delta.shape) * _NODES * _WEIGHTS).sum(axis=1) * way  # 2 from the square
    radius = np.where(force > 0.0, radius, 0.0)
    dent = np.where(plastic > 0.0, dent, 0.0)
    force, back, part = factor * force, factor * (largest - residual), (1.0 - screening) * yielded
    taken = 3.0 / 7.0 * force * np.where(plastic > 0.0, part * back - retreat, 0.0)
    return force, radius, largest - (1.0 - part) * back, dent, plastic, factor**2 * elastic - taken


def _of_growth(law: Law, R: Array, largest: Array, grown: Array, pressure: Array, yielded: Array) -> Array:
    """The largest force with growth over that of the law: what growth adds to the area carries `pressure` [Pa]."""
    alone = largest - grown
    there = alone > 0.0
    force, radius, _ = law.step(R_star=R, delta_max=largest, delta=largest)
    before, inner, _ = law.step(R_star=R, delta_max=np.where(there, alone, 1.0), delta=np.where(there, alone, 0.0))
    carried = math.pi * (radius**2 - inner**2) * pressure
    excess = np.where(grown > 0.0, yielded * (force - before - carried), 0.0)
    return 1.0 - excess / np.maximum(force, 1e-300)


def _with_adhesion(
    law: JKR, opening: tuple[AdhesiveCurve, Array], top: Array, overlap: Array, attached: Array
) -> tuple[Array, ...]:
    branch, dent = opening
    a = np.where(attached, branch.radius(overlap - dent), 0.0)
    force, energy = (np.where(attached, found, 0.0) for found in (branch.force(a), branch.energy(a)))
    return force, a, dent, np.where(dent > 0, top, 0.0), plastic_work(law, top), energy
