# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures of a scene, fit for a paper: its walls and spheres before a run, its bed after one."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ..base.files import atomic
from ..base.readable import in_words
from ..case.motions import FloatArray
from ..case.walls import Room
from ..errors import CaseError
from ..scenes.judge.energy_balance import kinetic
from ..scenes.plan import placement
from ..scenes.plan.meshes import at_end, box, sheet, tube
from ..scenes.plan.phases import Phase
from ..scenes.plan.plan import ScenePlan
from ..scenes.tables.columns import last_frame, units
from .chart import Axis

AZIMUTH, ELEVATION = np.deg2rad(-60.0), np.deg2rad(18.0)  # from where a picture is seen
DPI = 200
MOST_PLACED = 4000  # spheres that are placed for the picture of a scene before its run
WIDE = 6.0  # inches
TITLE = 0.5  # room of the title above the axes [inch]
BAR = 1.0  # room of a colour bar [inch]
# discs of a sphere from its rim to the highlight: share of the radius, shift to the upper left over the radius, light
# (1: its colour, 2: white)
SHADES = [
    (1.0, 0.0, 0.35),
    (0.94, 0.0, 0.70),
    (0.84, 0.04, 0.86),
    (0.72, 0.08, 1.0),
    (0.26, 0.34, 1.25),
    (0.14, 0.37, 1.6),
]
MOST_SHADED = 20_000  # spheres with all discs
HAZE = 0.45  # share of white in the colour of the farthest sphere


def _axes() -> tuple[FloatArray, FloatArray]:
    """(the picture's axes to the right and up, shape (2, 3); the direction towards the viewer)."""
    c, s, ce, se = np.cos(AZIMUTH), np.sin(AZIMUTH), np.cos(ELEVATION), np.sin(ELEVATION)
    towards = np.array([c * ce, s * ce, se])
    right = np.array([-s, c, 0.0])
    return np.stack([right, np.cross(towards, right)]), towards


def coloured(spheres: pd.DataFrame) -> pd.DataFrame:
    """The spheres with their speed [m/s] and energy [J] beside the columns of the frames: fields of output.color."""
    speed = np.sqrt((spheres[["vx", "vy", "vz"]] ** 2).sum(axis=1))
    return spheres.assign(speed=speed, energy=kinetic(spheres))


Walls = tuple[list[FloatArray], list[FloatArray]]  # triangles (n, 3 corners, 3) of each wall, outlines of planes (4, 3)


def _walls(p: ScenePlan, triangles: dict[str, FloatArray], phase: Phase) -> Walls:
    """Walls of `triangles`, and the planes of a phase as their outline in the room."""
    planes = (*p.scene.planes, *(g for g in p.scene.gates if g.name in phase.gates))
    return [*triangles.values()], [sheet(w, p.box).reshape(-1, 3)[[0, 1, 2, 5]] for w in planes]


def _draw_walls(axis: Any, walls: Walls, *, front: bool) -> None:
    from matplotlib.collections import PolyCollection

    plane, _ = _axes()
    for triangles in walls[0]:
        outline = triangles @ plane.T
        face, edge = (0.3, 0.4, 0.6, 0.03 if front else 0.10), (0.3, 0.4, 0.6, 0.15)
        axis.add_collection(PolyCollection([*outline], facecolor=face, edgecolor=edge, lw=0.3))
    if front:
        return
    for outline in walls[1]:
        axis.add_collection(
            PolyCollection([outline @ plane.T], facecolor=(0.5, 0.5, 0.5, 0.12), edgecolor="0.5", lw=0.6)
        )


def _draw_spheres(axis: Any, x: FloatArray, radius: FloatArray, color: FloatArray) -> None:
    """Spheres as shaded discs, the nearest on top; color: red, green, blue from 0 to 1 of each, shape (n, 3)."""
    from matplotlib.collections import EllipseCollection

    plane, towards = _axes()
    depth = x @ towards
    order = np.argsort(depth)
    haze = HAZE * (depth.max() - depth[order]) / max(float(np.ptp(depth)), float(radius.max()))
    color = color[order] + haze[:, None] * (1.0 - color[order])
    share, shift, light = np.array(SHADES if len(x) <= MOST_SHADED else SHADES[:2]).T
    size = np.outer(2 * radius[order], share)
    places = (x @ plane.T)[order][:, None] + (radius[order, None] * shift)[:, :, None] * np.array([-1.0, 1.0])
    base, light = color[:, None], light[:, None]
    shaded = np.where(light <= 1.0, base * light, 1.0 - (1.0 - base) * (2.0 - light))
    look = {"units": "xy", "offset_transform": axis.transData, "linewidth": 0.0, "facecolor": shaded.reshape(-1, 3)}
    angles, offsets = np.zeros(size.size), places.reshape(-1, 2)
    axis.add_collection(EllipseCollection(size.ravel(), size.ravel(), angles, offsets=offsets, **look))


