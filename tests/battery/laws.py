# SPDX-License-Identifier: GPL-2.0-or-later
"""Random contacts of every law, for the battery: whatever the law, it must pass the same tests."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import strategies as st

from epdem.base.declarations import declarations
from epdem.laws.library import Law
from epdem.theory import backbones

NAMES = tuple(name for name, info in declarations().items() if not info.adheres)
YIELDING = tuple(n for n in NAMES if declarations()[n].parameters)
OTHERS = {"meyer": {"hardening_exponent": 0.3}}  # numbers beside the strength: without hardening meyer is thornton


# Routes to a law's numbers that take prescribed overlaps; for engines see test_embedded and test_liggghts_paths.
routes = pytest.mark.parametrize("route", ["c++", "theory"])


class TheoryLaw:
    """A law of the theory library behind the calls of Law: a step as its branches say it."""

    def __init__(self, name: str, *, E_star: float, **parameters: float):
        self.cls = backbones.LAWS[name]
        self.numbers = {"E_star": E_star} | {self.cls.declaration().symbols[k]: v for k, v in parameters.items()}

    def step(self, *, R_star, delta_max, delta):
        law = self.cls(R_star=R_star, **self.numbers)
        before, delta = np.broadcast_arrays(np.atleast_1d(delta_max).astype(float), np.atleast_1d(delta).astype(float))
        touches = delta > 0
        after = np.where(touches, np.maximum(before, delta), before)
        first = (after <= law.yield_overlap) | (delta >= after)  # on the backbone, or on its elastic start
        force, radius = np.zeros(delta.shape), np.zeros(delta.shape)
        up, down = touches & first, touches & ~first
        force[up], radius[up] = law.force(delta[up]), law.radius(delta[up])
        if down.any():
            force[down], radius[down] = law.unloading(delta[down], after[down])
        return force, radius, after

    def backbone(self, *, R_star, delta):
        law, delta = self.cls(R_star=R_star, **self.numbers), np.atleast_1d(delta)
        lost = np.where(delta > law.yield_overlap, law.work(delta) - law.recovered_work(delta), 0.0)
        return law.force(delta), law.radius(delta), law.work(delta), lost


@dataclass(frozen=True)
class Contact:
    """A law with numbers, and overlaps on the scale of its own yield."""

    name: str
    law: Law | TheoryLaw
    E_star: float
    R_star: float
    strength: float
    delta_y: float  # end of the elastic branch [m]; R* 1e-3 for hertz

    def step(self, delta_max, delta):
        return self.law.step(R_star=self.R_star, delta_max=delta_max, delta=delta)

    def backbone(self, delta):
        return self.law.backbone(R_star=self.R_star, delta=delta)

    def by(self, route: str) -> "Contact":
        """The same contact by another route."""
        return contact(self.name, self.E_star, self.R_star, self.strength / self.E_star, route)


def yield_overlap(name: str, E_star: float, R_star: float, strength: float) -> float:
    """End of the elastic branch [m], from the laws' definitions, not from the code; a new law's theory is believed."""
    ratio = {"thornton": 1.0, "johnson": 3.0, "cavity": 1.6, "meyer": 1.0}.get(name)
    if name == "hertz":
        return 1e-3 * R_star
    if ratio is None:
        return backbones.LAWS[name](E_star=E_star, R_star=R_star, **symbols(name, strength)).yield_overlap
    return R_star * (math.pi * ratio * strength / (2 * E_star)) ** 2


def numbers(name: str, strength: float) -> dict[str, float]:
    """The parameters of a law by name."""
    parameters = declarations()[name].parameters
    return {parameters[0].name: strength} | OTHERS.get(name, {}) if parameters else {}


def symbols(name: str, strength: float) -> dict[str, float]:
    """The same by the symbols of the theory."""
    return {declarations()[name].symbols[key]: value for key, value in numbers(name, strength).items()}


def contact(name: str, E_star: float, R_star: float, ratio: float, route: str = "c++") -> Contact:
    """A contact with strength = ratio E*."""
    strength = ratio * E_star
    make = {"c++": Law, "theory": TheoryLaw}[route]
    law = make(name, E_star=E_star, **numbers(name, strength))
    return Contact(name, law, E_star, R_star, strength, yield_overlap(name, E_star, R_star, strength))


def log_floats(low: float, high: float):
    return st.floats(math.log(low), math.log(high)).map(math.exp)


def contacts(names=NAMES):
    """E* 1 kPa to 10 TPa, R* 100 nm to 10 m, strength 1e-6 to 0.05 of E*."""
    return st.builds(
        contact, st.sampled_from(names), log_floats(1e3, 1e13), log_floats(1e-7, 10.0), log_floats(1e-6, 0.05)
    )


def paths(contact: Contact, fractions: list[float]) -> np.ndarray:
    """Overlaps [m] from numbers in [-0.1, 1]: below 0.5 elastic territory, above up to 1e4 times yield."""
    f = np.asarray(fractions)
    return contact.delta_y * np.where(f < 0.5, 2 * f, np.exp((f - 0.5) * 2 * math.log(1e4)))
