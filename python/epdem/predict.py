# SPDX-License-Identifier: GPL-2.0-or-later
"""What theory says of an experiment, before anything runs."""

from dataclasses import dataclass

import numpy as np

from .experiment import Experiment
from .theory import restitution, viscous
from .theory.yielding import FIRST_YIELD_ROUNDED

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

    COLUMNS = ("speed", "e_n", "contact_time", "force_max", "overlap_max", "residual_overlap", "work_in", "work_out",
               "plastic_work", "strain_ratio")  # fmt: skip

    def warnings(self) -> list[str]:
        """Where theory leaves its own domain, in words."""
        beyond = self.speed[self.strain_ratio > SMALL_DEFORMATION]
        if not beyond.size:
            return []
        return [
            f"a_max/R* reaches {self.strain_ratio.max():.2f} (> {SMALL_DEFORMATION}) from {beyond.min():.3g} m/s on: "
            "small-deformation theory is an extrapolation there"
        ]


def first_yield_speeds(x: Experiment) -> dict[str, float]:
    """Speed [m/s] from which each body yields somewhere, by material: its peak pressure reaches 1.60 Y (eq. 8.78).

    The softer body's plastic flow limits the pressure to the law's strength, so that a much harder one never yields
    (inf). The pressure of the law is Hertz's half-ellipse to uniform, by its flatness. Bodies without a yield stress
    are left out; a dashpot is not thought of.
    """
    law, speeds = x.theory(), {}
    strength = min(x.law.strengths)
    limit = {"cavity": x.law.parameters.get("plastic_ratio", 1.0)}.get(x.law.name, 1.0) * strength
    for body in (x.body, x.target):
        if body.yield_stress is None or body.rigid:
            continue
        wanted = FIRST_YIELD_ROUNDED * body.yield_stress
        if wanted > limit:
            speeds[body.material] = np.inf
            continue
        low, high = -700.0, np.log(x.R_star)  # of the overlap; the pressure rises with it
        for _ in range(100):
            middle = 0.5 * (low + high)
            alpha = np.array([np.exp(middle)])
            mean = law.force(alpha) / (np.pi * law.radius(alpha) ** 2)
            reached = ((1.5 - 0.5 * law.flatness(alpha)) * mean >= wanted).item()
            low, high = (low, middle) if reached else (middle, high)
        speeds[body.material] = float(np.sqrt(2 * law.work(np.array([np.exp(high)]))[0] / x.m_star))
    return speeds


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
    if columns["overlap_max"].max() > law.yield_overlap:
        bodies = zip((experiment.body, experiment.target), experiment.law.strengths, strict=True)
        yields = tuple(dict.fromkeys(b.material for b, strength in bodies if strength == softer))
    return Prediction(speed=experiment.speed, yields=yields, yield_speeds=first_yield_speeds(experiment), **columns)
