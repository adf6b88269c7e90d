# SPDX-License-Identifier: GPL-2.0-or-later
"""The strength of a law from one measurement: a restitution at a speed, or a hardness."""

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..case.impact import Case, load
from ..case.law import law_numbers
from ..case.toml import named
from ..errors import CaseError
from ..impacts.experiment import Experiment, bodies, pair_of, rated
from ..impacts.prediction import predict
from ..laws.strengths import LawNumbers, law_named
from ..theory import adhesion
from ..theory.backbones import JKR
from ..theory.indentation import Indentation
from ..theory.numerics import bisect
from .hardness import LEAST_STRENGTH, specimen, strength


@dataclass(frozen=True)
class Calibration:
    """A law's strength [Pa] by its own name, with the yield stress and the yield speed [m/s] that go with it."""

    law: str
    parameter: str
    value: float
    yield_stress: float
    yield_speed: float
    e_n: float | None
    speed: float | None
    source: str


@dataclass(frozen=True)
class _Unknown:
    """A case whose law has no strength yet; `parameter` is the strength's name."""

    case: Case
    law: LawNumbers
    parameter: str

    def experiment(self, strength: float, speed: float) -> Experiment:
        """One impact at `speed` [m/s] of bodies that all have this strength [Pa], with [rate] at its reference."""
        body, target = bodies(self.case)
        spec = pair_of(replace(self.law, absolute=strength), body, target)
        if self.case.rate:
            spec = rated(spec, self.case.rate, body, target, speed)
        viscous = self.case.viscous.restitution if self.case.viscous else None
        return Experiment(spec, body, target, np.array([speed]), viscous, rated=self.case.rate is not None)

    def result(self, strength: float, speed: float | None, source: str) -> Calibration:
        """The calibration that found this strength [Pa]."""
        x = self.experiment(strength, speed or 1.0)
        theory = x.theory()
        e_n = float(predict(x).e_n[0]) if speed else None
        stress = strength / law_named(self.law.name).default_ratio
        if isinstance(theory, JKR):
            yield_speed = float(adhesion.yield_speed(theory, m_star=x.m_star))
        else:
            yield_speed = math.sqrt(2.0 * float(theory.work(theory.yield_overlap)) / x.m_star)
        return Calibration(self.law.name, self.parameter, strength, stress, yield_speed, e_n, speed, source)


def _unknown(path: Path) -> _Unknown:
    case = load(path)
    with named(path):
        parameter = law_named(case.law.name).strength
    if parameter is None:
        raise CaseError(f"{path}: law {case.law.name} never yields; it has nothing to calibrate")
    given = {k: v for k, v in case.law.parameters().items() if k not in (parameter, f"{parameter}_ratio")}
    with named(path):
        return _Unknown(case, law_numbers(case.law.name, given), parameter)


def experiment(path: Path, found: Calibration) -> Experiment:
    """The impact of the case with the strength that was found, at the measured speed or at the speed of first yield."""
    return _unknown(path).experiment(found.value, found.speed or found.yield_speed)


def from_restitution(path: Path, e_n: float, speed: float) -> Calibration:
    """The strength with which the case's impact at `speed` [m/s] has the measured e_n. Raises CaseError.

    The case gives bodies, elastic constants and law; its own strength and speeds play no part.
    """
    if not 0.0 < e_n < 1.0:
        raise CaseError(f"--e-n {e_n:g}, must lie in (0, 1)")
    if not (math.isfinite(speed) and speed > 0):
        raise CaseError(f"--speed {speed:g} m/s, must be > 0")
    unknown = _unknown(path)

    def restitution(log_strength: float) -> float:
        return float(predict(unknown.experiment(math.exp(log_strength), speed)).e_n[0])

    modulus = unknown.experiment(1e9, speed).E_star
    low, high = math.log(LEAST_STRENGTH * modulus), math.log(modulus)
    if not restitution(low) < e_n < restitution(high):
        raise CaseError(f"e_n = {e_n:g} at {speed:g} m/s: no strength between {LEAST_STRENGTH:g} and 1 of E* gives it")
    strength = math.exp(bisect(lambda middle: restitution(middle) < e_n, low, high)[0])
    return unknown.result(strength, speed, f"e_n = {e_n:g} at {speed:g} m/s")


def from_hardness(path: Path, test: Indentation, source: str) -> Calibration:
    """The strength from a hardness test of the softer body of the case. Raises CaseError."""
    unknown = _unknown(path)
    return unknown.result(strength(unknown.law, test, specimen(*bodies(unknown.case)), source), None, source)
