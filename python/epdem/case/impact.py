# SPDX-License-Identifier: GPL-2.0-or-later
"""A case file: TOML with units in, frozen SI values out. Nothing behind this module knows a unit.

Every mistake is a CaseError that names file, key, value, limit and next step.
"""

import contextlib
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, model_validator

from ..errors import CaseError
from .messages import explain
from .units import to_si

RIGID = "rigid"
MAX_IMPACTS = 4096
# Largest relative errors a case accepts if it does not say (maximum over the phases, 400 steps in contact).
DEFAULT_CHECKS = {"e_n": 1e-4, "contact_time": 5e-3, "force_max": 1e-3, "overlap_max": 1e-3, "residual_overlap": 1e-3}


# Beyond these nothing in a particle simulation lies, and the laws' powers of them could leave the range of numbers.
LIMITS = {"Pa": (1e-9, 1e30), "m": (1e-12, 1e6), "kg/m^3": (1e-9, 1e20), "m/s": (1e-30, 1e12)}


def within_limits(x: float, si: str) -> float:
    """x, if its size is one that is computed with. Raises ValueError."""
    low, high = LIMITS.get(si, (0.0, np.inf))
    if x and not low <= abs(x) <= high:
        raise ValueError(f"must lie in [{low:g}, {high:g}] {si}; check the unit")
    return x


def quantity(si: str, *, above: float | None = None, hint: str = "", **limits: float):
    """A pydantic type: a quantity in `si`, in (above, ...) or within ge/le; `hint` ends the message."""

    def read(value: object) -> float:
        x = to_si(value, si)
        low, high = limits.get("ge"), limits.get("le")
        bad = (above is not None and x <= above) or (low is not None and x < low) or (high is not None and x > high)
        if bad:
            left = f"({above:g}" if above is not None else f"[{low:g}" if low is not None else "(-inf"
            right = f"{high:g}]" if high is not None else "inf)"
            raise ValueError(f"must lie in {left}, {right}{'' if si == '1' else ' ' + si}{'; ' + hint if hint else ''}")
        return within_limits(x, si)

    return Annotated[float, BeforeValidator(read)]


def _printable_line(value: object) -> str:
    if not isinstance(value, str) or not value.strip() or not value.isprintable() or len(value) > 200:
        raise ValueError("must be one printable line of at most 200 characters")
    if value.rstrip().endswith("&"):  # LIGGGHTS would read the next command as part of a comment
        raise ValueError("must not end in '&' (it would swallow the next line of the deck)")
    return value


Line = Annotated[str, BeforeValidator(_printable_line)]
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9_][A-Za-z0-9_-]{0,63}$")]


class Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class Header(Frozen):
    name: Name
    title: Line
    source: Line


class Material(Frozen):
    """Elastic constants, density and (if the law yields) the yield stress in simple compression, SI."""

    young_modulus: quantity("Pa", above=0.0)
    poisson_ratio: quantity("1", above=-1.0, le=0.5, hint="percent?")
    density: quantity("kg/m^3", above=0.0)
    yield_stress: quantity("Pa", above=0.0) | None = None


class Body(Frozen):
    radius: quantity("m", above=0.0)
    material: Name


class Target(Frozen):
    material: Name
    radius: quantity("m", above=0.0) | None = None


class SpeedRange(Frozen):
    """Speeds from `from` to `to`, evenly spaced in the logarithm."""

    start: quantity("m/s", above=0.0) = Field(alias="from")
    to: quantity("m/s", above=0.0)
    count: Annotated[int, Field(ge=2, le=1000)]

    @model_validator(mode="after")
    def _ordered(self):
        if not self.to > self.start:
            raise ValueError(f"'to' ({self.to:g} m/s) must exceed 'from' ({self.start:g} m/s)")
        return self


class Impact(Frozen):
    kind: Literal["sphere-wall", "sphere-sphere"]
    body: Body
    target: Target
    speeds: SpeedRange | Annotated[list[quantity("m/s", above=0.0)], Field(min_length=1, max_length=1000)]

    @model_validator(mode="after")
    def _target_has_radius(self):
        if (self.target.radius is not None) != (self.kind == "sphere-sphere"):
            need = "needs" if self.kind == "sphere-sphere" else "must not have"
            raise ValueError(f"kind = {self.kind!r}: target {need} a radius")
        if self.kind == "sphere-sphere" and self.target.material == RIGID:
            raise ValueError("kind = 'sphere-sphere': a rigid target has no mass; use kind = 'sphere-wall'")
        return self

    def speed_values(self) -> np.ndarray:
        """Approach speeds [m/s], shape (n,)."""
        if isinstance(self.speeds, SpeedRange):
            return np.geomspace(self.speeds.start, self.speeds.to, self.speeds.count)
        return np.array(self.speeds)


