# SPDX-License-Identifier: GPL-2.0-or-later
"""Base of LIGGGHTS, YADE and LAMMPS as engines: a deck in a folder, of impacts or of a scene."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection
from pathlib import Path
from types import ModuleType
from typing import overload

import pandas as pd

from ..base import rendering as decks
from ..base.files import stored_results, write_texts
from ..case import impact, scene
from ..case.toml import error_context, read_toml
from ..errors import CaseError, EngineError
from ..impacts.engine import Trajectory
from ..impacts.experiment import experiment
from ..impacts.plan import Plan, plan
from ..impacts.prediction import predict
from ..jobs.engine import Feature, Report, check_law, silent
from ..jobs.stage import Tables
from ..scenes.columns import named_rows
from ..scenes.engine import Resumed
from ..scenes.plan import ScenePlan
from ..scenes.plan import plan as plan_scene
from . import log
from .restarts import choose

LIGGGHTS = "use --engine liggghts"  # the engine of every scene


class Host(ABC):
    """An engine whose decks run without epdem."""

    name: str
    source: str | None
    title: str  # the program's name
    template: str  # of impacts
    laws: tuple[str, ...] | None = None
    features: frozenset[Feature]
    out: str  # file of both streams of a scene
    leftovers: tuple[str, ...]  # patterns of files that an earlier run of a scene may have left in the folder
    scene_deck: ModuleType  # deck and files of a scene
    scene_tables: ModuleType  # rows, particles, contact_table and wall_table of a scene from its files

    @abstractmethod
    def missing(self) -> str | None:
        """None if the program can run here, else a sentence with the command that installs it."""

    @abstractmethod
    def parts(self) -> list[Path]:
        """The compiled parts of epdem that the program loads."""

    @abstractmethod
    def deck(self, plan: Plan) -> object:
        """The deck of a plan. Raises CaseError for what the program cannot do."""

    @abstractmethod
    def impact_files(self, plan: Plan) -> dict[str, str]:
        """The text of every file of the deck of impacts by its name. Raises CaseError."""

    def check_scene(self, plan: ScenePlan) -> list[str]:
        """Sentences on what a scene leaves out. Raises CaseError for what the program cannot do."""
        self.scene_deck.deck(plan)
        return []

    def files(self, plan: ScenePlan) -> dict[str, str]:
        """The text of every file of the deck of a scene by its name. Raises CaseError."""
        texts: dict[str, str] = self.scene_deck.files(plan)
        return texts

    @abstractmethod
    def run_impacts(self, plan: Plan, folder: Path, ranks: int) -> Trajectory:
        """Run the deck of a plan, which is in `folder`. Raises EngineError."""

    @abstractmethod
    def run_scene(self, plan: ScenePlan, folder: Path, ranks: int, report: Report) -> None:
        """Run the deck of a scene, which is in `folder`. Raises CaseError, EngineError."""

    def read(self, plan: ScenePlan, folder: Path, *, without: Collection[int] = ()) -> Tables:
        """The tables of a run, SI, without the frames of the steps `without`.

        Raises EngineError for a frame that is missing or not whole.
        """
        out, own = folder / self.out, self.scene_tables
        plan = plan.with_ends(log.ends(out), log.not_reached(out)) if plan.ends_early else plan
        found: Tables = {"rows": named_rows(plan, own.rows(plan, out))}
        if plan.frames:
            found["particles"] = own.particles(plan, folder, without)
        if plan.contacts:
            found["contacts"] = own.contact_table(plan, folder, found["particles"], without)
        if plan.stress_walls:
            found["walls"] = own.wall_table(plan, folder, without)
        return found | {"phases": plan.phase_table}

    def check(self, job: Plan | ScenePlan) -> list[str]:
        if isinstance(job, ScenePlan):
            check_law(self, job.model.law)
            return self.check_scene(job)
        self.deck(job)
        return []

    def write(self, job: Plan | ScenePlan, folder: Path) -> list[Path]:
        return write_texts(folder, self.files(job) if isinstance(job, ScenePlan) else self.impact_files(job))

    @overload
    def run(self, job: Plan, folder: Path, *, ranks: int = 1, report: Report = silent) -> Trajectory: ...

    @overload
    def run(self, job: ScenePlan, folder: Path, *, ranks: int = 1, report: Report = silent) -> Tables: ...

    def run(
        self, job: Plan | ScenePlan, folder: Path, *, ranks: int = 1, report: Report = silent
    ) -> Trajectory | Tables:
        if not isinstance(job, ScenePlan):
            return self.run_impacts(job, folder, ranks)
        stored_results(folder).remove(*self.leftovers)
        self.run_scene(job, folder, ranks, report)
        return self.read(job, folder)

    def continue_scene(self, plan: ScenePlan, folder: Path, step: int, ranks: int, report: Report) -> None:
        """Continue a run from the restart file of a step, of an engine with Feature.RESTART. Raises EngineError."""
        raise NotImplementedError

    def resume(self, job: ScenePlan, folder: Path, *, ranks: int, report: Report) -> tuple[Tables, Resumed]:
        step, lost = choose(job, folder, folder / self.out, self.scene_tables.damaged)
        self.continue_scene(job, folder, step, ranks, report)
        return self.read(job, folder, without=lost), Resumed(step, lost)


def impact_head(plan: Plan) -> decks.Head:
    """The head of the deck of impacts."""
    x = plan.experiment
    return decks.Head(x.title, x.source, f"{plan.summary}, law {x.law.name}")


def scene_head(p: ScenePlan) -> decks.Head:
    """The head of the deck of a scene."""
    return decks.Head(p.case.case.title, p.case.case.source, p.summary)


def job_of(path: Path) -> Plan | ScenePlan:
    """The plan of the case or scene in a file. Raises CaseError."""
    data = read_toml(path)
    with error_context(path):
        if scene.is_scene(data):
            return plan_scene(scene.parse(data, path))
        x = experiment(impact.parse(data, path))
        return plan(x, predict(x))


def refuse(place: str, value: object, reason: str) -> None:
    """Raise CaseError if a case gives what the engine does not have. True as a value is not shown."""
    if value:
        shown = "" if value is True else f" = {value!r}"
        raise CaseError(f"{place}{shown}: {reason}; remove it or {LIGGGHTS}")


def frames(
    p: ScenePlan,
    folder: Path,
    pattern: str,
    every: int,
    read: Callable[[Path], pd.DataFrame],
    without: Collection[int] = (),
) -> pd.DataFrame:
    """The frames that a run of this plan writes, one below the other; other files of such names are the user's.

    pattern: name of the file of a step; read: the table of one file; without: steps that are left out. Raises
    EngineError for a frame that is missing or not whole.
    """
    tables = []
    for step in p.frame_steps(every):
        path = folder / pattern.format(step)
        try:
            if step not in without:
                tables.append(read(path))
                tables[-1].insert(0, "step", step)
        except EngineError:
            raise
        except Exception as error:  # of a damaged head numpy says almost anything
            reason = " ".join(str(error).split()) or type(error).__name__
            raise EngineError(f"{path}: incomplete ({reason}); run the case again") from None
    return pd.concat(tables, ignore_index=True)
