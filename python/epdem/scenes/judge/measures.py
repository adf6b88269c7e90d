# SPDX-License-Identifier: GPL-2.0-or-later
"""Measures of a case, from the tables of any engine: loads over the rows, curves over the frames, histograms. SI."""

import math

import numpy as np
import pandas as pd

from ...case.kinds import in_file
from ...case.motions import FloatArray
from ...case.outputs import MassFlow, ReboundSpeed
from ...case.parts import MEASURES, Amount, CenterOfMass, Flow, Height, Histogram, Load, Measure, Porosity, Repose
from ...case.walls import Room, Upright
from ...errors import CaseError
from ..plan.plan import ScenePlan
from ..tables.columns import bodies, columns_of_frames, columns_of_rows, last_frame, pair_laws, reduced

LINES = 2**16  # through a region whose porosity is measured
RINGS = 12  # of the surface of a bed; the outer ones, which are its tip and its foot, are left out
# names of key figures: from frames, by their check; of a press
FRAME_FIGURES = {"mass_flow": MassFlow, "rebound_speed": ReboundSpeed}
PRESS_FIGURES = ("punch_force", "densification", "heckel", "kawakita", "springback", "side_pressure", "conductance")
SURFACE = 0.95  # of the mass of a bed, nearest to its middle: beyond it single spheres have rolled away


def refuse_measures(p: ScenePlan) -> None:
    """Raise CaseError for measures, key figures and colours that the scene cannot give."""
    fields = ["speed", "energy", *columns_of_frames(p)]
    if p.output.color not in fields:
        raise CaseError(f"output.color = {p.output.color!r}: spheres of this scene have {', '.join(fields)}")
    s = p.scene
    names, taken = [m.name for m in s.measure], columns_of_rows(p)
    figures = [*sorted({*taken, *names} - {"step", "time"}), *(PRESS_FIGURES if s.stages else ())]
    figures += [figure for figure, check in FRAME_FIGURES.items() if any(isinstance(c, check) for c in s.check)]
    if bad := next((name for name in s.key_figure if name not in figures), None):
        said = f"key_figure = {bad!r} is no row, measure or figure; there are {', '.join(figures)}"
        raise CaseError(in_file(p.case.scene, p.output, said))
    for m in s.measure:
        place = f"scene.measure.{m.name}"
        if names.count(m.name) > 1:
            raise CaseError(f"{place}: two measures have this name; give each its own")
        if m.name in taken:
            raise CaseError(f"{place}: a column of the rows has this name; give another one")
        if not (p.frames or isinstance(m, Load)):
            raise CaseError(f"{place}: measures are taken from frames; give output.particles")
        if isinstance(m, Load) and m.wall not in p.loads:
            known = ", ".join(p.loads) or "none; give output.loads in a scene of parts"
            raise CaseError(f"{place}.wall = {m.wall!r}: walls whose forces are known: {known}")
        if isinstance(m, Load) and m.kind == "torque" and m.wall not in p.scene.meshes:
            raise CaseError(f"{place}.wall = {m.wall!r}: a plane has no torque; name a wall of triangles")
        _refuse_beyond(p, m, place)
        material = getattr(m, "material", None)
        if material is not None and material not in {t.material for t in p.model.types if not t.wall}:
            raise CaseError(f"{place}.material = {material!r}: no sphere is of it")
        if isinstance(m, Histogram) and m.kind == "plastic_work" and "plastic_work" not in p.works:
            raise CaseError(f"{place}: the plastic work is known with output.energy and a law that yields; give them")
        if isinstance(m, Histogram) and m.kind == "impact_speed" and (p.model.adheres or not p.contacts):
            raise CaseError(f"{place}: impact speeds follow from contacts without adhesion; give output.contacts")


def _inside(region: Room | Upright, x: FloatArray) -> np.ndarray:
    """Whether places, shape (n, 3), lie in a region."""
    if isinstance(region, Upright):
        near = np.hypot(x[:, 0] - region.center[0], x[:, 1] - region.center[1]) <= region.diameter / 2
        return np.asarray(near & (x[:, 2] >= region.z[0]) & (x[:, 2] <= region.z[1]))
    limits = np.array(region.limits)
    return np.asarray(((x >= limits[0::2]) & (x <= limits[1::2])).all(axis=1))


