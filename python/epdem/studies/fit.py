# SPDX-License-Identifier: GPL-2.0-or-later
"""Fit of keys of a scene to target values of its results: floor load, plate force, rate of discharge.

Every evaluation is a point of a sweep, in its folder: interrupted or repeated, a fit runs no stored point again.
"""

import contextlib
import difflib
import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ..base.files import results_folder
from ..base.paths import DEFAULT_ENGINE
from ..case.keys import keys_of
from ..case.scene import is_scene
from ..case.toml import LoadedCase, portable_text
from ..case.units import to_si
from ..errors import CaseError, EngineError
from .sweep import folder as store
from .sweep import run as study
from .sweep.folder import Sweep
from .sweep.points import Point, ValueRange, axes
from .sweep.table import unit

Targets = Mapping[str, str | float]
MOST = 3  # keys that a fit frees
STEP = 0.1  # of a difference quotient, as a share of a key's range: above the scatter of a bulk scene
DIGITS = 6  # of a share: values closer than this are one point
STEPS = 20  # of the optimiser
SMALLEST = 1e-3  # step of the optimiser, as a share of a key's range


@dataclass(frozen=True)
class Fit:
    """The found values of the free keys as in a case file, the numbers at these values, and the point of the sweep.

    `numbers` and `targets` are in SI, of these `units` ("": none); `ran` counts the scenes that ran just now, `points`
    all that the fit needed; `sweep` holds their table.
    """

    values: Point
    numbers: dict[str, float]
    targets: dict[str, float]
    units: dict[str, str]
    case: Path
    ran: int
    points: int
    sweep: study.SweepOutcome

    def _repr_html_(self) -> str:
        numbers = {name: f"{value:.6g} {self.units[name]}" for name, value in self.numbers.items()}
        return str(pd.Series(self.values | numbers).to_frame("found").to_html())


class _TargetsMet(Exception):
    """All targets are within tolerance."""


class _Search:
    """The evaluated points of a fit and their numbers."""

    def __init__(self, base: Sweep, folder: Path, free: dict[str, ValueRange], given: Targets, **options: Any):
        self.base, self.folder, self.free, self.given, self.options = base, folder, free, given, options
        self.shares: list[tuple[float, ...]] = []
        self.found: list[dict[str, float]] = []
        self.targets: dict[str, float] = {}
        self.ran = 0

    def point(self, shares: tuple[float, ...]) -> Point:
        return {name: axis.at(share) for (name, axis), share in zip(self.free.items(), shares, strict=True)}

    @property
    def sweep(self) -> Sweep:
        return replace(self.base, points=tuple(map(self.point, self.shares)))

    def __call__(self, wanted: list[np.ndarray]) -> np.ndarray:
        """Relative errors of the targets at shares of the ranges, shape (points, targets). Raises EngineError."""
        asked = [tuple(np.round(shares, DIGITS).tolist()) for shares in wanted]
        new = [shares for shares in dict.fromkeys(asked) if shares not in self.shares]
        if new:
            self.shares += new
            sweep = self.sweep
            self.outcome = study.run(sweep, self.folder, retry_failed=True, **self.options)
            self.ran += self.outcome.ran
            self.found += [self._numbers(sweep, n) for n in range(len(self.found) + 1, len(self.shares) + 1)]
        self.targets = self.targets or {name: self._target(name, text) for name, text in self.given.items()}
        return np.array([[self._error(self.shares.index(s), name) for name in self.targets] for s in asked])

    def _numbers(self, sweep: Sweep, number: int) -> dict[str, float]:
        about = store.record(sweep, self.folder, number)
        if about["state"] != store.DONE:
            reason = about.get("reason", "its inputs changed during the fit")
            raise EngineError(f"{sweep.place(number)}: {reason}; see {store.point_folder(sweep, self.folder, number)}")
        return {name: row[0] for name, row in about["rows"].items() if isinstance(row[0], float)}

    def _target(self, name: str, text: str | float) -> float:
        """The value of a target in SI. Raises CaseError for a name that the results do not have, and for 0."""
        if name not in self.found[0]:
            near = ", ".join(difflib.get_close_matches(name, self.found[0], n=3, cutoff=0.0))
            raise CaseError(f"--target {name}: the results have no such number; the nearest: {near}")
        si = unit(name, self.base.tables)
        try:
            value = text if isinstance(text, float | int) else to_si(text, si) if si else float(text)
        except ValueError as error:
            raise CaseError(
                f"--target {name} = {text!r}: {error}; write it as {name}={'1 ' + si if si else '1'}"
            ) from None
        if not (math.isfinite(value) and value != 0.0):
            raise CaseError(f"--target {name} = {text!r}: must be a number other than 0, for errors are relative")
        return float(value)

    def _error(self, index: int, name: str) -> float:
        value = self.found[index][name]
        if not math.isfinite(value):
            raise CaseError(f"--target {name}: {self.sweep.place(index + 1)} does not have it; more rows or particles?")
        return value / self.targets[name] - 1.0


