# SPDX-License-Identifier: GPL-2.0-or-later
"""The strength of a law from one e_n, a hardness or an indentation curve; strength and hardening exponent from e_n."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..case.impact import HIGHEST_E_N, Case, load
from ..case.law import law_numbers
from ..case.sizes import csv_table, number_in
from ..case.toml import LoadedCase
from ..case.units import read_number
from ..errors import CaseError
from ..impacts.experiment import Body, Experiment, at_rate, bodies, pair_of
from ..impacts.prediction import predict
from ..laws.strengths import LEAST_STRENGTH, LawNumbers, find_law, strength_of_hardness
from ..theory.backbones import Backbone
from ..theory.indentation import KGF_PER_MM2, PYRAMID, VICKERS, Indentation
from ..theory.numerics import bisect

BRINELL_DENT = 0.375  # dent over ball diameter in a usual Brinell test (0.24 to 0.6)


def hardness_test(
    *, vickers: float | None = None, brinell: float | None = None, dent_ratio: float | None = None
) -> Indentation:
    """The hardness test behind HV or HB (kgf/mm^2).

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
        return Indentation(hardness * VICKERS, PYRAMID)
    x = BRINELL_DENT if dent_ratio is None else dent_ratio
    if not 0.0 < x <= 1.0:
        raise CaseError(f"--dent-ratio {x:g}, must lie in (0, 1]")
    return Indentation(hardness * KGF_PER_MM2 * 2.0 / (1.0 + math.sqrt(1.0 - x**2)), x)


def specimen(body: Body, target: Body) -> Body:
    """The body that the hardness belongs to: the lower yield stress, else the lower modulus."""
    return min((b for b in (body, target) if not b.rigid), key=lambda b: (b.yield_stress or math.inf, b.young_modulus))


EXPONENT = "hardening_exponent"
LARGEST_EXPONENT = 0.999
CONFIDENCE = 0.95  # of intervals
FAR = 2.0  # between the strength that e_n gives and that of the material
UNKNOWN = 0.5  # standard error of the exponent, whose range is [0, 1), above which measurements do not determine it


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
    hardening_exponent: float | None = None  # of several e_n
    standard_errors: tuple[float, float] | None = None  # of value [Pa] and hardening_exponent
    intervals: tuple[tuple[float, float], tuple[float, float]] | None = None  # of both, which hold the true numbers
    # with the probability CONFIDENCE: Student's t if the scatter gives the uncertainty, else a normal distribution
    correlation: float | None = None  # of the errors of ln(value) and hardening_exponent
    measured: tuple[tuple[float, float], ...] = ()  # speeds [m/s] and e_n
    largest_residual: float | None = None  # of e_n, in units of its uncertainty, or else of the scatter
    scatter: float | None = None  # of e_n about the fit, where no uncertainty was given
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Uncalibrated:
    """A case whose law has no strength yet; `parameter` is the strength's name."""

    case: Case
    law: LawNumbers
    parameter: str

    def experiment(self, strength: float, *speeds: float) -> Experiment:
        """Impacts at `speeds` [m/s] of bodies that all have this strength [Pa], with [rate] at its reference."""
        body, target = bodies(self.case)
        spec = pair_of(replace(self.law, absolute=strength), body, target)
        viscous = self.case.viscous.restitution if self.case.viscous else None
        return at_rate(Experiment(spec, body, target, np.array(speeds), viscous), self.case.rate)

    def hardening(self, exponent: float) -> "_Uncalibrated":
        """The same with this hardening exponent."""
        return replace(self, law=replace(self.law, ratios=self.law.ratios | {EXPONENT: exponent}))

    def far_from_material(self, strength: float) -> tuple[str, ...]:
        """A sentence where this strength [Pa] is far from that which the material itself has."""
        body = specimen(*bodies(self.case))
        try:
            known = self.law.strength(body.material, body)
        except CaseError:  # the material has none
            return ()
        if 1.0 / FAR <= strength / known <= FAR:
            return ()
        return (
            f"{self.parameter} is {strength / known:.3g} times the {known / 1e6:.4g} MPa of materials.{body.material}, "
            f"so that E/Y is {known / strength:.3g} times the material's: a part of the loss may be viscous, as in "
            "polymers (see [viscous]), or to waves; compare e_n at other speeds",
        )

    def result(self, strength: float, speed: float | None, source: str) -> Calibration:
        """The calibration with this strength [Pa]."""
        x = self.experiment(strength, speed or 1.0)
        e_n = float(predict(x).e_n[0]) if speed else None
        stress = strength / find_law(self.law.name).default_ratio
        yield_speed = float(x.theory().yield_speed(m_star=x.m_star))
        return Calibration(self.law.name, self.parameter, strength, stress, yield_speed, e_n, speed, source)


