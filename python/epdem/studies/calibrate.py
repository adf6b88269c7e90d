# SPDX-License-Identifier: GPL-2.0-or-later
"""The strength of a law from one measurement: a restitution at a speed, or a hardness."""

import math
from dataclasses import dataclass
from pathlib import Path

from ..case.impact import parse, read_toml
from ..errors import CaseError
from ..impacts.experiment import Experiment, experiment
from ..impacts.prediction import predict
from ..laws import library as claw
from ..theory import backbones

KGF_PER_MM2 = 9.80665e6  # Pa
TABOR = 2.8  # mean pressure of full plasticity over the yield stress in simple compression
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
    *, vickers: float | None = None, brinell: float | None = None, dent_ratio: float = BRINELL_DENT
) -> float:
    """Mean pressure [Pa] of full plasticity from HV or HB (kgf/mm^2).

    HV counts the pyramid's faces, 7 % more than the projected area; by custom 1 HV is taken as 9.807 MPa of mean
    pressure. HB counts the dent's spherical surface: the mean pressure is larger by 2 (1 - sqrt(1 - x^2))/x^2, x the
    dent's diameter over the ball's.
    """
    if (vickers is None) == (brinell is None):
        raise CaseError("give one hardness, --hv or --hb")
    value = vickers if vickers is not None else brinell
    if not (math.isfinite(value) and value > 0):
        raise CaseError(f"hardness {value:g}, must be > 0")
    if vickers is not None:
        return vickers * KGF_PER_MM2
    if not 0.0 < dent_ratio <= 1.0:
        raise CaseError(f"--dent-ratio {dent_ratio:g}, must lie in (0, 1]")
    return brinell * KGF_PER_MM2 * 2.0 * (1.0 - math.sqrt(1.0 - dent_ratio**2)) / dent_ratio**2


def _with_strength(data: dict, path: object, name: str, value: float, speed: float) -> Experiment:
    law = {k: v for k, v in data["law"].items() if k not in (name, name + "_ratio")} | {name: f"{value!r} Pa"}
    impact = data["impact"] | {"speeds": [f"{speed!r} m/s"]}
    return experiment(parse(data | {"law": law, "impact": impact}, path))


def _strength(data: dict) -> str:
    name = data.get("law", {}).get("name")
    if name not in claw.laws():
        raise CaseError(f"law.name = {name!r} does not exist; there are {', '.join(claw.laws())}")
    parameter = next((p.name for p in claw.laws()[name].parameters if p.unit == "Pa"), None)
    if parameter is None:
        raise CaseError(f"law {name} never yields; it has nothing to calibrate")
    return parameter


def _result(data: dict, path: object, value: float, speed: float | None, source: str) -> Calibration:
    parameter = _strength(data)
    x = _with_strength(data, path, parameter, value, speed or 1.0)
    e_n = float(predict(x).e_n[0]) if speed else None
    stress = value if parameter == "yield_stress" else value / backbones.LAWS[x.law.name].default_ratio
    yield_speed = math.sqrt(2.0 * float(x.theory().work(x.theory().yield_overlap)) / x.m_star)
    return Calibration(x.law.name, parameter, value, stress, yield_speed, e_n, speed, source)


def from_restitution(path: Path, e_n: float, speed: float) -> Calibration:
    """The strength with which the case's impact at `speed` [m/s] has the measured e_n. Raises CaseError.

    The case gives bodies, elastic constants and law; its own strength and speeds play no part.
    """
    data = read_toml(path)
    if "impact" not in data:
        raise CaseError(f"{path}: calibration from e_n needs an [impact]: the bodies of the measured impact")
    if not 0.0 < e_n < 1.0:
        raise CaseError(f"--e-n {e_n:g}, must lie in (0, 1)")
    if not (math.isfinite(speed) and speed > 0):
        raise CaseError(f"--speed {speed:g} m/s, must be > 0")
    name = _strength(data)

    def restitution(log_strength: float) -> float:
        return float(predict(_with_strength(data, path, name, math.exp(log_strength), speed)).e_n[0])

    modulus = _with_strength(data, path, name, 1e9, speed).E_star
    low, high = math.log(1e-8 * modulus), math.log(modulus)
    if not restitution(low) < e_n < restitution(high):
        raise CaseError(f"e_n = {e_n:g} at {speed:g} m/s: no strength between 1e-8 and 1 of E* gives it")
    while high - low > 1e-13 * max(abs(low), 1.0):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if restitution(middle) < e_n else (low, middle)
    return _result(data, path, math.exp(0.5 * (low + high)), speed, f"e_n = {e_n:g} at {speed:g} m/s")


def from_hardness(path: Path, pressure: float, source: str) -> Calibration:
    """The strength from the mean pressure [Pa] of full plasticity."""
    data = read_toml(path)
    if "impact" not in data:
        raise CaseError(f"{path}: calibration needs an [impact]")
    name = _strength(data)
    value = pressure / TABOR if name == "yield_stress" else pressure
    return _result(data, path, value, None, source)
