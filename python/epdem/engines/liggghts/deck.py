# SPDX-License-Identifier: GPL-2.0-or-later
"""The LIGGGHTS decks of impacts and of scenes: all values of the templates."""

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...base import rendering as decks
from ...base.declarations import declarations
from ...errors import CaseError
from ...impacts.plan import Plan
from ...jobs.engine import Unsupported
from ...scenes.plan import quantities
from ...scenes.plan.meshes import stl_text
from ...scenes.plan.model import Model
from ...scenes.plan.plan import ScenePlan
from ...scenes.tables.columns import GROWTH, columns_of_spheres
from .. import log
from ..frames import later, phase_at
from ..host import refuse_narrow
from ..input_script import SKIN, SKIN_OF_GROWTH, default_skin, finite, heat_words, row_words
from . import launcher
from .primitives import Primitive, WallLoad, loads, primitives, tubes
from .properties import HARD, SOFT, Property, of_model, tangential, wear
from .scene_parts import DeckPhase, InsertFix, SurfaceMesh, insertions, phases, surface_meshes
from .scene_parts import data as data_files

PATH = "path.bin"  # dump of impacts
MOST_CELLS = 2**31 - 1  # that LIGGGHTS counts, each half as wide as its longest reach
LEAST_SPAN = 1e-4  # of all coordinates of a mesh [m]


@dataclass(frozen=True)
class ContactWords:
    """Materials and contact model of pairs and walls. hard, soft: whether a modulus is beyond LIGGGHTS's limits.

    has_history: whether contacts have a memory. settings: behind everything else of a pair or wall line.
    """

    hard: bool
    soft: bool
    has_history: bool
    properties: tuple[Property, ...]
    model: str
    tangential: str
    cohesion: str | None
    rolling_friction: str | None
    settings: tuple[str, ...]


def contact_words(m: Model, properties: Sequence[Property] = (), recorded: Sequence[str] = ()) -> ContactWords:
    """A contact model in words of LIGGGHTS. properties: beside those of the model; recorded: settings of what a scene
    records. Raises CaseError."""
    moduli = [finite(t.young_modulus) for t in m.types]
    dashpot = ["viscous on"] * (m.viscous is not None)
    if m.viscous is not None and m.sliding and m.tangential_restitution is None:
        dashpot.append("tangential_damping off")  # a dashpot along the normal alone
    return ContactWords(
        hard=max(moduli) > HARD,
        soft=min(moduli) < SOFT,
        has_history=m.yields or m.spins or m.adheres or m.cohesion is not None,  # sjkr keeps one, too
        properties=(*of_model(m), *properties),
        model=f"ep/{m.law}",
        tangential=tangential(m),
        cohesion="sjkr" if m.cohesion else "ep/bond" if m.bond else None,
        rolling_friction=m.rolling.model if m.rolling else None,
        settings=(*dashpot, *recorded, *["compaction on"] * m.compaction),
    )


@dataclass(frozen=True)
class ImpactDeck:
    """Values of the template of impacts. types: materials of the atom types. wall_type: None: two spheres meet."""

    plan: Plan
    contact: ContactWords
    skin: float
    types: tuple[str, ...]
    wall_type: int | None


def memory(m: Model, *, wall: bool = False) -> int:
    """History values of one contact in LIGGGHTS, in this order: law, step, friction, rolling, compaction."""
    law = declarations()[m.law].memory
    friction = 3 * m.nodes + 1 if m.nodes else 3 * m.sliding
    others = friction + 3 * (m.rolling is not None and m.rolling.model in ("epsd", "epsd2"))
    stamp = 0 if wall else int(law + others > 0)
    return law + stamp + others + (len(declarations()[m.law].growth) if m.compaction else 0)


def history(m: Model, *, wall: bool = False) -> dict[str, int]:
    """Where the history of a contact has our columns, from 1: first the law's, of which the root of `attached` is above
    0, last what compaction adds."""
    growth = declarations()[m.law].growth
    begin = memory(m, wall=wall) + 1 - len(growth)
    first = ["delta_max"] * m.yields + ["attached"] * m.adheres
    places = {name: n for n, name in enumerate(first, 1)}
    return places | {name: begin + growth.index(name) for name in [*GROWTH, *["broken"] * bool(m.bond)] if m.compaction}


