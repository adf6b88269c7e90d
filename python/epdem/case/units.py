# SPDX-License-Identifier: GPL-2.0-or-later
"""Quantities with units ("208 GPa") as SI floats."""

import math
import re
from functools import cache
from typing import Any

from ..errors import CaseError

# number, blank, unit; checked before pint, which evaluates any expression
_NUMBER = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,3})?"
_NAME = r"[A-Za-zµ°%]{1,20}"
_FACTOR = rf"{_NAME}(?:(?:\^|\*\*)-?\d)?"
_FACTORS = rf"{_FACTOR}(?: ?[*/·] ?{_FACTOR}|/\d|/\({_FACTOR}(?:[ *·]{_FACTOR})+\))*"
_QUANTITY = re.compile(rf"({_NUMBER})(?: +((?:1/)?{_FACTORS}))?")
_ANGLES = ("radian", "degree", "turn", "grade", "revolutions_per_minute", "revolutions_per_second")  # pint's names


@cache
def _registry() -> Any:
    import pint  # half a second: only when a case is read

    return pint.UnitRegistry(autoconvert_offset_to_baseunit=True)


PREFIXES = {"n": 1e-9, "u": 1e-6, "m": 1e-3, "c": 1e-2, "k": 1e3, "M": 1e6, "G": 1e9}
_TAKES_PREFIX = re.compile(r"(?!kg)[A-Za-z]+(?![A-Za-z^])")  # mm^2 is (mm)^2, so m^2 does not


@cache
def _factor(unit: str, si: str) -> float:
    if unit == si:
        return 1.0
    if unit[1:] == si and _TAKES_PREFIX.match(si):  # what most cases have, without the half second
        return PREFIXES.get(unit[0]) or _by_pint(unit, si)
    return _by_pint(unit, si)


def _by_pint(unit: str, si: str) -> float:
    import pint

    registry = _registry()
    try:
        quantity = registry.Quantity(1.0, unit.replace("·", "*"))
        factor = float(quantity.to(si).magnitude)
    except pint.UndefinedUnitError as error:
        raise ValueError(f"unknown unit {unit!r}") from error
    except pint.DimensionalityError as error:
        raise ValueError(f"the unit {unit!r} has the wrong dimension; expected a unit like {si!r}") from error
    if any(name.startswith("degree_") for name, _ in quantity.unit_items()):
        raise ValueError(f"the unit {unit!r} has a zero of its own; write kelvins, K (20 degC are 293.15 K)")
    turns = any(name.endswith(_ANGLES) for name, _ in quantity.unit_items())  # pint takes a radian for the number 1
    if si == "rad/s" and not turns:
        raise ValueError(f"the unit {unit!r} does not say whether it counts turns; write turn/s, rpm or rad/s")
    if si in ("Hz", "1/s") and turns:
        raise ValueError(f"the unit {unit!r} is one of angles; write how many in a second, in Hz (60 rpm are 1 Hz)")
    return factor


def refuse_unit(unit: str) -> None:
    """Raise ValueError for a text that is no unit, or none of SI."""
    _by_pint(unit, unit)
    factor = float(_registry().Quantity(1.0, unit.replace("·", "*")).to_base_units().magnitude)
    if factor != 1.0:
        raise ValueError(f"the unit {unit!r} is {factor:g} of SI's; write the unit of SI")


def to_si(text: object, si: str) -> float:
    """The value of `text`, a quantity as "208 GPa", in the SI unit `si`; a plain number if `si` is "1".

    Raises ValueError that names the expected form: number, blank, unit; finite; the right dimension.
    """
    if si == "1":
        if isinstance(text, bool) or not isinstance(text, int | float):
            raise ValueError(f"expected a plain number, got {text!r}")
        value = float(text)
    else:
        if not isinstance(text, str):
            shown = text if isinstance(text, int | float) and not isinstance(text, bool) else 1
            raise ValueError(f'expected a quantity with a unit in quotes, as "{shown} {si}", got {text!r}')
        match = _QUANTITY.fullmatch(text.strip()) if len(text) < 80 else None
        if match is None:
            raise ValueError(f'{text[:60]!r} is not number, blank, unit, as "1 {si}"')
        number, unit = match.groups()
        if unit is None:
            raise ValueError(f'{text!r} has no unit; write "{text.strip()} {si}" if that is what is meant')
        value = float(number) * _factor(unit, si)
    if not math.isfinite(value):
        raise ValueError(f"{text!r} is not a finite number")
    return value


# Limits of particle simulations, within which the powers in the laws stay in the range of numbers.
LIMITS = {"Pa": (1e-9, 1e30), "m": (1e-12, 1e6), "kg/m^3": (1e-9, 1e20), "m/s": (1e-30, 1e12)}


def within_limits(x: float, si: str) -> float:
    """x within LIMITS of its unit. Raises ValueError."""
    low, high = LIMITS.get(si, (0.0, math.inf))
    if x and not low <= abs(x) <= high:
        raise ValueError(f"must lie in [{low:g}, {high:g}] {si}; check the unit")
    return x


def read_number(place: str, value: object, unit: str, *, zero: bool = False, below: float = math.inf) -> float:
    """`value` as written at `place` in a file or a command, in SI, in (0, below), or [0, below) with `zero`.

    Raises CaseError.
    """
    try:
        x = within_limits(to_si(value, unit), unit)
    except ValueError as error:
        raise CaseError(f"{place} = {value!r}, {error}") from None
    if not (0 < x < below or (zero and x == 0)):
        limits = f"be {'>=' if zero else '>'} 0" if below == math.inf else f"lie in {'[' if zero else '('}0, {below:g})"
        raise CaseError(f"{place} = {value!r}, must {limits}; correct it")
    return x