def _refuse_beyond(p: ScenePlan, m: Measure, place: str) -> None:
    """Raise CaseError for a region of void that does not belong to the scene, or in which no sphere can be."""
    region = getattr(m, "region", None)
    if region is None:
        return
    low, high = np.array(region.limits).reshape(3, 2).T
    first, last = np.array(p.scene.room.limits).reshape(3, 2).T
    room = " x ".join(f"[{a:g}, {b:g}]" for a, b in zip(first, last, strict=True)) + " m"
    slack = 1e-9 * (last - first)
    if isinstance(m, Porosity) and ((low < first - slack) | (high > last + slack)).any():
        raise CaseError(
            f"{place}.region: it reaches beyond the room of the scene, {room}, whose outside would count as void; "
            "move it, or make it smaller"
        )
    if ((low >= last) | (high <= first)).any():
        raise CaseError(f"{place}.region: it lies outside of the room of the scene, {room}; move it")


def _chosen(p: ScenePlan, m: Amount | Height | Repose | CenterOfMass | Flow, frame: pd.DataFrame) -> pd.DataFrame:
    if m.material is not None:
        kinds = [n for n, t in enumerate(p.model.types, 1) if t.material == m.material]
        frame = frame[frame["type"].isin(kinds)]
    region = None if isinstance(m, Flow) else m.region
    return frame if region is None else frame[_inside(region, frame[["x", "y", "z"]].to_numpy())]


def _height(frame: pd.DataFrame, share: float) -> float:
    if frame.empty:
        return math.nan
    by_height = frame.sort_values("z")
    below = by_height["mass"].cumsum().to_numpy() / by_height["mass"].sum()
    return float(by_height["z"].iloc[min(int(np.searchsorted(below, share * (1.0 - 1e-9))), len(below) - 1)])


def _angle(m: Repose, frame: pd.DataFrame) -> tuple[float, int]:
    """Angle [rad] of a line through the highest spheres of rings, or of strips, of equal width, and their number.

    They reach over `SURFACE` of the mass, for spheres that have rolled away are no surface. NaN with fewer than three
    of them.
    """
    if len(frame) < 2 * RINGS:
        return math.nan, 0
    x, y = frame["x"] - m.center[0], frame["y"] - m.center[1]
    way = {"distance": np.hypot(x, y), "x": x, "y": y}[m.over].to_numpy()
    top, mass = (frame["z"] + frame["radius"]).to_numpy(), frame["mass"].to_numpy()
    order = np.argsort(way)
    share = np.cumsum(mass[order]) / mass.sum()
    outside = (0.0, SURFACE) if m.over == "distance" else (0.5 - SURFACE / 2, 0.5 + SURFACE / 2)
    low, high = way[order][np.searchsorted(share, outside)]
    ring = np.floor((way - low) / max(high - low, 1e-300) * RINGS)
    highest = [np.flatnonzero(ring == k) for k in range(1, RINGS - 1)]
    highest = [at[np.argmax(top[at])] for at in highest if at.size]
    if len(highest) < 3:
        return math.nan, len(highest)
    return float(math.atan(abs(np.polyfit(way[highest], top[highest], 1)[0]))), len(highest)


def _porosity(p: ScenePlan, m: Porosity, frame: pd.DataFrame) -> float:
    """The share of a region that lies in no sphere and, in a periodic room, in no image of one: along z exact, by the
    union of what spheres cut out of lines that are evenly spread over x and y; the error is below 1e-4
    (tests/scenes/test_parts_measures.py)."""
    from scipy.spatial import cKDTree
    from scipy.stats import qmc

    low, high = np.array(m.region.limits).reshape(3, 2).T
    lines = low[:2] + (high - low)[:2] * qmc.Sobol(2, scramble=False).random(LINES)
    if isinstance(m.region, Upright):
        lines = lines[np.hypot(*(lines - m.region.center).T) <= m.region.diameter / 2]
    x, radius = frame[["x", "y", "z"]].to_numpy(), frame["radius"].to_numpy()
    images = p.scene.images
    x, radius = np.concatenate([x + shift for shift in images]), np.tile(radius, len(images))
    near = ((x + radius[:, None] > low) & (x - radius[:, None] < high)).all(axis=1)
    x, radius = x[near], radius[near]
    found = cKDTree(lines).query_ball_point(x[:, :2], radius)
    sphere = np.repeat(np.arange(len(x)), [len(some) for some in found])
    line = np.concatenate([np.zeros(0, int), *(np.array(some, int) for some in found)])
    half = np.sqrt(np.maximum(radius[sphere] ** 2 - ((lines[line] - x[sphere, :2]) ** 2).sum(axis=1), 0.0))
    begin = np.clip(x[sphere, 2] - half, low[2], high[2])
    end = np.clip(x[sphere, 2] + half, low[2], high[2])
    order = np.lexsort((begin, line))
    line, begin, end = line[order], begin[order], end[order]
    height = high[2] - low[2]
    # of each line by itself: one above the other, so that the largest end so far is one running maximum
    covered = np.maximum.accumulate(np.append(-np.inf, end + 2 * height * line))[:-1] - 2 * height * line
    taken = np.maximum(end - np.maximum(begin, covered), 0.0).sum()
    return float(1.0 - taken / (len(lines) * height))


