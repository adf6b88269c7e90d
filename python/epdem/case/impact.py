# SPDX-License-Identifier: GPL-2.0-or-later
"""A case file: TOML with units in, frozen SI values out. Only this package has units.

Every mistake is a CaseError that names file, key, value, limit and next step.
"""

import math
from pathlib import Path
from typing import Annotated, Any, Generic, Literal, Self

import numpy as np
from pydantic import Field, Tag, model_validator

from .fields import (
    Coefficient,
    Frozen,
    Interval,
    Length,
    Line,
    Name,
    Quantity,
    Speed,
    Spin,
    T,
    Tangential,
    Viscous,
    by_shape,
)
from .law import AnyCase, LawChoice, check_law
from .sizes import Share
from .toml import read_toml

RIGID = "rigid"
MAX_IMPACTS = 4096
MOST_STEPS = 100_000  # in contact
HIGHEST_E_N = 1.2  # of a measurement: 1 and its noise

Angle = Annotated[float, Quantity("rad", ge=0.0, le=1.55, hint="from the normal")]
Tolerance = Annotated[float, Quantity("1", above=0.0)]


class ImpactingBody(Frozen):
    """The sphere that moves."""

    radius: Length
    material: Name


class Target(Frozen):
    """The other body: a plane, a sphere with a radius, or a rigid plane."""

    material: Name
    radius: Length | None = None


class Range(Interval[T], Generic[T]):
    """`count` values from `from` to `to`: angles evenly spaced, speeds evenly in the logarithm."""

    count: Annotated[int, Field(ge=2, le=1000)]


LISTED = Field(min_length=1, max_length=1000)
Speeds = Annotated[Annotated[Range[Speed], Tag("table")] | Annotated[list[Speed], LISTED, Tag("plain")], by_shape()]
Angles = Annotated[Annotated[Range[Angle], Tag("table")] | Annotated[list[Angle], LISTED, Tag("plain")], by_shape()]


class Impact(Frozen):
    """The two bodies and their speeds of approach along the normal.

    `angles` from the normal: the body also moves sideways, at its speed times the tangent. `spins` of the body before,
    positive as friction turns it; every speed is combined with every angle and every spin.
    """

    kind: Literal["sphere-wall", "sphere-sphere"]
    body: ImpactingBody
    target: Target
    speeds: Speeds
    angles: Angles | None = None
    spins: Annotated[list[Spin], LISTED] | None = None

    @model_validator(mode="after")
    def _target_has_radius(self) -> Self:
        if (self.target.radius is not None) != (self.kind == "sphere-sphere"):
            need = "needs" if self.kind == "sphere-sphere" else "must not have"
            raise ValueError(f"kind = {self.kind!r}: target {need} a radius")
        if self.kind == "sphere-sphere" and self.target.material == RIGID:
            raise ValueError("kind = 'sphere-sphere': a rigid target has no mass; use kind = 'sphere-wall'")
        return self

    def speed_values(self) -> np.ndarray:
        """Approach speeds [m/s], shape (n,)."""
        if isinstance(self.speeds, Range):
            return np.geomspace(self.speeds.start, self.speeds.to, self.speeds.count)
        return np.array(self.speeds)

    @property
    def oblique(self) -> bool:
        """Whether the bodies slip on each other."""
        return self.angles is not None or self.spins is not None

    def rows(self) -> np.ndarray:
        """Speed [m/s], angle [rad] and spin [rad/s] of each combination, shape (3, n)."""
        if isinstance(self.angles, Range):
            angles = np.linspace(self.angles.start, self.angles.to, self.angles.count)
        else:
            angles = np.array(self.angles or [0.0])
        grid = np.meshgrid(self.speed_values(), angles, np.array(self.spins or [0.0]), indexing="ij")
        return np.array([axis.ravel() for axis in grid])


class Rate(Frozen):
    """Strength that grows with the strain rate: times 1 + sensitivity ln(rate/reference).

    `reference` [1/s] is the rate of the test that gave the strength: 1e-3 for tensile and hardness tests, 1 for
    constants of Johnson and Cook.
    """

    sensitivity: Annotated[float, Quantity("1", ge=0.0, le=0.1, hint="about 0.012 for steel")]
    reference: Annotated[float, Quantity("1/s", above=0.0)] = 1e-3


