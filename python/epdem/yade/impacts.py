# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE with our laws: a plan becomes one Python deck with all impacts side by side and a copy of the law."""

import re
import shutil
import time
from math import isfinite, isinf
from pathlib import Path

import numpy as np

from ..base import rendering as decks
from ..base.processes import ask, call
from ..case.fields import NODES
from ..errors import EngineError
from ..impacts.engine import Abilities, Trajectory, check_abilities
from ..impacts.experiment import Body, Experiment
from ..impacts.placement import approach, side_by_side
from ..impacts.plan import Plan
from ..theory.sources import Source
from .deck import Deck, Group, Material, refuse_parameters, strength_values
from .deck_modules.law import LAWS
from .launcher import command, environment, write_deck_modules

INSTALL = "apt-get install yade"


class Yade:
    """Impacts in YADE: sphere on sphere or wall, with a copy of the law in the deck."""

    name = "yade"
    source: Source | None = Source(
        "V. Smilauer et al.",
        "Yade Documentation, 3rd ed.",
        "The Yade Project",
        year=2021,
        kind="manual",
        note="doi:10.5281/zenodo.5705394",
    )
    # a serial YADE keeps bodies where they are in memory and has no ranks: sorting and migration do not exist
    can = Abilities(
        laws=tuple(LAWS),
        friction=tuple(NODES),
        own_spring=True,
        scenes=("settle", "compaction", "parts"),
    )
    template = "yade/impact.py.j2"

    def missing(self) -> str | None:
        if shutil.which(command()) is None:
            return f"YADE was not found ({command()}); {INSTALL}"
        return None

    def version(self) -> str:
        match = re.search(r"version: (\S+)", ask([command(), "--version"], environment()))
        return f"YADE {match.group(1) if match else '(version unknown)'}"

    def material(self, x: Experiment, body: Body, strength: float) -> Material:
        """The material of one body. Raises CaseError for a strength beyond YADE's law."""
        values = {
            "young_modulus": body.young_modulus,
            "poisson_ratio": body.poisson_ratio,
            "density": body.density if isfinite(body.density) else 1.0,  # of a rigid wall: not used
        }
        own = strength_values(x.law.name, x.law.ratios(), strength, values["young_modulus"], body.material)
        friction = {"friction": x.oblique.friction} if x.oblique else {}
        return Material(body.material, values | own | friction)

    def ratios(self, x: Experiment) -> dict[str, float]:
        """The law's dimensionless parameters in the deck."""
        return x.law.ratios()

    def deck(self, plan: Plan) -> Deck:
        """The deck of a plan. Raises CaseError for what YADE cannot do."""
        x, wall = plan.experiment, isinf(plan.experiment.target.radius)
        check_abilities(self, x)
        if x.law.name in LAWS:
            refuse_parameters(x.law.name, x.law.ratios())
        materials = {
            x.target.material: self.material(x, x.target, x.law.strengths[1]),
            x.body.material: self.material(x, x.body, x.law.strengths[0]),
        }
        bodies = [Group("body.data", x.body.radius, x.body.material)]
        if not wall:
            bodies.append(Group("target.data", x.target.radius, x.target.material))
        return Deck(
            title=x.title,
            source=x.source,
            summary=f"{plan.summary}, law {x.law.name}",
            rigid=x.target.rigid,
            law=x.law.name,
            native=False,
            anvil=None,
            ratios=self.ratios(x),
            materials=tuple(materials.values()),
            wall_material=x.target.material if wall else None,
            bodies=tuple(bodies),
            oblique=x.oblique is not None,
            skin=0.1 * min(x.body.radius, x.target.radius),
            time_step=plan.time_step,
            samples=plan.steps + 2,  # one more than the plan has: a velocity is the mean of those half a step away
            path="path.bin",
        )

    def check(self, plan: Plan) -> None:
        self.deck(plan)

    def write(self, plan: Plan, folder: Path) -> list[Path]:
        deck = self.deck(plan)
        folder.mkdir(parents=True, exist_ok=True)
        modules = [] if deck.native else write_deck_modules(folder)
        script = folder / "impact.py"
        script.write_text(decks.render(self.template, deck=deck), encoding="utf-8")
        files = [folder / b.data for b in deck.bodies]
        for path, table in zip(files, tables(plan), strict=True):
            lines = [
                "# x y z v_z v_x omega_y, SI" if deck.oblique else "# x y z v_z, SI",
                *(" ".join(map(decks.number, row)) for row in table),
                "",
            ]
            path.write_text("\n".join(lines), encoding="utf-8")
        return [script, *files, *modules]

    def run(self, plan: Plan, folder: Path, *, ranks: int = 1) -> Trajectory:
        path, log = folder / "path.bin", folder / "out.yade"
        path.unlink(missing_ok=True)
        start = time.perf_counter()
        call(
            [command(), "-n", "-x", "impact.py"],
            folder,
            log=log.name,
            seconds=120 + 2e-5 * plan.n * plan.steps,
            env=environment(),
        )
        wall = time.perf_counter() - start
        result = trajectory(plan, path, {"total": wall, "stepping": stepping_seconds(log)})
        path.unlink()  # large
        return result


def tables(plan: Plan) -> list[np.ndarray]:
    """x, y, z [m] and v_z [m/s] of the bodies, and of targets that move; v_x and omega_y too if they are oblique."""
    groups = side_by_side(plan)
    if plan.experiment.oblique is None:
        return [np.column_stack([g.place, g.velocity[:, 2]]) for g in groups]
    return [
        np.column_stack([g.place, g.velocity[:, 2], g.velocity[:, 0], g.spin]) for g in groups if g.spin is not None
    ]


def trajectory(plan: Plan, path: Path, seconds: dict[str, float]) -> Trajectory:
    """Overlap, force, approach velocity from z, v_z, F_z of every body. Raises EngineError if samples are missing."""
    n = plan.n
    expected = (plan.steps + 2, 3, n if isinf(plan.experiment.target.radius) else 2 * n)
    tangential = spin = None
    try:
        with path.open("rb") as file:
            samples = np.load(file)
            if plan.experiment.oblique:
                tangential, spin = np.load(file)
        if samples.shape != expected or not np.isfinite(samples).all():
            raise ValueError(f"{samples.shape} samples, expected {expected}, all finite")
    except (OSError, ValueError) as error:
        raise EngineError(f"{path}: the run left no complete result ({error}); see out.yade beside it") from None
    overlap, velocity = approach(plan, samples[:-1, 0], 0.5 * (samples[:-1, 1] + samples[1:, 1]))
    return Trajectory(plan.time_step, overlap, samples[:-1, 2, :n].T, velocity, seconds, tangential, spin)


def stepping_seconds(log: Path) -> float:
    """The deck's own time for its steps [s]; NaN if the log does not contain it."""
    times = re.findall(r"stepping took (\S+) s", log.read_text(errors="replace")) if log.exists() else []
    return float(times[-1]) if times else float("nan")