def _time_to_sides(p: ScenePlan, spheres: pd.DataFrame, axis: str) -> FloatArray:
    """Time [s] after which each sphere leaves the room by a face that is not across the axis; inf: never."""
    times = np.full(len(spheres), np.inf)
    for k, name in enumerate("xyz"):
        if name != axis and not p.scene.periods[k]:
            x, v = spheres[name].to_numpy(), spheres[f"v{name}"].to_numpy()
            way = np.where(v > 0, p.scene.room.limits[2 * k + 1], p.scene.room.limits[2 * k]) - x
            times = np.minimum(times, np.divide(way, v, out=np.full(len(v), np.inf), where=v != 0))
    return np.asarray(np.maximum(times, 0.0))


def _flow(p: ScenePlan, m: Flow, spheres: pd.DataFrame, steps: np.ndarray) -> FloatArray:
    """Mass that passes the plane between two frames over the time between them; 0 at the first.

    A sphere that leaves the room passes the plane if its last place, velocity and weight carry it through before they
    carry it out by a side. Along a periodic axis a sphere passes the plane in each image of the room; its velocities
    tell how many periods it moves between two frames.
    """
    axis, sign = m.direction[1], 1.0 if m.direction[0] == "+" else -1.0
    chosen, seconds = _chosen(p, m, spheres), np.diff(p.time_at(steps))
    mass = chosen.groupby("id")["mass"].first()
    place, speed = (
        chosen.pivot_table(index="step", columns="id", values=name).reindex(index=steps, columns=mass.index).to_numpy()
        for name in (axis, f"v{axis}")
    )
    period = p.scene.periods["xyz".index(axis)]
    moved = np.diff(place, axis=0)
    if period:
        moved += period * np.round((0.5 * (speed[:-1] + speed[1:]) * seconds[:, None] - moved) / period)
    there = np.isfinite(place)
    last = chosen.drop_duplicates("id", keep="last").set_index("id").loc[mass.index]
    until = np.minimum(seconds[:, None], _time_to_sides(p, last, axis))
    fall = 0.5 * p.scene.gravity * until**2 if axis == "z" else 0.0
    moved = np.where(there[:-1] & ~there[1:] & (not period), speed[:-1] * until - fall, moved)
    before = sign * (place[:-1] - m.at)
    counted = [np.floor(x / period) if period else (x > 0).astype(float) for x in (before, before + sign * moved)]
    new = np.where(np.isfinite(moved), counted[1] - counted[0], 0.0)
    return np.concatenate([[0.0], (new * mass.to_numpy()).sum(axis=1) / seconds])


def with_loads(p: ScenePlan, rows: pd.DataFrame) -> pd.DataFrame:
    """The rows with a column for each force and torque: the mean over each row [N, N m]."""
    found = rows.copy()
    loads = [m for m in p.scene.measure if isinstance(m, Load)]
    for m in loads:
        parts = [f"{m.wall}_{m.kind}_{axis}" for axis in "xyz" if m.component in (axis, "magnitude")]
        values = rows[[part for part in parts if part in rows]].to_numpy()
        found[m.name] = values[:, 0] if m.component != "magnitude" else np.linalg.norm(values, axis=1)
    found.attrs["units"] = rows.attrs.get("units", {}) | {m.name: MEASURES[m.kind].unit for m in loads}
    return found