def fit(
    scene: Path | LoadedCase,
    targets: Targets,
    free: Mapping[str, str],
    *,
    out: Path | str | None = None,
    engine: str = DEFAULT_ENGINE,
    ranks: int = 1,
    tolerance: float = 0.01,
    jobs: int | None = None,
    force: bool = False,
    report: study.Report = lambda done, total: None,
) -> Fit:
    """Find values of the keys `free` (ranges, "0.1..0.5" or "log:1 MPa..1 GPa") that give the targets of a scene.

    `targets`: numbers of its results by name (see `numbers_of`), as text with a unit or in SI; `tolerance` is their
    largest relative error; the points are in `out` (default: runs/<name>_fit). Raises CaseError for unknown names, a
    key that changes nothing and targets out of reach, EngineError for a scene that fails.
    """
    text, place = (scene.text, scene.place) if isinstance(scene, LoadedCase) else (portable_text(scene), scene)
    data = tomllib.loads(text)
    if not is_scene(data):
        raise CaseError(f"{place}: --target is a number of a scene's results; for impacts give --e-n, --hv or --hb")
    if not 0.0 < tolerance < 1.0:
        raise CaseError(f"--tolerance {tolerance:g}, must lie in (0, 1)")
    if not targets or not 1 <= len(free) <= MOST:
        raise CaseError(f"a fit needs a --target NAME=VALUE, and one to {MOST} keys --free KEY=LOW..HIGH")
    ranges: dict[str, ValueRange] = {}
    for name, axis in axes(free, keys_of(data), "--free").items():
        if not isinstance(axis, ValueRange) or axis.count is not None:
            raise CaseError(f"--free {name} = {free[name]!r}: write its range as LOW..HIGH or log:LOW..HIGH")
        ranges[name] = axis
    middle = np.full(len(ranges), 0.5)
    base = study.plan(text, {name: [axis.at(0.5)] for name, axis in ranges.items()}, engines=[engine], ranks=ranks)
    folder = results_folder(Path(out) if out else None, f"{base.name}_fit")
    search = _Search(base, folder, ranges, targets, jobs=jobs, force=force, report=report)
    search([middle])  # its results show whether the targets exist
    _refuse_insensitive(search, middle, tolerance)
    _solve(search, tolerance)
    errors = np.abs(search([np.array(s) for s in search.shares])).max(axis=1)
    best = int(errors.argmin())
    values = search.point(search.shares[best])
    numbers = {name: search.found[best][name] for name in search.targets}
    if errors[best] > tolerance:
        raise CaseError(f"{place}: {_failure_message(search, values, numbers)}")
    case = store.point_folder(search.sweep, folder, best + 1) / store.CASE
    units = {name: unit(name, base.tables) or "" for name in numbers}
    return Fit(values, numbers, search.targets, units, case, search.ran, len(search.shares), search.outcome)


def _refuse_insensitive(search: _Search, middle: np.ndarray, tolerance: float) -> None:
    """Raise CaseError for a key whose range changes no target by more than the tolerance."""
    ends = [np.where(np.arange(middle.size) == k, end, middle) for k in range(middle.size) for end in (0.0, 1.0)]
    search([middle, *ends])
    for k, (name, axis) in enumerate(search.free.items()):
        found = [search.found[n] for n in (0, 1 + 2 * k, 2 + 2 * k)]
        values = np.array([[numbers[target] for numbers in found] for target in search.targets])
        change = (np.ptp(values, axis=1) / np.maximum(np.abs(values).max(axis=1), 1e-300)).max()
        if change <= tolerance:
            raise CaseError(
                f"--free {name}: from {axis.at(0.0)} to {axis.at(1.0)} it changes {' and '.join(search.targets)} "
                f"by {change:.1g} of the value, not more than --tolerance {tolerance:g}; free another key"
            )


def _solve(search: _Search, tolerance: float) -> None:
    """Search until all relative errors are within the tolerance, or no step helps any more.

    One key and one target between two known points: Brent's method, which scatter does not lead astray. Else least
    squares, from the best point so far.
    """
    from scipy.optimize import brentq, least_squares

    def residuals(shares: np.ndarray) -> np.ndarray:
        (errors,) = search([shares])
        if np.abs(errors).max() <= tolerance:
            raise _TargetsMet
        return np.asarray(errors)

    def jacobian(shares: np.ndarray) -> np.ndarray:
        steps = np.diag(np.where(shares + STEP <= 1.0, STEP, -STEP))
        errors = search([shares, *(shares + steps)])
        return np.asarray((errors[1:] - errors[0]).T / steps.diagonal())

    known = search([np.array(s) for s in search.shares])
    start = np.array(search.shares[int((known**2).sum(axis=1).argmin())])
    options: dict[str, Any] = {"bounds": (0.0, 1.0), "method": "dogbox", "xtol": SMALLEST, "ftol": 1e-4, "gtol": None}
    with contextlib.suppress(_TargetsMet):
        residuals(start)
        if known.shape == (3, 1) and (known[0] * known[1:] < 0).any():  # in the middle and at the ends of one key
            ends = (0.0, 0.5) if known[0] * known[1] < 0 else (0.5, 1.0)
            brentq(lambda share: residuals(np.array([share]))[0], *ends, xtol=SMALLEST, maxiter=STEPS, disp=False)
        else:
            least_squares(residuals, start, jacobian, max_nfev=STEPS, **options)


def _failure_message(search: _Search, values: Point, numbers: dict[str, float]) -> str:
    said = []
    for name, target in search.targets.items():
        low, high = (f(found[name] for found in search.found) for f in (min, max))
        how = "not met" if low <= target <= high else "out of reach"
        si = f" {of}" if (of := unit(name, search.base.tables)) else ""
        said.append(f"{name} = {target:g}{si} is {how}: {low:.4g} to {high:.4g}{si}")
    nearest = ", ".join(f"{name} = {value:.4g}" for name, value in numbers.items())
    where = ", ".join(f"{key} = {value}" for key, value in values.items())
    return (
        f"{'; '.join(said)} at {len(search.found)} points; the nearest is {nearest} at {where}; "
        "widen --free, or if neighbouring points scatter, allow more by --tolerance or take a larger scene"
    )