def _model(case: Path | LoadedCase) -> Case:
    return case.model if isinstance(case, LoadedCase) else load(case)


def _uncalibrated(path: Path | LoadedCase) -> _Uncalibrated:
    case = _model(path)
    parameter = find_law(case.law.name).strength
    if parameter is None:
        raise CaseError(f"{path}: law {case.law.name} never yields; it has nothing to calibrate")
    given = {k: v for k, v in case.law.parameters().items() if k not in (parameter, f"{parameter}_ratio")}
    return _Uncalibrated(case, law_numbers(case.law.name, given), parameter)


def _check(path: Path | LoadedCase, e_n: float, speed: float) -> None:
    if not 0.0 < e_n <= HIGHEST_E_N:
        raise CaseError(f"{path}: e_n = {e_n:g} at {speed:g} m/s, must lie in (0, {HIGHEST_E_N:g}]; percent?")
    if not (math.isfinite(speed) and speed > 0):
        raise CaseError(f"--speed {speed:g} m/s, must be > 0")


def from_restitution(path: Path | LoadedCase, e_n: float, speed: float) -> Calibration:
    """The strength with which the case's impact at `speed` [m/s] has the measured e_n. Raises CaseError.

    The case gives bodies, elastic constants and law; its own strength and speeds play no part.
    """
    _check(path, e_n, speed)
    if e_n >= 1.0:
        raise CaseError(
            f"{path}: e_n = {e_n:g} at {speed:g} m/s, must lie in (0, 1); one impact without loss gives a lower limit "
            "of the strength alone: take a faster impact"
        )
    uncalibrated = _uncalibrated(path)

    def restitution(log_strength: float) -> float:
        return float(predict(uncalibrated.experiment(math.exp(log_strength), speed)).e_n[0])

    modulus = uncalibrated.experiment(1e9, speed).E_star
    low, high = math.log(LEAST_STRENGTH * modulus), math.log(modulus)
    if not restitution(low) < e_n < restitution(high):
        raise CaseError(f"e_n = {e_n:g} at {speed:g} m/s: no strength between {LEAST_STRENGTH:g} and 1 of E* gives it")
    strength = math.exp(bisect(lambda middle: restitution(middle) < e_n, low, high)[0])
    found = uncalibrated.result(strength, speed, f"e_n = {e_n:g} at {speed:g} m/s")
    return replace(found, warnings=uncalibrated.far_from_material(strength))


def from_hardness(path: Path | LoadedCase, test: Indentation, source: str) -> Calibration:
    """The strength from a hardness test of the softer body of the case. Raises CaseError."""
    uncalibrated = _uncalibrated(path)
    return uncalibrated.result(
        strength_of_hardness(uncalibrated.law, test, specimen(*bodies(uncalibrated.case)), source), None, source
    )


CURVE = {"depth": "m", "force": "N"}  # columns of an indentation curve


def from_indentation(path: Path | LoadedCase, curve: Path) -> Calibration:
    """The strength with which the contact of the case follows a measured curve of force and depth, by least squares.

    The depth is the overlap of the contact of body and target; points behind the largest force, the unloading, play no
    part. Raises CaseError for a curve that does not yield, and for one that no strength gives.
    """
    from scipy.optimize import minimize_scalar

    uncalibrated = _uncalibrated(path)
    depth, force = _loading(curve)
    modulus = uncalibrated.experiment(1e9, 1.0).E_star

    def branch(logarithm: float) -> Backbone:
        x = uncalibrated.experiment(math.exp(logarithm), 1.0)
        if x.law.adheres:
            dry = find_law(uncalibrated.law.name).without_adhesion
            raise CaseError(f"{path}: an indentation curve has no adhesion here; take law.name = {dry!r}")
        return x.backbone()

    def misfit(logarithm: float) -> float:
        return float(np.sum((branch(logarithm).force(depth) / force.max() - force / force.max()) ** 2))

    low, high = math.log(LEAST_STRENGTH * modulus), math.log(modulus)
    grid = np.linspace(low, high, 200)
    best = int(np.argmin([misfit(x) for x in grid]))
    bounds = (grid[max(best - 1, 0)], grid[min(best + 1, 199)])
    found = float(minimize_scalar(misfit, bounds=bounds, method="bounded", options={"xatol": 1e-10}).x)
    if float(branch(found).yield_overlap) >= depth.max():
        raise CaseError(
            f"{curve}: the curve is that of an elastic contact up to {depth.max():.3g} m; check young_modulus and "
            "radius of the case, or press deeper"
        )
    if best == 0:
        raise CaseError(f"{curve}: no strength above {LEAST_STRENGTH:g} of E* = {modulus:.3g} Pa gives it; check units")
    rms = 100.0 * math.sqrt(misfit(found) / len(depth))
    source = f"{len(depth)} points of {curve.name}, which it meets within {rms:.2g} % of the largest force (rms)"
    return uncalibrated.result(math.exp(found), None, source)


