# SPDX-License-Identifier: GPL-2.0-or-later
"""Every unit of a case file, with every prefix, has the value that pint gives."""

import itertools
from typing import get_args

import pint
import pytest

from epdem.base.declarations import declarations
from epdem.case import impact, scene, units
from epdem.case.fields import Frozen, Quantity

MODELS = (impact.Case, scene.SceneCase)  # their import makes every model of a case file


def quantities(annotation):
    """The SI units in a type, at any depth."""
    found = {annotation.si} if isinstance(annotation, Quantity) else set()
    return found.union(*map(quantities, get_args(annotation)))


def models(model=Frozen):
    return [model, *itertools.chain.from_iterable(map(models, model.__subclasses__()))]


def si_units():
    """The SI unit of every key of a case file and of every parameter of a law."""
    fields = [field for model in models() for field in model.model_fields.values()]
    found = {m.si for field in fields for m in field.metadata if isinstance(m, Quantity)}
    found |= set().union(*(quantities(field.annotation) for field in fields))
    return sorted((found | {p.unit for law in declarations().values() for p in law.parameters}) - {"1"})


def test_every_unit_with_every_prefix_has_the_value_of_pint():
    registry, names = pint.UnitRegistry(), si_units()
    assert {"m", "Pa", "m/s", "m^2/N", "kg/m^3", "J/m^2", "rad/s", "m/s^2", "N"} <= set(names)
    pairs = [(prefix + si, si) for si, prefix in itertools.product(names, ["", *units.PREFIXES])]
    twice = [(unit, si) for unit, si in pairs if unit != si and si.startswith(("kg", "1/"))]  # a second prefix
    for unit, si in twice:
        with pytest.raises(ValueError):
            units.to_si(f"2.5 {unit}", si)
    pairs = [pair for pair in pairs if pair not in twice]
    read = {unit: units.to_si(f"2.5 {unit}", si) for unit, si in pairs}
    expected = {unit: registry.Quantity(2.5, unit).to(si).magnitude for unit, si in pairs}
    assert read == pytest.approx(expected, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(("text", "si", "value"), [("1 mm^2/N", "m^2/N", 1e-6), ("3 cm^2/N", "m^2/N", 3e-4)])
def test_the_prefix_of_a_power_is_raised_to_the_power(text, si, value):
    assert units.to_si(text, si) == pytest.approx(value, rel=1e-14, abs=0.0)