def curve(m: Measure, tables: dict[str, pd.DataFrame]) -> tuple[FloatArray, FloatArray]:
    """(times [s], values) of a measure but a histogram: of a force or torque in each row, of another in each frame."""
    table = tables["rows" if isinstance(m, Load) else "measures"]
    return table["time"].to_numpy(float), table[m.name].to_numpy(float)


def _frame_steps(p: ScenePlan, spheres: pd.DataFrame, rows: pd.DataFrame) -> np.ndarray:
    """The steps of the frames, with those of a room that has emptied: the table of spheres has no row of them."""
    planned = np.array(p.frame_steps(p.frames) if p.frames else [], dtype=int)
    planned = planned[(planned > spheres["step"].min()) & (planned <= rows["step"].max())]
    next_row = np.searchsorted(rows["step"], planned)
    return np.union1d(spheres["step"].unique(), planned[rows["particles"].to_numpy()[next_row] == 0])


def curves(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """One row per frame: step, time, a column for each measure but loads and histograms; of an angle of repose also
    the number of its rings."""
    spheres = tables.get("particles", pd.DataFrame({"step": np.zeros(0, int)}))  # loads need no frames
    steps = _frame_steps(p, spheres, tables["rows"])
    frames = dict.fromkeys(steps, spheres.head(0)) | dict(tuple(spheres.groupby("step")))
    table = pd.DataFrame({"step": steps, "time": p.time_at(steps)})
    for m in p.scene.measure:
        match m:
            case Amount():
                chosen = [_chosen(p, m, frames[step])["mass"] for step in steps]
                table[m.name] = [float(len(c) if m.kind == "count" else c.sum()) for c in chosen]
            case Height():
                table[m.name] = [_height(_chosen(p, m, frames[step]), m.share) for step in steps]
            case Repose():
                found = [_angle(m, _chosen(p, m, frames[step])) for step in steps]
                table[m.name], table[f"{m.name}_rings"] = zip(*found, strict=True) if found else ([], [])
            case CenterOfMass():
                chosen = [_chosen(p, m, frames[step]) for step in steps]
                table[m.name] = [
                    float((c["mass"] * c[m.axis]).sum() / c["mass"].sum()) if len(c) else math.nan for c in chosen
                ]
            case Flow():
                table[m.name] = _flow(p, m, spheres, steps)
            case Porosity():
                table[m.name] = [_porosity(p, m, frames[step]) for step in steps]
            case Load() | Histogram():
                pass
    table.attrs["units"] = {m.name: MEASURES[m.kind].unit for m in p.scene.measure if m.name in table}
    return table


def _impact_speeds(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> FloatArray:
    contacts = tables["contacts"]
    largest = contacts.loc[contacts.groupby(["wall", "i", "j"])["delta_max"].idxmax()]
    one, other = bodies(p, largest, tables["particles"])
    R_star, m_star = (reduced(one[name], other[name]) for name in ("radius", "mass"))
    speeds = np.zeros(len(one))
    for spec, E_star, at in pair_laws(p, one["type"], other["type"]):
        law = spec.backbone(E_star=E_star, R_star=R_star[at], radius=one["radius"].to_numpy()[at])
        work = np.asarray(law.work(largest["delta_max"].to_numpy()[at]), float)
        speeds[at] = np.sqrt(2.0 * work / m_star[at])
    return speeds


def values_of(p: ScenePlan, m: Histogram, tables: dict[str, pd.DataFrame]) -> FloatArray:
    """Values of a histogram: the plastic work of each sphere in the last frame [J], or the impact speeds [m/s]."""
    if m.kind == "impact_speed":
        return _impact_speeds(p, tables)
    return np.asarray(last_frame(tables["particles"])["plastic_work"], float)


def histograms(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """One row per bin: measure, low, high, number."""
    found = []
    for m in p.scene.measure:
        if not isinstance(m, Histogram):
            continue
        number, edges = np.histogram(values_of(p, m, tables), m.bins)
        found.append(pd.DataFrame({"measure": m.name, "low": edges[:-1], "high": edges[1:], "number": number}))
    return pd.concat(found, ignore_index=True) if found else pd.DataFrame(columns=["measure", "low", "high", "number"])
