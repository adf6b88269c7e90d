# SPDX-License-Identifier: GPL-2.0-or-later
"""The interface of an engine of impacts: a plan goes in, a trajectory comes out."""

import shutil
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import numpy as np

from ..errors import CaseError, EngineError
from ..theory.sources import Source
from . import oblique
from .experiment import Experiment
from .plan import Plan
from .prediction import Prediction

EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Trajectory:
    """Samples of n impacts, every step; arrays of shape (n, samples), SI. Force and overlap belong together.

    overlap [m] is negative while apart, force [N] is never negative, velocity [m/s] is that of approach.
    NaN after the end of an impact. `seconds` is the engine's own account of its time. tangential: velocity [m/s] of the
    centres against each other after oblique impacts, spin: of the body then [rad/s], shape (n,).
    """

    time_step: float
    overlap: np.ndarray
    force: np.ndarray
    velocity: np.ndarray
    seconds: dict[str, float] = field(default_factory=dict)
    tangential: np.ndarray | None = None
    spin: np.ndarray | None = None


@dataclass(frozen=True)
class Abilities:
    """The abilities of an engine; other code never tests its name."""

    laws: tuple[str, ...] | None = None  # of ours that it can run; None: every one
    walls: bool = True  # planes as targets
    spheres: bool = True  # spheres as targets
    dashpot: bool = False  # [viscous] of a case
    friction: tuple[str, ...] = ()  # its tangential models for oblique impacts
    oblique_spheres: bool = False  # oblique impacts of two spheres too
    own_spring: bool = False  # whatever tangential model is asked for, its own one spring runs
    ranks: int = 1  # the largest number on this machine
    deck: bool = True  # it reads a deck, which runs without epdem too
    positions: bool = True  # its overlap is a difference of positions
    scenes: tuple[str, ...] = ()  # kinds of bulk scenes
    restarts: bool = False  # it continues an interrupted bulk scene
    stays: bool = False  # one process of it can run plan after plan; the class takes `stay`


class Engine(Protocol):
    """One way to run a plan."""

    name: str
    can: Abilities
    source: Source | None  # what to cite for its program; None: epdem itself

    def missing(self) -> str | None:
        """None if the engine can run here, else a sentence with the command that installs it."""

    def version(self) -> str:
        """One line: the engine's version, and that of our part in it."""

    def check(self, plan: Plan) -> None:
        """Raise CaseError for a plan that the engine cannot run."""

    def write(self, plan: Plan, folder: Path) -> list[Path]:
        """Write the deck and its data files into `folder`, where they run without epdem."""

    def run(self, plan: Plan, folder: Path, *, ranks: int = 1) -> Trajectory:
        """Run what `write` wrote. Raises EngineError with the end of the engine's log."""


class Installable(Protocol):
    """What may be missing here: an engine of any kind."""

    name: str

    def missing(self) -> str | None:
        """None if it can run here, else a sentence with the command that installs it."""


def require(*tools: Installable) -> None:
    """Raise EngineError for the first of `tools` that cannot run here."""
    for tool in tools:
        if reason := tool.missing():
            raise EngineError(f"engine {tool.name}: {reason}")


def check_law(engine: str, can: Abilities, law: str) -> None:
    """Raise CaseError for a law that an engine does not have."""
    if can.laws is not None and law not in can.laws:
        raise CaseError(f"law.name = {law!r}: engine {engine} has {', '.join(can.laws)} only; use another --engine")


def check_abilities(tool: Engine, x: Experiment) -> None:
    """Raise CaseError if an experiment needs an ability that the engine does not have."""
    can, wall = tool.can, not np.isfinite(x.target.radius)
    check_law(tool.name, can, x.law.name)
    if x.oblique:
        oblique.check(tool.name, can.friction, can.oblique_spheres, x)
    if x.viscous_restitution is not None and not can.dashpot:
        raise CaseError(f"viscous: engine {tool.name} does not have this dashpot; use --engine liggghts or embedded")
    if (wall and not can.walls) or (not wall and not can.spheres):
        kind = "walls" if wall else "impacts of two spheres"
        raise CaseError(f"impact.kind: engine {tool.name} does not run {kind}; use another --engine")


def refuse(tool: Engine, plan: Plan, prediction: Prediction, *, ranks: int = 1) -> None:
    """Raise CaseError if `tool` cannot run `plan` as it is, EngineError if its ranks cannot be started.

    `prediction` is that of the plan's experiment.
    """
    refuse_ranks(tool.name, tool.can.ranks, ranks)
    tool.check(plan)
    for speed, overlap in zip(prediction.speed, prediction.overlap_max, strict=True):
        if tool.can.positions and (why := not_representable(plan.experiment, float(overlap))):
            raise CaseError(f"{speed:.4g} m/s is not representable by positions ({why}); use --engine embedded for it")


def refuse_ranks(engine: str, most: int, ranks: int) -> None:
    """Raise CaseError for a number of ranks outside 1 to `most`, EngineError if there is no mpirun for them."""
    if ranks < 1:
        raise CaseError(f"--ranks {ranks}: must be at least 1; leave it out for one rank")
    if ranks > most:
        limit = "one rank; leave it out" if most == 1 else f"at most {most} ranks here; ask for no more"
        raise CaseError(f"--ranks {ranks}: engine {engine} runs on {limit}")
    if ranks > 1 and shutil.which("mpirun") is None:
        raise EngineError("--ranks needs mpirun, which was not found; apt-get install openmpi-bin")


def not_representable(x: Experiment, overlap_max: float) -> str | None:
    """Why a position-based engine cannot hold this contact, or None.

    Overlap is a difference of numbers as large as the larger radius: it is known to eps R. Beyond half the smaller
    radius the spheres' centres come so near that contact detection and normal lose their sense.
    """
    radii = [r for r in (x.body.radius, x.target.radius) if np.isfinite(r)]
    if overlap_max > min(radii) / 2:
        return f"alpha_max = {overlap_max:.2g} m exceeds half the smaller radius"
    if overlap_max < 1e4 * EPS * max(radii):
        return f"alpha_max = {overlap_max:.2g} m is below 1e4 eps R = {1e4 * EPS * max(radii):.2g} m"
    return None
