# SPDX-License-Identifier: GPL-2.0-or-later
"""Common fields of cases of impacts and scenes: quantities, names, materials, law, dashpot; SI values out."""

from dataclasses import dataclass
from typing import Annotated, Generic, Literal, Self, TypeVar

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Discriminator, Field, GetCoreSchemaHandler, model_validator
from pydantic_core.core_schema import CoreSchema, no_info_before_validator_function

from ..theory.indentation import VICKERS
from .toml import strength_keys
from .units import to_si, within_limits


@dataclass(frozen=True)
class Quantity:
    """Annotation of a pydantic field: a quantity in `si` above `above` or in [ge, le]; `hint` ends the message."""

    si: str
    above: float = -np.inf
    ge: float = -np.inf
    le: float = np.inf
    hint: str = ""

    def read(self, value: object) -> float:
        """The SI value of a quantity as a user writes it. Raises ValueError."""
        x = to_si(value, self.si)
        if x > self.above and self.ge <= x <= self.le:
            return within_limits(x, self.si)
        left = f"[{self.ge:g}" if self.ge > self.above else f"({self.above:g}"
        right = f"{self.le:g}{']' if self.le < np.inf else ')'}"
        unit, hint = "" if self.si == "1" else f" {self.si}", f"; {self.hint}" if self.hint else ""
        raise ValueError(f"must lie in {left}, {right}{unit}{hint}")

    def __get_pydantic_core_schema__(self, source: type[float], handler: GetCoreSchemaHandler) -> CoreSchema:
        return no_info_before_validator_function(self.read, handler(source))


@dataclass(frozen=True)
class Hardness(Quantity):
    """A mean contact pressure [Pa]: of nanoindentation as "1.9 GPa", of Vickers tests as "180 HV"."""

    def read(self, value: object) -> float:
        number, _, unit = value.strip().partition(" ") if isinstance(value, str) else ("", "", "")
        if unit.strip() != "HV":
            return super().read(value)
        return super().read(f"{to_si(f'{number} Pa', 'Pa') * VICKERS!r} Pa")


@dataclass(frozen=True)
class YieldStress(Quantity):
    """A yield stress [Pa]; "inf Pa" of a material that never yields."""

    def read(self, value: object) -> float:
        return np.inf if value == NEVER else super().read(value)


NEVER = "inf Pa"
Temperature = Annotated[float, Quantity("K", above=0.0)]
Length = Annotated[float, Quantity("m", above=0.0)]
Speed = Annotated[float, Quantity("m/s", above=0.0)]
Pressure = Annotated[float, Quantity("Pa", above=0.0)]
Spin = Annotated[float, Quantity("rad/s")]
Gravity = Annotated[float, Quantity("m/s^2", ge=0.0)]
Coefficient = Annotated[float, Quantity("1", ge=0.0)]
Tangential = Literal["history", "partial_slip", "partial_slip_2"]  # the last with 2 nodes in place of 3
NODES = {"history": 0, "partial_slip": 3, "partial_slip_2": 2}  # of partial slip; 0: one spring
Restitution = Annotated[
    float, Quantity("1", ge=0.14, le=1.0, hint="1 is no dashpot, below 0.14 none is strong enough")
]  # of impacts that do not yield


def zero_vector() -> list[float]:
    """The vector (0, 0, 0)."""
    return [0.0, 0.0, 0.0]


def _printable_line(value: object) -> str:
    if not isinstance(value, str) or not value.strip() or not value.isprintable() or len(value) > 200:
        raise ValueError("must be one printable line of at most 200 characters")
    if value.rstrip().endswith("&"):  # LIGGGHTS would read the next command as part of a comment
        raise ValueError("must not end in '&' (it would swallow the next line of the deck)")
    return value


Line = Annotated[str, BeforeValidator(_printable_line)]
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$")]


class Frozen(BaseModel):
    """Keys that a case may have, and no others; values are never changed."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


def by_shape() -> Discriminator:
    """Chooses between the readings of a value by whether it is a table: "table" or "plain"."""
    return Discriminator(lambda value: "table" if isinstance(value, dict | BaseModel) else "plain")


def by_key(otherwise: str, **tags: str) -> Discriminator:
    """Chooses between the readings of a table by the first of these keys that it has."""

    def choose(value: object) -> str:
        keys = value if isinstance(value, dict) else vars(value) if isinstance(value, BaseModel) else ()
        return next((tag for key, tag in tags.items() if key in keys), otherwise)

    return Discriminator(choose)


T = TypeVar("T", bound=float)


class Interval(Frozen, Generic[T]):
    """Values from one limit to a larger one; T: their quantity."""

    start: T = Field(alias="from")
    to: T

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if not self.start < self.to:
            unit = type(self).model_fields["to"].metadata[0].si
            raise ValueError(f"'to' ({self.to:g} {unit}) must exceed 'from' ({self.start:g} {unit})")
        return self


class Header(Frozen):
    """The name of a case, its title and the source of its numbers."""

    name: Name
    title: Line
    source: Line


class Material(Frozen):
    """Elastic constants, density, (if the law yields) the strength and (if it adheres) the surface energy, of which the
    work of adhesion of a pair is 2 sqrt(gamma_i gamma_j); SI.

    The strength is one of: the yield stress in simple compression ("inf Pa" of a material that never yields); the
    hardness, which is load over projected area ("1.9 GPa") or Vickers's number ("180 HV"); yield_ratio, which is the
    overlap at first yield of two like spheres over their diameter (half of the number where a paper divides by the
    radius).
    """

    young_modulus: Pressure
    poisson_ratio: Annotated[float, Quantity("1", ge=-0.99, le=0.5, hint="percent?")]
    density: Annotated[float, Quantity("kg/m^3", above=0.0)]
    yield_stress: Annotated[float, YieldStress("Pa", above=0.0)] | None = None
    hardness: Annotated[float, Hardness("Pa", above=0.0)] | None = None
    yield_ratio: Annotated[float, Quantity("1", above=0.0, le=0.1, hint="percent?")] | None = None
    surface_energy: Annotated[float, Quantity("J/m^2", ge=0.0)] | None = None

    @model_validator(mode="after")
    def _one_strength(self) -> Self:
        given = [k for k in strength_keys() if (getattr(self, k, None) or (self.model_extra or {}).get(k)) is not None]
        if len(given) > 1:
            raise ValueError(f"both {given[0]} and {given[1]} are given, each the strength; keep one")
        return self


class Viscous(Frozen):
    """A dashpot on the elastic branches: `restitution` of impacts that do not yield."""

    restitution: Restitution