class Numerics(Frozen):
    """Steps of the shortest contact, or the largest relative `error` of e_n, for which the step is then searched."""

    steps_in_contact: Annotated[int, Field(ge=5, le=MOST_STEPS)] = 400
    error: Annotated[float, Field(ge=1e-9, le=0.1)] | None = None
    phases: Annotated[int, Field(ge=1, le=64)] = 8

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        if self.error is not None and "steps_in_contact" in self.model_fields_set:
            raise ValueError("both 'error' and 'steps_in_contact' are given; keep one")
        return self


class Check(Frozen):
    """Largest relative errors with which a run passes (maximum over the phases), by default at 400 steps in contact."""

    e_n: Tolerance = 1e-4
    contact_time: Tolerance = 5e-3
    force_max: Tolerance = 1e-3
    overlap_max: Tolerance = 1e-3
    residual_overlap: Tolerance = 1e-3
    psi_2: Tolerance = 0.05  # absolute: of the sliding velocity after an oblique impact, in mu/kappa times the speed


class Measured(Frozen):
    """Measured restitution beside theory in figure and page; no check uses it."""

    source: Line
    speeds: Annotated[list[Speed], LISTED]
    e_n: list[Annotated[float, Quantity("1", ge=0.0, le=HIGHEST_E_N, hint="percent?")]]

    @model_validator(mode="after")
    def _pairs(self) -> Self:
        if len(self.speeds) != len(self.e_n):
            raise ValueError(f"speeds: {len(self.speeds)}, e_n: {len(self.e_n)}; give one e_n for each speed")
        return self


class Friction(Frozen):
    """Friction of oblique impacts."""

    friction: Coefficient
    tangential: Tangential = "history"
    tangential_restitution: Share | None = None  # of the dashpot beside the tangential spring


class Case(AnyCase):
    """One experiment: impacts of one body on one target over a range of speeds."""

    impact: Impact
    law: LawChoice
    rate: Rate | None = None
    viscous: Viscous | None = None
    contact: Friction | None = None
    numerics: Numerics = Numerics()
    check: Check = Check()
    measured: Measured | None = None

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if RIGID in self.materials:
            raise ValueError(f"materials.{RIGID}: this name is kept for a rigid target; choose another")
        for place, name in (("body", self.impact.body.material), ("target", self.impact.target.material)):
            if place == "body" and name == RIGID:
                raise ValueError(f"impact.body.material = {name!r}: only the target can be rigid; name a material")
            if name not in self.materials and name != RIGID:
                raise ValueError(f"impact.{place}.material = {name!r} is not defined; add [materials.{name}]")
        impacts = self.impact.rows().shape[1] * self.numerics.phases
        if impacts > MAX_IMPACTS:
            kinds = "speeds x angles x spins" if self.impact.oblique else "speeds"
            raise ValueError(f"{impacts} impacts ({kinds} x phases), at most {MAX_IMPACTS}; lower count or phases")
        self._friction()
        check_law(self.law, self.materials)
        return self

    def _friction(self) -> None:
        """Raise ValueError unless oblique impacts, and only they, have friction."""
        if self.impact.oblique and (self.contact is None or self.contact.friction == 0.0):
            raise ValueError("impact.angles, impact.spins: without friction they change nothing; give contact.friction")
        if self.contact is not None and not self.impact.oblique:
            raise ValueError("contact: nothing rubs in a normal impact; give impact.angles, or remove it")
        if self.impact.oblique and self.viscous:
            raise ValueError("viscous: there is no theory of oblique impacts with a dashpot; remove one of both")
        if self.impact.oblique and self.measured:
            raise ValueError("measured: these are e_n of normal impacts; remove it, or impact.angles and impact.spins")

    @property
    def tolerances(self) -> Check:
        """`check`; by default psi_2 of one spring or with a dashpot is not checked: theory has partial slip alone."""
        c = self.contact
        of_theory = c is None or (c.tangential != "history" and c.tangential_restitution is None)
        if of_theory or "psi_2" in self.check.model_fields_set:
            return self.check
        return self.check.model_copy(update={"psi_2": math.inf})


def parse(data: dict[str, Any], path: object = "case") -> Case:
    """A Case from TOML data; `path` names the place in messages. Raises CaseError."""
    return Case.read(data, path, "impact")


def load(path: Path | str) -> Case:
    """The case in a file. Raises CaseError."""
    return parse(read_toml(path), path)