def contact_columns(slots: Collection[int], values: int, points: int = 0) -> tuple[int, ...]:
    """Where a local compute has these numbers of the history, the overlap, the force and `points`: the points stand
    first, then three ids and the force, then `values` of history, the overlap last."""
    ids = 3 * points
    begin = ids + 6
    history = (*(begin + slot for slot in slots), begin + values + 1) if slots else (begin + 1,)
    return (*history, *range(ids + 4, begin + 1), *range(1, ids + 1))


def _refuse_room(p: ScenePlan) -> None:
    """Raise Unsupported for a room in which LIGGGHTS cannot count the cells where it looks for neighbours."""
    sides = [high - low for low, high in zip(p.box[::2], p.box[1::2], strict=True)]
    width = p.largest + 0.5 * SKIN * p.smallest  # half of the longest reach
    cells = math.prod(max(1.0, side / width) for side in sides)
    if cells > MOST_CELLS:
        raise Unsupported(
            f"scene: the room of {' x '.join(f'{side:g}' for side in sides)} m has {cells:.3g} cells of the size of "
            f"the spheres, LIGGGHTS takes {MOST_CELLS}",
            "check the units of lengths, speeds and rates",
        )


def _refuse_meshes(p: ScenePlan) -> None:
    """Raise Unsupported for a mesh that LIGGGHTS takes for an empty one."""
    formulas = tubes(p)
    for name, triangles in p.triangles.items():
        if name not in formulas and np.ptp(triangles) < LEAST_SPAN:
            raise Unsupported(
                f"scene.wall.{name}: its coordinates span {np.ptp(triangles):.3g} m, LIGGGHTS takes meshes from "
                f"{LEAST_SPAN:g} m on",
                "give all lengths 1000 times, which changes no density under pressure without gravity and adhesion",
            )


def _refuse_skin(p: ScenePlan) -> None:
    """Raise CaseError for a skin with which planes and cylinders find spheres late that touch them by growth alone."""
    skin, least = p.case.numerics.skin, SKIN_OF_GROWTH * p.largest
    if p.model.compaction and skin is not None and skin < least:
        raise CaseError(
            f"numerics.skin = {skin:g} m: with law.compaction spheres grow by up to a tenth of their radius, and lists "
            f"are made anew after half a skin; give at least {SKIN_OF_GROWTH:g} of the largest radius, {least:g} m"
        )


def _refuse_restarts(p: ScenePlan) -> None:
    """Raise Unsupported for motions that LIGGGHTS's restart files do not hold."""
    others = any(not move.constant_velocity for phase in p.phases for move in phase.moves.values())
    if p.restarts and others:
        raise Unsupported(
            "output.restarts: in LIGGGHTS only walls with linear motions go on where they were", "remove it"
        )


@dataclass(frozen=True)
class SceneDeck:
    """Values of the templates of a scene.

    frozen: ids of spheres that rest. open: whether a variable holds the step. from_restart: file from which the run
    continues, in the phase of number `resumed_phase`; comes: whether the spheres that come with that phase are still to
    come.
    """

    plan: ScenePlan
    contact: ContactWords
    skin: float
    primitives: tuple[Primitive, ...]
    meshes: tuple[SurfaceMesh, ...]
    loads_of: tuple[WallLoad, ...]
    frozen: tuple[int, ...]
    insertions: tuple[InsertFix, ...]
    phases: tuple[DeckPhase, ...]
    open: bool
    particle_words: tuple[str, ...]
    work_words: tuple[str, ...]
    history: dict[str, int]
    wall_history: dict[str, int]
    contact_columns: tuple[int, ...]
    wall_contact_columns: tuple[int, ...]
    row_words: tuple[str, ...]
    heat: str
    from_restart: str | None = None
    resumed_phase: int = 0
    comes: bool = False

    @property
    def starts_empty(self) -> bool:
        """Whether no sphere comes with the first phase."""
        first = self.plan.phases[0].name
        return not self.plan.scene.table and all(f.phase != first for f in self.plan.insertions)


