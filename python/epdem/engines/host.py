# SPDX-License-Identifier: GPL-2.0-or-later
"""Base of LIGGGHTS, YADE and LAMMPS as engines: a deck in a folder, of impacts or of a scene."""

import logging
from abc import abstractmethod
from collections.abc import Collection, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, ClassVar, TypeVar

import pandas as pd

from ..base import rendering as decks
from ..base.files import stored_results
from ..base.processes import crowded
from ..case.motions import Move
from ..impacts.plan import Plan
from ..jobs.engine import Engine, Report, Unsupported, check_law, silent
from ..jobs.stage import Tables, parts_hash
from ..scenes.plan.limits import refuse_bodies_in_moved_walls
from ..scenes.plan.model import Model
from ..scenes.plan.phases import Phase
from ..scenes.plan.plan import ScenePlan
from ..scenes.tables.columns import complete, named_rows, with_first_works
from . import log
from .frames import Frames, choose, pruning
from .input_script import impact_data

T = TypeVar("T")


class Host(Engine[Any, Any]):
    """An engine whose decks run without epdem: a job is a plan of impacts or of a scene."""

    title: str  # the program's name
    template: str  # of impacts
    laws: tuple[str, ...] | None = None
    left_out: ClassVar[dict[str, str]] = {}  # keys of [numerics] that the program does not have, and why
    launcher: ModuleType  # missing, version, run and OUT (file of both streams) of the program
    scripts = ("in.impact", "in.scene")  # names of the decks
    # patterns of files that an earlier run of a scene may have left in the folder
    leftovers = "particles.*.* contacts*.*.* wall_contacts.*.txt stress_*.*.* picture.*.ppm restart.*.bin in.resume"
    scene_deck: ModuleType  # deck and files of a scene; with Feature.RESTART write_resume
    # trajectory of impacts; of a scene kinds of frames ("particles", "contacts", "stress_WALL"), contacts and rows
    tables: ModuleType

    def missing(self) -> str | None:
        reason: str | None = self.launcher.missing()
        return reason

    def version(self) -> str:
        return f"{self.launcher.version()}, epdem {parts_hash(self)[:12]}"

    @abstractmethod
    def deck(self, plan: Plan, model: Model | None = None) -> Any:
        """The deck of a plan; model: in place of its own. Raises CaseError for what the program cannot do."""

    def data(self, deck: Any) -> dict[str, str]:
        """The data files of a deck of impacts by name."""
        return {"impact.data": impact_data(deck.plan, len(deck.types))}

    def files(self, job: Plan | ScenePlan) -> dict[str, str]:
        if isinstance(job, ScenePlan):
            return dict(self.scene_deck.files(job))
        deck = self.deck(job)
        return {self.scripts[0]: decks.render(self.template, deck=deck)} | self.data(deck)

    def notes(self, plan: ScenePlan) -> list[str]:
        """Sentences on what a scene leaves out."""
        numerics = plan.case.numerics
        return [f"numerics.{k}: {why}, it was left out" for k, why in self.left_out.items() if getattr(numerics, k)]

    def check(self, job: Plan | ScenePlan) -> list[str]:
        if isinstance(job, ScenePlan):
            check_law(self, job.model.law)
            self.scene_deck.deck(job)
            return self.notes(job)
        self.deck(job)
        return []

    def start(self, script: str, folder: Path, **how: Any) -> float:
        """Run a deck that is in `folder` to its end; seconds taken. Raises EngineError."""
        if said := crowded(how.get("ranks", 1)):
            logging.getLogger("epdem").warning(said)
        return float(self.launcher.run(script, folder, **how))

    def run(self, job: Any, folder: Path, *, ranks: int = 1, report: Report = silent) -> Any:
        earlier = stored_results(folder)
        if isinstance(job, ScenePlan):
            earlier.remove(*self.leftovers.split())
            self.start(self.scripts[1], folder, ranks=ranks, report=pruning(folder, report))
            return self.read(job, folder)
        earlier.remove("path.*", "end.*")
        total = self.start(self.scripts[0], folder, ranks=ranks, seconds=120 + 2e-5 * job.n * job.steps)
        seconds = {"total": total, "stepping": log.loop_seconds(folder / self.launcher.OUT)}
        found = self.tables.trajectory(job, folder, seconds)
        earlier.remove("path.*")  # large
        return found

    def resume(self, job: ScenePlan, folder: Path, *, ranks: int, report: Report) -> tuple[Tables, int, list[int]]:
        out = folder / self.launcher.OUT
        begun = job.with_ends(log.ends(out), held=log.held(out)) if job.ends_early else job
        frames = Frames(begun, folder, self.tables.kinds(begun))
        step, lost = choose(frames, out)
        written = frames.whole_at(step)
        script = self.scene_deck.write_resume(job, folder, step)
        self.start(script.name, folder, ranks=ranks, append=True, report=pruning(folder, report))
        for path, content in written.items():
            path.write_bytes(content)
        return self.read(job, folder, without=lost), step, lost

    def read(self, plan: ScenePlan, folder: Path, *, without: Collection[int] = ()) -> Tables:
        """The tables of a run, SI, without the frames of the steps `without`.

        Raises EngineError for a frame that is missing or not whole, and for a body that came into a wall.
        """
        out, own = folder / self.launcher.OUT, self.tables
        plan = plan.with_ends(log.ends(out), log.not_reached(out), log.held(out)) if plan.ends_early else plan
        refuse_bodies_in_moved_walls(plan, log.ways(out))
        frames = Frames(plan, folder, own.kinds(plan), without)
        rows = own.rows(plan, out)
        plan = plan.with_ways(rows)
        found: Tables = {"rows": named_rows(plan, rows)}
        if plan.frames:
            found["particles"] = spheres = frames.spheres()
        if plan.contacts:
            parts = own.contacts(frames, spheres)
            raw = pd.concat([part for part in parts if len(part)] or parts[:1], ignore_index=True)
            found["contacts"] = complete(plan, raw, spheres, folder)
            found["particles"] = with_first_works(plan, spheres, found["contacts"])
        if plan.stress_walls:
            stresses = {name: frames.table(f"stress_{name}") for name in plan.stress_walls}
            for name, table in stresses.items():
                table.insert(1, "wall", name)
            found["walls"] = pd.concat(stresses.values(), ignore_index=True).astype({"triangle": int})
        return found | {"phases": plan.phase_table}


def refuse(place: str, value: object, reason: str) -> None:
    """Raise Unsupported if a case gives what the engine does not have. True as a value is not shown."""
    if value:
        shown = "" if value is True else f" = {value!r}"
        raise Unsupported(f"{place}{shown}: {reason}", "remove it")


def words_of_motion(words: Mapping[type[Move], T], program: str, phase: Phase, wall: str) -> T:
    """A program's words for the motion of a wall in a phase. Raises Unsupported if it has none."""
    move = phase.moves[wall]
    if type(move) not in words:
        place = f"scene.phase.{phase.name}.move, wall {wall}"
        raise Unsupported(f"{place}: {program} has no words for the motion {move.kind!r}", "take another engine")
    return words[type(move)]


def refuse_narrow(p: ScenePlan, least: float, reason: str) -> None:
    """Raise Unsupported for a room that repeats after less than `least` [m]."""
    for axis, period in zip("xyz", p.scene.periods, strict=True):
        if 0.0 < period < least * (1.0 - 1e-9):
            raise Unsupported(
                f"scene.room.{axis}: the room repeats after {period:g} m, at least {least:.4g} m are needed: {reason}",
                "enlarge it, give a smaller numerics.skin",
            )
