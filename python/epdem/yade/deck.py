# SPDX-License-Identifier: GPL-2.0-or-later
"""The data of the template of an impact deck."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Material:
    """Keywords of Contacts.material, or of a material of YADE's own, SI."""

    name: str
    values: dict[str, float]


@dataclass(frozen=True)
class Group:
    """The bodies of one kind; `data` holds x, y, z [m] and v_z [m/s] of each."""

    data: str
    radius: float
    material: str


@dataclass(frozen=True)
class Anvil:
    """A fixed sphere under each body, its centre at z [m]."""

    radius: float
    material: str
    z: float


@dataclass(frozen=True)
class Deck:
    """Everything the template writes; every number was decided here."""

    title: str
    source: str
    summary: str
    rigid: bool
    law: str
    native: bool  # YADE's own law
    ratios: dict[str, float]
    materials: tuple[Material, ...]
    wall_material: str | None
    anvil: Anvil | None  # fixed spheres that replace the wall where YADE's law has spheres only
    bodies: tuple[Group, ...]
    skin: float
    time_step: float
    samples: int
    path: str
