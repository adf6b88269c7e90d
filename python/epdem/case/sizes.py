# SPDX-License-Identifier: GPL-2.0-or-later
"""Sizes of spheres: one radius, evenly spread, normal, log-normal, or a sieve table, in classes of one radius. SI."""

import csv
import math
import re
from abc import ABC, abstractmethod
from pathlib import Path
from statistics import NormalDist
from typing import Annotated, Any, Self

from pydantic import BeforeValidator, Field, Tag, ValidationInfo, model_validator

from ..errors import CaseError
from .fields import Frozen, Interval, Length, Name, Quantity, by_key, by_shape
from .toml import text_of
from .units import read_number

Share = Annotated[float, Quantity("1", above=0.0, le=1.0)]
Count = Annotated[int, Field(ge=1, le=100_000_000)]
LARGEST_FILE = 200_000_000  # bytes of a file beside a case
MOST_SIEVES = 64
_HEAD = re.compile(r"(.*?)\s*(?:\[(.+)\])?")


def _find_file(value: object, info: ValidationInfo) -> Path:
    """The file that a case names, beside the case or by its whole path. Raises ValueError."""
    if isinstance(value, Path):
        return value
    if not isinstance(value, str) or not value or not value.isprintable():
        raise ValueError("must be the name of a file in quotes")
    folder = Path((info.context or {}).get("folder", "."))
    try:
        path = folder / value
        if not path.is_file():
            raise ValueError(f"no such file; names of files count from the folder of the case ({folder})")
        if path.stat().st_size > LARGEST_FILE:
            raise ValueError(f"more than {LARGEST_FILE // 1_000_000} MB; name another file")
    except OSError as error:
        raise ValueError(f"cannot be read ({error.strerror}); name another file") from None
    return path


FileName = Annotated[Path, BeforeValidator(_find_file)]


def csv_table(path: Path) -> tuple[dict[str, str], list[tuple[str, dict[str, str]]]]:
    """Units by head ("": none), and (place, cells by head) of each row, of a CSV file with heads NAME or NAME [UNIT].

    `#` begins a comment. Raises CaseError.
    """
    lines = [(f"{path} line {n}", line.strip()) for n, line in enumerate(text_of(path, LARGEST_FILE).splitlines(), 1)]
    try:
        rows = [(place, next(csv.reader([line]))) for place, line in lines if line and not line.startswith("#")]
    except csv.Error as error:
        raise CaseError(
            f"{path} cannot be read ({error}); divide its values by commas, its rows by line ends"
        ) from None
    rows = [(place, [*map(str.strip, cells)]) for place, cells in rows if any(map(str.strip, cells))]
    if len(rows) < 2:
        raise CaseError(f"{path} needs a line of heads and at least one row")
    heads = [_HEAD.fullmatch(head) for head in rows[0][1]]
    units = {head[1]: head[2] or "" for head in heads if head}
    if len(units) < len(heads):
        raise CaseError(f"{path}: two columns have the same head; keep one")
    for place, cells in rows[1:]:
        if len(cells) != len(units):
            raise CaseError(f"{place}: {len(cells)} values, expected {len(units)}")
    return units, [(place, dict(zip(units, cells, strict=True))) for place, cells in rows[1:]]


