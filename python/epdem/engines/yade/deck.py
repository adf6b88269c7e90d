# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE's decks of impacts and of scenes: values of the templates, tables of spheres and triangles."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isinf

import numpy as np

from ...base import rendering as decks
from ...impacts.plan import Group, Plan, side_by_side
from ...scenes.plan import placement
from ...scenes.plan.phases import PhaseSteps
from ...scenes.plan.plan import ScenePlan
from ...scenes.plan.quantities import WORKS
from ..host import refuse, refuse_narrow
from .classes import ContactClasses, functors, materials
from .scene_parts import (
    HEAD,
    DeckMotion,
    LateSpheres,
    Stop,
    Wall,
    check_walls,
    late_spheres,
    loads,
    motions,
    stop,
    table_text,
    walls,
)
from .scene_parts import files as files_of_parts

SCRIPT, SPHERES = "scene.py", "spheres.txt"
ENLARGED = 1.25  # bounds of spheres that grow
SKIN = 0.25  # of the smallest radius: few sortings and few idle neighbours


@dataclass(frozen=True)
class Anvil:
    """A fixed sphere under each body, its centre at z [m]: it replaces the wall of a law that has spheres only."""

    radius: float
    material: str
    z: float


@dataclass(frozen=True)
class ImpactDeck:
    """Values of the template of impacts. wall_material: None: the target is a sphere.

    samples: one more than the plan has, for a velocity is the mean of those half a step away. axes: of the trajectory.
    """

    plan: Plan
    contact: ContactClasses
    anvil: Anvil | None
    wall_material: str | None
    bodies: tuple[Group, ...]
    skin: float
    samples: int
    axes: tuple[int, ...] = (2,)


def body_tables(plan: Plan) -> list[np.ndarray]:
    """x, y, z [m] and v_z [m/s] of the bodies, and of targets that move; v_x and omega_y too if they are oblique."""
    tables = []
    for g in side_by_side(plan):
        spin = np.zeros(plan.n) if g.spin is None else g.spin
        more = [g.velocity[:, 0], spin] if plan.experiment.oblique else []
        tables.append(np.column_stack([g.place, g.velocity[:, 2], *more]))
    return tables


def axes(plan: Plan) -> tuple[int, ...]:
    """Along z, and along x between spheres that meet obliquely."""
    return (0, 2) if plan.experiment.oblique and not isinf(plan.experiment.target.radius) else (2,)


def check(p: ScenePlan) -> None:
    """Raise CaseError for parts of a scene that YADE does not have."""
    out = p.output
    check_walls(p)
    rolling = p.model.rolling and p.model.rolling.model
    unknown: dict[str, tuple[object, str]] = {
        "contact.rolling": (rolling == "epsd" and rolling, "YADE's laws have cdt and epsd2"),
        "temperature": (p.heat is not None, "the module of YADE conducts no heat"),
        "output.restarts": (out.restarts, "a YADE scene is not continued"),
        "output.pictures": (out.pictures, "YADE draws none without a display"),
    }
    for fill in p.insertions:
        unknown[f"{fill.key} with a rate"] = (fill.rate, "all spheres come at the begin of a phase")
    for name in p.stress_walls:
        key = "wear" if p.scene.meshes[name].wear else "stress"
        unknown[f"scene.wall.{name}.{key}"] = (True, "a YADE scene writes the force of a whole wall")
    for place, (value, reason) in unknown.items():
        refuse(place, value, reason)


@dataclass(frozen=True)
class DeckPhase:
    """A phase. late: the spheres that come at its begin. stop: condition on a row that ends it."""

    run: PhaseSteps
    motions: tuple[DeckMotion, ...]
    late: LateSpheres | None
    stop: Stop | None


@dataclass(frozen=True)
class SceneDeck:
    """Values of the template of a scene.

    cell: sides of the periodic cell [m], twice the room where this does not repeat. walls: that are there at the start,
    `late`: that come later. placed: whether spheres are there at the start. sampling: steps between two calls of the
    recorder. loads: walls with the place of their torque.
    """

    plan: ScenePlan
    contact: ContactClasses
    cell: tuple[float, float, float]
    walls: tuple[Wall, ...]
    late: tuple[Wall, ...]
    placed: bool
    skin: float
    phases: tuple[DeckPhase, ...]
    motions: tuple[DeckMotion, ...]
    sampling: int
    works: tuple[str, ...]
    loads: tuple[tuple[str, Sequence[float] | None], ...]


def _placed(p: ScenePlan) -> bool:
    """Whether there are spheres at the start."""
    first = p.phases[0].name
    return bool(p.scene.table) or any(f.phase == first for f in p.insertions)


def deck(p: ScenePlan) -> SceneDeck:
    """The YADE deck of a scene. Raises CaseError for what YADE cannot do."""
    check(p)
    skin = p.case.numerics.skin or float(f"{SKIN * p.smallest:.1e}")
    reach = p.largest * (ENLARGED if p.model.compaction else 1.0) + skin
    refuse_narrow(p, 4.0 * reach, "YADE finds no contacts of spheres whose bounds are half of a period")
    m, every_wall = p.model, walls(p)
    phases = tuple(DeckPhase(x, motions(p, x), late_spheres(p, x.name), stop(p, x)) for x in p.phase_steps)
    shapes = ("Sphere", *sorted({w.shape.capitalize() for w in every_wall.values()}))
    sides = zip(p.scene.periods, p.box[0::2], p.box[1::2], strict=True)
    x, y, z = (period or 2.0 * (high - low) for period, low, high in sides)
    there = {*p.scene.meshes, *(w.name for w in p.scene.planes), *p.phases[0].gates}
    return SceneDeck(
        plan=p,
        contact=ContactClasses(m.law, functors(m, shapes, recordStrain=True), materials(m)),
        cell=(x, y, z),
        walls=tuple(wall for name, wall in every_wall.items() if name in there),
        late=tuple(wall for name, wall in every_wall.items() if name not in there),
        placed=_placed(p),
        skin=skin,
        phases=phases,
        motions=tuple(motion for phase in phases for motion in phase.motions),
        sampling=1 if p.row_columns else p.sampling if p.measured_walls else p.every,
        works=tuple(WORKS[name].words["yade"] for name in p.works if "yade" in WORKS[name].words),
        loads=tuple(loads(p)),
    )


def files(p: ScenePlan) -> dict[str, str]:
    """All files of a YADE scene by name; they run by hand in one folder. Raises CaseError."""
    deck_files = {SCRIPT: decks.render("yade/scene.py.j2", deck=deck(p))}
    if _placed(p):
        deck_files[SPHERES] = table_text(HEAD, placement.spheres(p).tolist())
    return deck_files | files_of_parts(p)