def _round(length: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten up to a length."""
    power = 10.0 ** math.floor(math.log10(length))
    return max(x * power for x in (1.0, 2.0, 5.0) if x * power <= length)


def _frame(title: str, corners: FloatArray, *, beside: float = 0.0) -> tuple[Any, Any]:
    """A figure in which these places are seen, with a bar of a length; room `beside` it [inch]."""
    from matplotlib.figure import Figure

    plane, _ = _axes()
    seen = corners @ plane.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    margin = 0.06 * (high - low).max()
    ratio = (high[1] - low[1] + 2 * margin) / (high[0] - low[0] + 2 * margin)
    height = (WIDE - beside) * ratio + TITLE
    fig = Figure(figsize=(WIDE, float(np.clip(height, 2.5, 11.0))), layout="constrained")
    axis = fig.subplots()
    axis.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin), aspect="equal")
    axis.set_axis_off()
    length = _round(0.2 * (high[0] - low[0]))
    axis.plot([low[0], low[0] + length], [low[1] - 0.5 * margin] * 2, "k", lw=2.0)
    axis.text(low[0] + length + 0.5 * margin, low[1] - 0.5 * margin, in_words(length, "m"), va="center", fontsize=8)
    axis.set_title(title, parse_math=False, fontsize=9)
    return fig, axis


def _save(fig: Any, path: Path) -> None:
    with atomic(path) as temporary:
        fig.savefig(temporary, dpi=DPI)


def bed(p: ScenePlan, spheres: pd.DataFrame, path: Path) -> str:
    """Draw walls and spheres of the last frame, coloured by the field `output.color`, into the PNG file `path`; what it
    shows, in words.

    A wall that a force drives is left out: no table holds its position.
    """
    from matplotlib.cm import ScalarMappable

    last = coloured(last_frame(spheres))
    x, radius, values = last[["x", "y", "z"]].to_numpy(), last["radius"].to_numpy(), last[p.output.color].to_numpy()
    walls = _walls(p, at_end(p.motions_until(int(last["step"].iloc[0])), p.triangles), p.phases[-1])
    label = str(Axis(p.output.color, units(last).get(p.output.color, "")))
    time = float(p.time_at(last["step"].to_numpy()[:1])[0])
    corners = np.concatenate([x - radius[:, None], x + radius[:, None]])
    fig, axis = _frame(p.case.case.title, corners, beside=BAR)
    _draw_walls(axis, walls, front=False)
    shown = ScalarMappable(cmap="viridis")
    _draw_spheres(axis, x, radius, shown.to_rgba(values)[:, :3])
    _draw_walls(axis, walls, front=True)
    fig.colorbar(shown, ax=axis, label=label, shrink=0.8)
    _save(fig, path)
    return f"Spheres and walls at {time:.3g} s; the colour is {label}, from {values.min():.3g} to {values.max():.3g}."


def before(p: ScenePlan, path: Path) -> int:
    """Draw walls, regions to be filled and the first spheres of a scene into the PNG file `path`.

    Returns the number of drawn spheres; spheres of regions are drawn only if few enough to be placed at once. Raises
    CaseError for an ending that no picture has.
    """
    from matplotlib.colors import to_rgba_array

    fig, axis = _frame(p.case.case.title, box(p.box).reshape(-1, 3))
    if path.suffix[1:].lower() not in fig.canvas.get_supported_filetypes():
        raise CaseError(f"--out {path}: no picture has this ending; name it {path.stem}.png")
    _draw_walls(axis, _walls(p, p.triangles, p.phases[0]), front=False)
    for fill in p.insertions:
        _draw_region(axis, fill.region)
    table = _first(p)
    if len(table):
        colors = to_rgba_array([f"C{int(kind) - 1}" for kind in table[:, 4]])[:, :3]
        _draw_spheres(axis, table[:, :3], table[:, 3], colors)
    _save(fig, path)
    return len(table)


def _first(p: ScenePlan) -> FloatArray:
    """The spheres that can be placed before a run, and single ones that come later, in the form of `placement`."""
    placed = p.count <= MOST_PLACED and bool(p.insertions)
    alone = [b.sphere for b in p.scene.later] + ([] if placed else [*p.scene.table])
    rows = np.array([placement.of_sphere(p, s) for s in alone]).reshape(-1, 12)
    return np.concatenate([placement.spheres(p), rows]) if placed else rows


def _draw_region(axis: Any, region: Any) -> None:
    from matplotlib.collections import PolyCollection

    if isinstance(region, Room):
        faces = box(region.limits)
    else:
        faces = tube((2 * region.radius,) * 2, *region.z, closed=(True, True))
        faces = faces + np.array([*region.center, 0.0])
    plane, _ = _axes()
    axis.add_collection(PolyCollection([*(faces @ plane.T)], facecolor=(0.9, 0.6, 0.1, 0.02), edgecolor="none"))
