# SPDX-License-Identifier: GPL-2.0-or-later
"""Heat of a scene in which a part has a temperature: materials, walls, the temperatures with which spheres come. SI."""

from dataclasses import dataclass

from ...case.scene import SceneCase
from ...errors import CaseError
from .model import Model


@dataclass(frozen=True)
class Heat:
    """share: of the plastic and frictional work that becomes heat. conductivities [W/(m K)], capacities [J/(kg K)]: of
    the types of spheres and walls, 1 where no heat passes. walls: temperatures [K] of walls that have one."""

    share: float
    conductivities: tuple[float, ...]
    capacities: tuple[float, ...]
    walls: dict[str, float]


def heat(case: SceneCase, m: Model) -> Heat | None:
    """The heat of a scene; None: no part has a temperature. Raises CaseError for what lacks one."""
    parts = case.parts
    walls = {w.name: w.temperature for w in parts.wall if w.temperature is not None}
    comes = {f"scene.{kind}.{x.name}": x.temperature for kind in ("fill", "body") for x in getattr(parts, kind)}
    warm = [*(f"scene.wall.{name}" for name in walls), *(place for place, T in comes.items() if T is not None)]
    for row in parts.row:
        if row.heat_flow and row.wall not in walls:
            raise CaseError(
                f"scene.row.{row.name}: wall {row.wall} has no temperature, so no heat flows into it; give it one"
            )
    if not warm:
        return None
    given = f"{parts.place(f'{warm[0]}.temperature')} is given"
    for place, T in comes.items():
        if T is None:
            raise CaseError(f"{parts.place(f'{place}.temperature')} is missing: {given}, and every sphere needs one")
    conducting = {w.material for w in parts.wall if w.name in walls}
    conductivities, capacities = [], []
    for t in m.types:
        x = case.materials[t.material]
        for key in ("thermal_conductivity", "specific_heat"):
            needed = not t.wall or (key == "thermal_conductivity" and t.material in conducting)
            if needed and getattr(x, key) is None:
                raise CaseError(f"materials.{t.material}.{key} is missing: {given}")
        conductivities.append(x.thermal_conductivity or 1.0)
        capacities.append(x.specific_heat or 1.0)
    return Heat(case.contact.heat_share, tuple(conductivities), tuple(capacities), walls)
