# SPDX-License-Identifier: GPL-2.0-or-later
"""The LAMMPS decks of impacts and of scenes: an input file, and a data file for the spheres of each phase."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations
from pathlib import Path

import numpy as np

from ...base import rendering as decks
from ...case.walls import StlWall
from ...impacts.plan import Plan
from ...jobs.engine import Unsupported
from ...scenes.plan import placement, quantities
from ...scenes.plan.meshes import stl_text
from ...scenes.plan.model import Model
from ...scenes.plan.phases import PhaseSteps
from ...scenes.plan.plan import ScenePlan
from ...scenes.tables.columns import columns_of_frames
from .. import log
from ..frames import later, phase_at
from ..host import refuse
from ..input_script import (
    StopCondition,
    data_text,
    default_skin,
    heat_words,
    row_words,
    stop_condition,
    taken_places,
    temperature_words,
)
from . import launcher
from .scene_walls import (
    DeckWall,
    force,
    height,
    meshes,
    motions,
    motions_again,
    of_type,
    options,
    plane,
    power,
    restart_commands,
    stop_commands,
    way,
)

ROLLING = ("cdt", "epsd2")
PATH, END = "path.txt", "end.txt"  # dumps of impacts


@dataclass(frozen=True)
class ImpactDeck:
    """Values of the template of impacts. types: materials of the atom types. pairs: the words of each type. wall: the
    words of the wall; None: none is hit. columns: of the trajectory.
    """

    plan: Plan
    skin: float
    types: tuple[str, ...]
    pairs: tuple[str, ...]
    wall: str | None
    columns: str = "z vz fz"


def check(p: ScenePlan) -> None:
    """Raise CaseError for what a scene in LAMMPS does not have."""
    m = p.model
    rolling = m.rolling.model if m.rolling else None
    refuse("contact.rolling.model", rolling not in (None, *ROLLING) and rolling, "pair ep in LAMMPS has cdt and epsd2")
    for fill in p.insertions:
        refuse(f"{fill.key} with a rate", fill.rate, "all spheres come at the begin of a phase")
    if not len(placement.spheres(p)):
        raise Unsupported("scene: no sphere is there at the start, LAMMPS needs one")


@dataclass(frozen=True)
class PhaseCommands:
    """A phase. data: file of the spheres that come with it; None: none do. placed: spheres that were placed before.
    temperatures: first and last id of spheres and their temperature.

    steps: that are left. time_step [s]: None: that of the phase before. places: formulas of the spheres that lie in the
    places of single ones. driven: walls that a force has driven, words of their ways. fills: key, id, and limits of the
    region that has to be empty. gates: planes that come with it. commands: which set walls in motion. ends: fixes that
    end with it. restart_commands: where a restart is due.
    """

    run: PhaseSteps
    steps: int
    time_step: float | None
    data: str | None
    placed: int
    temperatures: tuple[str, ...]
    places: tuple[tuple[str, str], ...]
    driven: tuple[tuple[str, list[str]], ...]
    fills: tuple[tuple[str, str, str], ...]
    gates: tuple[DeckWall, ...]
    commands: tuple[str, ...]
    ends: tuple[str, ...]
    stop: StopCondition | None
    restart_commands: tuple[str, ...]


@dataclass(frozen=True)
class Restart:
    """Where a run continues. file: the restart file; gates: planes that are there beside the walls of all phases."""

    file: str
    gates: tuple[DeckWall, ...]


@dataclass(frozen=True)
class SceneDeck:
    """Values of the template of a scene.

    materials: type, material, options of its contacts; pairs: two types, options. frozen: ids of spheres that rest.
    columns: of the frames.
    """

    plan: ScenePlan
    skin: float
    settings: str
    materials: tuple[tuple[int, str, str], ...]
    pairs: tuple[tuple[int, int, str], ...]
    motions: tuple[str, ...]
    power: str
    walls: tuple[DeckWall, ...]
    frozen: tuple[int, ...]
    phases: tuple[PhaseCommands, ...]
    contact_walls: tuple[str, ...]
    stress_walls: tuple[str, ...]
    row_words: tuple[str, ...]
    columns: tuple[str, ...]
    heat: str
    restart: Restart | None = None


def _phases(p: ScenePlan) -> Iterator[PhaseCommands]:
    gates = {w.name: plane(p, w) for w in p.scene.gates}
    for number, run in enumerate(p.phase_steps):
        yield PhaseCommands(
            run=run,
            steps=run.steps,
            time_step=run.own_time_step,
            data=_data_file(p, run.name),
            placed=p.count_before(run.name),
            temperatures=temperature_words(p, run.name, placement.temperatures(p, run.name)),
            places=taken_places(p, run.name, "radius"),
            driven=tuple((name, way(p, name)) for name in p.driven_before(run.name)),
            fills=tuple(_fills(p, run.name)),
            gates=tuple(gates[name] for name in run.added),
            commands=(*motions(p, number), *_power(p, number)) if number else (),
            ends=tuple(decks.wall_id(name) for name in run.removed),
            stop=stop_condition(p, run, partial(height, p), force, stop_commands(p, run)),
            restart_commands=restart_commands(p, number),
        )


def _power(p: ScenePlan, number: int) -> list[str]:
    """The command for the power of the walls from a phase on; none, if that of the phase before holds."""
    now, before = (power(p, p.phases[k]) for k in (number, number - 1))
    return [f"variable power equal {now}"] if "wall_power" in p.row_columns and now != before else []


def deck(p: ScenePlan) -> SceneDeck:
    """The deck of a scene. Raises CaseError for what LAMMPS cannot do."""
    check(p)
    m, types = p.model, range(1, len(p.model.types) + 1)
    return SceneDeck(
        plan=p,
        skin=p.case.numerics.skin or default_skin(p),
        settings=(" works" if m.compaction else " energies") * (p.output.energy or p.contacts > 0 or p.heat is not None)
        + " strain",
        materials=tuple((i, of_type(m, i), options(m, i, i)) for i in types),
        pairs=tuple((i, j, options(m, i, j)) for i, j in combinations(types, 2) if _is_special(m, i, j)),
        motions=tuple(motions(p, 0)),
        power=power(p, p.phases[0]),
        walls=(*(plane(p, w) for w in p.scene.planes), *meshes(p)),
        frozen=tuple(n for n, s in enumerate(p.scene.table, 1) if s.frozen),
        phases=tuple(_phases(p)),
        contact_walls=tuple(decks.wall_id(w) for w in contact_walls(p)),
        stress_walls=tuple(map(decks.wall_id, p.stress_walls)),
        row_words=(
            "f_ratio[1]",
            "f_ratio[2]",
            *row_words(p),
            *(f"f_flow{n}" for n in p.heat_flows),
        ),
        columns=quantities.words("lammps", columns_of_frames(p)),
        heat=heat_words(p),
    )


def _is_special(m: Model, i: int, j: int) -> bool:
    """Whether two types have other coefficients than the mean of the like pairs."""
    own = options(m, i, j)
    return own != options(m, i, i) or own != options(m, j, j)


def contact_walls(p: ScenePlan) -> list[str]:
    """The walls whose contacts are in the tables: those that are always there."""
    return [w.name for w in p.scene.planes] + [*p.scene.meshes]


def _data_file(p: ScenePlan, phase: str) -> str | None:
    """The data file of the spheres that come with a phase but the first; None: none do."""
    come = _fills(p, phase) or any(b.phase == phase for b in p.scene.later)
    return f"phase_{phase}.data" if come else None


def _fills(p: ScenePlan, phase: str) -> list[tuple[str, str, str]]:
    """Of each fill of a phase but the first: key, id, limits of a block that holds the centres of what it may touch."""
    fills = [(n, f) for n, f in enumerate(p.insertions, 1) if f.phase == phase != p.phases[0].name]
    wider = np.tile([-p.largest, p.largest], 3)
    return [(f.key, f"fill{n}", " ".join(map(decks.number, f.region.limits + wider))) for n, f in fills]


def _data(p: ScenePlan, phase: str) -> str:
    rows = [*placement.spheres(p, phase).tolist(), *placement.later_bodies(p, phase)]
    density = [0.0, *(t.density for t in p.model.types)]
    spheres = [(kind, 2 * r, density[int(kind)], x, y, z, *motion) for x, y, z, r, kind, *motion, _ in rows]
    return data_text(f"spheres of {p.case.name}", len(p.model.types), p.box, spheres)


def files(p: ScenePlan) -> dict[str, str]:
    """The text of every file of a scene's deck by its name. Raises CaseError."""
    data = deck(p)
    texts = {"in.scene": decks.render("lammps/scene.in.j2", deck=data), "spheres.data": _data(p, p.phases[0].name)}
    texts |= {phase.data: _data(p, phase.run.name) for phase in data.phases if phase.data}
    files_of_walls = [w.name for w in p.scene.wall if isinstance(w, StlWall) or w.name in p.stress_walls]
    return texts | {f"{name}.stl": stl_text(name, p.triangles[name]) for name in files_of_walls}


