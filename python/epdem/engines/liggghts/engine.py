# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS with our plugin: impacts side by side in one deck, whose dump is a trajectory, and bulk scenes."""

import math
from collections.abc import Collection
from pathlib import Path
from typing import overload

import numpy as np

from ...base import paths
from ...base import rendering as decks
from ...base.files import write_texts
from ...base.folders import held
from ...case.kinds import KINDS
from ...errors import CaseError, EngineError
from ...impacts.engine import Feature, Report, Trajectory, check_features, silent
from ...impacts.placement import approach, room, side_by_side
from ...impacts.plan import Plan
from ...laws.library import laws
from ...scenes.engine import Resumed, Tables, check_scene
from ...scenes.plan import ScenePlan
from ...theory.sources import Source
from . import data_file, dump, executable, launcher, scene_deck, scenes
from .log import loop_seconds
from .properties import HARD, SOFT, Property, atom_types, finite, of_law, tangential
from .session import Session

PATH, END = "path.bin", "end.bin"


class Liggghts:
    """LIGGGHTS with a model of epdem; `model` and more can be replaced to run LIGGGHTS's own models."""

    name = "liggghts"
    source: Source | None = Source(
        "C. Kloss, C. Goniva, A. Hager, S. Amberger, S. Pirker",
        "Models, algorithms and validation for opensource DEM and CFD-DEM",
        "Prog. Comput. Fluid Dyn.",
        "12",
        "140",
        2012,
    )
    template = "liggghts/impact.in.j2"
    laws: tuple[str, ...] | None = None
    ranks = launcher.most_ranks()
    mpirun = launcher.MPIRUN
    features = frozenset(Feature) - {Feature.SPHERE_FRICTION}
    leftovers: tuple[str, ...] = scenes.LEFTOVERS

    def __init__(self, *, stay: bool = False):
        self.session = Session() if stay else None

    def missing(self) -> str | None:
        return launcher.missing()

    def version(self) -> str:
        path = paths.launcher()
        return (executable.version(path) if path else "") or "LIGGGHTS (version unknown)"

    def model(self, plan: Plan) -> str:
        return f"ep/{plan.experiment.law.name}"

    def tangential(self, plan: Plan) -> str | None:
        """The tangential model of a case; None: no friction."""
        return plan.experiment.oblique.tangential if plan.experiment.oblique else None

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        """The material properties of the deck, for this model."""
        return of_law(plan)

    def deck(self, plan: Plan) -> decks.Deck:
        """The deck of a plan. Raises CaseError for what LIGGGHTS cannot do."""
        x, types = plan.experiment, atom_types(plan)
        check_features(self, x)
        for b, _ in types:
            if b.poisson_ratio < 0:
                raise CaseError(
                    f"materials.{b.material}.poisson_ratio = {b.poisson_ratio}, LIGGGHTS takes [0, 0.5] "
                    "only; use --engine embedded"
                )
        moduli = [finite(b.young_modulus) for b, _ in types]
        return decks.Deck(
            plan,
            title=x.title,
            source=x.source,
            summary=f"{plan.summary}, law {x.law.name}",
            has_history=laws()[x.law.name].memory > 0 or x.oblique is not None,
            hard=max(moduli) > HARD,
            soft=min(moduli) < SOFT,
            data="impact.data",
            skin=0.2 * min(x.body.radius, x.target.radius),
            types=tuple(b.material for b, _ in types),
            properties=self.properties(plan),
            model=self.model(plan),
            tangential=tangential(self.tangential(plan)),
            settings=("viscous on",) if x.viscous_restitution is not None else (),
            oblique=x.oblique is not None,
            wall_type=len(types) if math.isinf(x.target.radius) else None,
            path=PATH,
        )

    def files(self, plan: ScenePlan) -> dict[str, str]:
        """The text of every file of the deck of a scene by its name. Raises CaseError."""
        return scene_deck.files(plan)

    def check(self, job: Plan | ScenePlan) -> list[str]:
        if isinstance(job, ScenePlan):
            check_scene(self, job, KINDS)
            scene_deck.deck(job)
        else:
            self.deck(job)
        return []

    def write(self, job: Plan | ScenePlan, folder: Path) -> list[Path]:
        if isinstance(job, ScenePlan):
            return write_texts(folder, self.files(job))
        deck = self.deck(job)
        texts = {"in.impact": decks.render(self.template, deck=deck), deck.data: data_text(job, len(deck.types))}
        return write_texts(folder, texts)

    @overload
    def run(self, job: Plan, folder: Path, *, ranks: int = 1, report: Report = silent) -> Trajectory: ...

    @overload
    def run(self, job: ScenePlan, folder: Path, *, ranks: int = 1, report: Report = silent) -> Tables: ...

    def run(
        self, job: Plan | ScenePlan, folder: Path, *, ranks: int = 1, report: Report = silent
    ) -> Trajectory | Tables:
        if isinstance(job, ScenePlan):
            held(folder).remove(*self.leftovers)
            scenes.run(job, folder, ranks=ranks, report=report)
            return self.read(job, folder)
        path = folder / PATH
        path.unlink(missing_ok=True)
        (folder / END).unlink(missing_ok=True)
        allowed = 120 + 2e-6 * job.n * job.steps
        if self.session and ranks == 1:
            wall = self.session.run("in.impact", folder, log=launcher.LOG, seconds=allowed)
        else:
            wall = launcher.run("in.impact", folder, ranks=ranks, log=launcher.LOG, seconds=allowed)
        result = trajectory(job, path, {"total": wall, "stepping": loop_seconds(folder / launcher.LOG)})
        path.unlink()  # large
        return result

    def resume(self, job: ScenePlan, folder: Path, *, ranks: int, report: Report) -> tuple[Tables, Resumed]:
        resumed = scenes.resume(job, folder, ranks=ranks, report=report)
        return self.read(job, folder, without=resumed.lost), resumed

    def read(self, plan: ScenePlan, folder: Path, *, without: Collection[int] = ()) -> Tables:
        return scenes.read(plan, folder, without=without)


