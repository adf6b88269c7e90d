# SPDX-License-Identifier: GPL-2.0-or-later
"""The interface of an engine: a job goes in, and a trajectory of impacts or the tables of a scene come out."""

import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Protocol, TypeVar

import numpy as np

from ..errors import CaseError, EngineError
from ..laws.strengths import law_named
from ..theory.sources import Source
from .experiment import Experiment
from .plan import Plan
from .prediction import Prediction

EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Trajectory:
    """Samples of n impacts, every step; arrays of shape (n, samples), SI. Force and overlap belong together.

    overlap [m] is negative while apart, force [N] is never negative, velocity [m/s] is positive on approach.
    NaN after the end of an impact. `seconds` is the engine's own account of its time. tangential: velocity [m/s] of the
    centres against each other after oblique impacts, spin: of the body then [rad/s], shape (n,). end_power: of
    another law than the plan's, the power of the force that falls linearly with the overlap at the end.
    """

    time_step: float
    overlap: np.ndarray
    force: np.ndarray
    velocity: np.ndarray
    seconds: dict[str, float] = field(default_factory=dict)
    tangential: np.ndarray | None = None
    spin: np.ndarray | None = None
    end_power: float | None = None


class Feature(StrEnum):
    """A named ability of an engine; other code never tests the name of the engine."""

    ADHESION = "adhesion"  # laws with adhesion
    DASHPOT = "dashpot"  # [viscous] of a case of impacts
    FRICTION = "friction"  # oblique impacts on walls
    SPHERE_FRICTION = "friction of two spheres"  # oblique impacts of two spheres
    DECK = "deck"  # the engine reads a deck, which runs without epdem
    POSITIONS = "positions"  # an overlap is a difference of positions
    RESTART = "restart"  # an interrupted scene continues from a restart file


Report = Callable[[int], None]  # takes the step that a run has reached
Job = TypeVar("Job", contravariant=True)
Result = TypeVar("Result", covariant=True)
AnyJob = TypeVar("AnyJob")


def silent(step: int) -> None:
    """Report nothing."""


class Engine(Protocol[Job, Result]):
    """One way to run a job: the plan of impacts gives a trajectory, the plan of a scene gives tables."""

    name: str
    source: Source | None  # what to cite for its program; None: epdem itself
    laws: tuple[str, ...] | None  # the laws of epdem that the engine has; None: every one
    ranks: int  # the largest number on this machine
    features: frozenset[Feature]

    @property
    def mpirun(self) -> str:
        """The program that starts several ranks."""

    def missing(self) -> str | None:
        """None if the engine can run here, else a sentence with the command that installs it."""

    def version(self) -> str:
        """One line: the version of the engine and of epdem's part in it."""

    def check(self, job: Job) -> list[str]:
        """Sentences on what the engine leaves out or replaces. Raises CaseError for a job that it cannot run."""

    def write(self, job: Job, folder: Path) -> list[Path]:
        """Write the deck and its data files into `folder`, where they run without epdem; their paths, the deck first.

        Raises CaseError for a job that the engine cannot run.
        """

    def run(self, job: Job, folder: Path, *, ranks: int = 1, report: Report = silent) -> Result:
        """Run what `write` wrote. Raises EngineError with the end of the engine's log."""


ImpactEngine = Engine[Plan, Trajectory]


def texts(tool: Engine[AnyJob, object], job: AnyJob) -> dict[str, str]:
    """The text of every file of a job by its path in the folder. Raises CaseError."""
    with tempfile.TemporaryDirectory(prefix="epdem-") as scratch:
        folder = Path(scratch)
        files = tool.write(job, folder)
        return {f.relative_to(folder).as_posix(): f.read_text(encoding="utf-8") for f in files if is_text(f)}


def is_text(file: Path) -> bool:
    """Whether a file of a deck is text: every one but a copy of the C library."""
    return file.suffix != ".so"


class Tool(Protocol):
    """An engine of any kind: its laws, its features, and whether it can run here."""

    name: str
    laws: tuple[str, ...] | None
    features: frozenset[Feature]

    def missing(self) -> str | None:
        """None if it can run here, else a sentence with the command that installs it."""


def require(*tools: Tool) -> None:
    """Raise EngineError for the first of `tools` that cannot run here."""
    for tool in tools:
        if reason := tool.missing():
            raise EngineError(f"engine {tool.name}: {reason}")


def has_law(tool: Tool, law: str) -> bool:
    """Whether an engine has a law of epdem."""
    named = tool.laws is None or law in tool.laws
    return named and (Feature.ADHESION in tool.features or not law_named(law).adheres)


def check_law(tool: Tool, law: str) -> None:
    """Raise CaseError for a law that an engine does not have."""
    if not has_law(tool, law):
        known = "no law with adhesion" if tool.laws is None else f"{', '.join(tool.laws)} only"
        raise CaseError(f"law.name = {law!r}: engine {tool.name} has {known}; use another --engine")


def check_features(tool: ImpactEngine, x: Experiment) -> None:
    """Raise CaseError if an experiment needs a law or a feature that the engine does not have."""
    check_law(tool, x.law.name)
    if x.oblique and Feature.FRICTION not in tool.features:
        raise CaseError(
            f"impact.angles: engine {tool.name} runs normal impacts only; use --engine embedded, liggghts or lammps"
        )
    if x.oblique and np.isfinite(x.target.radius) and Feature.SPHERE_FRICTION not in tool.features:
        raise CaseError(f"impact.angles: engine {tool.name} runs oblique impacts on walls only; use --engine embedded")
    if x.viscous_restitution is not None and Feature.DASHPOT not in tool.features:
        raise CaseError(
            f"viscous: engine {tool.name} does not have this dashpot; use --engine embedded, liggghts or lammps"
        )


def refuse(tool: ImpactEngine, plan: Plan, prediction: Prediction, *, ranks: int = 1) -> None:
    """Raise CaseError if `tool` cannot run `plan` as it is, EngineError if its ranks cannot be started.

    `prediction` belongs to the plan's experiment.
    """
    refuse_ranks(tool.name, tool.ranks, ranks, tool.mpirun)
    tool.check(plan)
    for speed, overlap in zip(prediction.speed, prediction.overlap_max, strict=True):
        if Feature.POSITIONS in tool.features and (why := not_representable(plan.experiment, float(overlap))):
            raise CaseError(f"{speed:.4g} m/s is not representable by positions ({why}); use --engine embedded for it")


def refuse_ranks(engine: str, most: int, ranks: int, mpirun: str) -> None:
    """Raise CaseError for a number of ranks outside 1 to `most`, EngineError if the program `mpirun` is not there."""
    if ranks < 1:
        raise CaseError(f"--ranks {ranks}: must be at least 1; leave it out for one rank")
    if ranks > most:
        limit = "one rank; leave it out" if most == 1 else f"at most {most} ranks here; ask for no more"
        raise CaseError(f"--ranks {ranks}: engine {engine} runs on {limit}")
    if ranks > 1 and shutil.which(mpirun) is None:
        raise EngineError(f"--ranks needs {mpirun}, which was not found; apt-get install openmpi-bin")


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
