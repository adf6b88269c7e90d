# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS with our plugin: impacts side by side in one deck, whose dump is a trajectory."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...base import rendering as decks
from ...base.declarations import declarations
from ...base.files import write_texts
from ...errors import CaseError, EngineError
from ...impacts.engine import Feature, Report, Trajectory, check_features, silent
from ...impacts.experiment import Body
from ...impacts.placement import approach
from ...impacts.plan import Plan
from ...theory.sources import Source
from ..liggghts.engine import data_text
from ..liggghts.properties import atom_types, finite
from . import launcher

PATH, END, LOG = "path.txt", "end.txt", "log.lammps"


@dataclass(frozen=True)
class Deck:
    """Everything the template writes; `pairs` and `wall` are the words of the contacts."""

    title: str
    source: str
    summary: str
    data: str
    skin: float
    types: tuple[str, ...]
    pairs: tuple[str, ...]
    wall: str | None
    oblique: bool
    time_step: float
    path: str
    end: str
    steps: int


class Lammps:
    """LAMMPS with pair_style ep and fix wall/ep."""

    name = "lammps"
    source: Source | None = Source(
        "A. P. Thompson et al.",
        "LAMMPS - a flexible simulation tool for particle-based materials modeling at the atomic, meso, and continuum "
        "scales",
        "Comput. Phys. Commun.",
        "271",
        "108171",
        2022,
    )
    template = "lammps/impact.in.j2"
    laws: tuple[str, ...] | None = None
    ranks = 1
    features = frozenset(
        {Feature.ADHESION, Feature.DASHPOT, Feature.FRICTION, Feature.SPHERE_FRICTION, Feature.DECK, Feature.POSITIONS}
    )

    def missing(self) -> str | None:
        return launcher.missing()

    def version(self) -> str:
        return launcher.version()

    def deck(self, plan: Plan) -> Deck:
        """The deck of a plan. Raises CaseError for what the plugin cannot do."""
        x, types = plan.experiment, atom_types(plan)
        check_features(self, x)
        wall = math.isinf(x.target.radius)
        if x.law.adheres and wall:
            raise CaseError(
                f"law.name = {x.law.name!r}: engine lammps has adhesion between spheres only; use --engine embedded "
                "or liggghts for walls"
            )
        return Deck(
            title=x.title,
            source=x.source,
            summary=f"{plan.summary}, law {x.law.name}",
            data="impact.data",
            skin=0.2 * min(x.body.radius, x.target.radius),
            types=tuple(body.material for body, _ in types),
            pairs=tuple(contact(plan, body, strength) for body, strength in types),
            wall=contact(plan, *types[-1]) if wall else None,
            oblique=x.oblique is not None,
            time_step=plan.time_step,
            path=PATH,
            end=END,
            steps=plan.steps,
        )

    def check(self, job: Plan) -> list[str]:
        self.deck(job)
        return []

    def write(self, job: Plan, folder: Path) -> list[Path]:
        deck = self.deck(job)
        texts = {"in.impact": decks.render(self.template, deck=deck), deck.data: data_text(job, len(deck.types))}
        return write_texts(folder, texts)

    def run(self, job: Plan, folder: Path, *, ranks: int = 1, report: Report = silent) -> Trajectory:
        for name in (PATH, END):
            (folder / name).unlink(missing_ok=True)
        wall = launcher.run("in.impact", folder, log=LOG, seconds=120 + 1e-5 * job.n * job.steps)
        bodies = job.n if math.isinf(job.experiment.target.radius) else 2 * job.n
        z, vz, fz = np.moveaxis(_frames(folder / PATH, job.steps + 1, bodies), 2, 0)
        end = _frames(folder / END, 2, bodies)[-1].T if job.experiment.oblique else (None, None)
        (folder / PATH).unlink()  # large
        overlap, velocity = approach(job, z, vz)
        return Trajectory(job.time_step, overlap, fz[:, : job.n].T, velocity, {"total": wall}, *end)


def contact(plan: Plan, body: Body, strength: float) -> str:
    """LAW E nu PARAMETERS [options]: the material of a body and the coefficients of its contacts."""
    x = plan.experiment
    law = declarations()[x.law.name]
    given = x.law.parameters | ({law.strength: finite(strength)} if law.strength else {})
    numbers = [finite(body.young_modulus), body.poisson_ratio, *(given[p.name] for p in law.parameters)]
    words = [law.name, *map(decks.number, numbers)]
    if x.oblique:
        words += ["tangential", x.oblique.tangential, decks.number(x.oblique.friction)]
    if x.viscous_restitution is not None:
        words += ["restitution", decks.number(x.viscous_restitution)]
    return " ".join(words)


def _frames(path: Path, frames: int, bodies: int) -> np.ndarray:
    """A dump without headers and ids, shape (frames, bodies, columns - 1). Raises EngineError if it is incomplete."""
    try:
        return np.array(path.read_text(encoding="utf-8").split(), float).reshape(frames, bodies, -1)[:, :, 1:]
    except (OSError, ValueError) as error:
        raise EngineError(f"{path}: the run left an incomplete dump ({error}); see {LOG} beside it") from None
