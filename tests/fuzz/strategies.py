# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases, values and bytes as careless or hostile people make them: mutations of what is right."""

import copy
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import tomlkit
from hypothesis import strategies as st

from epdem.case.toml import read_toml

CASES = Path(__file__).parents[2] / "cases"
FILES = sorted(CASES.glob("*.toml"))
BASES = [read_toml(path) for path in FILES]
UNITS = ["m", "mm", "um", "m/s", "km/h", "Pa", "GPa", "kg/m^3", "g/cm^3", "s", "Hz", "rpm", "deg", "m/s^2", "J/m^3"]
words = st.text(st.characters(codec="utf-8", exclude_categories=["Cs"]), max_size=20)
numbers = st.one_of(
    st.integers(-10, 10**6),
    st.floats(allow_nan=True, allow_infinity=True),
    st.sampled_from([0, 0.0, -0.0, 1e-300, 1e300, 2**31, 2**63, 10**30]),
)
quantities = st.builds(
    "{} {}".format, st.one_of(numbers, st.floats(1e-6, 1e6)), st.one_of(st.sampled_from(UNITS), words)
)
values = st.recursive(
    st.one_of(
        quantities, numbers, words, st.booleans(), st.sampled_from(["steel", "glass", "wall", "rigid", "cavity"])
    ),
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(words, inner, max_size=3)),
    max_leaves=6,
)


def places(data: Any) -> Iterator[tuple[Any, Any]]:
    """(table or list, key) of every value of nested tables."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        yield data, key
        if isinstance(value, dict | list):
            yield from places(value)


def rescaled(value: Any, power: int) -> Any:
    """A quantity or number times a power of ten; anything else as it is."""
    if isinstance(value, str) and (match := re.fullmatch(r"(-?[\d.]+(?:e-?\d+)?) (.*)", value)):
        return f"{float(match[1]) * 10.0**power:.6g} {match[2]}"
    if isinstance(value, float):
        return value * 10.0**power
    return value


@st.composite
def cases(draw: st.DrawFn) -> dict[str, Any]:
    """The tables of a case or scene of the project with up to four changes, many of which leave it valid."""
    data = copy.deepcopy(draw(st.sampled_from(BASES)))
    for _ in range(draw(st.integers(0, 4))):
        where = list(places(data))
        if not where:
            break
        table, key = where[draw(st.integers(0, len(where) - 1))]
        match draw(st.sampled_from(["rescale", "rescale", "set", "delete", "add", "copy"])):
            case "rescale":
                table[key] = rescaled(table[key], draw(st.integers(-9, 9)))
            case "set":
                table[key] = draw(values)
            case "delete":
                del table[key]
            case "add" if isinstance(table, dict):
                table[draw(words)] = draw(values)
            case "copy":
                other, name = where[draw(st.integers(0, len(where) - 1))]
                if name in other if isinstance(other, dict) else name < len(other):
                    table[key] = copy.deepcopy(other[name])
    return data


def toml(data: dict[str, Any]) -> str:
    """The text of a case file."""
    return tomlkit.dumps(data)


@st.composite
def damaged(draw: st.DrawFn, raw: bytes) -> bytes:
    """Bytes as a crash, a full disk or a stray program leaves them."""
    at = draw(st.integers(0, len(raw)))
    end = min(len(raw), at + draw(st.sampled_from([1, 4, 8, 64, 512, 4096])))
    match draw(st.sampled_from(["cut", "zero", "flip", "insert", "remove", "replace"])):
        case "cut":
            return raw[:at]
        case "zero":
            return raw[:at] + bytes(end - at) + raw[end:]
        case "flip":
            flipped = bytes(b ^ 1 << draw(st.integers(0, 7)) for b in raw[at : at + 1])
            return raw[:at] + flipped + raw[at + 1 :]
        case "insert":
            return raw[:at] + draw(st.binary(max_size=64)) + raw[at:]
        case "remove":
            return raw[:at] + raw[end:]
        case _:
            return raw[:at] + draw(st.binary(max_size=64)) + raw[end:]
