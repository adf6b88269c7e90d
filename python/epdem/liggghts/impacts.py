# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS with our plugin: a plan becomes one deck with all impacts side by side, its dump a trajectory."""

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import data_file, paths
from .. import rendering as decks
from ..errors import CaseError, EngineError
from ..impacts.engine import Trajectory
from ..impacts.places import room, side_by_side
from ..impacts.plan import Plan
from ..processes import ask
from . import dump, launcher
from .log import loop_seconds
from .properties import HARD, SOFT, Property, atom_types, finite, of_law


@dataclass(frozen=True)
class Deck:
    """Everything the template writes; every number was decided here."""

    title: str
    source: str
    summary: str
    remembers: bool  # the law has a contact history
    hard: bool
    soft: bool
    data: str
    skin: float
    types: tuple[str, ...]
    properties: tuple[Property, ...]
    model: str
    tangential: str
    settings: tuple[str, ...]
    wall_type: int | None
    time_step: float
    path: str
    steps: int


class Liggghts:
    """LIGGGHTS with a model of ours; `model` and more can be replaced to run LIGGGHTS's own models."""

    name = "liggghts"
    template = "liggghts/impact.in.j2"
    takes_dashpot = True

    def missing(self) -> str | None:
        return launcher.missing()

    def version(self) -> str:
        found = re.search(r"LIGGGHTS[-\w ]*?(\d+\.\d+\.\d+)", ask([str(paths.launcher()), "-log", "none", "-h"]))
        return f"LIGGGHTS {found.group(1) if found else '(version unknown)'}"

    def model(self, plan: Plan) -> str:
        return f"ep/{plan.experiment.law.name}"

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        return of_law(plan)

    def deck(self, plan: Plan) -> Deck:
        """The deck of a plan. Raises CaseError for what LIGGGHTS cannot do."""
        x, types, model = plan.experiment, atom_types(plan), self.model(plan)
        for b, _ in types:
            if b.poisson_ratio < 0:
                raise CaseError(
                    f"materials.{b.material}.poisson_ratio = {b.poisson_ratio}, LIGGGHTS takes [0, 0.5] "
                    "only; use --engine embedded"
                )
        dashpot = x.viscous_restitution is not None
        if dashpot and not self.takes_dashpot:
            raise CaseError(f"viscous: engine {self.name} does not know our dashpot; use --engine liggghts or embedded")
        moduli = [finite(b.young_modulus) for b, _ in types]
        return Deck(
            title=x.title,
            source=x.source,
            summary=f"{x.speed.size} speeds x {plan.phases} phases = {plan.n} independent impacts, law {x.law.name}",
            remembers=x.law.strength_property is not None,
            hard=max(moduli) > HARD,
            soft=min(moduli) < SOFT,
            data="impact.data",
            skin=0.2 * min(x.body.radius, x.target.radius),
            types=tuple(b.material for b, _ in types),
            properties=self.properties(plan),
            model=model,
            tangential="off",
            settings=("viscous on",) if dashpot else (),
            wall_type=len(types) if math.isinf(x.target.radius) else None,
            time_step=plan.time_step,
            path="path.bin",
            steps=plan.steps,
        )

    def write(self, plan: Plan, folder: Path) -> list[Path]:
        deck = self.deck(plan)
        folder.mkdir(parents=True, exist_ok=True)
        files = [folder / "in.impact", folder / deck.data]
        files[0].write_text(decks.render(self.template, deck=deck))
        files[1].write_text(data_text(plan, len(deck.types)))
        return files

    def run(self, plan: Plan, folder: Path, *, ranks: int = 1) -> Trajectory:
        (folder / "path.bin").unlink(missing_ok=True)
        allowed = 120 + 2e-6 * plan.n * plan.steps
        wall = launcher.run("in.impact", folder, ranks=ranks, log=launcher.LOG, seconds=allowed)
        return trajectory(plan, folder / "path.bin", {"total": wall, "stepping": loop_seconds(folder / launcher.LOG)})


def data_text(plan: Plan, types: int) -> str:
    """Positions and velocities of all bodies as a data file; a target that moves is of the last type."""
    kinds = (1, types)
    groups = [
        data_file.Spheres(k, 2 * g.body.radius, g.body.density, g.place, g.velocity)
        for k, g in zip(kinds, side_by_side(plan), strict=False)
    ]
    return data_file.text(plan.experiment.name, types, room(plan), groups)


def trajectory(plan: Plan, path: Path, seconds: dict[str, float]) -> Trajectory:
    """Overlap, force and approach velocity from z, vz, fz of every body. Raises EngineError if samples are missing."""
    x, n = plan.experiment, plan.n
    wall = math.isinf(x.target.radius)
    try:
        z, vz, fz = np.moveaxis(dump.series(path), 2, 0)
        bodies = n if wall else 2 * n
        if z.shape != (plan.steps + 1, bodies):
            raise ValueError(f"{z.shape[0]} frames of {z.shape[1]} bodies, expected {plan.steps + 1} of {bodies}")
    except ValueError as error:
        raise EngineError(f"{path}: the run left an incomplete dump ({error}); see log.liggghts beside it") from None
    if wall:
        overlap, velocity = x.body.radius - z, -vz
    else:
        overlap = x.body.radius + x.target.radius - (z[:, :n] - z[:, n:])
        velocity = vz[:, n:] - vz[:, :n]
    return Trajectory(plan.time_step, overlap.T, fz[:, :n].T, velocity.T, seconds)