def write_resume(p: ScenePlan, folder: Path, step: int) -> Path:
    """in.resume, which continues from the restart file of `step`."""
    path, out = folder / "in.resume", folder / launcher.OUT
    path.write_text(decks.render("lammps/scene.in.j2", deck=_continued(p, out, step)), encoding="utf-8")
    return path


def _continued(p: ScenePlan, out: Path, step: int) -> SceneDeck:
    d = deck(p)
    number, begin = phase_at(p, out, step)
    phases = d.phases[number:]
    inside = bool(phases) and step > begin
    if inside:
        part, gone = phases[0], step - begin
        rest = replace(part, steps=part.steps - gone, stop=later(part.stop, out, step, gone, p.every))
        phases = (
            replace(rest, time_step=None, data=None, temperatures=(), fills=(), gates=(), commands=()),
            *phases[1:],
        )
    last = number if inside else number - 1  # the phase whose motions and planes the restart file meets
    return replace(
        d,
        phases=phases,
        power=power(p, p.phases[last]),
        motions=tuple(motions_again(p, last, _printed(out, step))),
        restart=Restart(f"restart.{step}.bin", tuple(_gates(p, last, ended=not inside))),
    )


def _gates(p: ScenePlan, number: int, *, ended: bool) -> list[DeckWall]:
    """The planes of some phases that are there in a phase, or after it has ended, in the order of their fixes."""
    there: list[str] = []
    for run in p.phase_steps[: number + 1]:
        there += run.added
        if ended or run.name != p.phases[number].name:
            there = [name for name in there if name not in run.removed]
    walls = {w.name: w for w in p.scene.gates}
    return [plane(p, walls[name]) for name in there]


def _printed(out: Path, step: int) -> dict[str, str]:
    """The values of the variables of motions that the run printed at a step."""
    lines = log.said(out, rf"^motions at step {step}: (.*)$")
    return dict(value.split("=") for value in lines[-1].split()) if lines else {}
