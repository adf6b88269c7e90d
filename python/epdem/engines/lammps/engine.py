# SPDX-License-Identifier: GPL-2.0-or-later
"""LAMMPS with our plugin: impacts side by side in one deck, whose dump is a trajectory, and bulk scenes."""

import math
from pathlib import Path

import numpy as np

from ...base import paths
from ...base.files import stored_results
from ...base.processes import most_ranks
from ...impacts.engine import Trajectory, check_features, oblique_pairs
from ...impacts.plan import Plan, approach
from ...jobs.engine import Feature, Report
from ...scenes.plan import ScenePlan
from ..host import Host, impact_head
from ..input_script import atom_types, impact_files
from ..restarts import pruning
from . import deck, launcher, resume, tables
from .deck import END, PATH, ImpactDeck, contact
from .launcher import LOG


class Lammps(Host):
    """LAMMPS with pair_style ep and fix wall/ep."""

    name, title = "lammps", "LAMMPS"
    source: str | None = "A. P. Thompson et al., Comput. Phys. Commun. 271 (2022) 108171"
    template = "lammps/impact.in.j2"
    ranks = most_ranks()
    out = launcher.OUT
    scene_deck, scene_tables = deck, tables
    leftovers: tuple[str, ...] = ("particles.*.txt", "contacts.*.txt", "contacts_*.txt", "restart.*.bin", "in.resume")
    features = frozenset(
        {Feature.ADHESION, Feature.DASHPOT, Feature.FRICTION, Feature.SPHERE_FRICTION, Feature.DECK, Feature.POSITIONS}
        | {Feature.RESTART}
    )

    @property
    def mpirun(self) -> str:
        return launcher.mpirun()

    def missing(self) -> str | None:
        return launcher.missing()

    def version(self) -> str:
        return launcher.version()

    def parts(self) -> list[Path]:
        plugin = paths.native("lammps/epdemplugin.so")
        return [plugin] if plugin else []

    def impact_files(self, plan: Plan) -> dict[str, str]:
        return impact_files(self.template, self.deck(plan), plan)

    def deck(self, plan: Plan) -> ImpactDeck:
        """The deck of a plan. Raises CaseError for what the plugin cannot do."""
        x, types = plan.experiment, atom_types(plan)
        check_features(self, x)
        wall = math.isinf(x.target.radius)
        return ImpactDeck(
            plan=plan,
            head=impact_head(plan),
            data="impact.data",
            skin=0.2 * min(x.body.radius, x.target.radius),
            types=tuple(body.material for body, _ in types),
            pairs=tuple(contact(plan, body, strength) for body, strength in types),
            wall=contact(plan, *types[-1]) if wall else None,
            oblique=x.oblique is not None,
            columns="z vz fz" if wall or not x.oblique else "x z vx vz fx fz",
        )

    def run_impacts(self, plan: Plan, folder: Path, ranks: int) -> Trajectory:
        stored_results(folder).remove(PATH, END)
        wall = launcher.run("in.impact", folder, ranks=ranks, log=LOG, seconds=120 + 1e-5 * plan.n * plan.steps)
        bodies = plan.n if math.isinf(plan.experiment.target.radius) else 2 * plan.n
        path = np.moveaxis(tables.impact_frames(folder / PATH, plan.steps + 1, bodies), 2, 0)
        tangential, spin = None, None
        if plan.experiment.oblique:
            tangential, spin = tables.impact_frames(folder / END, 2, bodies)[-1].T
        (folder / PATH).unlink()  # large
        if spin is not None and bodies > plan.n:
            place, velocity, force = path.reshape(3, 2, *path.shape[1:])
            return oblique_pairs(plan, place, velocity, force, spin[: plan.n], {"total": wall})
        z, vz, fz = path
        overlap, velocity = approach(plan, z, vz)
        return Trajectory(plan.time_step, overlap, fz[:, : plan.n].T, velocity, {"total": wall}, tangential, spin)

    def run_scene(self, plan: ScenePlan, folder: Path, ranks: int, report: Report) -> None:
        launcher.run("in.scene", folder, ranks=ranks, log=LOG, report=pruning(folder, report))

    def continue_scene(self, plan: ScenePlan, folder: Path, step: int, ranks: int, report: Report) -> None:
        script = resume.write_resume(plan, folder, step)
        launcher.run(script.name, folder, ranks=ranks, append=True, report=pruning(folder, report))