def data_text(plan: Plan, types: int) -> str:
    """Positions and velocities of all bodies as a data file; a target that moves is of the last type."""
    kinds = (1, types)
    groups = [
        data_file.Spheres(k, 2 * g.body.radius, g.body.density, g.place, g.velocity, g.spin)
        for k, g in zip(kinds, side_by_side(plan), strict=False)
    ]
    return data_file.text(plan.experiment.name, types, room(plan), groups)


def _incomplete(path: Path, error: Exception) -> EngineError:
    return EngineError(f"{path}: the run left an incomplete dump ({error}); see {launcher.LOG} beside it")


def _end(plan: Plan, path: Path) -> tuple[np.ndarray, np.ndarray] | tuple[None, None]:
    """v_x [m/s] and omega_y [rad/s] of the bodies at the end of oblique impacts; None for normal ones."""
    if plan.experiment.oblique is None:
        return None, None
    try:
        vx, spin = dump.series(path)[-1].T
    except (ValueError, IndexError) as error:
        raise _incomplete(path, error) from None
    return vx, spin


def trajectory(plan: Plan, path: Path, seconds: dict[str, float]) -> Trajectory:
    """Overlap, force and approach velocity from z, vz, fz of every body. Raises EngineError if samples are missing."""
    n = plan.n
    try:
        z, vz, fz = np.moveaxis(dump.series(path), 2, 0)
        bodies = n if math.isinf(plan.experiment.target.radius) else 2 * n
        if z.shape != (plan.steps + 1, bodies):
            raise ValueError(f"{z.shape[0]} frames of {z.shape[1]} bodies, expected {plan.steps + 1} of {bodies}")
    except ValueError as error:
        raise _incomplete(path, error) from None
    overlap, velocity = approach(plan, z, vz)
    return Trajectory(plan.time_step, overlap, fz[:, :n].T, velocity, seconds, *_end(plan, path.with_name(END)))