class LawChoice(BaseModel):
    """The law by name; its parameters are checked against the law itself, see experiment.choose_law."""

    model_config = ConfigDict(frozen=True, extra="allow", strict=True)
    name: Name

    def parameters(self) -> dict[str, Any]:
        """What the file says beside the name, as written."""
        return dict(self.model_extra or {})


class Viscous(Frozen):
    """A dashpot on the elastic branches: `restitution` of impacts that do not yield."""

    restitution: quantity("1", ge=0.14, le=1.0, hint="1 is no dashpot, below 0.14 none is strong enough")


class Numerics(Frozen):
    """Steps of the shortest contact, or the largest relative `error` of e_n, for which the step is then searched."""

    steps_in_contact: Annotated[int, Field(ge=5, le=100_000)] = 400
    error: Annotated[float, Field(ge=1e-9, le=0.1)] | None = None
    phases: Annotated[int, Field(ge=1, le=64)] = 8

    @model_validator(mode="after")
    def _one_of_two(self):
        if self.error is not None and "steps_in_contact" in self.model_fields_set:
            raise ValueError("both 'error' and 'steps_in_contact' are given; keep one")
        return self


class Check(Frozen):
    e_n: quantity("1", above=0.0) = DEFAULT_CHECKS["e_n"]
    contact_time: quantity("1", above=0.0) = DEFAULT_CHECKS["contact_time"]
    force_max: quantity("1", above=0.0) = DEFAULT_CHECKS["force_max"]
    overlap_max: quantity("1", above=0.0) = DEFAULT_CHECKS["overlap_max"]
    residual_overlap: quantity("1", above=0.0) = DEFAULT_CHECKS["residual_overlap"]


class Case(Frozen):
    """One experiment: impacts of one body on one target over a range of speeds."""

    case: Header
    materials: dict[Name, Material]
    impact: Impact
    law: LawChoice
    viscous: Viscous | None = None
    numerics: Numerics = Numerics()
    check: Check = Check()

    @model_validator(mode="after")
    def _consistent(self):
        if RIGID in self.materials:
            raise ValueError(f"materials.{RIGID}: this name is kept for a rigid target; choose another")
        for place, name in (("body", self.impact.body.material), ("target", self.impact.target.material)):
            if place == "body" and name == RIGID:
                raise ValueError(f"impact.body.material = {name!r}: only the target can be rigid; name a material")
            if name not in self.materials and name != RIGID:
                raise ValueError(f"impact.{place}.material = {name!r} is not defined; add [materials.{name}]")
        impacts = len(self.impact.speed_values()) * self.numerics.phases
        if impacts > MAX_IMPACTS:
            raise ValueError(f"{impacts} impacts (speeds x phases), at most {MAX_IMPACTS}; lower count or phases")
        return self

    @property
    def name(self) -> str:
        return self.case.name


def parse(data: dict, path: object = "case") -> Case:
    """A Case from TOML data; `path` names the place in messages. Raises CaseError."""
    try:
        return Case.model_validate(data)
    except ValidationError as error:
        raise CaseError(explain(path, data, error, "impact")) from None


def read_toml(path: Path | str) -> dict:
    """The raw tables of a TOML file. Raises CaseError."""
    path = Path(path)
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise CaseError(f"{path}: no such file; the examples are in cases/") from None
    except (OSError, UnicodeDecodeError) as error:
        raise CaseError(f"{path}: cannot be read ({error})") from None
    except tomllib.TOMLDecodeError as error:
        raise CaseError(f"{path}: not valid TOML: {error}") from None


@contextlib.contextmanager
def named(path: Path | str) -> Iterator[None]:
    """Errors of a case that was read from `path` name the file."""
    try:
        yield
    except CaseError as error:
        raise error if str(path) in str(error) else CaseError(f"{path}: {error}") from None


def load(path: Path | str) -> Case:
    """The case in a file. Raises CaseError."""
    return parse(read_toml(path), path)