def number_in(place: str, name: str, text: str) -> float:
    """A number in a cell of a CSV file. Raises CaseError that names file, line and column."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise CaseError(f"{place}: {name} = {text[:40]!r} is not a number")
    return value


class _Limits(Interval[Length]):
    """Radii between two limits [m], in `classes` classes of one radius each."""

    classes: Annotated[int, Field(ge=2, le=50)] = 5


class Range(_Limits):
    """Radii evenly spread, by number, from one limit to the other."""

    def numbers(self) -> list[tuple[float, float]]:
        """(radius [m], weight by number) of each class."""
        step = (self.to - self.start) / (self.classes - 1)
        return [(float(f"{self.start + k * step:.6g}"), 1.0) for k in range(self.classes)]


class _Spread(_Limits, ABC):
    """Radii of a distribution cut off at the limits, in classes of equal width, each with the radius in its middle."""

    @abstractmethod
    def share_below(self, radius: float) -> float:
        """Share by number of the uncut distribution below a radius [m]."""

    def numbers(self) -> list[tuple[float, float]]:
        """(radius [m], weight by number) of each class."""
        width = (self.to - self.start) / self.classes
        edges = [self.start + k * width for k in range(self.classes + 1)]
        below = [self.share_below(edge) for edge in edges]
        radii = [float(f"{edge + width / 2:.6g}") for edge in edges[:-1]]
        return [(r, high - low) for r, low, high in zip(radii, below[:-1], below[1:], strict=True) if high > low]

    @model_validator(mode="after")
    def _some(self) -> Self:
        if not self.numbers():
            raise ValueError("no sphere lies between 'from' and 'to'; move them towards the middle of the distribution")
        return self


class Normal(_Spread):
    """Radii normally distributed by number, cut off at two limits [m]."""

    mean: Length
    deviation: Length

    def share_below(self, radius: float) -> float:
        return NormalDist(self.mean, self.deviation).cdf(radius)


class LogNormal(_Spread):
    """Radii whose logarithm is normally distributed by number, cut off at two limits [m]."""

    median: Length
    ratio: Annotated[float, Quantity("1", above=1.0)]  # geometric standard deviation

    def share_below(self, radius: float) -> float:
        return NormalDist().cdf(math.log(radius / self.median) / math.log(self.ratio))


def _table(value: object, info: ValidationInfo) -> tuple[tuple[float, float], ...]:
    """((opening [m], share of the mass retained on it), ...), from the largest opening, of a sieve table's file."""
    if isinstance(value, tuple):
        return value
    path = _find_file(value, info)
    units, lines = csv_table(path)
    if len(units) != 2 or not all(units.values()):
        form = "'opening [mm],retained [%]' (divided by a comma)"
        raise ValueError(f"{path} needs two columns with units, as {form}; it has {[*units]}")
    (first, length), (second, share) = units.items()
    if re.search("pass|cumul", second, re.IGNORECASE):
        raise ValueError(f"{path}: the column {second!r} is a running sum; give what each sieve retains")
    if share not in ("%", "1"):
        raise ValueError(f"{path}: the mass retained is in [%] or [1], not in [{share}]")
    rows = []
    for place, cells in lines:
        opening, retained = (number_in(place, name, cells[name]) for name in units)
        if opening < 0 or retained < 0:
            raise ValueError(f"{place}: openings and shares must be at least 0")
        rows.append((read_number(f"{place}: {first}", f"{opening!r} {length}", "m", zero=True), retained))
    rows.sort(reverse=True)
    if not 2 <= len(rows) <= MOST_SIEVES or len({opening for opening, _ in rows}) < len(rows):
        raise ValueError(f"{path}: from 2 to {MOST_SIEVES} different openings are needed, there are {len(rows)}")
    total, whole = sum(retained for _, retained in rows), 100.0 if share == "%" else 1.0
    if abs(total / whole - 1.0) > 0.02:
        raise ValueError(
            f"{path}: the shares add up to {total:g}, must be {whole:g} within 2 %; give what each sieve retains"
        )
    if rows[0][1] > 0:
        raise ValueError(f"{path}: nothing may be retained on the largest opening; add a larger one with 0")
    return tuple((opening, retained / total) for opening, retained in rows)


class Sieve(Frozen):
    """A sieve table: spheres retained on an opening have the diameter halfway to the next larger opening."""

    sieve: Annotated[tuple[tuple[float, float], ...], BeforeValidator(_table)]

    def numbers(self) -> list[tuple[float, float]]:
        """(radius [m], weight by number) of each class, the smallest first."""
        pairs = zip(self.sieve[:-1], self.sieve[1:], strict=True)
        classes = [(float(f"{(larger + opening) / 4:.6g}"), share) for (larger, _), (opening, share) in pairs]
        return [(r, share / r**3) for r, share in reversed(classes) if share > 0]


Sizes = Annotated[
    Annotated[Range, Tag("range")]
    | Annotated[Normal, Tag("normal")]
    | Annotated[LogNormal, Tag("log")]
    | Annotated[Sieve, Tag("sieve")],
    by_key("range", sieve="sieve", mean="normal", deviation="normal", median="log", ratio="log"),
]


class Particles(Frozen):
    """Spheres of one material; `share` is their part of the mass that is filled in."""

    material: Name
    radius: Annotated[Annotated[Length, Tag("plain")] | Annotated[Sizes, Tag("table")], by_shape()]
    share: Share = 1.0

    @classmethod
    def of(cls, material: str, radius: float) -> Self:
        """Spheres of one radius [m]."""
        return cls.model_construct(material=material, radius=radius, share=1.0)

    def sizes(self) -> list[tuple[float, float]]:
        """(radius [m], share of the total mass) of each class of equal radii."""
        if isinstance(self.radius, float):
            return [(self.radius, self.share)]
        masses = [(r, weight * r**3) for r, weight in self.radius.numbers()]
        total = sum(mass for _, mass in masses)
        return [(r, self.share * mass / total) for r, mass in masses]

    def radii(self) -> tuple[float, float]:
        """Smallest and largest radius [m]."""
        return self.sizes()[0][0], self.sizes()[-1][0]


Mixture = Annotated[list[Particles], Field(min_length=1, max_length=64)]


def refuse_shares(particles: list[Particles]) -> None:
    """Raise ValueError unless the shares of a mixture add up to 1."""
    total = sum(p.share for p in particles)
    if abs(total - 1.0) > 1e-9:
        raise ValueError(f"the shares of 'particles' add up to {total:g}, must be 1")


def context(path: object) -> dict[str, Any]:
    """Context in which the models of a case in `path` find the files that it names."""
    return {"folder": Path(str(path)).parent}
