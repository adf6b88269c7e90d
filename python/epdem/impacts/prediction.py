# SPDX-License-Identifier: GPL-2.0-or-later
"""What theory says of an experiment, before anything runs."""

from dataclasses import dataclass

import numpy as np

from ..theory import restitution, viscous
from ..theory.yielding import first_yield_speed
from .experiment import Experiment

SMALL_DEFORMATION = 0.3  # a_max/R* above which Hertz's half-space is a poor picture


@dataclass(frozen=True)
class Prediction:
    """Theory for each speed, arrays of shape (n,), SI."""

    speed: np.ndarray
    e_n: np.ndarray
    contact_time: np.ndarray
    force_max: np.ndarray
    overlap_max: np.ndarray
    residual_overlap: np.ndarray
    work_in: np.ndarray
    work_out: np.ndarray
    plastic_work: np.ndarray
    strain_ratio: np.ndarray  # a_max/R*
    yields: tuple[str, ...]  # materials that the law lets flow somewhere in the range of speeds
    yield_speeds: dict[str, float]  # from which each material yields beneath its surface [m/s], eq. 8.78; inf: never

    COLUMNS = (
        "speed",
        "e_n",
        "contact_time",
        "force_max",
        "overlap_max",
        "residual_overlap",
        "work_in",
        "work_out",
        "plastic_work",
        "strain_ratio",
    )

    def warnings(self) -> list[str]:
        """Where theory leaves its own domain, in words."""
        beyond = self.speed[self.strain_ratio > SMALL_DEFORMATION]
        if not beyond.size:
            return []
        return [
            f"a_max/R* reaches {self.strain_ratio.max():.2f} (> {SMALL_DEFORMATION}) from {beyond.min():.3g} m/s on: "
            "small-deformation theory is an extrapolation there"
        ]


def predict(experiment: Experiment) -> Prediction:
    """The prediction of `experiment` from theory alone; the C++ laws are not called."""
    law = experiment.theory()
    numbers = {"m_star": experiment.m_star, "speed": experiment.speed}
    if experiment.viscous_restitution is None:
        impact = restitution.impact(law, **numbers)
    else:
        impact = viscous.impact(law, **numbers, restitution=experiment.viscous_restitution)
    names = Prediction.COLUMNS[1:]
    columns = {n: np.asarray(getattr(impact, n), float) for n in names}
    softer = min(experiment.law.strengths)
    yields = ()
    pair = (experiment.body, experiment.target)
    if columns["overlap_max"].max() > law.yield_overlap:
        bodies = zip(pair, experiment.law.strengths, strict=True)
        yields = tuple(dict.fromkeys(b.material for b, strength in bodies if strength == softer))
    speeds = {
        b.material: float(first_yield_speed(law, b.yield_stress, m_star=experiment.m_star))
        for b in pair
        if b.yield_stress is not None and not b.rigid
    }
    return Prediction(speed=experiment.speed, yields=yields, yield_speeds=speeds, **columns)
