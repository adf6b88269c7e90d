# SPDX-License-Identifier: GPL-2.0-or-later
"""Laws of other codes for a case, and their own theory. A rule determines each number that a case does not have.

luding     k_1 = F_max/alpha_max of the case's own law at its middle speed; k_p/k_1 = 5 and phi_f = 0.05 (Luding 2008)
edinburgh  k_1 = 4/3 E* sqrt(R*), Hertz's, to which the model is tied; k_2/k_1 = 5, n = 1.5, no adhesion
mdr        a sphere on a rigid flat: the modulus that makes E/(1-nu^2) the case's E*, the smaller yield stress
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import CaseError
from ...impacts.experiment import Experiment
from ...impacts.prediction import Prediction, predict
from . import hysteresis
from . import mdr as mdr_theory

STIFFENING = 5.0  # k_p/k_1 and k_2/k_1
DEPTH = 0.05  # phi_f
EXPONENT = 1.5


@dataclass(frozen=True)
class Luding:
    """Numbers of the law for one pair of bodies."""

    k_1: float  # [N/m]
    k_p: float  # [N/m]
    phi_f: float


def luding(x: Experiment) -> Luding:
    """Stiffnesses of luding: k_1 is the mean stiffness of the case's own law at its middle speed."""
    own, middle = predict(x), x.speed.size // 2
    k_1 = float(own.force_max[middle] / own.overlap_max[middle])
    return Luding(k_1, STIFFENING * k_1, DEPTH)


def predict_luding(x: Experiment) -> Prediction:
    """Theory of luding for the bodies and speeds of a case."""
    law = luding(x)
    overlap_p = hysteresis.plasticity_overlap(k_1=law.k_1, k_p=law.k_p, phi_f=law.phi_f, R_star=x.R_star)
    return _prediction(
        x, hysteresis.luding(k_1=law.k_1, k_p=law.k_p, overlap_p=overlap_p, m_star=x.m_star, speed=x.speed)
    )


def luding_note(x: Experiment) -> str:
    """The rule for the numbers of luding."""
    law = luding(x)
    return (
        f"k_1 = {law.k_1:.4g} N/m (F_max/overlap of {x.law.name} at {x.speed[x.speed.size // 2]:.4g} m/s), "
        f"k_p/k_1 = {STIFFENING:g}, phi_f = {law.phi_f:g}"
    )


def predict_edinburgh(x: Experiment) -> Prediction:
    """Theory of edinburgh for the bodies and speeds of a case."""
    k_1 = 4 / 3 * x.E_star * math.sqrt(x.R_star)
    return _prediction(
        x, hysteresis.edinburgh(k_1=k_1, k_2=STIFFENING * k_1, exponent=EXPONENT, m_star=x.m_star, speed=x.speed)
    )


def edinburgh_note(x: Experiment) -> str:
    """The rule for the numbers of edinburgh."""
    return f"k_1 = 4/3 E* sqrt(R*), k_2/k_1 = {STIFFENING:g}, n = {EXPONENT:g}, no adhesion"


@dataclass(frozen=True)
class Mdr:
    """Numbers of the sphere on a rigid flat, SI."""

    young_modulus: float
    poisson_ratio: float
    yield_stress: float


def mdr(x: Experiment) -> Mdr:
    """Raises CaseError for cases that mdr cannot represent."""
    if math.isfinite(x.target.radius) or x.viscous_restitution is not None:
        raise CaseError("mdr is compared on walls and without a dashpot: its flats are rigid")
    stresses = [b.yield_stress for b in (x.body, x.target) if b.yield_stress is not None]
    if len(stresses) < 2 or x.body.rigid:
        raise CaseError("mdr needs the yield stress of both materials")
    nu = x.body.poisson_ratio
    return Mdr(x.E_star * (1 - nu * nu), nu, min(stresses))


def predict_mdr(x: Experiment) -> Prediction:
    """Theory of mdr for the body and speeds of a case, its radius constant. Raises CaseError."""
    law = mdr(x)
    try:
        impact = mdr_theory.impact(
            E_eff=x.E_star, nu=law.poisson_ratio, R=x.R_star, Y=law.yield_stress, m_star=x.m_star, speed=x.speed
        )
    except ValueError as error:
        raise CaseError(f"mdr: {error}") from None
    return _prediction(x, impact)


def mdr_note(x: Experiment) -> str:
    """The rule for the numbers of mdr."""
    law = mdr(x)
    return (
        f"rigid flat, E = {law.young_modulus:.4g} Pa (the case's E*), Y = {law.yield_stress:.4g} Pa, p = 2.75 Y; "
        "its radius grows, its theory's does not: a comparison"
    )


def prediction(tool: object, x: Experiment) -> Prediction:
    """Theory of what an engine runs: of its own law if it has one, else of the case's."""
    return getattr(tool, "predict", predict)(x)


def _prediction(x: Experiment, impact: hysteresis.Impact) -> Prediction:
    names = ("e_n", "contact_time", "force_max", "overlap_max", "residual_overlap", "work_in", "work_out")
    columns: dict[str, Any] = {n: np.asarray(getattr(impact, n), float) for n in names}
    return Prediction(
        speed=x.speed,
        **columns,
        plastic_work=columns["work_in"] - columns["work_out"],
        radius_max=(radius := np.sqrt(columns["overlap_max"] * x.R_star)),
        strain=x.law.share * radius / x.R_star,
        yields=(),
        yield_speeds={},
    )
