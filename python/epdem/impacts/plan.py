# SPDX-License-Identifier: GPL-2.0-or-later
"""The impacts to run: every speed from every starting phase, with one time step for all."""

from dataclasses import dataclass

import numpy as np

from ..errors import CaseError
from .experiment import Experiment
from .prediction import Prediction
from .timestep import search, starting_phases

MAX_SAMPLES = 1e8  # of a trajectory: three numbers each, 2.4 GB


@dataclass(frozen=True)
class Plan:
    """n = speeds x phases impacts, speed by speed; arrays of shape (n,), SI.

    The body starts `gap` before first touch; a phase is the share of a step at which the contact then begins.
    One step serves all speeds (contact time goes only as v^-0.2): the fastest has steps_in_contact, or all of them
    the step that keeps e_n within the case's target error.
    """

    experiment: Experiment
    time_step: float
    steps: int
    phases: int
    speed: np.ndarray
    gap: np.ndarray

    def each(self, values: np.ndarray) -> np.ndarray:
        """Values of the experiment's rows for every impact, shape (n,)."""
        return np.repeat(values, self.phases)

    @property
    def n(self) -> int:
        return self.speed.size

    @property
    def summary(self) -> str:
        """One line for the head of a deck."""
        return f"{self.experiment.speed.size} speeds x {self.phases} phases = {self.n} independent impacts"


def plan(experiment: Experiment, prediction: Prediction, *, time_step: float | None = None) -> Plan:
    """The plan of `experiment`; `time_step` [s] replaces the one that follows from steps_in_contact or error."""
    numerics = experiment.numerics
    if time_step is not None:
        dt = time_step
    elif numerics.error is not None:
        dt = search(experiment, prediction, numerics.error).time_step
    else:
        dt = float(prediction.duration.min() / numerics.steps_in_contact)
    speed = np.repeat(experiment.speed, numerics.phases)
    gap = np.tile(starting_phases(numerics.phases), experiment.speed.size) * speed * dt
    # a few steps more than the longest contact: integration errors stretch it, and its end must be among the samples
    steps = int(np.ceil(1.02 * prediction.duration.max() / dt)) + 8
    if speed.size * steps > MAX_SAMPLES:
        raise CaseError(
            f"{speed.size} impacts of up to {steps} steps are {speed.size * steps:.2g} samples, at most "
            f"{MAX_SAMPLES:.0e} fit; lower steps_in_contact, count or phases, or split the range of speeds"
        )
    return Plan(experiment, dt, steps, numerics.phases, speed, gap)
