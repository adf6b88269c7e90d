# SPDX-License-Identifier: GPL-2.0-or-later
"""Points of a sweep: keys by dotted names; ranges, lists and tables of values; grids and Latin hypercubes."""

import itertools
import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tomlkit

from ...case.keys import Key, entry, law_of
from ...case.law import alternatives
from ...case.messages import nearest
from ...case.sizes import csv_table
from ...case.toml import strength_keys
from ...case.units import to_si
from ...errors import CaseError


def require_key(key: str, keys: dict[str, Key], place: str) -> Key:
    """The key of that name. Raises CaseError with the nearest names."""
    if key in keys:
        return keys[key]
    raise CaseError(f"{place}: the case has no key {key!r}; the nearest: {nearest(key, keys)}")


def numbers(text: str, count: int) -> list[int]:
    """The numbers of points in a text as "7,9-12", of `count` points. Raises CaseError."""
    found: list[int] = []
    for part in text.split(","):
        ends = re.fullmatch(r"\s*([0-9]{1,9})\s*(?:-\s*([0-9]{1,9})\s*)?", part)
        low, high = (int(ends[1]), int(ends[2] or ends[1])) if ends else (0, 0)
        if not 1 <= low <= high <= count:
            raise CaseError(f"--only {part!r}: must be points from 1 to {count}, as 7,9-12; --dry-run lists them")
        found += range(low, high + 1)
    return list(dict.fromkeys(found))


def _exclusive_keys(key: str, data: dict[str, Any]) -> tuple[str, ...]:
    """Alternatives of `key`, of which a case may have one."""
    if key == "numerics.error":
        return ("numerics.steps_in_contact",)
    if key == "numerics.steps_in_contact":
        return ("numerics.error",)
    law, (table, _, name) = law_of(data), key.partition(".")
    material, _, last = name.rpartition(".")
    if table == "materials" and last in strength_keys():
        return tuple(f"materials.{material}.{other}" for other in strength_keys())
    return tuple(f"law.{other}" for other in alternatives(law, name)) if law and table == "law" else ()


def assign(document: Any, key: str, value: Any) -> None:
    """Set `key` in a TOML document or plain tables; missing tables are made, alternatives of the key are removed."""
    *way, last = key.split(".")
    for other in _exclusive_keys(key, document):
        *path, name = other.split(".")
        table = document
        for part in path:
            table = table.get(part, {})
        if other != key and name in table:
            del table[name]
    table = document
    for name in way:
        if isinstance(table, list):
            table = table[entry(table, name)]
            continue
        if name not in table:
            table[name] = tomlkit.table() if isinstance(document, tomlkit.TOMLDocument) else {}
        table = table[name]
    table[entry(table, last) if isinstance(table, list) else last] = value