def deck(p: ScenePlan) -> SceneDeck:
    """The deck of a scene. Raises CaseError for what LIGGGHTS cannot do."""
    _refuse_room(p)
    skin = p.case.numerics.skin or default_skin(p)
    refuse_narrow(p, 2.0 * (2.0 * p.largest + skin), "LIGGGHTS has one history for a pair of spheres, also for images")
    _refuse_meshes(p)
    _refuse_skin(p)
    _refuse_restarts(p)
    m, works = p.model, ["computePlasticWork on"] + ["computeElasticEnergy off"] * p.model.compaction
    recorded = works * bool(p.works or p.heat) + ["computeContactStrain on"]
    commands = phases(p)
    return SceneDeck(
        plan=p,
        contact=contact_words(m, wear(p), recorded),
        skin=skin,
        primitives=primitives(p),
        meshes=surface_meshes(p),
        loads_of=loads(p),
        frozen=tuple(n for n, sphere in enumerate(p.scene.table, 1) if sphere.frozen),
        insertions=insertions(p),
        phases=commands,
        open=p.ends_early or any(phase.speeds for phase in commands),
        particle_words=quantities.words("liggghts", columns_of_spheres(p)),
        work_words=quantities.words("liggghts", p.works),
        history=history(m),
        wall_history=history(m, wall=True),
        contact_columns=contact_columns(history(m).values(), memory(m)),
        wall_contact_columns=contact_columns(history(m, wall=True).values(), memory(m, wall=True), points=2),
        row_words=(
            "c_ratio[1]",
            "c_ratio[2]",
            *row_words(p),
            *(f"f_flow{n}" for n in p.heat_flows),
            *["v_awaited", "v_opposite"] * _looks_at_primitives(commands),
        ),
        heat=heat_words(p),
    )


def _looks_at_primitives(commands: Sequence[DeckPhase]) -> bool:
    """Whether a condition needs a sum over spheres, which LIGGGHTS has at a step only if its thermo line has it."""
    return any("c_load" in x.stop.formula + x.stop.opposite + x.stop.force for x in commands if x.stop)


def files(p: ScenePlan) -> dict[str, str]:
    """The text of every file of a scene's deck by its name; it runs by hand where they are. Raises CaseError."""
    data = deck(p)
    texts = {
        "in.scene": decks.render("liggghts/scene.in.j2", deck=data),
        "setup.in": decks.render("liggghts/scene_setup.in.j2", deck=data),
    }
    texts |= data_files(p)
    formulas = tubes(p)
    return texts | {f"{name}.stl": stl_text(name, x) for name, x in p.triangles.items() if name not in formulas}


def _going_on(d: SceneDeck, phase: int, inserted: dict[str, int]) -> Iterator[InsertFix]:
    """The insertions of a run that goes on in a phase, without streams that have ended: LIGGGHTS refuses these. A
    stream of an earlier phase goes on in this one."""
    names = [part.run.name for part in d.phases]
    for f in d.insertions:
        if f.fill.rate is None:
            yield f
        elif inserted.get(f"fill{f.number}", 0) < f.fill.count:
            number = min(max(names.index(f.fill.phase), phase), len(names) - 1)
            yield replace(f, fill=replace(f.fill, phase=names[number]))


def write_resume(p: ScenePlan, folder: Path, step: int) -> Path:
    """in.resume, which continues from the restart file of `step`."""
    d = deck(p)
    number, begin = phase_at(p, folder / launcher.OUT, step)
    comes = False  # spheres that come with this phase and are not in the restart file
    if number < len(p.phases):
        part = d.phases[number]
        at_once = [f for f in d.insertions if f.fill.rate is None and f.fill.phase == part.run.name]
        comes = step == begin and bool(part.bodies or at_once)
        gone = step - begin
        stop = later(part.stop, folder / launcher.OUT, step, gone, p.every)
        rest = replace(part, steps=part.steps - gone, stop=stop)
        d = replace(d, phases=(*d.phases[:number], rest, *d.phases[number + 1 :]))
    path = folder / "in.resume"
    going_on = tuple(_going_on(d, number, log.inserted(folder / launcher.OUT, step)))
    continued = replace(d, insertions=going_on, from_restart=f"restart.{step}.bin", resumed_phase=number, comes=comes)
    path.write_text(decks.render("liggghts/scene_resume.in.j2", deck=continued), encoding="utf-8")
    return path