def _loading(curve: Path) -> tuple[np.ndarray, np.ndarray]:
    """Depths [m] > 0 and forces [N] of a curve's file up to the largest force. Raises CaseError."""
    units, rows = csv_table(curve)
    if units.keys() != CURVE.keys() or not all(units.values()):
        raise CaseError(f"{curve}: the heads {', '.join(units)!r} must be depth and force, as 'depth [nm],force [mN]'")
    scales = {name: read_number(f"{curve}: {name}", f"1 {units[name]}", si) for name, si in CURVE.items()}
    depth, force = (
        scale * np.array([number_in(place, name, cells[name]) for place, cells in rows])
        for name, scale in scales.items()
    )
    loading = slice(0, int(np.argmax(force)) + 1)
    kept = depth[loading] > 0
    if kept.sum() < 3:
        raise CaseError(f"{curve}: {kept.sum()} points of loading with a depth > 0, must be at least 3")
    return depth[loading][kept], force[loading][kept]


def from_restitutions(
    path: Path | LoadedCase, measured: Sequence[tuple[float, float]], uncertainty: float | None = None
) -> Calibration:
    """Strength and hardening exponent by least squares of e_n: (speed [m/s], e_n) of two or more impacts of the case.

    `uncertainty` is the standard error of each e_n; None: the scatter about the fit, of three or more. An e_n above 1
    by noise takes part: without it the others would be too low. Raises CaseError for laws without hardening, and for
    measurements that do not determine both numbers.
    """
    from scipy.optimize import least_squares
    from scipy.special import stdtrit

    uncalibrated = _uncalibrated(path)
    name = uncalibrated.law.name
    if EXPONENT not in uncalibrated.law.ratios:
        raise CaseError(f"{path}: law {name} has one strength; give one e_n, or law.name = 'meyer' for several")
    for speed, e_n in measured:
        _check(path, e_n, speed)
    if uncertainty is not None and not 0.0 < uncertainty < 1.0:
        raise CaseError(f"--uncertainty {uncertainty:g}, must lie in (0, 1); it is that of e_n")
    if uncertainty is None and len(measured) < 3:
        raise CaseError("two e_n say nothing of their scatter; give --uncertainty, the standard error of each e_n")
    speeds, e_n = np.array(measured).T
    modulus = uncalibrated.experiment(1e9, 1.0).E_star
    unit = uncertainty or 1.0

    def residuals(logarithm_and_exponent: np.ndarray) -> np.ndarray:
        logarithm, exponent = logarithm_and_exponent.tolist()
        found = predict(uncalibrated.hardening(exponent).experiment(math.exp(logarithm), *speeds)).e_n
        return np.asarray((found - e_n) / unit)

    low, high = (math.log(LEAST_STRENGTH * modulus), 0.0), (math.log(modulus), LARGEST_EXPONENT)
    starts = [(math.log(strength * modulus), x) for strength in (1e-4, 1e-3, 1e-2) for x in (0.1, 0.5)]
    start = min(starts, key=lambda point: float(np.sum(residuals(np.array(point)) ** 2)))
    fit = least_squares(residuals, start, bounds=(low, high), x_scale=(1.0, 0.3), xtol=1e-12, ftol=1e-12, gtol=1e-12)
    logarithm, exponent = fit.x.tolist()
    spread = unit if uncertainty else math.sqrt(2.0 * fit.cost / (len(e_n) - 2))
    scale = 1.0 if uncertainty else max(spread, 1e-12)  # of the residuals
    information = fit.jac.T @ fit.jac / scale**2
    apart = np.linalg.cond(information) < 1e12
    covariance = np.linalg.inv(information) if apart else np.full((2, 2), math.inf)
    error = np.sqrt(np.diag(covariance))
    if not error[1] < UNKNOWN:
        raise CaseError(
            f"these e_n do not tell {uncalibrated.parameter} and {EXPONENT} apart: the standard error of {EXPONENT} is "
            f"{error[1]:.2g}; measure at speeds further apart, or give law.{EXPONENT} and one e_n"
        )
    reach = stdtrit(math.inf if uncertainty else len(e_n) - 2, 0.5 + CONFIDENCE / 2) * error
    free = exponent - float((covariance @ (fit.jac.T @ fit.fun))[1]) / scale**2  # below 0 without its limit
    if exponent < 1e-6:
        exponent = 0.0
    if free + reach[1] < 0.0:
        raise CaseError(
            f"{path}: e_n falls faster than law {name} allows; {EXPONENT} = 0, which is law thornton, is the closest: "
            "check speeds and e_n, or give one e_n"
        )
    if logarithm < low[0] + 1e-3 or exponent > 0.99:
        raise CaseError(
            f"{path}: e_n hardly falls with speed; check speeds and e_n: no {uncalibrated.parameter} above "
            f"{LEAST_STRENGTH:g} E* with {EXPONENT} < 1 gives them"
        )
    found = uncalibrated.hardening(exponent).result(math.exp(logarithm), None, f"{len(e_n)} values of e_n")
    return replace(
        found,
        hardening_exponent=exponent,
        standard_errors=(float(found.value * error[0]), float(error[1])),
        intervals=(
            (found.value * math.exp(-reach[0]), found.value * math.exp(reach[0])),
            (max(free - reach[1], 0.0), min(free + reach[1], LARGEST_EXPONENT)),
        ),
        correlation=float(covariance[0, 1] / (error[0] * error[1])),
        measured=tuple(zip(speeds.tolist(), e_n.tolist(), strict=True)),
        largest_residual=float(np.abs(fit.fun).max() / scale),
        scatter=None if uncertainty else spread,
    )


