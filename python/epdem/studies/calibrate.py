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
from ..laws.strengths import LawNumbers, law_named, yields_by_stress
from ..theory import adhesion
from ..theory.backbones import JKR, LAWS
from ..theory.numerics import bisect

KGF_PER_MM2 = 9.80665e6  # Pa
VICKERS_FACETS = 2 / 1.8544  # area of the facets of a Vickers indentation over its projected area, 1/sin(136 deg/2)
# mean pressure of full plasticity over the yield stress (Tabor 1951)
TABOR = LAWS["thornton"].declaration().default_ratio
LEAST_STRENGTH = 1e-8  # of E*; the largest is E* itself
BRINELL_DENT = 0.375  # dent over ball diameter in a usual Brinell test (0.24 to 0.6)


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


def pressure_of_hardness(
    *, vickers: float | None = None, brinell: float | None = None, dent_ratio: float | None = None
) -> float:
    """Mean pressure [Pa] of full plasticity from HV or HB (kgf/mm^2).

    Both hardnesses are the load over the area of the surface that the indenter leaves; the mean pressure (Meyer's
    hardness) is the load over its projection. For the pyramid of Vickers p_m = 1.0785 HV. For the cap of Brinell
    p_m = HB 2/(1 + sqrt(1 - x^2)) with x = `dent_ratio` in (0, 1], diameter of the indentation over that of the
    ball (None: BRINELL_DENT). Raises CaseError unless one hardness > 0 is given.
    """
    values = [value for value in (vickers, brinell) if value is not None]
    if len(values) != 1:
        raise CaseError("give one hardness, --hv or --hb")
    hardness = values[0]
    if not (math.isfinite(hardness) and hardness > 0):
        raise CaseError(f"hardness {hardness:g}, must be > 0")
    if vickers is not None:
        return hardness * KGF_PER_MM2 * VICKERS_FACETS
    x = BRINELL_DENT if dent_ratio is None else dent_ratio
    if not 0.0 < x <= 1.0:
        raise CaseError(f"--dent-ratio {x:g}, must lie in (0, 1]")
    return hardness * KGF_PER_MM2 * 2.0 / (1.0 + math.sqrt(1.0 - x**2))


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
        return Experiment(spec, body, target, np.array([speed]), viscous)

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


def from_hardness(path: Path, pressure: float, source: str) -> Calibration:
    """The strength from the mean pressure [Pa] of full plasticity. Raises CaseError."""
    unknown = _unknown(path)
    ratio = unknown.law.ratios.get("plastic_ratio", TABOR)  # the law's own pressure of full plasticity over its stress
    value = pressure / ratio if yields_by_stress(unknown.law.name) else pressure
    modulus = unknown.experiment(value, 1.0).E_star
    if not LEAST_STRENGTH <= pressure / modulus <= 1.0:
        raise CaseError(
            f"{source}: its mean pressure {pressure:.3g} Pa must lie between {LEAST_STRENGTH:g} and 1 of E* = "
            f"{modulus:.3g} Pa; a hardness is in kgf/mm^2, for steel 100 to 1000"
        )
    return unknown.result(value, None, source)
