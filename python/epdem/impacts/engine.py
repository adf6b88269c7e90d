# SPDX-License-Identifier: GPL-2.0-or-later
"""What an engine is: it takes a plan and gives a trajectory. Its own words end here."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import numpy as np

from .experiment import Experiment
from .plan import Plan
from .prediction import Prediction

EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Trajectory:
    """Samples of n impacts, every step; arrays of shape (n, samples), SI. Force and overlap belong together.

    overlap [m] is negative while apart, force [N] is never negative, velocity [m/s] is that of approach.
    NaN after the end of an impact. `seconds` is the engine's own account of its time.
    """

    time_step: float
    overlap: np.ndarray
    force: np.ndarray
    velocity: np.ndarray
    seconds: dict[str, float] = field(default_factory=dict)


class Engine(Protocol):
    """One way to run a plan."""

    name: str

    def missing(self) -> str | None:
        """None if the engine can run here, else a sentence with the command that installs it."""

    def version(self) -> str:
        """One line: the engine's version, and that of our part in it."""

    def write(self, plan: Plan, folder: Path) -> list[Path]:
        """The deck and its data files, in `folder`; they run by hand there."""

    def run(self, plan: Plan, folder: Path, *, ranks: int = 1) -> Trajectory:
        """Run what `write` wrote. Raises EngineError with the engine's last words."""


class OwnTheory(Engine, Protocol):
    """An engine with a law that is none of ours, and the theory of that law."""

    end_power: float  # the power of the force that falls linearly with the overlap at the end of an impact

    def predict(self, x: Experiment) -> Prediction:
        """What its own theory says of a case. Raises CaseError where it cannot stand for it."""

    def note(self, x: Experiment) -> str:
        """Where its numbers come from, in words."""


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