def from_measurement(
    case: Path | LoadedCase,
    *,
    e_n: Sequence[float] = (),
    speed: Sequence[str | float] = (),
    measured: bool = False,
    uncertainty: float | None = None,
    hv: float | None = None,
    hb: float | None = None,
    dent_ratio: float | None = None,
    indentation: Path | None = None,
) -> Calibration:
    """The calibration from the one measurement that is given, as in `epdem calibrate`. Raises CaseError."""

    def refuse(owner: str, **given: object) -> None:
        for name, value in given.items():
            if value is not None and value != []:
                raise CaseError(f"{case}: --{name.replace('_', '-')}: it belongs to {owner}; leave it out")

    if (bool(e_n) + measured + (hv is not None or hb is not None) + (indentation is not None)) != 1:
        raise CaseError("give one measurement: --e-n with --speed, --measured, --hv, --hb, or --indentation")
    if hb is None:
        refuse("--hb", dent_ratio=dent_ratio)
    if not e_n:
        refuse("--e-n", speed=list(speed))
    if not (measured or e_n):
        refuse("--e-n and --measured", uncertainty=uncertainty)
        if indentation is not None:
            return from_indentation(case, indentation)
        test = hardness_test(vickers=hv, brinell=hb, dent_ratio=dent_ratio)
        return from_hardness(case, test, f"HV {hv:g}" if hv is not None else f"HB {hb:g}")
    if len(e_n) != len(speed):
        raise CaseError("--e-n belongs to one impact; add its speed, as --speed '2 m/s'")
    speeds = [read_number("--speed", v, "m/s") if isinstance(v, str) else float(v) for v in speed]
    points = measured_restitutions(case) if measured else list(zip(speeds, e_n, strict=True))
    if len(points) == 1:
        refuse("several e_n", uncertainty=uncertainty)
        return from_restitution(case, points[0][1], points[0][0])
    return from_restitutions(case, points, uncertainty)


def summary(c: Calibration) -> list[str]:
    """The strength with its interval, and the lines of the case file."""
    lines = [f'{c.parameter} = "{c.value / 1e6:.6g} MPa"']
    interval, more = "", ""
    if c.hardening_exponent is not None and c.intervals is not None:
        lines.append(f"hardening_exponent = {c.hardening_exponent:.4g}")
        (low, high), (least, most) = c.intervals
        interval = f" ({low / 1e6:.4g} to {high / 1e6:.4g} MPa)"
        distribution, fits = "normal distribution", f"largest residual of e_n {c.largest_residual:.2g} standard errors"
        if c.scatter is not None:
            freedom = len(c.measured) - 2
            distribution = f"Student's t, {freedom} degree{'s' if freedom > 1 else ''} of freedom"
            fits = f"scatter of e_n about the fit {c.scatter:.2g}, to be compared with the error of the measurement"
        more = (
            f", hardening_exponent = {c.hardening_exponent:.4g} ({least:.3g} to {most:.3g}); {CONFIDENCE * 100:g} % "
            f"confidence intervals, {distribution}; correlation {c.correlation:.3f}; {fits}"
        )
    return [
        f"law {c.law}, {c.source}: {c.parameter} = {c.value / 1e6:.6g} MPa{interval}{more}; "
        f"that is yield_stress = {c.yield_stress / 1e6:.6g} MPa, yield speed {c.yield_speed:.4g} m/s",
        f"in the case file, under [law]: {'; '.join(lines)}",
    ]


def measured_restitutions(path: Path | LoadedCase) -> list[tuple[float, float]]:
    """The (speed [m/s], e_n) of [measured] of a case. Raises CaseError."""
    curve = _model(path).measured
    if curve is None:
        raise CaseError(f"{path}: it has no [measured] speeds and e_n; add them, or give --e-n with --speed")
    return list(zip(curve.speeds, curve.e_n, strict=True))