Value = Any  # as it stands in a case file: text, number, true or false, list, table
Point = dict[str, Value]
MOST = 1_000_000  # points of a sweep
_SPLIT = re.compile(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(.*?)\s*")


@dataclass(frozen=True)
class ValueRange:
    """Values from `low` to `high` in `unit` ("" for a plain number), evenly spaced, or evenly in the logarithm."""

    low: float
    high: float
    unit: str
    count: int | None
    log: bool
    whole: bool

    def at(self, share: float) -> Value:
        """The value at `share` (0 to 1) of the way."""
        x = self.low * (self.high / self.low) ** share if self.log else self.low + share * (self.high - self.low)
        if self.whole:
            return round(x)
        text = f"{x:.13g}"  # without the round-off of this line
        return f"{text} {self.unit}" if self.unit else float(text)

    def values(self) -> list[Value]:
        assert self.count is not None
        return list(dict.fromkeys(self.at(k / (self.count - 1)) for k in range(self.count)))


@dataclass(frozen=True)
class Listed:
    """Values one by one."""

    all: tuple[Value, ...]

    def at(self, share: float) -> Value:
        """The value at `share` (0 to 1) of the list."""
        return self.all[min(int(share * len(self.all)), len(self.all) - 1)]

    def values(self) -> list[Value]:
        return list(self.all)


Axis = ValueRange | Listed


def axis(text: str, key: Key, place: str) -> Axis:
    """The values of a key from text: "1 mm,2 mm", "0.5 GPa..2 GPa:16", "log:1 m/s..100 m/s:9".

    Raises CaseError, which begins with `place`.
    """
    log = text.strip().startswith("log:")
    body = text.strip().removeprefix("log:")
    if ".." not in body:
        if log:
            raise CaseError(f"{place} = {text!r}: log: needs a range, as log:1 m/s..100 m/s:9")
        return Listed(tuple(_value(part, place) for part in _parts(body)))
    low_text, _, high_text = body.partition("..")
    high_text, _, count_text = high_text.partition(":")
    (low, low_unit), (high, high_unit) = (_number(part, text, place) for part in (low_text, high_text))
    unit = low_unit or high_unit
    if high_unit not in ("", unit):
        try:
            high = to_si(f"{high!r} {high_unit}", unit)
        except ValueError as error:
            raise CaseError(f"{place} = {text!r}: {error}") from None
    if count_text and not (count_text.strip().isdecimal() and 2 <= int(count_text) <= MOST):
        raise CaseError(f"{place} = {text!r}: {count_text!r} is not a number of values from 2 to {MOST}")
    if low == high or (log and not (low > 0 and high > 0)):
        needs = "two limits > 0" if log else "two limits that differ"
        raise CaseError(f"{place} = {text!r}: a range needs {needs}")
    return ValueRange(low, high, unit, int(count_text) if count_text else None, log, key.whole)


def _number(part: str, text: str, place: str) -> tuple[float, str]:
    match = _SPLIT.fullmatch(part)
    try:
        number, unit = (float(match[1]), match[2]) if match else (math.nan, "")
    except ValueError:
        number, unit = math.nan, ""
    if not math.isfinite(number):
        raise CaseError(f"{place} = {text!r}: {part!r} is not a number with a unit; write 0.5 GPa..2 GPa:16")
    return number, unit


def _parts(text: str) -> list[str]:
    """The text split at commas outside quotes and brackets."""
    depth, quoted, parts = 0, False, [""]
    for c in text:
        quoted ^= c == '"'
        depth += 0 if quoted else (c in "[{") - (c in "]}")
        if c == "," and depth == 0 and not quoted:
            parts.append("")
        else:
            parts[-1] += c
    return parts


def _value(text: str, place: str) -> Value:
    """The value of TOML that the text is, else the text."""
    if not text.strip():
        raise CaseError(f"{place}: a value is empty; write one between the commas, or remove a comma")
    try:
        table = tomllib.loads(f"x = {text.strip()}")
    except (ValueError, RecursionError):
        return text.strip()
    value = table.get("x")
    return value if len(table) == 1 and isinstance(value, str | int | float | list | dict) else text.strip()


def settings(
    texts: Sequence[str], option: str = "--set", example: str = "impact.body.radius='1 mm,2 mm'"
) -> dict[str, str]:
    """Values by key from options KEY=VALUES. Raises CaseError, which shows the example."""
    given: dict[str, str] = {}
    for text in texts:
        key, equals, values = text.partition("=")
        if not equals or not key.strip() or not values.strip():
            raise CaseError(f"{option} {text!r}: write it as {option} {example}")
        if key.strip() in given:
            raise CaseError(f"{option} {key.strip()}: given twice; write all its values behind one")
        given[key.strip()] = values
    return given


def axes(given: Mapping[str, Any], keys: dict[str, Key], option: str = "--set") -> dict[str, Axis]:
    """The values of each key, from text as in `axis`, from a sequence, or from one value. Raises CaseError."""
    axes: dict[str, Axis] = {}
    for name, values in given.items():
        key = require_key(name, keys, f"{option} {name}")
        if isinstance(values, str):
            axes[name] = axis(values, key, f"{option} {name}")
        else:
            axes[name] = Listed(tuple(with_units(v, keys, name) for v in _listed(values)))
            if not axes[name].values():
                raise CaseError(f"{option} {name}: no values; give at least one")
    return axes


def _listed(values: Any) -> list[Any]:
    if isinstance(values, Mapping):
        return [values]
    try:
        return list(values)
    except TypeError:
        return [values]


def with_units(value: Any, names: dict[str, Key], place: str = "") -> Value:
    """A value of a program as a case file has it: a table, a list or a single value of the key `place`.

    A plain number of a quantity is in SI and gets its unit; numpy's values become Python's. `names`: every key of the
    case; with none, numbers stay. Raises CaseError for a value of a type that TOML does not have.
    """
    value = value.tolist() if isinstance(value, np.generic | np.ndarray) else value
    if isinstance(value, Mapping):
        return {str(k): with_units(v, names, f"{place}.{k}" if place else str(k)) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [with_units(v, names, f"{place}.{n}" if isinstance(v, Mapping) else place) for n, v in enumerate(value)]
    if hasattr(value, "magnitude"):  # a quantity of pint
        return f"{value:~C}"
    if not isinstance(value, str | int | float):
        raise CaseError(f"{place} = {value!r}: of type {type(value).__name__}; give a number in SI or a text")
    unit = names.get(place, Key()).unit
    return f"{float(value)!r} {unit}" if unit not in (None, "1") and not isinstance(value, str | bool) else value


def grid(all_axes: dict[str, Axis]) -> list[Point]:
    """Every combination of the values. Raises CaseError."""
    for name, values in all_axes.items():
        if isinstance(values, ValueRange) and values.count is None:
            raise CaseError(f"--set {name}: how many values? write LOW..HIGH:COUNT, or add --latin-hypercube")
    columns = {name: values.values() for name, values in all_axes.items()}
    total = math.prod(map(len, columns.values()))
    if total > MOST:
        raise CaseError(f"--set: {total} points, at most {MOST}; take fewer values, or --latin-hypercube")
    return [dict(zip(columns, values, strict=True)) for values in itertools.product(*columns.values())]


def latin_hypercube(all_axes: dict[str, Axis], count: int, seed: int) -> list[Point]:
    """`count` points; each axis is cut into as many equal parts, and each part holds one point."""
    if not 1 <= count <= MOST:
        raise CaseError(f"--latin-hypercube {count}: must lie in [1, {MOST}]")
    random = np.random.default_rng(seed)
    shares = {name: ((random.permutation(count) + random.random(count)) / count).tolist() for name in all_axes}
    return [{name: values.at(shares[name][n]) for name, values in all_axes.items()} for n in range(count)]


def table(path: Path, keys: dict[str, Key]) -> list[Point]:
    """The points in a CSV file: a column per key, "KEY" with units in the cells or "KEY [UNIT]". Raises CaseError."""
    units, rows = csv_table(path)
    for name in units:
        require_key(name, keys, f"--points {path}")
    return [
        {name: _value(f"{cell} {units[name]}".strip(), place) for name, cell in cells.items()} for place, cells in rows
    ]
